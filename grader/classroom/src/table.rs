//! Tables as course systems and spreadsheets write them.

mod spreadsheet;

use std::path::Path;

use csv::{ReaderBuilder, WriterBuilder};
use encoding_rs::{Encoding, WINDOWS_1252};

use verdict::error::{Error, Result};
use verdict::output;

/// Maximum size of a table in bytes, more than the largest class needs.
const MAX_BYTES: u64 = 16 << 20;

/// Separators of cells, the most likely one first.
const SEPARATORS: [u8; 3] = *b",;\t";

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
    /// Reads a table: CSV in UTF-8, UTF-16 or Windows-1252, or the first sheet of a spreadsheet. The separator of CSV is
    /// the one that occurs most often in the header outside of quotes.
    ///
    /// # Errors
    /// If it cannot be read, or if a row has more cells than the header.
    pub fn load(path: &Path) -> Result<Self> {
        let size = std::fs::metadata(path).map_err(|error| Error::file(path, error))?.len();
        if size > MAX_BYTES {
            return Err(Error::file(path, format!("{size} bytes are too many for a table")));
        }
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xd0\xcf\x11\xe0") {
            return spreadsheet::read(path, bytes);
        }
        let (text, is_marked) = decode(&bytes).map_err(|message| Error::file(path, message))?;
        Self::parse(&text, is_marked)
            .map_err(|(line, message)| Error::Input(format!("{}:{line}: {message}", path.display())))
    }

    fn parse(text: &str, marked: bool) -> std::result::Result<Self, (u64, String)> {
        // Excel's own hint, which other programs take for a row.
        let first = text.lines().next().unwrap_or_default();
        let hint = first.trim_end().strip_prefix("sep=").and_then(|rest| rest.bytes().next());
        let (text, before) = match (hint, text.split_once('\n')) {
            (Some(_), Some((_, rest))) => (rest, 1),
            _ => (text, 0),
        };
        let separator = hint.unwrap_or_else(|| separator(text));
        if let Some(line) = open_quote(text, separator) {
            return Err((
                before + line,
                "a cell begins with `\"`, which is closed nowhere: close or remove it".into(),
            ));
        }
        let mut reader =
            ReaderBuilder::new().delimiter(separator).flexible(true).from_reader(text.as_bytes());
        let blame =
            |error: csv::Error| (before + error.position().map_or(1, csv::Position::line), error.to_string());
        let header: Vec<String> =
            reader.headers().map_err(blame)?.iter().map(|name| name.trim().to_owned()).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(blame)?;
            let line = before + record.position().map_or(0, csv::Position::line);
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

/// Text of a table, and whether it should be saved with a byte order mark.
fn decode(bytes: &[u8]) -> std::result::Result<(String, bool), String> {
    if let Some((encoding, length)) = Encoding::for_bom(bytes) {
        let (text, has_errors) = encoding.decode_without_bom_handling(&bytes[length..]);
        return if has_errors {
            Err(format!("it is not valid {}", encoding.name()))
        } else {
            Ok((text.into_owned(), true))
        };
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok((text.to_owned(), false)),
        Err(_) if bytes.contains(&0) => Err("it is neither text nor a spreadsheet".to_owned()),
        // What spreadsheets write in Western Europe if nobody tells them otherwise.
        Err(_) => Ok((WINDOWS_1252.decode_without_bom_handling(bytes).0.into_owned(), true)),
    }
}

/// The separator that occurs most often in the first row, outside of quotes.
fn separator(text: &str) -> u8 {
    let (mut counts, mut is_quoted) = ([0; SEPARATORS.len()], false);
    for byte in text.bytes() {
        match byte {
            b'"' => is_quoted = !is_quoted,
            b'\n' if !is_quoted => break,
            _ if !is_quoted => {
                if let Some(index) = SEPARATORS.iter().position(|separator| *separator == byte) {
                    counts[index] += 1;
                }
            }
            _ => {}
        }
    }
    let best = (0..SEPARATORS.len()).rev().max_by_key(|&index| counts[index]).unwrap_or(0);
    SEPARATORS[best]
}

/// Line of a quoted cell that never ends, counted from 1: it would swallow all lines after it.
fn open_quote(text: &str, separator: u8) -> Option<u64> {
    let (mut line, mut is_start) = (1, true);
    // Line of the cell that is open, and of one that the byte before has closed: a doubled quote opens it again.
    let (mut open, mut closed) = (None, None);
    for byte in text.bytes() {
        line += u64::from(byte == b'\n');
        (open, closed) = match (byte, open, closed) {
            (b'"', Some(began), _) => (None, Some(began)),
            (b'"', None, Some(began)) => (Some(began), None),
            (b'"', None, None) if is_start => (Some(line), None),
            (_, open, _) => (open, None),
        };
        is_start = byte == separator || byte == b'\n';
    }
    open
}

/// A number as offices write it: `8`, `7.5` or `7,5`; `None` if it is none.
pub fn number(text: &str) -> Option<f64> {
    let value: f64 = text.trim().replace(',', ".").parse().ok()?;
    value.is_finite().then_some(value)
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

    fn table(bytes: &[u8]) -> Result<Table> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("table.csv");
        std::fs::write(&path, bytes).expect("it can be written");
        Table::load(&path)
    }

    #[test]
    fn separators_marks_and_ragged_rows_are_taken_as_they_come() {
        for (text, expected) in [
            ("a,b\n1,2\n", "2"),
            ("\u{feff}a;b\r\n1;2\r\n", "2"),
            ("a\tb\n1\t2\n\t\n", "2"),
            ("a,b\n1\n", ""),
            ("a,b\n1,\"2, \"\"x\"\"\"\n", "2, \"x\""),
            ("a,b\n1,2,\n", "2"),
            ("sep=;\r\na;b\r\n1;2\r\n", "2"),
            ("\"a, b, c, d\";b\n1;2\n", "2"),
        ] {
            let table = table(text.as_bytes()).expect("it is a table");
            assert_eq!((table.rows.len(), table.rows[0].cell(1)), (1, expected), "{text:?}");
        }
        let message = table(b"sep=,\na,b\n1,2\n1,2,3\n").expect_err("too many").to_string();
        assert!(message.contains("table.csv:4:"), "{message}");
        let message = table(b"a,b\n1,2\n\"3,4\n5,\"\"6\n").expect_err("it never ends").to_string();
        assert!(message.contains("table.csv:3:") && message.contains("closed nowhere"), "{message}");
        assert!(table(b"a,b\n3\",4\n").is_ok(), "inches");
        let table = table(b"E-Mail address,X\n").expect("it is a table");
        assert_eq!(table.column(&["mail", "Email Address"]), Some(0));
    }

    #[test]
    fn the_encodings_of_offices_are_read() {
        let text = "Name;Gruppe\nMüller;ß\n";
        let utf16: Vec<u8> =
            "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
        let windows = WINDOWS_1252.encode(text).0.into_owned();
        for bytes in [text.as_bytes(), &utf16, &windows] {
            let table = table(bytes).expect("it is a table");
            assert_eq!((table.rows[0].cell(0), table.rows[0].cell(1)), ("Müller", "ß"));
        }
        assert!(table(b"a\0b\xff").is_err());
        assert!(
            table(b"PK\x03\x04 no spreadsheet")
                .expect_err("it is none")
                .to_string()
                .contains("save it as CSV")
        );
        assert_eq!(
            [number("7,5"), number(" 8 "), number("x"), number("inf")],
            [Some(7.5), Some(8.0), None, None]
        );
    }

    #[test]
    fn formulas_are_made_texts() {
        for text in ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", " =1"] {
            assert_eq!(no_formula(text), format!("'{text}"));
        }
        assert_eq!(no_formula("a=b"), "a=b");
    }
}
