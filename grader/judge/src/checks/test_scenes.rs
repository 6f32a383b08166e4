//! Scenes of `scenes/` for tests.

use super::SceneWithReference;
use crate::grade::load_scene;
use harness::workspace::Workspace;

/// Loads a scene with its reference.
pub(super) fn load(name: &str) -> SceneWithReference {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    load_scene(&workspace, name).expect("the scene and its reference are up to date")
}
