//! Finds a row of a graded class by what a person types.

use std::path::Path;

use super::gradebook::Row;
use super::names::{Agreement, agreement, same};

/// Indices of the rows that a text means: the student's key, login, address, number or name, or else the name or path of
/// the submission. All members of a team are meant by the name of one.
///
/// # Errors
/// If it means nobody, or several students who are not one team: a message.
pub fn rows_of(rows: &[Row], text: &str) -> Result<Vec<usize>, String> {
    let sent =
        Path::new(text).file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let stem =
        Path::new(&sent).file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let tests: [&dyn Fn(&Row) -> bool; 5] = [
        &|row| same(&row.key, text),
        &|row| [&row.login, &row.email].iter().any(|own| same(own, text)),
        &|row| row.numbers.iter().any(|own| same(own, text)),
        &|row| agreement(&row.name(), text) >= Agreement::Ascii,
        &|row| same(&row.sent, &sent) || same(&row.sent, &stem),
    ];
    for test in tests {
        let found: Vec<usize> = (0..rows.len()).filter(|&index| test(&rows[index])).collect();
        let Some(&first) = found.first() else { continue };
        let team = &rows[first].team;
        let is_team = !team.is_empty() && found.iter().all(|&index| same(&rows[index].team, team));
        if found.len() > 1 && !is_team {
            let keys: Vec<&str> = found.iter().map(|&index| rows[index].key.as_str()).collect();
            return Err(format!("`{text}` can be {}: name one of them", keys.join(" or ")));
        }
        let mates = |index: &usize| *index == first || (!team.is_empty() && same(&rows[*index].team, team));
        return Ok((0..rows.len()).filter(mates).collect());
    }
    Err(format!("`{text}` is nobody in the class: use the column `student` of gradebook.csv"))
}
