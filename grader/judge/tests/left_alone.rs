//! What a submission must leave as it is: plain BSDF sampling, and scenes without lights.

use std::path::PathBuf;

use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Options, grade};
use verdict::check::{CheckKind, Deviation, Evidence, NumericalCause, Reason, Verdict};
use verdict::report::Report;
use verdict::submission::Submission;

/// The grade of the changed solution in the selected checks. Each text must occur exactly once.
fn graded(only: &str, changes: &[(&str, &str)]) -> Report {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let assignment = harness::assignment::Assignment::open(&workspace, "05-nee-mis").expect("it is sound");
    let mut source = assignment.solution().expect("the solution is there");
    for (from, to) in changes {
        assert_eq!(source.matches(from).count(), 1, "{from}");
        source = source.replace(from, to);
    }
    let options = Options {
        assignment: "05-nee-mis".to_owned(),
        seed: 1,
        threads: 2,
        only: vec![only.to_owned()],
        limits: Limits::default(),
    };
    let submission = Submission { path: PathBuf::from("render_pt.rs"), source };
    let report = grade(&workspace, &submission, &options, |_| {}).expect("the harness works");
    assert!(report.submission.build_failure.is_none(), "{:?}", report.submission.build_failure);
    report
}

fn verdict(report: &Report, kind: CheckKind) -> &Verdict {
    let check = report.checks.iter().find(|check| check.id.kind == kind);
    &check.unwrap_or_else(|| panic!("{kind} was not run")).verdict
}

const NO_LIGHT_SAMPLES: (&str, &str) =
    ("if self.settings.technique == Technique::Bsdf || bsdf.is_delta()", "if bsdf.is_delta()");

/// One seed, so that it is repeatable.
#[test]
fn plain_bsdf_sampling_has_no_light_samples_and_all_hits() {
    let causes = |report: &Report| -> Vec<String> {
        report.diagnosis.iter().map(|diagnosis| diagnosis.cause.id().to_owned()).collect()
    };
    let (selection, mean) = (CheckKind::LightPick, CheckKind::MeanBias);
    let right = graded("bsdf", &[]);
    assert_eq!((verdict(&right, selection), verdict(&right, mean)), (&Verdict::Pass, &Verdict::Pass));
    assert!(causes(&right).is_empty());

    let added = graded("bsdf", &[NO_LIGHT_SAMPLES]);
    assert_eq!((verdict(&added, selection), verdict(&added, mean)), (&Verdict::Fail, &Verdict::Fail));
    assert_eq!(causes(&added), ["bsdf-changed"]);

    // Next event estimation in its place is unbiased, but finds point lights.
    let replaced = graded("bsdf", &[NO_LIGHT_SAMPLES, ("Technique::Bsdf => 1.0", "Technique::Bsdf => 0.0")]);
    assert_eq!(verdict(&replaced, selection), &Verdict::Fail);

    let dropped = graded("bsdf", &[("Technique::Bsdf => 1.0", "Technique::Bsdf => 0.0")]);
    assert_eq!((verdict(&dropped, selection), verdict(&dropped, mean)), (&Verdict::Pass, &Verdict::Fail));
}

/// The selection of the sheet panics where there is no light.
const SELECTION: (&str, &str) = (
    "let Some(light) = scene.lights().get(pick as usize) else { return Rgb::BLACK };",
    "let light = &scene.lights()[pick as usize];",
);

#[test]
fn a_panic_without_lights_hides_nothing_that_is_seen_with_lights() {
    let report = graded("stability", &[SELECTION]);
    for check in &report.checks {
        assert_eq!((&check.verdict, check.reason), (&Verdict::Fail, Reason::Crash), "{check:#?}");
        let Some(Evidence::Stability(test)) = &check.evidence else { panic!("{check:#?}") };
        let panics = test.findings.iter().filter(|it| matches!(it.deviation, Deviation::Panic { .. }));
        let causes: Vec<&NumericalCause> = panics.map(|finding| &finding.likely_cause).collect();
        assert_eq!(causes, [&NumericalCause::NoLights]);
    }
    let two = [
        SELECTION,
        (
            "scene.occluded(hit, sample.point)",
            "scene.occluded(hit, sample.point) || scene.occluded(hit, sample.point)",
        ),
    ];
    for (changes, reason) in [(&two[..1], Reason::Crash), (&two[..], Reason::RayBudget)] {
        for check in graded("ray-budget", changes).checks {
            let Some(Evidence::RayBudget(rays)) = &check.evidence else { panic!("{check:#?}") };
            assert!(
                rays.panic_without_lights.as_ref().is_some_and(|message| message.contains("render_pt.rs"))
            );
            assert_eq!((check.reason, rays.excess.is_some()), (reason, reason == Reason::RayBudget));
        }
    }
}
