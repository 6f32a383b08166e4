//! The inputs of a grade: scenes, references and the rubric.

use std::collections::BTreeMap;
use std::path::Path;

use arty::scene::Scene;

use super::select::Selected;
use crate::checks::SceneWithReference;
use crate::reference;
use harness::workspace::Workspace;
use verdict::check::Visibility;
use verdict::error::{Error, Result};

/// Loads the scenes of the selected checks with their references. In a checkout without the solution, staff-only scenes
/// may be missing.
pub(super) fn load_scenes(
    workspace: &Workspace,
    selected: &Selected<'_>,
) -> Result<BTreeMap<String, SceneWithReference>> {
    let mut scenes = BTreeMap::new();
    let is_staff = workspace.is_staff();
    let is_missing = |scene: &str| {
        !is_staff
            && Visibility::of_scene(scene) == Visibility::StaffOnly
            && !workspace.scene_file(scene).exists()
    };
    for (_, spec) in selected.iter().filter(|(_, spec)| spec.check.needs_scene()) {
        if !(scenes.contains_key(&spec.scene) || is_missing(&spec.scene)) {
            scenes.insert(spec.scene.clone(), load_scene(workspace, &spec.scene)?);
        }
    }
    Ok(scenes)
}

/// Makes sure that the references have what the selected checks need of them.
///
/// # Errors
/// The first check whose reference lacks something, with the command that adds it.
pub(super) fn require_references(
    workspace: &Workspace,
    selected: &Selected<'_>,
    scenes: &BTreeMap<String, SceneWithReference>,
) -> Result<()> {
    for (_, spec) in selected {
        if let Some(lacking) = scenes.get(&spec.scene).and_then(|scene| scene.reference.lacks(spec)) {
            let (id, scene) = (spec.id(), &spec.scene);
            let message =
                format!("it lacks {lacking}, which {id} needs: run `cargo lab reference --missing {scene}`");
            return Err(Error::file(&workspace.reference_file(scene), message));
        }
    }
    Ok(())
}

/// Loads a scene of `scenes/` with its reference.
///
/// # Errors
/// If either cannot be read or the reference is stale.
pub fn load_scene(workspace: &Workspace, name: &str) -> Result<SceneWithReference> {
    let description = arty::scene::file::load(&workspace.scene_file(name))?.description;
    let reference = reference::load(&workspace.reference_file(name), name, &description)?;
    Ok(SceneWithReference { scene: Scene::new(&description), description, reference })
}

/// BLAKE3 of a text file, independent of its line endings, in hexadecimal.
pub(super) fn hash_of_file(path: &Path) -> Result<String> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
    let mut hasher = blake3::Hasher::new();
    text.lines().for_each(|line| {
        hasher.update(line.as_bytes()).update(b"\n");
    });
    Ok(hasher.finalize().to_hex().to_string())
}

/// BLAKE3 of all references, in hexadecimal.
pub(super) fn hash_of_references(scenes: &BTreeMap<String, SceneWithReference>) -> String {
    let mut hasher = blake3::Hasher::new();
    for (name, scene) in scenes {
        hasher.update(name.as_bytes());
        hasher.update(format!("{:?}", scene.reference).as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}
