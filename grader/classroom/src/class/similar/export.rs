//! The submissions of a class in the layout that JPlag and Dolos read: a folder of sources, the starting file as the code
//! that all have in common, and Dolos' table of metadata.

use std::collections::BTreeSet;
use std::path::Path;

use crate::class::gradebook::{Row, State};
use crate::class::identity::team_key;
use crate::class::record::ResultDir;
use crate::table::{Table, no_formula};
use verdict::error::{Error, Result};
use verdict::output;

/// Writes the folder, and returns the number of sources in it. `out` holds the results of the class. A team's submission is
/// written once.
///
/// # Errors
/// If the folder exists and is not empty, or cannot be written.
pub fn save(folder: &Path, out: &Path, rows: &[Row], starter: &str) -> Result<usize> {
    if std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(Error::file(folder, "this folder is not empty: name a new one"));
    }
    output::create_folder(&folder.join("submissions"))?;
    output::create_folder(&folder.join("base"))?;
    output::write_bytes(&folder.join("base/starter.rs"), starter)?;
    let mut info = Table::new(["filename", "full_name", "label", "created_at"].map(str::to_owned).to_vec());
    let mut teams: BTreeSet<String> = BTreeSet::new();
    for row in rows.iter().filter(|row| row.state == State::Graded) {
        // Results of an earlier version of the grader have no source.
        let Ok(source) = std::fs::read(ResultDir::new(out, &row.key).source()) else { continue };
        if !row.team.is_empty() && !teams.insert(team_key(&row.team)) {
            continue;
        }
        let file = format!("submissions/{}.rs", row.key);
        output::write_bytes(&folder.join(&file), source)?;
        let name = if row.name().is_empty() { row.key.clone() } else { row.name() };
        let time = row.received_at.as_ref().and_then(|time| time.parse::<jiff::Timestamp>().ok());
        let time = time.map_or_else(String::new, |time| time.strftime("%F %T +0000").to_string());
        info.push(vec![file, no_formula(&name), no_formula(&row.team), time]);
    }
    info.save(&folder.join("info.csv"))?;
    Ok(info.rows.len())
}
