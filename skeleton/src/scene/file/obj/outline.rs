//! A first pass over an OBJ file: everything but its numbers.
//!
//! `tobj` reads the numbers, but is silent about much: it makes up normals and texture coordinates for faces
//! that have none, takes lines for faces and unknown statements for comments, and knows no line numbers. This
//! pass checks the statements and the indices, notes which triangles have what, and picks the lines for `tobj`.

use std::io::{self, BufRead, Read};
use std::ops::Range;
use std::path::Path;

use super::numbers;
use crate::diagnostic::Diagnostic;
use crate::scene::file::text::{Statement, statements};
use crate::scene::file::warnings::Warnings;

/// What an OBJ file is made of.
#[derive(Default)]
pub(super) struct Outline<'a> {
    /// Where the text has statements `v`, `vt`, `vn` and `f`, without comments; neighbours make one range.
    pub(super) geometry: Vec<Range<usize>>,
    /// Runs of triangles that are alike, in the order of the file.
    pub(super) runs: Vec<Run<'a>>,
    /// How many triangles there are once polygons are cut into fans.
    pub(super) triangles: usize,
    /// The arguments of `mtllib`, with their lines.
    pub(super) libraries: Vec<(usize, &'a str)>,
    /// How many `v`, `vt` and `vn` there are.
    counts: [usize; 3],
    /// Indices that were greater than the counts when they were met.
    forward: Vec<ForwardIndex>,
}

/// Triangles one after the other that have the same material and the same kinds of indices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run<'a> {
    /// The first of them; the run ends where the next one starts.
    pub(super) first: usize,
    /// The name after `usemtl`, and its line.
    pub(super) material: Option<(usize, &'a str)>,
    /// They have indices of texture coordinates.
    pub(super) uvs: bool,
    /// They have indices of normals.
    pub(super) normals: bool,
}

struct ForwardIndex {
    line: usize,
    kind: usize,
    index: usize,
}

/// What the three parts of a corner, as in `1/2/3`, refer to.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Statements that say nothing about the look of a mesh.
const HARMLESS: [&str; 7] = ["o", "g", "s", "mg", "bevel", "c_interp", "d_interp"];

/// Statements of the format that are left out although they say something: other primitives than polygons,
/// free-form surfaces, and what the format's first programs could do.
#[rustfmt::skip]
const UNSUPPORTED: [&str; 32] = [
    "p", "l", "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
    "sp", "end", "con", "lod", "usemap", "maplib", "shadow_obj", "trace_obj", "ctech", "stech", "call", "csh",
    "bsp", "bzp", "cdc", "cdp", "res", "fo",
];

impl<'a> Outline<'a> {
    /// Goes through the `text` of `file`.
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
                    return Err(at("`usemtl` must be followed by the name of a material".into()));
                }
                "usemtl" => material = Some((statement.line, statement.arguments)),
                "mtllib" if statement.arguments.is_empty() => {
                    return Err(at("`mtllib` must be followed by the name of an MTL file".into()));
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

    /// Takes note of a `v`, `vt` or `vn`.
    fn vertex_data(&mut self, kind: usize, statement: &Statement<'a>) -> Result<(), String> {
        if !numbers::look_right(statement) {
            numbers::check(statement)?;
        }
        self.counts[kind] += 1;
        self.push_geometry(statement);
        Ok(())
    }

    /// Checks a face and takes note of it.
    fn face(&mut self, statement: &Statement<'a>, material: Option<(usize, &'a str)>) -> Result<(), String> {
        let mut corners = 0;
        let mut form = (false, false);
        for corner in statement.uncommented().split_ascii_whitespace() {
            let its_form = self.corner(corner, statement.line)?;
            if corners > 0 && its_form != form {
                return Err("the corners of a face must all have the same parts: `v`, `v/vt`, `v//vn` or \
                            `v/vt/vn`"
                    .into());
            }
            form = its_form;
            corners += 1;
        }
        if corners < 3 {
            return Err(format!("a face must have at least 3 corners, but this has {corners}"));
        }
        let run = Run { first: self.triangles, material, uvs: form.0, normals: form.1 };
        match self.runs.last() {
            Some(last) if last.goes_on_with(&run) => {}
            _ => self.runs.push(run),
        }
        self.triangles += corners - 2;
        self.push_geometry(statement);
        Ok(())
    }

    /// Checks one corner of a face; says whether it has a texture coordinate and whether it has a normal.
    fn corner(&mut self, corner: &str, line: usize) -> Result<(bool, bool), String> {
        let mut has = [false; 3];
        for (kind, part) in corner.split('/').enumerate() {
            if kind >= has.len() {
                return Err(format!("`{}` has more than the three parts `v/vt/vn`", shown(corner)));
            }
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| {
                format!("`{}` is not a corner of a face; an index must be a whole number", shown(corner))
            })?;
            has[kind] = true;
            let count = self.counts[kind];
            if index > 0 {
                let index = usize::try_from(index).unwrap_or(usize::MAX);
                if index > count {
                    self.forward.push(ForwardIndex { line, kind, index });
                }
            } else if index == 0 {
                return Err(format!("`{}` has the index 0, but indices start from 1", shown(corner)));
            } else if index.unsigned_abs() > count as u64 {
                return Err(out_of_range(kind, index, count));
            }
        }
        if !has[0] {
            return Err(format!("the corner `{}` has no vertex", shown(corner)));
        }
        Ok((has[1], has[2]))
    }

    /// Leaves a statement to `tobj`, but not a comment at its end.
    fn push_geometry(&mut self, statement: &Statement<'a>) {
        let Statement { start, text, .. } = *statement;
        let end = start + text.len();
        match text.find('#') {
            Some(comment) => {
                self.geometry.extend([start..start + comment, end - usize::from(text.ends_with('\n'))..end])
            }
            None => match self.geometry.last_mut() {
                Some(last) if last.end == start => last.end = end,
                _ => self.geometry.push(start..end),
            },
        }
    }
}

impl Run<'_> {
    fn goes_on_with(&self, next: &Self) -> bool {
        self.material == next.material && self.uvs == next.uvs && self.normals == next.normals
    }
}

fn out_of_range(kind: usize, index: i64, count: usize) -> String {
    let kind = KINDS[kind];
    if index < 0 {
        format!("{kind} {index} does not exist: there are {count} of this kind before this line")
    } else {
        format!("{kind} {index} does not exist: the file has {count} of this kind")
    }
}

/// The beginning of a word, without control characters, so that garbage does not upset the terminal.
pub(super) fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    let printable = |character: char| if character.is_control() { '\u{fffd}' } else { character };
    let mut start: String = word.chars().take(LONGEST).map(printable).collect();
    if word.chars().nth(LONGEST).is_some() {
        start.push('…');
    }
    start
}

/// Lets `tobj` read parts of a text one after the other, without a copy.
pub(super) struct Parts<'a> {
    text: &'a [u8],
    /// What is left of the current part.
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
