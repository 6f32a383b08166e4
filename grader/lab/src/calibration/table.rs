//! The results as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::plot::{MADE_FOR, times};
use super::{Counts, Line, Test};
use crate::mutants::Record;
use verdict::report::Verdict;

/// False alarms of the statistics alone and of whole grades, power, and what simpler tests need, as tables. `wrong` names
/// the wrong variants.
pub fn table(
    lines: &[&Line],
    wrong: &[String],
    checks: &[String],
    grades: &BTreeMap<String, Vec<&Record>>,
) -> String {
    let of_right: Vec<&Line> = lines.iter().copied().filter(|line| !wrong.contains(&line.variant)).collect();
    let ours: Vec<&Line> = of_right.iter().copied().filter(|line| line.test == Test::Sequential).collect();
    let mut text = String::from(
        "# How often correct submissions fail, and how small an error is found\n\nMade by `cargo lab calibrate`; do \
         not edit. No failure in n grades shows a rate below 3/n (at 95 %).\n",
    );
    false_alarms(&mut text, &ours, checks);
    power(&mut text, &ours, checks);
    whole_grades(&mut text, grades);
    if lines.iter().any(|line| line.test != Test::Sequential) {
        cost_of_bias(&mut text, &of_right, checks);
        cost_of_mistakes(&mut text, lines, wrong);
    }
    text
}

fn false_alarms(text: &mut String, lines: &[&Line], checks: &[String]) {
    let of = |select: &dyn Fn(&Line) -> bool| -> Counts {
        lines
            .iter()
            .filter(|line| line.bias == 0.0 && select(line))
            .map(|line| line.counts)
            .fold(Counts::default(), std::ops::Add::add)
    };
    let mut variants: Vec<&str> = lines.iter().map(|line| line.variant.as_str()).collect();
    variants.sort_unstable();
    variants.dedup();
    let all = of(&|_| true);
    let grades = all.grades / checks.len().max(1) as u64;
    add(
        text,
        format_args!(
            "\n## The statistics alone: {} of {grades} simulated grades fail\n\nEach grade draws the samples of {} checks \
         anew from recorded ones, of {} correct variants in turn.\n\n| check | judged | called biased | inconclusive | \
         paths each |\n|---|---:|---:|---:|---:|",
            all.biased,
            checks.len(),
            variants.len()
        ),
    );
    for check in checks {
        let counts = of(&|line| line.check == *check);
        let paths = counts.samples / counts.grades.max(1);
        add(
            text,
            format_args!(
                "| {check} | {} | {} | {} | {paths} |",
                counts.grades, counts.biased, counts.unclear
            ),
        );
    }
}

fn power(text: &mut String, lines: &[&Line], checks: &[String]) {
    let mut biases: Vec<f64> = lines.iter().map(|line| line.bias).filter(|&bias| bias != 0.0).collect();
    biases.sort_by(f64::total_cmp);
    biases.dedup();
    let heads: Vec<String> = biases.iter().map(|bias| format!("{:.1} %", 100.0 * bias)).collect();
    add(
        text,
        format_args!(
            "\n## Power: how often samples of the solution that are all too bright do not pass\n\n| check | {} |\n|---|{}",
            heads.join(" | "),
            "---:|".repeat(heads.len())
        ),
    );
    for check in checks {
        let cell = |bias: &f64| {
            let found = lines.iter().find(|line| line.check == *check && line.bias == *bias);
            found.map_or("–".to_owned(), |line| {
                let Counts { grades, biased, unclear, .. } = line.counts;
                let share = |count: u64| 100.0 * count as f64 / grades.max(1) as f64;
                match unclear {
                    0 => format!("{:.0} %", share(biased)),
                    _ => format!("{:.0} % + {:.0} % inconclusive", share(biased), share(unclear)),
                }
            })
        };
        let cells: Vec<String> = biases.iter().map(cell).collect();
        add(text, format_args!("| {check} | {} |", cells.join(" | ")));
    }
}

fn whole_grades(text: &mut String, grades: &BTreeMap<String, Vec<&Record>>) {
    let fails = |record: &Record| record.checks.values().any(|&verdict| verdict == Verdict::Fail);
    let full = |record: &Record| record.tasks.values().all(|[earned, worth]| earned >= worth);
    let failed = |records: &[&Record]| records.iter().filter(|record| fails(record)).count();
    let undecided = |records: &[&Record]| records.iter().filter(|it| !fails(it) && !full(it)).count();
    let all: Vec<&Record> = grades.values().flatten().copied().collect();
    add(
        text,
        format_args!(
            "\n## Whole grades: {} of {} fail a check, {} lose points to one that stays undecided\n\n| correct variant | \
             grades | fail a check | leave one undecided | seconds each |\n|---|---:|---:|---:|---:|",
            failed(&all),
            all.len(),
            undecided(&all)
        ),
    );
    for (variant, records) in grades {
        let seconds: f64 = records.iter().map(|record| record.seconds).sum();
        add(
            text,
            format_args!(
                "| `{variant}` | {} | {} | {} | {:.1} |",
                records.len(),
                failed(records),
                undecided(records),
                seconds / records.len().max(1) as f64
            ),
        );
    }
}

/// Processor time that each test needs to find a bias.
fn cost_of_bias(text: &mut String, lines: &[&Line], checks: &[String]) {
    add(
        text,
        format_args!(
            "\n## What simpler tests need\n\nMilliseconds of one core until an error of that size is found, in 19 of 20 \
             draws of the solution's samples, for {}. The tests with a fixed number of samples (N) have the nominal rate of \
             false alarms that ours has, and are told the best power of two beforehand, from 32 to 8192 for each pixel, of those with \
             which they sound no alarm in 20 draws where nothing is wrong. With 1024 samples they do so as often as stands \
             beside it. `–`: not found.\n\n| check | {} | false alarms |\n|---|{}---|",
            Test::ALL.map(Test::name).join(" / "),
            BIASES_SHOWN.map(|bias| format!("{:.0} %", 100.0 * bias)).join(" | "),
            "---:|".repeat(BIASES_SHOWN.len())
        ),
    );
    for check in checks {
        let line = |test, bias: f64| {
            lines.iter().find(|line| line.check == *check && line.test == test && line.bias == bias)
        };
        let cell = |bias: f64| {
            let cost = |test| match line(test, bias) {
                Some(line) if line.found() => format!("{:.0}", 1000.0 * line.seconds()),
                _ => "–".to_owned(),
            };
            Test::ALL.map(cost).join(" / ")
        };
        let alarms = |test| {
            let of_all =
                lines.iter().filter(|line| line.check == *check && line.test == test && line.bias == 0.0);
            let counts = of_all.map(|line| line.counts).fold(Counts::default(), std::ops::Add::add);
            format!("{} of {}", counts.biased, counts.grades)
        };
        let alarms = Test::ALL.map(alarms).join(" / ");
        add(text, format_args!("| {check} | {} | {alarms} |", BIASES_SHOWN.map(cell).join(" | ")));
    }
}

/// The errors whose cost is shown.
const BIASES_SHOWN: [f64; 3] = [0.01, 0.02, 0.05];

/// Processor time that each test needs to find a wrong variant, in the check where that takes it the least.
fn cost_of_mistakes(text: &mut String, lines: &[&Line], wrong: &[String]) {
    let found = Test::ALL.map(|test| times(lines, wrong, test));
    let middle = |times: &Vec<f64>| match times.get(times.len() / 2) {
        Some(time) => format!("{:.0}", 1000.0 * time),
        None => "–".to_owned(),
    };
    add(
        text,
        format_args!(
            "\n## What simpler tests need to find the wrong variants\n\nMilliseconds of one core, in the check by means that \
             finds it first; the fixed numbers of samples are those that find an error of {:.0} % in the solution's samples, or more \
             where that takes more. What is unbiased should have no time, since other checks find that: a test that finds it has \
             taken more noise, or heavier tails, for an error. Of {} wrong variants {} are found, in {} ms \
             in the median. As a plot: `calibration.svg`.\n\n| variant | {} |\n|---|{}",
            100.0 * MADE_FOR,
            wrong.len(),
            found.each_ref().map(|times| times.len().to_string()).join(" / "),
            found.each_ref().map(middle).join(" / "),
            Test::ALL.map(Test::name).join(" | "),
            "---:|".repeat(Test::ALL.len())
        ),
    );
    for variant in wrong {
        let cell = |test| {
            times(lines, std::slice::from_ref(variant), test)
                .first()
                .map_or("–".to_owned(), |seconds| format!("{:.0}", 1000.0 * seconds))
        };
        add(text, format_args!("| `{variant}` | {} |", Test::ALL.map(cell).join(" | ")));
    }
}

fn add(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    writeln!(text, "{arguments}").expect("writing to a string never fails");
}
