//! CSV tables as course systems and spreadsheets write them.

use std::path::Path;

use csv::{ReaderBuilder, WriterBuilder};

use verdict::error::{Error, Result};
use verdict::output;

/// Maximum size of a table in bytes, more than the largest class needs.
const MAX_BYTES: u64 = 16 << 20;

/// A table with a header.
#[derive(Clone, Debug)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows, each with as many cells as there are columns.
    pub rows: Vec<Row>,
    /// Separator of cells: a comma, a semicolon or a tab.
    separator: u8,
    /// True if the file began with a byte order mark, which some spreadsheets need to recognize UTF-8.
    marked: bool,
}

/// A row of a table.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// Line in the file, counted from 1; 0 if it was not read from a file.
    pub line: u64,
    /// Cells in the order of the columns.
    pub cells: Vec<String>,
}

impl Row {
    /// A cell without surrounding blanks; empty if the row is too short.
    pub fn cell(&self, column: usize) -> &str {
        self.cells.get(column).map_or("", |text| text.trim())
    }
}

impl Table {
    /// Reads a table. The separator is the one that occurs most often in the first line.
    ///
    /// # Errors
    /// If it cannot be read or is not UTF-8, or if a row has more cells than the header.
    pub fn load(path: &Path) -> Result<Self> {
        let size = std::fs::metadata(path).map_err(|error| Error::file(path, error))?.len();
        if size > MAX_BYTES {
            return Err(Error::file(path, format!("{size} bytes are too many for a table")));
        }
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let text = String::from_utf8(bytes).map_err(|_| Error::file(path, "it is not UTF-8"))?;
        Self::parse(&text)
            .map_err(|(line, message)| Error::Input(format!("{}:{line}: {message}", path.display())))
    }

    fn parse(text: &str) -> std::result::Result<Self, (u64, String)> {
        let (text, marked) = text.strip_prefix('\u{feff}').map_or((text, false), |rest| (rest, true));
        let first = text.lines().next().unwrap_or_default();
        let count = |separator: &u8| first.bytes().filter(|byte| byte == separator).count();
        let separator = [b',', b';', b'\t'].into_iter().rev().max_by_key(count).unwrap_or(b',');
        let mut reader =
            ReaderBuilder::new().delimiter(separator).flexible(true).from_reader(text.as_bytes());
        let blame = |error: csv::Error| (error.position().map_or(1, csv::Position::line), error.to_string());
        let header: Vec<String> =
            reader.headers().map_err(blame)?.iter().map(|name| name.trim().to_owned()).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(blame)?;
            let line = record.position().map_or(0, csv::Position::line);
            let mut cells: Vec<String> = record.iter().map(str::to_owned).collect();
            if cells.iter().all(|cell| cell.trim().is_empty()) {
                continue;
            }
            if cells.len() > header.len() && cells[header.len()..].iter().any(|cell| !cell.is_empty()) {
                return Err((line, format!("{} cells, but {} columns", cells.len(), header.len())));
            }
            cells.resize(header.len(), String::new());
            rows.push(Row { line, cells });
        }
        Ok(Self { header, rows, separator, marked })
    }

    /// Creates a table without rows.
    pub fn new(header: Vec<String>) -> Self {
        Self { header, rows: Vec::new(), separator: b',', marked: false }
    }

    /// Appends a row.
    pub fn push(&mut self, cells: Vec<String>) {
        self.rows.push(Row { line: 0, cells });
    }

    /// Index of the first column with one of these names, ignoring case, blanks and hyphens; `None` if there is none.
    pub fn column(&self, names: &[&str]) -> Option<usize> {
        let plain = |text: &str| {
            text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect::<String>()
        };
        names.iter().find_map(|name| self.header.iter().position(|other| plain(other) == plain(name)))
    }

    /// Writes the table with the separator and byte order mark that it was read with.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        output::write(path, |file| -> std::io::Result<()> {
            use std::io::Write;
            if self.marked {
                file.write_all("\u{feff}".as_bytes())?;
            }
            let mut writer = WriterBuilder::new().delimiter(self.separator).from_writer(file);
            writer.write_record(&self.header)?;
            for row in &self.rows {
                writer.write_record(&row.cells)?;
            }
            writer.flush()
        })
    }
}

/// Escapes a text, with a leading `'`, that a spreadsheet would take for a formula.
pub fn no_formula(text: &str) -> String {
    // A tab or carriage return before the sign is skipped by some spreadsheets.
    let starts_formula =
        text.trim_start().starts_with(['=', '+', '-', '@']) || text.starts_with(['\t', '\r']);
    if starts_formula { format!("'{text}") } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_marks_and_ragged_rows_are_taken_as_they_come() {
        for (text, expected) in [
            ("a,b\n1,2\n", "2"),
            ("\u{feff}a;b\r\n1;2\r\n", "2"),
            ("a\tb\n1\t2\n\t\n", "2"),
            ("a,b\n1\n", ""),
            ("a,b\n1,\"2, \"\"x\"\"\"\n", "2, \"x\""),
            ("a,b\n1,2,\n", "2"),
        ] {
            let table = Table::parse(text).expect("it is a table");
            assert_eq!((table.rows.len(), table.rows[0].cell(1)), (1, expected), "{text:?}");
        }
        assert_eq!(Table::parse("a,b\n1,2\n1,2,3\n").expect_err("too many").0, 3);
        let table = Table::parse("E-Mail address,X\n").expect("it is a table");
        assert_eq!(table.column(&["mail", "Email Address"]), Some(0));
    }

    #[test]
    fn formulas_are_made_texts() {
        for text in ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", " =1"] {
            assert_eq!(no_formula(text), format!("'{text}"));
        }
        assert_eq!(no_formula("a=b"), "a=b");
    }
}
