//! The kill matrix as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{Kind, Outcome, Record, Variant, Variants};
use verdict::report::Verdict;
use verdict::rubric::Rubric;

/// Variant against check, with points and what became of it.
pub fn table(variants: &Variants, rubric: &Rubric, records: &[Vec<&Record>]) -> String {
    let checks: Vec<String> =
        rubric.checks().map(|(task, spec)| format!("{} {}", task.id, spec.id())).collect();
    let tasks: Vec<&str> =
        rubric.tasks.iter().filter(|task| !task.manual).map(|task| task.id.as_str()).collect();
    let mut text = String::from(
        "# Which check catches which mistake\n\nMade by `cargo lab mutants`; do not edit. The variants stand in \
         `wrong.yml` and `right.yml`.\n\n`·` pass, `F` fail, `?` inconclusive (no points), several where seeds differ. \
         Points are the fewest over all seeds, for right variants too; seconds are the mean over them, on one core.\n\n",
    );
    for (kind, title) in [(Kind::Wrong, "Wrong variants"), (Kind::Right, "Right variants")] {
        let rows = || variants.list.iter().zip(records).filter(|(variant, _)| variant.kind == kind);
        let caught = rows().filter(|(variant, records)| {
            let Outcome { missed, blamed, graded, .. } = Outcome::new(variant, records);
            graded && missed.is_empty() && blamed.is_empty()
        });
        let word = match kind {
            Kind::Wrong => "caught, and for the right tasks",
            Kind::Right => "with full points",
        };
        line(&mut text, format_args!("## {title}: {} of {} {word}\n", caught.count(), rows().count()));
        header(&mut text, &tasks, checks.len());
        for (variant, records) in rows() {
            row(&mut text, variant, records, &tasks, &checks);
        }
        line(&mut text, format_args!(""));
    }
    line(&mut text, format_args!("## Checks\n"));
    for (index, check) in checks.iter().enumerate() {
        line(&mut text, format_args!("{}. {check}", index + 1));
    }
    line(&mut text, format_args!("\n## Why mistakes are missed\n"));
    for variant in &variants.list {
        let mut by_reason: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for (task, why) in &variant.missed_because {
            by_reason.entry(why).or_default().push(task);
        }
        for (why, tasks) in by_reason {
            line(&mut text, format_args!("- `{}`, {}: {why}.", variant.id, tasks.join(", ")));
        }
    }
    line(&mut text, format_args!("\n## Mistakes that no submission can make\n"));
    for missing in &variants.not_possible {
        line(&mut text, format_args!("- Row {}: {}.", missing.row, missing.why));
    }
    text
}

fn line(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    writeln!(text, "{arguments}").expect("writing to a string never fails");
}

fn header(text: &mut String, tasks: &[&str], checks: usize) {
    let numbers: Vec<String> = (1..=checks).map(|number| number.to_string()).collect();
    let columns = format!("{} | s | {}", tasks.join(" | "), numbers.join(" | "));
    line(text, format_args!("| variant | rows | outcome | seeds | {columns} |"));
    let numeric = "---:|".repeat(tasks.len() + 2);
    line(text, format_args!("|---|---|---|{numeric}{}", ":-:|".repeat(checks)));
}

fn row(text: &mut String, variant: &Variant, records: &[&Record], tasks: &[&str], checks: &[String]) {
    let points = |task: &&str| {
        let fewest = records.iter().filter_map(|record| record.tasks.get(*task)).map(|[earned, _]| *earned);
        fewest.reduce(f64::min).map_or_else(|| "–".to_owned(), |points| points.to_string())
    };
    let cell = |check: &String| {
        let mut symbols: Vec<char> =
            records.iter().map(|record| symbol(record.checks.get(check).copied())).collect();
        symbols.sort_unstable();
        symbols.dedup();
        symbols.into_iter().collect::<String>()
    };
    let seconds = records.iter().map(|record| record.seconds).sum::<f64>() / records.len().max(1) as f64;
    let outcome = Outcome::new(variant, records).word(variant.kind);
    let cells = tasks
        .iter()
        .map(points)
        .chain([format!("{seconds:.0}")])
        .chain(checks.iter().map(cell))
        .collect::<Vec<_>>()
        .join(" | ");
    let (id, rows) = (&variant.id, variant.rows.join(", "));
    line(text, format_args!("| `{id}` | {rows} | {outcome} | {} | {cells} |", records.len()));
}

fn symbol(verdict: Option<Verdict>) -> char {
    match verdict {
        Some(Verdict::Pass) => '·',
        Some(Verdict::Fail) => 'F',
        Some(Verdict::Inconclusive) => '?',
        Some(Verdict::LeftOut | Verdict::Error) | None => '–',
    }
}
