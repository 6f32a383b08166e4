//! The page of a class, one self-contained file for staff: a sortable table, hard tasks, shared mistakes, and submissions
//! that still need a mark.
//!
//! Records are read one at a time and thumbnails are copied to the file, so that little more than its row is in memory of
//! each submission. The template escapes all texts of other people; names of folders need no more than that in links (see
//! [`crate::class::Member::key`]).

mod digest;
mod leaderboard;
mod sections;
mod table;

use std::io::{BufWriter, Write};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::html;

use super::gradebook::Row;
use super::record::ResultDir;
use digest::Digests;
pub use leaderboard::save_leaderboard;
use present::page::document;
use verdict::error::Result;
use verdict::output;
use verdict::rubric::Rubric;

const SCRIPT: &str = include_str!("class.js");

/// Content of the page.
pub struct ClassPage<'a> {
    /// Rubric of the assignment.
    pub rubric: &'a Rubric,
    /// One row per member.
    pub rows: &'a [Row],
    /// Changes of scores since the last run.
    pub changes: &'a [String],
    /// Number of groups of similar submissions.
    pub similar: usize,
    /// Result folder.
    pub out: &'a Path,
}

impl ClassPage<'_> {
    /// Writes the page.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        let digests = Digests::read(self.out, self.rows);
        output::write(path, |file| self.write(&digests, file))
    }

    fn write(&self, digests: &Digests, file: &mut BufWriter<&std::fs::File>) -> std::io::Result<()> {
        let title = format!("{}, {} in the class", self.rubric.assignment, self.rows.len());
        file.write_all(document::begin(&title, SCRIPT).as_bytes())?;
        file.write_all(b"<main>")?;
        for section in [
            sections::header(self),
            sections::changes(self),
            sections::points(self),
            table::table(self, digests),
            sections::alike(self, digests),
        ] {
            file.write_all(section.into_string().as_bytes())?;
        }
        self.wall(digests, file)?;
        let after = [sections::to_mark(self), sections::hard(self, digests), sections::speed(self, digests)];
        for section in after {
            file.write_all(section.into_string().as_bytes())?;
        }
        file.write_all(b"</main>")?;
        file.write_all(document::end(SCRIPT).as_bytes())
    }

    /// Writes a thumbnail of each submission, those with the fewest points first.
    fn wall(&self, digests: &Digests, file: &mut BufWriter<&std::fs::File>) -> std::io::Result<()> {
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.sort_by(|&a, &b| {
            let points = |index: usize| self.rows[index].raw.unwrap_or(0.0);
            points(a).total_cmp(&points(b))
        });
        let mut begun = false;
        for index in order {
            let row = &self.rows[index];
            // One that is cut off is a broken picture, no more.
            let Ok(png) = std::fs::read(ResultDir::new(self.out, &row.key).thumbnail()) else { continue };
            if !begun {
                let words = "The same scene by everybody, with multiple importance sampling; the fewest points come first.";
                let begin = html! { h2 { "Pictures" } p.soft { (words) } };
                write!(file, "{}<div class=\"wall\">", begin.into_string())?;
                begun = true;
            }
            let source = format!("data:image/png;base64,{}", STANDARD.encode(&png));
            let inside = html! {
                img src=(source) alt={ "picture of " (row.key) };
                span { (row.key) } " " span.soft { (table::points_of(row)) }
            };
            let tile = html! {
                @if digests.of_rows[index].pages { a href=(table::link(row, "report-tutor.html")) { (inside) } }
                @else { span { (inside) } }
            };
            file.write_all(tile.into_string().as_bytes())?;
        }
        if begun { file.write_all(b"</div>") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests;
