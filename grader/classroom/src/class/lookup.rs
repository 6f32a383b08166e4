//! Finds a row of a graded class by what a person types.

use std::ffi::OsStr;
use std::path::Path;

use super::directory::{Index, key};
use super::gradebook::Row;
use super::names::{Name, same};

/// The rows of a class, to be found by what a person types.
#[derive(Debug, Default)]
pub struct Lookup<'a> {
    rows: &'a [Row],
    keys: Index,
    logins: Index,
    numbers: Index,
    names: Index,
    sent: Index,
}

impl<'a> Lookup<'a> {
    /// Prepares the rows of a class.
    pub fn new(rows: &'a [Row]) -> Self {
        let mut lookup = Self { rows, ..Self::default() };
        for (index, row) in rows.iter().enumerate() {
            lookup.keys.add(key(&row.key), index);
            [&row.login, &row.email].iter().for_each(|login| lookup.logins.add(key(login), index));
            row.numbers.iter().for_each(|number| lookup.numbers.add(key(number), index));
            Name::new(&row.name()).forms().into_iter().for_each(|form| lookup.names.add(form, index));
            lookup.sent.add(key(&row.sent), index);
        }
        lookup
    }

    /// The rows that a text means: the student's key, login, address, number or name, or else the name or path of the
    /// submission. All members of a team are meant by the name of one.
    ///
    /// # Errors
    /// If it means nobody, or several students who are not one team: a message.
    pub fn rows_of(&self, text: &str) -> Result<Vec<&'a Row>, String> {
        let rows = self.rows;
        let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let sent = part(Path::new(text).file_name());
        let stem = part(Path::new(&sent).file_stem());
        let plain = [key(text)];
        let tests: [(&Index, &[String]); 5] = [
            (&self.keys, &plain),
            (&self.logins, &plain),
            (&self.numbers, &plain),
            (&self.names, &Name::new(text).forms()),
            (&self.sent, &[key(&sent), key(&stem)]),
        ];
        for (index, texts) in tests {
            let found = index.of_any(texts);
            let Some(&first) = found.first() else { continue };
            let team = &rows[first].team;
            let is_mate = |index: usize| !team.is_empty() && same(&rows[index].team, team);
            if found.len() > 1 && !found.iter().all(|&index| is_mate(index)) {
                let keys: Vec<&str> = found.iter().map(|&index| rows[index].key.as_str()).collect();
                return Err(format!("`{text}` can be {}: name one of them", keys.join(" or ")));
            }
            if team.is_empty() {
                return Ok(vec![&rows[first]]);
            }
            return Ok(rows.iter().filter(|row| same(&row.team, team)).collect());
        }
        Err(format!("`{text}` is nobody in the class: use the column `student` of gradebook.csv"))
    }
}
