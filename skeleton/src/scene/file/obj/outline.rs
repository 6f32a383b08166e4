//! A first pass over an OBJ file: everything except the numbers.
//!
//! `tobj` reads the numbers, but it invents normals and texture coordinates for faces without them, treats lines as faces
//! and unknown statements as comments, and reports no line numbers. This pass checks statements and indices, records which
//! triangles have which attributes, and selects the lines for `tobj`.

use std::io::{self, BufRead, Read};
use std::ops::Range;
use std::path::Path;

use super::numbers;
use crate::diagnostic::Diagnostic;
use crate::scene::file::text::{Statement, statements};
use crate::scene::file::warnings::Warnings;

/// The structure of an OBJ file.
#[derive(Default)]
pub(super) struct Outline<'a> {
    /// Byte ranges of the statements `v`, `vt`, `vn` and `f` without comments; adjacent ones are merged.
    pub(super) geometry: Vec<Range<usize>>,
    /// Runs of similar triangles, in the order of the file.
    pub(super) runs: Vec<Run<'a>>,
    /// Number of triangles after triangulation.
    pub(super) triangles: usize,
    /// Faces with more than three corners, in the order of the file.
    pub(super) polygons: Vec<Polygon>,
    /// Lines and arguments of `mtllib`.
    pub(super) libraries: Vec<(usize, &'a str)>,
    /// Numbers of `v`, `vt` and `vn`.
    counts: [usize; 3],
    /// Indices beyond the counts at their line, to be checked at the end.
    forward: Vec<ForwardIndex>,
}

/// Consecutive triangles with the same material and the same kinds of indices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run<'a> {
    /// Index of the first triangle; the run ends where the next one starts.
    pub(super) first: usize,
    /// Line and argument of `usemtl`.
    pub(super) material: Option<(usize, &'a str)>,
    /// True if they have texture coordinates.
    pub(super) uvs: bool,
    /// True if they have normals.
    pub(super) normals: bool,
}

/// A face with more than three corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    /// Index of its first triangle.
    pub(super) first: usize,
    /// Number of corners: two more than triangles.
    pub(super) corners: usize,
}

struct ForwardIndex {
    line: usize,
    kind: usize,
    index: usize,
}

/// The three parts of a corner such as `1/2/3`.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Statements that do not affect the image.
const HARMLESS: [&str; 7] = ["o", "g", "s", "mg", "bevel", "c_interp", "d_interp"];

/// Statements of the format that are ignored with a warning: primitives other than polygons, free-form surfaces, and
/// features of the format's original programs.
#[rustfmt::skip]
const UNSUPPORTED: [&str; 32] = [
    "p", "l", "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
    "sp", "end", "con", "lod", "usemap", "maplib", "shadow_obj", "trace_obj", "ctech", "stech", "call", "csh",
    "bsp", "bzp", "cdc", "cdp", "res", "fo",
];

impl<'a> Outline<'a> {
    /// Scans the `text` of `file`.
    pub(super) fn new(file: &Path, text: &'a str, warnings: &mut Warnings) -> Result<Self, Diagnostic> {
        let mut outline = Self::default();
        let mut material = None;
        for statement in statements(text) {
            let at = |message: String| Diagnostic::at(file, statement.line, message);
            match statement.keyword {
                "v" => outline.vertex_data(0, &statement).map_err(at)?,
                "vt" => outline.vertex_data(1, &statement).map_err(at)?,
                "vn" => outline.vertex_data(2, &statement).map_err(at)?,
                "f" => outline.face(&statement, material).map_err(at)?,
                "usemtl" if statement.arguments.is_empty() => {
                    return Err(at("`usemtl` needs the name of a material".into()));
                }
                "usemtl" => material = Some((statement.line, statement.arguments)),
                "mtllib" if statement.arguments.is_empty() => {
                    return Err(at("`mtllib` needs the name of an MTL file".into()));
                }
                "mtllib" => outline.libraries.push((statement.line, statement.arguments)),
                keyword if HARMLESS.contains(&keyword) => {}
                keyword if UNSUPPORTED.contains(&keyword) => warnings.once(
                    (file, keyword),
                    at(format!("`{keyword}` is ignored: only polygons (`f`) are read")),
                ),
                keyword => return Err(at(format!("`{}` is not a statement of an OBJ file", shown(keyword)))),
            }
        }
        match outline.forward.iter().find(|forward| forward.index > outline.counts[forward.kind]) {
            Some(forward) => {
                let message = out_of_range(forward.kind, forward.index as i64, outline.counts[forward.kind]);
                Err(Diagnostic::at(file, forward.line, message))
            }
            None => Ok(outline),
        }
    }

    /// Adds a `v`, `vt` or `vn`.
    fn vertex_data(&mut self, kind: usize, statement: &Statement<'a>) -> Result<(), String> {
        if !numbers::look_right(statement) {
            numbers::check(statement)?;
        }
        self.counts[kind] += 1;
        // Colours change nothing, and `tobj` refuses files where only some vertices have them.
        match numbers::has_colour(statement).then(|| end_of_word(statement.text, 4)).flatten() {
            Some(end) => self.push_part(statement, end),
            None => self.push_geometry(statement),
        }
        Ok(())
    }

    /// Checks and adds a face.
    fn face(&mut self, statement: &Statement<'a>, material: Option<(usize, &'a str)>) -> Result<(), String> {
        let mut corners = 0;
        let mut form = (false, false);
        for corner in statement.uncommented().split_ascii_whitespace() {
            let its_form = self.corner(corner, statement.line)?;
            if corners > 0 && its_form != form {
                return Err(
                    "all corners of a face must have the same form: `v`, `v/vt`, `v//vn` or `v/vt/vn`".into(),
                );
            }
            form = its_form;
            corners += 1;
        }
        if corners < 3 {
            return Err(format!("a face needs at least 3 corners, but has {corners}"));
        }
        let run = Run { first: self.triangles, material, uvs: form.0, normals: form.1 };
        match self.runs.last() {
            Some(last) if last.continues_with(&run) => {}
            _ => self.runs.push(run),
        }
        if corners > 3 {
            self.polygons.push(Polygon { first: self.triangles, corners });
        }
        self.triangles += corners - 2;
        self.push_geometry(statement);
        Ok(())
    }

    /// Checks a corner of a face. Returns whether it has a texture coordinate and whether it has a normal.
    fn corner(&mut self, corner: &str, line: usize) -> Result<(bool, bool), String> {
        let mut has = [false; 3];
        for (kind, part) in corner.split('/').enumerate() {
            if kind >= has.len() {
                return Err(format!("`{}` has more than three parts (`v/vt/vn`)", shown(corner)));
            }
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| {
                format!("`{}` is not a corner of a face: indices must be whole numbers", shown(corner))
            })?;
            has[kind] = true;
            let count = self.counts[kind];
            if index > 0 {
                let index = usize::try_from(index).unwrap_or(usize::MAX);
                if index > count {
                    self.forward.push(ForwardIndex { line, kind, index });
                }
            } else if index == 0 {
                return Err(format!("`{}`: indices start at 1", shown(corner)));
            } else if index.unsigned_abs() > count as u64 {
                return Err(out_of_range(kind, index, count));
            }
        }
        if !has[0] {
            return Err(format!("corner `{}` has no vertex", shown(corner)));
        }
        Ok((has[1], has[2]))
    }

    /// Passes a statement to `tobj`, without its comment.
    fn push_geometry(&mut self, statement: &Statement<'a>) {
        let Statement { start, text, .. } = *statement;
        match text.find('#') {
            Some(comment) => self.push_part(statement, comment),
            None => match self.geometry.last_mut() {
                Some(last) if last.end == start => last.end = start + text.len(),
                _ => self.geometry.push(start..start + text.len()),
            },
        }
    }

    /// Passes the first `length` bytes of a statement to `tobj`, and the end of its line.
    fn push_part(&mut self, statement: &Statement<'a>, length: usize) {
        let Statement { start, text, .. } = *statement;
        let end = start + text.len();
        self.geometry.extend([start..start + length, end - usize::from(text.ends_with('\n'))..end]);
    }
}

/// Where the word with this number, counted from 1, ends in a line; `None` if no other one follows it.
fn end_of_word(line: &str, number: usize) -> Option<usize> {
    let (mut words, mut end, mut is_inside) = (0, 0, false);
    for (index, byte) in line.bytes().enumerate() {
        let is_space = byte.is_ascii_whitespace();
        if !is_space && !is_inside {
            words += 1;
            if words > number {
                return Some(end);
            }
        } else if is_space && is_inside && words == number {
            end = index;
        }
        is_inside = !is_space;
    }
    None
}

impl Run<'_> {
    fn continues_with(&self, next: &Self) -> bool {
        self.material == next.material && self.uvs == next.uvs && self.normals == next.normals
    }
}

fn out_of_range(kind: usize, index: i64, count: usize) -> String {
    let kind = KINDS[kind];
    if index < 0 {
        format!("{kind} {index} does not exist: only {count} are defined before this line")
    } else {
        format!("{kind} {index} does not exist: the file has only {count}")
    }
}

/// The beginning of a word without control characters, safe to print on a terminal.
pub(super) fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    let printable = |character: char| if character.is_control() { '\u{fffd}' } else { character };
    let mut start: String = word.chars().take(LONGEST).map(printable).collect();
    if word.chars().nth(LONGEST).is_some() {
        start.push('…');
    }
    start
}

/// A reader over parts of a text, without a copy.
pub(super) struct Parts<'a> {
    text: &'a [u8],
    /// The rest of the current part.
    current: Range<usize>,
    rest: std::slice::Iter<'a, Range<usize>>,
}

impl<'a> Parts<'a> {
    /// The `parts` must be within the text.
    pub(super) fn new(text: &'a str, parts: &'a [Range<usize>]) -> Self {
        Self { text: text.as_bytes(), current: 0..0, rest: parts.iter() }
    }
}

impl BufRead for Parts<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.current.is_empty() {
            match self.rest.next() {
                Some(part) => self.current = part.clone(),
                None => break,
            }
        }
        Ok(&self.text[self.current.clone()])
    }

    fn consume(&mut self, amount: usize) {
        self.current.start += amount;
    }
}

impl Read for Parts<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}
