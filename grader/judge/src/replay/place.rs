//! Loading the scene of a replay target.

use arty::scene::SceneDescription;
use glam::DVec3;
use harness::workspace::Workspace;
use verdict::error::{Error, Result};
use verdict::replay::ReplayTarget;

use crate::scenes::{changed, room};

/// The scene of a replay target, scaled and brightened as it says.
///
/// # Errors
/// If there is no such scene, or it cannot be read.
pub fn load(workspace: &Workspace, target: &ReplayTarget) -> Result<SceneDescription> {
    let ReplayTarget { scene: name, scale, emission, .. } = target;
    let scene = if name == ReplayTarget::ROOM {
        room()
    } else {
        // The name must not lead out of the folder.
        if name.contains(['\\', ':']) || name.split('/').any(|part| matches!(part, "" | "." | "..")) {
            return Err(Error::Input(format!("--scene: `{name}` is a path: give the name of a scene")));
        }
        let files = [workspace.scene_file(name), workspace.extreme_scene_file(name)];
        let file = files.iter().find(|file| file.is_file()).ok_or_else(|| {
            Error::Input(format!(
                "--scene: there is no scene `{name}` in scenes/ or scenes/extreme/, and it is not {}",
                ReplayTarget::ROOM
            ))
        })?;
        arty::scene::file::load(file)?.description
    };
    Ok(if (*scale, *emission) == (1.0, 1.0) {
        scene
    } else {
        changed(&scene, *scale, DVec3::ZERO, *emission)
    })
}
