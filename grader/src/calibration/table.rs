//! The results as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{Counts, Line};
use crate::mutants::Record;

/// False alarms of the statistics alone and of whole grades, and power, as tables.
pub fn table(lines: &[&Line], checks: &[String], grades: &BTreeMap<String, Vec<&Record>>) -> String {
    let mut text = String::from(
        "# How often correct hand-ins fail, and how small an error is found\n\nMade by `cargo grader calibrate`; do \
         not edit. No failure in n grades shows a rate below 3/n (at 95 %).\n",
    );
    false_alarms(&mut text, lines, checks);
    power(&mut text, lines, checks);
    whole_grades(&mut text, grades);
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
    let full = |record: &Record| record.tasks.values().all(|[earned, worth]| earned >= worth);
    let count = |records: &[&Record]| records.iter().filter(|record| !full(record)).count();
    let all: usize = grades.values().map(Vec::len).sum();
    let failed: usize = grades.values().map(|records| count(records)).sum();
    add(
        text,
        format_args!(
            "\n## Whole grades: {failed} of {all} lose points\n\n| correct variant | grades | lose points | seconds each \
         |\n|---|---:|---:|---:|"
        ),
    );
    for (variant, records) in grades {
        let seconds: f64 = records.iter().map(|record| record.seconds).sum();
        add(
            text,
            format_args!(
                "| `{variant}` | {} | {} | {:.1} |",
                records.len(),
                count(records),
                seconds / records.len().max(1) as f64
            ),
        );
    }
}

fn add(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    writeln!(text, "{arguments}").expect("writing to a string never fails");
}
