//! `grader plan`.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arty::scene::{Scene, SceneDescription};

use harness::workspace::Workspace;
use judge::checks::JudgedScene;
use judge::plan::{self, Entry};
use judge::reference::{self, Reference};
use verdict::error::{Error, Result};

/// Say which checks mean something in a scene, and why others are left out.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A scene: its name in the collection, or a file
    scene: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let judged = load(&workspace, &arguments.scene)?;
    let entries = plan::for_scene(&judged);
    let mut out = std::io::stdout().lock();
    let text = if arguments.json {
        let list: Vec<_> = entries
            .iter()
            .map(|entry| {
                serde_json::json!({
                    "check": entry.check,
                    "technique": entry.technique,
                    "applies": entry.why_not.is_none(),
                    "why_not": entry.why_not,
                })
            })
            .collect();
        serde_json::to_string_pretty(&list).map_err(|error| Error::Harness(error.to_string()))?
    } else {
        format!("{}\n\n{}", judged.scene.features(), list(&entries))
    };
    // Nobody may be reading any more.
    let _ = writeln!(out, "{text}");
    Ok(ExitCode::SUCCESS)
}

/// Techniques of which the same is to be said stand in one line.
fn list(entries: &[Entry]) -> String {
    let mut lines: Vec<(&Entry, Vec<String>)> = Vec::new();
    for entry in entries {
        match lines
            .iter_mut()
            .find(|(other, _)| (other.check, &other.why_not) == (entry.check, &entry.why_not))
        {
            Some((_, techniques)) => techniques.push(entry.technique.to_string()),
            None => lines.push((entry, vec![entry.technique.to_string()])),
        }
    }
    let line = |(entry, techniques): &(&Entry, Vec<String>)| {
        let applies = if entry.why_not.is_none() { "yes" } else { "no" };
        let why = entry.why_not.as_deref().unwrap_or_default();
        format!("{applies:<4}{:<15} {:<15} {why}", entry.check.name(), techniques.join(", "))
            .trim_end()
            .to_owned()
    };
    lines.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// A scene of the collection has a reference, a file of anyone's has none.
fn load(workspace: &Workspace, scene: &Path) -> Result<JudgedScene> {
    let name = scene.to_string_lossy();
    let known = workspace.scene_file(&name);
    let with = |description: SceneDescription, reference: Reference| JudgedScene {
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
            "{name}: neither a scene of the collection nor a file (the scenes are in {})",
            workspace.root().join("scenes").display()
        )));
    }
    Ok(with(arty::scene::file::load(scene)?.description, Reference::default()))
}
