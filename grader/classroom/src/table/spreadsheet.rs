//! Spreadsheets (`.xlsx`, `.xls`, `.ods`): the cells of the first sheet, as texts.

use std::io::Cursor;
use std::path::Path;

use calamine::{Data, Reader, open_workbook_auto_from_rs};

use super::{Row, Table};
use verdict::error::{Error, Result};

/// Reads the first sheet. Its first row that is not empty is the header.
///
/// # Errors
/// If it is no spreadsheet, or has no sheet or header.
pub(super) fn read(path: &Path, bytes: Vec<u8>) -> Result<Table> {
    let trouble = |error: calamine::Error| {
        Error::file(path, format!("this spreadsheet cannot be read ({error}): save it as CSV (UTF-8)"))
    };
    let mut workbook = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(trouble)?;
    let sheet = workbook.worksheet_range_at(0).ok_or_else(|| Error::file(path, "it has no sheet"))?;
    let sheet = sheet.map_err(trouble)?;
    let before = sheet.start().map_or(0, |(row, _)| u64::from(row));
    let mut rows = sheet.rows().enumerate().map(|(index, cells)| Row {
        line: before + index as u64 + 1,
        cells: cells.iter().map(text).collect(),
    });
    let header = rows.next().ok_or_else(|| Error::file(path, "its first sheet is empty"))?;
    let is_filled = |row: &Row| row.cells.iter().any(|cell| !cell.trim().is_empty());
    let mut table = Table::new(header.cells.iter().map(|name| name.trim().to_owned()).collect());
    table.rows = rows.filter(is_filled).collect();
    Ok(table)
}

/// A cell as a person sees it. Spreadsheets keep matriculation numbers as fractions and times as days.
fn text(cell: &Data) -> String {
    match cell {
        Data::Float(number) if number.fract() == 0.0 && number.abs() < 1e15 => format!("{number:.0}"),
        Data::DateTime(time) if time.is_datetime() => {
            let (year, month, day, hour, minute, second, _) = time.to_ymd_hms_milli();
            format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}")
        }
        Data::Empty | Data::Error(_) => String::new(),
        other => other.to_string(),
    }
}
