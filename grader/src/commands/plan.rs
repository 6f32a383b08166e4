//! `grader plan`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arty::scene::{Scene, SceneDescription};

use harness::workspace::Workspace;
use judge::checks::SceneWithReference;
use judge::plan::{self, PlannedCheck};
use judge::reference::{self, Reference};
use present::streams::print_line;
use present::words;
use verdict::error::{Error, Result};

/// List the checks that apply to a scene, and why others are skipped
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Scene: a name in scenes/, or a file
    scene: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let scene = load(workspace, &arguments.scene)?;
    let entries = plan::for_scene(&scene);
    if arguments.json {
        print_line(json(&entries)?)?;
    } else {
        print_line(format_args!("{}\n\n{}", scene.scene.features(), list(&entries)))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The entries as JSON. `why_not` is a sentence, `code` the same as data.
fn json(entries: &[PlannedCheck]) -> Result<String> {
    let object = |PlannedCheck { check, technique, why_not }: &PlannedCheck| {
        serde_json::json!({
            "check": check,
            "technique": technique,
            "applies": why_not.is_none(),
            "why_not": why_not.as_ref().map(words::why_not),
            "code": why_not,
        })
    };
    let list: Vec<_> = entries.iter().map(object).collect();
    serde_json::to_string_pretty(&list).map_err(|error| Error::Harness(error.to_string()))
}

/// One line for each check and reason, with all techniques that share it.
fn list(entries: &[PlannedCheck]) -> String {
    let mut lines: Vec<(&PlannedCheck, Vec<String>)> = Vec::new();
    for entry in entries {
        let is_same = |other: &PlannedCheck| (other.check, &other.why_not) == (entry.check, &entry.why_not);
        match lines.iter_mut().find(|(other, _)| is_same(other)) {
            Some((_, techniques)) => techniques.push(entry.technique.to_string()),
            None => lines.push((entry, vec![entry.technique.to_string()])),
        }
    }
    let line = |(entry, techniques): &(&PlannedCheck, Vec<String>)| {
        let applies = if entry.why_not.is_none() { "yes" } else { "no" };
        let why = entry.why_not.as_ref().map(words::why_not).unwrap_or_default();
        let line = format!("{applies:<4}{:<15} {:<15} {why}", entry.check.name(), techniques.join(", "));
        line.trim_end().to_owned()
    };
    lines.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// A scene by name, with its reference, or from a file, without one.
fn load(workspace: &Workspace, scene: &Path) -> Result<SceneWithReference> {
    let name = scene.to_string_lossy();
    let known = workspace.scene_file(&name);
    let with = |description: SceneDescription, reference: Reference| SceneWithReference {
        scene: Scene::new(&description),
        description,
        reference,
    };
    if known.is_file() {
        let description = arty::scene::file::load(&known)?.description;
        let file = workspace.reference_file(&name);
        let reference =
            if file.is_file() { reference::load(&file, &name, &description)? } else { Reference::default() };
        return Ok(with(description, reference));
    }
    if !scene.is_file() {
        return Err(Error::Input(format!(
            "{name}: neither the name of a scene nor a file (scenes are in {})",
            workspace.root().join("scenes").display()
        )));
    }
    Ok(with(arty::scene::file::load(scene)?.description, Reference::default()))
}
