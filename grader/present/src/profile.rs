//! Where the time of a grade went.

use std::io::{self, Write};

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, Cell, CellAlignment, Table};

use verdict::report::Report;

/// Prints the time of each part of a grade, and of each check, the longest first.
pub fn print_profile(report: &Report) {
    // The reader may be gone (`… | head`).
    let _ = writeln!(io::stdout().lock(), "\n{}", text(report));
}

fn text(report: &Report) -> String {
    let cost = &report.cost;
    let parts = [
        ("preparing the framework, scenes and references", cost.framework),
        ("compiling the submission", cost.build),
        ("running the checks", cost.run),
        ("total", cost.total),
    ];
    let mut table = new_table(["part", "s"]);
    for (part, seconds) in parts {
        table.add_row([Cell::new(part), number(format!("{seconds:.2}"))]);
    }
    let mut checks: Vec<_> = report.checks.iter().collect();
    checks.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let mut of_checks = new_table(["check (several run in parallel)", "s", "samples", "samples/s"]);
    for check in checks {
        let rate = check.samples as f64 / check.seconds;
        of_checks.add_row([
            Cell::new(check.id.to_string()),
            number(format!("{:.3}", check.seconds)),
            number(check.samples.to_string()),
            number(if rate.is_finite() { format!("{rate:.1e}") } else { String::new() }),
        ]);
    }
    format!("{table}\n\n{of_checks}")
}

fn new_table<const COLUMNS: usize>(heads: [&str; COLUMNS]) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(heads.map(|head| Cell::new(head).add_attribute(Attribute::Bold)));
    table
}

fn number(text: String) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
}

#[cfg(test)]
mod tests {
    use super::text;
    use verdict::check::{CheckKind, CheckResult};
    use verdict::sample::{id, report};

    #[test]
    fn the_longest_check_stands_first() {
        let mut report = report("quick");
        let slow = CheckResult {
            id: id(CheckKind::MeanBias, "slow"),
            seconds: 4.0,
            samples: 8,
            ..report.checks[0].clone()
        };
        report.checks.push(slow);
        let text = text(&report);
        let place = |name| text.find(name).unwrap_or_else(|| panic!("{name} in {text}"));
        assert!(place("/slow/") < place("/quick/") && text.contains("2.0e0"), "{text}");
    }
}
