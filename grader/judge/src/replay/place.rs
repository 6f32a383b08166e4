//! Which path.

use arty::integrator::Technique;
use arty::scene::SceneDescription;
use glam::DVec3;
use host::protocol::{AnomalousSample, Switches};

use crate::extreme::build::{changed, room};
use harness::workspace::Workspace;
use verdict::error::{Error, Result};

/// A path by its number, in a scene that may have been made larger or brighter.
#[derive(Clone, Debug)]
pub struct Place {
    /// The name of the scene: one of `scenes/` or `scenes/extreme/`, or [`Place::ROOM`].
    pub scene: String,
    /// Its content, changed as the fields below say.
    pub description: SceneDescription,
    /// How many times as large it is.
    pub scale: f64,
    /// How many times as bright it is.
    pub emission: f32,
    /// With which technique.
    pub technique: Technique,
    /// Up to how many bounces.
    pub max_bounces: u32,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The seed of the rendering.
    pub seed: u64,
    /// Column and row.
    pub pixel: [u32; 2],
    /// Number of the sample.
    pub sample: u64,
    /// Ways of finding light that are closed.
    pub switches: Switches,
}

impl Place {
    /// The name of the scene that the check `stability` makes in memory.
    pub const ROOM: &str = "stability-room";

    /// The content of the scene of a name, `scale` times as large and `emission` times as bright.
    ///
    /// # Errors
    /// If there is no such scene, or it cannot be read.
    pub fn load(workspace: &Workspace, name: &str, scale: f64, emission: f32) -> Result<SceneDescription> {
        let scene = if name == Self::ROOM {
            room()
        } else {
            // A name, not a way out of the folder.
            if name.contains(['/', '\\']) {
                return Err(Error::Input(format!(
                    "--scene: `{name}` is a path; the name of a scene is wanted"
                )));
            }
            let files = [workspace.scene_file(name), workspace.extreme_scene_file(name)];
            let file = files.iter().find(|file| file.is_file()).ok_or_else(|| {
                Error::Input(format!(
                    "--scene: there is no scene `{name}` in scenes/ or scenes/extreme/, and it is not {}",
                    Self::ROOM
                ))
            })?;
            arty::scene::file::load(file)?.description
        };
        Ok(if (scale, emission) == (1.0, 1.0) {
            scene
        } else {
            changed(&scene, scale, DVec3::ZERO, emission)
        })
    }

    /// The same for one sample that a check has found.
    pub fn of(self, sample: &AnomalousSample) -> Self {
        Self { seed: sample.seed, pixel: [sample.x, sample.y], sample: sample.sample, ..self }
    }

    /// The command that follows this path again; `submission` is already quoted for a shell.
    pub fn command(&self, submission: &str) -> String {
        let [width, height] = self.size;
        let [x, y] = self.pixel;
        let mut command = format!(
            "cargo grader replay {submission} --scene={} --pixel={x},{y} --sample={} --technique={} --max-bounces={} \
             --seed={} --size={width}x{height}",
            self.scene, self.sample, self.technique, self.max_bounces, self.seed
        );
        if !self.switches.emission_on_hit {
            command += " --hits-off";
        }
        if self.scale != 1.0 {
            command += &format!(" --scale={}", self.scale);
        }
        if self.emission != 1.0 {
            command += &format!(" --emission={}", self.emission);
        }
        command
    }
}
