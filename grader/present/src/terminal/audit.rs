//! The table of an audit, in text.

use std::io::{self, Write};

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, Cell, Color, ContentArrangement, Table};
use verdict::audit::{Audit, Fact, Outcome, Place};

use super::lines::paragraph;
use crate::words;

/// Prints the facts of an audit as a table, and what each failed one says.
pub fn print_audit(audit: &Audit) {
    let out = anstream::stdout();
    let width = out.is_terminal().then(textwrap::termwidth);
    // The reader may be gone (`… | head`).
    let _ = write_audit(&mut out.lock(), audit, width);
}

/// Writes the table, then one sentence per failed fact.
pub(super) fn write_audit(out: &mut impl Write, audit: &Audit, width: Option<usize>) -> io::Result<()> {
    writeln!(out, "{}", table(&words::audit_rows(audit)))?;
    if let Some(fault) = &audit.fault {
        paragraph(out, "", &format!("the audit ended early: {}", words::fault(fault)), width)?;
    }
    let failed = audit.failed().count();
    let verb = if failed == 1 { "fact fails" } else { "facts fail" };
    writeln!(out, "{failed} {verb} of {}, measured in {:.1} s", audit.facts.len(), audit.seconds)?;
    for fact in audit.failed() {
        paragraph(out, "  ", &words::fact::fact(fact), width)?;
    }
    let remarks: Vec<&Fact> = audit.facts.iter().filter(|fact| fact.outcome == Outcome::Remark).collect();
    if !remarks.is_empty() {
        writeln!(out, "Remarks (they cost no points)")?;
    }
    for fact in remarks {
        paragraph(out, "  ", &words::fact::fact(fact), width)?;
    }
    Ok(())
}

/// Writes the rows of the table in which a fact fails.
pub(super) fn write_failed(out: &mut impl Write, audit: &Audit) -> io::Result<()> {
    let mut rows = words::audit_rows(audit);
    rows.retain(|row| row.iter().any(|fact| fact.fails()));
    writeln!(out, "{}", table(&rows))
}

/// One row per factor: what it should be, and what it is at the first, second and third hit.
fn table(rows: &[Vec<&Fact>]) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Disabled).enforce_styling();
    let heads = ["factor", "should be", "1st hit", "2nd", "3rd"];
    table.set_header(heads.map(|head| Cell::new(head).add_attribute(Attribute::Bold)));
    let mut last = None;
    for row in rows {
        let first = row[0];
        if last != Some((first.term, first.technique)) {
            let heading = format!("{} (`{}`)", words::fact::heading(first.term), first.technique);
            table.add_row([Cell::new(heading).add_attribute(Attribute::Bold)]);
            last = Some((first.term, first.technique));
        }
        let mut cells = vec![
            Cell::new(format!("  {}", words::fact::factor(first))),
            Cell::new(words::fact::expected(first)),
        ];
        for hit in 1..=3 {
            let at_hit = |fact: &&&Fact| fact.place == Place::Hit(hit);
            let fact = row.iter().find(at_hit);
            let fact =
                fact.or_else(|| (hit == 1 && !matches!(first.place, Place::Hit(_))).then_some(&row[0]));
            cells.push(fact.map_or_else(|| Cell::new(""), |fact| cell(fact)));
        }
        table.add_row(cells);
    }
    table
}

fn cell(fact: &Fact) -> Cell {
    let value = words::fact::measured(fact);
    match fact.outcome {
        Outcome::Fails => Cell::new(format!("{value} ✗")).fg(Color::Red),
        Outcome::Remark => Cell::new(format!("{value} !")).fg(Color::Yellow),
        _ => Cell::new(value),
    }
}
