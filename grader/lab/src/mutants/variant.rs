//! Variants of the solution, read from the folder of an assignment.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Deserialize;

use harness::assignment::Assignment;
use verdict::error::{Error, Result};

/// Whether a variant is correct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It has a mistake and must lose points.
    Wrong,
    /// It is correct and must earn all points.
    Right,
}

impl Kind {
    /// Name on the command line and of the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wrong => "wrong",
            Self::Right => "right",
        }
    }
}

/// A submission with a known expectation.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Unique name.
    pub id: String,
    /// Whether it is correct.
    pub kind: Kind,
    /// Rows in the catalogue of mistakes.
    pub rows: Vec<String>,
    /// What it does.
    pub title: String,
    /// Tasks that must lose points.
    pub costs: Vec<String>,
    /// Tasks that must keep all of their points.
    pub keeps: Vec<String>,
    /// Tasks whose outcome differs from the expectation, and the reason.
    pub missed_because: BTreeMap<String, String>,
    /// Source text.
    pub source: String,
}

/// A mistake of the catalogue that no submission can make.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NotPossible {
    /// Its row.
    pub row: String,
    /// Reason.
    pub why: String,
}

/// All variants.
#[derive(Clone, Debug)]
pub struct Variants {
    /// The wrong ones, then the correct ones, in the order of their files.
    pub list: Vec<Variant>,
    /// Mistakes without a variant.
    pub not_possible: Vec<NotPossible>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    variants: Vec<Entry>,
    #[serde(default)]
    not_possible: Vec<NotPossible>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    id: String,
    title: String,
    #[serde(default)]
    rows: Vec<String>,
    /// For readers: true if it was seen in a real submission.
    #[serde(default, rename = "seen")]
    _seen: bool,
    #[serde(default)]
    costs: Vec<String>,
    #[serde(default)]
    keeps: Vec<String>,
    #[serde(default)]
    missed_because: BTreeMap<String, String>,
    replace: Option<Vec<Replace>>,
    file: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Replace {
    from: String,
    to: String,
}

/// Reads all variants.
///
/// # Errors
/// The first entry that does not fit the solution or the rubric.
pub fn variants(assignment: &Assignment) -> Result<Variants> {
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| Error::file(path, error));
    let solution = assignment.solution()?;
    let tasks: Vec<&str> =
        assignment.rubric.tasks.iter().filter(|task| !task.manual).map(|task| task.id.as_str()).collect();
    let folder = assignment.folder.variants();
    let mut all = Variants { list: Vec::new(), not_possible: Vec::new() };
    let mut ids = BTreeSet::new();
    for kind in [Kind::Wrong, Kind::Right] {
        let path = folder.join(kind.name()).with_extension("yml");
        let (file, _) = arty::yaml::read::<File>(&path)?;
        all.not_possible.extend(file.not_possible);
        for entry in file.variants {
            let id = entry.id.clone();
            let blame = |message: String| Error::file(&path, format!("variant {id}: {message}"));
            if !ids.insert(id.clone()) {
                return Err(blame("another variant has this name".to_owned()));
            }
            let source = match (&entry.file, &entry.replace) {
                (Some(name), None) => read(&folder.join(name))?,
                (None, Some(list)) => replace(&solution, list).map_err(blame)?,
                _ => return Err(blame("either `file` or `replace`".to_owned())),
            };
            all.list.push(variant(entry, kind, source, &tasks).map_err(blame)?);
        }
    }
    Ok(all)
}

fn variant(entry: Entry, kind: Kind, source: String, tasks: &[&str]) -> std::result::Result<Variant, String> {
    let Entry { id, title, rows, costs, mut keeps, missed_because, .. } = entry;
    match kind {
        Kind::Right if !(costs.is_empty() && keeps.is_empty()) => {
            return Err("a correct variant keeps all points: leave out `costs` and `keeps`".to_owned());
        }
        Kind::Right => keeps = tasks.iter().map(|&task| task.to_owned()).collect(),
        Kind::Wrong if costs.is_empty() => return Err("`costs` names at least one task".to_owned()),
        Kind::Wrong => {}
    }
    let named = costs.iter().chain(&keeps);
    if let Some(unknown) = named.clone().find(|task| !tasks.contains(&task.as_str())) {
        return Err(format!("no task `{unknown}` is graded automatically; there are {}", tasks.join(", ")));
    }
    if let Some(both) = costs.iter().find(|task| keeps.contains(task)) {
        return Err(format!("task {both} is in both `costs` and `keeps`"));
    }
    if let Some(task) = missed_because.keys().find(|task| !named.clone().any(|other| other == *task)) {
        return Err(format!("`missed_because` names task {task}, which is in neither `costs` nor `keeps`"));
    }
    Ok(Variant { id, kind, rows, title, costs, keeps, missed_because, source })
}

/// Applies all replacements to the original text, in which each pattern must occur exactly once.
fn replace(solution: &str, list: &[Replace]) -> std::result::Result<String, String> {
    let mut places = Vec::new();
    for Replace { from, to } in list {
        let mut found = solution.match_indices(from.as_str());
        match (found.next(), found.next()) {
            (Some((start, _)), None) if !from.is_empty() => places.push((start, from.len(), to)),
            (None, _) => return Err(format!("the solution does not contain `{from}`")),
            _ => return Err(format!("the solution contains `{from}` more than once")),
        }
    }
    places.sort_by_key(|&(start, _, _)| start);
    if let Some(pair) = places.windows(2).find(|pair| pair[0].0 + pair[0].1 > pair[1].0) {
        return Err(format!("two replacements overlap, the second one by `{}`", pair[1].2));
    }
    let mut text = solution.to_owned();
    for (start, length, to) in places.into_iter().rev() {
        text.replace_range(start..start + length, to);
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn replaced(list: &[(&str, &str)]) -> std::result::Result<String, String> {
        let list: Vec<_> =
            list.iter().map(|&(from, to)| Replace { from: from.into(), to: to.into() }).collect();
        replace("let a = b + b * c;", &list)
    }

    #[test]
    fn replacements_refer_to_the_original_in_any_order() {
        assert_eq!(replaced(&[("c", "a"), ("a", "c")]).as_deref(), Ok("let c = b + b * a;"));
    }

    #[test]
    fn a_pattern_that_does_not_occur_exactly_once_is_refused() {
        for (list, expected) in [
            (vec![("d", "e")], "does not contain `d`"),
            (vec![("b", "e")], "more than once"),
            (vec![("", "e")], "more than once"),
            (vec![("a = b", "e"), ("b + b", "f")], "overlap"),
        ] {
            let message = replaced(&list).expect_err(expected);
            assert!(message.contains(expected), "{message}");
        }
    }
}
