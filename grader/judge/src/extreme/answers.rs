//! The table of the extreme scenes: what each must show, by which techniques, and why not by others.

use std::collections::BTreeMap;

use arty::integrator::Technique;
use arty::scene::SceneDescription;
use serde::Deserialize;

use harness::workspace::Workspace;
use verdict::error::{Error, Result};

/// One line of `scenes/extreme/answers.yml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// The scene's name.
    pub scene: String,
    /// The radiance in every pixel and channel.
    #[serde(default)]
    pub radiance: Option<f64>,
    /// The scene that has the same mean.
    #[serde(default)]
    pub same_as: Option<String>,
    /// Where that comes from.
    pub because: String,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The relative error that single precision and the scene itself explain.
    pub tolerance: f64,
    /// True if points depend on it.
    #[serde(rename = "judged")]
    pub is_graded: bool,
    /// Techniques that cannot show it, with the reason.
    #[serde(default)]
    pub left_out: BTreeMap<Technique, String>,
}

/// A scene of the table, read.
pub struct ExtremeScene {
    /// What it must show.
    pub answer: Answer,
    /// Its content.
    pub description: SceneDescription,
}

/// Reads the table and the scenes in it.
///
/// # Errors
/// The first thing in these files that is wrong.
pub fn load(workspace: &Workspace) -> Result<Vec<ExtremeScene>> {
    let path = workspace.extreme_answers();
    let (answers, _) = arty::yaml::read::<Vec<Answer>>(&path)?;
    for answer in &answers {
        let named = |name: &String| answers.iter().any(|other| other.scene == *name);
        if answer.radiance.is_some() == answer.same_as.is_some() || !answer.same_as.iter().all(named) {
            let message =
                format!("scene {}: either `radiance` or `same_as` with a scene of the table", answer.scene);
            return Err(Error::file(&path, message));
        }
        if !(answer.tolerance > 0.0 && answer.tolerance < 1.0) || answer.size.contains(&0) {
            return Err(Error::file(&path, format!("scene {}: a wrong `tolerance` or `size`", answer.scene)));
        }
    }
    let load = |answer: Answer| {
        let description = arty::scene::file::load(&workspace.extreme_scene_file(&answer.scene))?.description;
        Ok(ExtremeScene { answer, description })
    };
    answers.into_iter().map(load).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_is_read_and_every_technique_left_out_has_a_reason() {
        let extremes =
            load(&Workspace::find().expect("the tests run inside the checkout")).expect("it is sound");
        assert!(extremes.len() > 35);
        for ExtremeScene { answer, .. } in &extremes {
            assert!(answer.left_out.len() < Technique::ALL.len(), "{}", answer.scene);
            assert!(answer.left_out.values().all(|why| why.len() > 10), "{}", answer.scene);
            assert!(
                answer.radiance.is_none_or(|value| value.is_finite() && value >= 0.0),
                "{}",
                answer.scene
            );
        }
    }
}
