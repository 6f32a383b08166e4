//! MTL files: the statements of each material.
//!
//! `tobj` is not used here: it supports neither `Tf` nor line numbers, accepts invalid values, and panics on a colour of two
//! numbers.

use std::collections::HashMap;
use std::path::Path;

use super::text::{Statement, statements};
use super::warnings::Warnings;
use crate::diagnostic::Diagnostic;
use crate::input::{self, Reference};
use crate::math::Rgb;

const MAX_BYTES: u64 = 64 << 20;

/// The statements of one material; `None` for missing ones.
#[derive(Clone, Debug, Default)]
pub(super) struct Definition {
    /// The line of `newmtl`.
    pub(super) line: usize,
    pub(super) kd: Option<Rgb>,
    pub(super) ks: Option<Rgb>,
    pub(super) ke: Option<Rgb>,
    pub(super) tf: Option<Rgb>,
    pub(super) ns: Option<f32>,
    /// Line and value.
    pub(super) ni: Option<(usize, f32)>,
    /// In 0..=10.
    pub(super) illum: Option<u8>,
    /// Line and name of an image.
    pub(super) map_kd: Option<(usize, String)>,
}

/// The materials of an MTL file by name.
pub(super) type Definitions = HashMap<String, Definition>;

/// Statements ignored without a warning: ambient colour, transparency without refraction, and parameters of other models
/// that are commonly written in addition to those supported here.
const HARMLESS: [&str; 15] = [
    "Ka",
    "map_Ka",
    "Tr",
    "d",
    "Km",
    "Pr",
    "Pm",
    "Ps",
    "Pc",
    "Pcr",
    "aniso",
    "anisor",
    "sharpness",
    "map_aat",
    "interpolateMode",
];

/// Options of a map, with the maximum number of arguments.
const MAP_OPTIONS: [(&str, usize); 14] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-boost", 1),
    ("-bm", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-colorspace", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-o", 3),
    ("-s", 3),
    ("-t", 3),
    ("-texres", 1),
    ("-type", 1),
];

/// Reads an MTL file, without the images it refers to.
pub(super) fn read(
    file: &Path,
    named: &Reference,
    warnings: &mut Warnings,
) -> Result<Definitions, Diagnostic> {
    let text = input::read(file, MAX_BYTES, Some(named))?;
    let mut definitions = Definitions::new();
    let mut current: Option<(&str, Definition)> = None;
    for statement in statements(&text) {
        if statement.keyword == "newmtl" {
            let name = statement.arguments;
            if name.is_empty() {
                let message = "`newmtl` needs the name of the material";
                return Err(Diagnostic::at(file, statement.line, message));
            }
            let next = (name, Definition { line: statement.line, ..Definition::default() });
            keep(current.replace(next), &mut definitions, file, warnings);
            continue;
        }
        let Some((_, definition)) = &mut current else {
            let message = format!("`{}` before the first `newmtl`", statement.keyword);
            return Err(Diagnostic::at(file, statement.line, message));
        };
        definition
            .take(&statement, file, warnings)
            .map_err(|message| Diagnostic::at(file, statement.line, message))?;
    }
    keep(current, &mut definitions, file, warnings);
    Ok(definitions)
}

fn keep(
    finished: Option<(&str, Definition)>,
    definitions: &mut Definitions,
    file: &Path,
    warnings: &mut Warnings,
) {
    let Some((name, definition)) = finished else { return };
    let line = definition.line;
    if let Some(former) = definitions.insert(name.to_owned(), definition) {
        let message =
            format!("material `{name}` is already defined in line {}; using this definition", former.line);
        warnings.add(Diagnostic::at(file, line, message));
    }
}

impl Definition {
    /// Adds a statement.
    ///
    /// # Errors
    /// What is wrong with it.
    fn take(
        &mut self,
        statement: &Statement<'_>,
        file: &Path,
        warnings: &mut Warnings,
    ) -> Result<(), String> {
        match statement.keyword {
            "Kd" => self.kd = Some(colour(statement)?),
            "Ks" => self.ks = Some(colour(statement)?),
            "Ke" => self.ke = Some(colour(statement)?),
            "Tf" => self.tf = Some(colour(statement)?),
            "Ns" => self.ns = Some(single(statement)?),
            "Ni" => self.ni = Some((statement.line, single(statement)?)),
            "illum" => self.illum = Some(illumination_model(statement)?),
            "map_Kd" => {
                let (name, has_options) = without_options(statement.arguments);
                if name.is_empty() {
                    return Err("`map_Kd` needs the name of an image".into());
                }
                if has_options {
                    let message = "the options of `map_Kd` are ignored";
                    warnings.add(Diagnostic::at(file, statement.line, message));
                }
                self.map_kd = Some((statement.line, name.to_owned()));
            }
            keyword if HARMLESS.contains(&keyword) => {}
            keyword => {
                let message = format!("`{keyword}` is not supported and ignored");
                warnings.once((file, keyword), Diagnostic::at(file, statement.line, message));
            }
        }
        Ok(())
    }
}

/// One non-negative number for all channels, or one for each.
fn colour(statement: &Statement<'_>) -> Result<Rgb, String> {
    match numbers(statement, "3 numbers")?[..] {
        [value] => Ok(Rgb::gray(value)),
        [r, g, b] => Ok(Rgb::new(r, g, b)),
        ref other => Err(format!("`{}` needs 3 numbers, but has {}", statement.keyword, other.len())),
    }
}

/// One non-negative number.
fn single(statement: &Statement<'_>) -> Result<f32, String> {
    match numbers(statement, "one number")?[..] {
        [value] => Ok(value),
        ref other => Err(format!("`{}` needs one number, but has {}", statement.keyword, other.len())),
    }
}

fn numbers(statement: &Statement<'_>, expected: &str) -> Result<Vec<f32>, String> {
    let keyword = statement.keyword;
    let number = |word: &str| match word.parse::<f32>() {
        Ok(value) if !value.is_finite() => Err(format!("`{keyword}`: the number `{word}` is not finite")),
        Ok(value) if value < 0.0 => Err(format!("`{keyword}`: the number `{word}` must not be negative")),
        Ok(value) => Ok(value),
        Err(_) => Err(format!("`{keyword}` needs {expected}, but `{word}` is not a number")),
    };
    statement.uncommented().split_ascii_whitespace().map(number).collect()
}

fn illumination_model(statement: &Statement<'_>) -> Result<u8, String> {
    let argument = statement.uncommented();
    argument
        .parse()
        .ok()
        .filter(|model| *model <= 10)
        .ok_or_else(|| format!("`illum` needs a whole number from 0 to 10, but has `{argument}`"))
}

/// The file name in the arguments of a map, and whether options precede it.
fn without_options(arguments: &str) -> (&str, bool) {
    let mut rest = arguments;
    let mut found = false;
    while let Some(&(_, max_arguments)) = MAP_OPTIONS.iter().find(|(option, _)| first_word(rest).0 == *option)
    {
        found = true;
        rest = first_word(rest).1;
        for number in 0..max_arguments {
            let (word, after) = first_word(rest);
            // `-o`, `-s` and `-t` have one to three numbers; the other options have a fixed number of arguments.
            if max_arguments == 3 && number > 0 && word.parse::<f32>().is_err() {
                break;
            }
            rest = after;
        }
    }
    (rest, found)
}

fn first_word(text: &str) -> (&str, &str) {
    let end = text.find(|character: char| character.is_ascii_whitespace()).unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    (word, rest.trim_ascii_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_a_map_are_not_part_of_its_name() {
        assert_eq!(without_options("wood planks.png"), ("wood planks.png", false));
        assert_eq!(without_options("-s 2 2 wood.png"), ("wood.png", true));
        assert_eq!(without_options("-clamp on -o 1 2 3 -mm 0 1 wood planks.png"), ("wood planks.png", true));
        assert_eq!(without_options("-s"), ("", true));
    }
}
