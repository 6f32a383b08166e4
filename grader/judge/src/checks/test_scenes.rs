//! Scenes of `scenes/` for tests.

use arty::scene::Scene;

use super::SceneWithReference;
use crate::reference;
use harness::workspace::Workspace;

/// Loads a scene with its reference.
pub(super) fn load(name: &str) -> SceneWithReference {
    let workspace = Workspace::find().expect("this is the repository");
    let description =
        arty::scene::file::load(&workspace.scene_file(name)).expect("the scene is right").description;
    let reference = reference::load(&workspace.reference_file(name), name, &description)
        .expect("the reference is up to date");
    SceneWithReference { scene: Scene::new(&description), description, reference }
}
