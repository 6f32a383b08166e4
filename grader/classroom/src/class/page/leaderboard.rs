//! The leaderboard of efficiency, to be shown to students: without names.

use std::collections::BTreeSet;
use std::path::Path;

use maud::html;

use super::SCRIPT;
use super::digest::Digests;
use crate::class::gradebook::Row;
use present::page::document;
use present::words::count;
use verdict::error::Result;
use verdict::output;

/// Number of characters of a submission's hash by which its author recognizes it.
const SHOWN: usize = 8;

/// Writes the leaderboard of a class, whose results are in `out`: submissions whose multiple importance sampling passes all
/// of its checks, the most efficient first. Each is named by the beginning of its hash, which only its own report tells.
///
/// # Errors
/// If it cannot be written.
pub fn save_leaderboard(path: &Path, rows: &[Row], out: &Path) -> Result<()> {
    let digests = Digests::read(out, rows);
    let mut seen = BTreeSet::new();
    let mut entries: Vec<(&str, f64)> = rows
        .iter()
        .zip(&digests.of_rows)
        .filter_map(|(row, digest)| Some((row.source.get(..SHOWN)?, digest.work?)))
        // A team has one submission.
        .filter(|(name, _)| seen.insert(*name))
        .collect();
    entries.sort_by(|one, other| one.1.total_cmp(&other.1).then(one.0.cmp(other.0)));
    let median = entries.get(entries.len() / 2).map_or(1.0, |(_, work)| *work);
    let body = html! {
        main {
            h1 { "Leaderboard of efficiency" }
            p { (count(entries.len(), "submission")) " whose multiple importance sampling passes all checks." }
            p.soft { "Efficiency is 1 / (variance × time) of multiple importance sampling, relative to the median. Times were measured "
                "while several submissions were graded, so close places mean nothing. The report of a submission names its hash, under "
                "“Versions and seeds”. The leaderboard gives no points." }
            div.scroll { table {
                thead { tr { th.number scope="col" { "place" } th scope="col" { "submission" } th.number scope="col" { "efficiency" } } }
                tbody { @for (place, (name, work)) in entries.iter().enumerate() {
                    tr { td.number { (place + 1) } td { code { (name) } } td.number { (format!("{:.2}", median / work)) } }
                } }
            } }
        }
    };
    let text = document::begin("Leaderboard", SCRIPT) + &body.into_string() + &document::end(SCRIPT);
    output::write_bytes(path, text)
}
