use super::*;

#[test]
fn what_was_not_run_says_why() {
    let lost = Some(id(CheckKind::MeanBias, "box"));
    for (verdict, expected) in [
        (
            Verdict::Skipped { why: SkipReason::PointsLostTo(lost) },
            "skipped because mean-bias/box/nee/8 failed",
        ),
        (Verdict::Skipped { why: SkipReason::PointsLostTo(None) }, "skipped because a required check failed"),
        (Verdict::NotRun { why: NotRun::OutOfTime }, "not run because earlier checks did not finish in time"),
    ] {
        assert_eq!(explanation(&check(verdict, Evidence::MeanBias(mean_test()))), expected);
    }
    for (why, expected) in [
        (WhyNot::ManyLights(49), "there are 49 lights, too many to add up their closed forms"),
        (WhyNot::Bounces { min: 1, max: 1 }, "this check needs exactly 1 bounce"),
        (
            WhyNot::AlikeNoise { at_most: 3.04, needed: 20.0 },
            "the other techniques have at most 3.0 times the variance of this one; a factor of 20 is needed to tell them apart",
        ),
    ] {
        assert_eq!(why_not(&why), expected);
    }
}

#[test]
fn tasks_and_sums_say_where_their_points_are() {
    let task = report("x").tasks[0].clone();
    let missing = vec![id(CheckKind::MeanBias, "a"), id(CheckKind::Efficiency, "b")];
    let required = id(CheckKind::MisWeights, "scripted");
    for (state, expected) in [
        (TaskState::Graded { missing }, "mean-bias/a/nee/8, efficiency/b/nee/8"),
        (TaskState::Graded { missing: Vec::new() }, "a check that only staff can see did not pass"),
        (
            TaskState::RequiredCheckMissing(Some(required)),
            "mis-weights/scripted/nee/8 must pass for any points in this task",
        ),
        (
            TaskState::RequiredTaskMissing("5.1a".to_owned()),
            "the required checks of 5.1a must pass for any points in this task",
        ),
        (TaskState::ByHand { comment: None }, "graded by your tutor"),
        (TaskState::ByHand { comment: Some("well done".to_owned()) }, "graded by your tutor: well done"),
    ] {
        assert_eq!(task_state(&TaskResult { state, ..task.clone() }), expected);
    }
    let full = TaskResult { points: Some(20.0), state: TaskState::Graded { missing: Vec::new() }, ..task };
    assert_eq!(task_state(&full), "");
    let points = |manual, staff_only| Points { manual_max: 10.0, manual, staff_only, ..Points::default() };
    assert_eq!(not_covered(&points(None, 0.0)), "10 more are graded by your tutor");
    assert_eq!(
        not_covered(&points(Some(7.5), 2.5)),
        "up to 2.5 points are added after submission; your tutor gave 7.5 of 10"
    );
    assert_eq!(not_covered(&Points::default()), "");
}

#[test]
fn causes_say_what_was_seen() {
    let mut report = report("x");
    report.checks[0] = check(Verdict::Fail, Evidence::MeanBias(mean_test()));
    let right = check(Verdict::Pass, Evidence::WhiteFurnace(furnace_test()));
    report.checks.push(right.clone());
    let seen_in = Some(SeenIn { wrong: report.checks[0].id.clone(), right: Some(right.id) });
    let known = Cause::Known { id: "a".to_owned(), title: "A title".to_owned(), hint: "A hint".to_owned() };
    let said = |report: &Report, cause: &Cause| {
        let diagnosis = Diagnosis { cause: cause.clone(), confidence: 1.0, seen: seen_in.clone() };
        [heading(&diagnosis), seen(report, &diagnosis)]
    };
    assert_eq!(
        said(&report, &known),
        [
            "Likely cause: A title",
            "the mean radiance is 0.88 ± 0.01 times what it should be in box (`nee`); the mean radiance is correct in box (`nee`)"
        ]
    );
    let factor = Cause::ConstantFactor { factor: 0.5, scenes: ["a", "b"].map(str::to_owned).into() };
    assert_eq!(
        said(&report, &factor),
        [
            "Likely cause: Each light sample is 0.5 times as bright as it should be, whatever the scene",
            "direct light is off by this factor in a and b"
        ]
    );
    assert_eq!(said(&report, &Cause::Unknown { several_fit: false })[1], "");
    report.checks[0].reason = Reason::Timeout;
    assert_eq!(
        said(&report, &Cause::DoesNotFinish { late: 1 })[1],
        "1 check did not finish in time, mean-bias/box/nee/8 among them"
    );
    report.checks[0].fault = Some(Fault::Panic("not yet implemented".to_owned()));
    assert_eq!(
        said(&report, &Cause::TodoLeft)[1],
        "in mean-bias/box/nee/8, the program panicked: not yet implemented"
    );
    let messages = "warning: w\nerror[E0425]: cannot find value `x`\nerror: other\n".to_owned();
    report.submission.build_failure = Some(BuildFailure { messages, line: Some(7) });
    assert_eq!(said(&report, &Cause::DoesNotCompile)[1], "error[E0425]: cannot find value `x` (line 7)");
    report.submission.refusal =
        Some(IntakeFinding { code: "missing-file".to_owned(), message: "there is none\nb".to_owned() });
    assert_eq!(said(&report, &Cause::NothingToCompile)[1], "missing-file: there is none");
}

#[test]
fn commands_are_quoted_for_a_shell() {
    let mut report = report("x");
    report.submission.path = "Ann's file/render_pt.rs".to_owned();
    report.provenance.assignment = "05-nee-mis".to_owned();
    report.provenance.seed = Some(3);
    assert_eq!(
        repeat_command(&report, &id(CheckKind::MeanBias, "a b")),
        r"cargo grade 'Ann'\''s file/render_pt.rs' --assignment=05-nee-mis --seed=3 --only='mean-bias/a b/nee/8'"
    );
    let off = ReplayTarget { scale: 0.5, emission: 2.0, emission_on_hit: EmissionOnHit::Off, ..target() };
    assert!(
        replay_command(&off, "a.rs").ends_with("--size=32x24 --emission-on-hit=off --scale=0.5 --emission=2")
    );
}

#[test]
fn every_kind_says_what_it_checks() {
    for kind in CheckKind::ALL {
        assert!(about(kind).starts_with(char::is_lowercase) && !about(kind).ends_with('.'), "{kind}");
    }
}
