//! The table of extreme scenes: the exact mean of each, and the techniques that can render it.

use std::collections::BTreeMap;

use arty::integrator::Technique;
use arty::scene::SceneDescription;
use serde::Deserialize;

use harness::workspace::Workspace;
use verdict::error::{Error, Result};

/// One entry of `scenes/extreme/answers.yml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// Name of the scene.
    pub scene: String,
    /// Exact radiance of every pixel and channel; `None` if `same_as` is given.
    #[serde(default)]
    pub radiance: Option<f64>,
    /// Name of a scene with the same mean; `None` if `radiance` is given.
    #[serde(default)]
    pub same_as: Option<String>,
    /// Derivation of the exact mean.
    pub because: String,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Relative error that single precision and the discretisation of the scene explain.
    pub tolerance: f64,
    /// True if failures cost points.
    #[serde(rename = "judged")]
    pub is_graded: bool,
    /// Techniques that cannot render the scene, with the reason.
    #[serde(default)]
    pub left_out: BTreeMap<Technique, String>,
}

/// An extreme scene.
pub struct ExtremeScene {
    /// The row of the table of extreme scenes: what the scene is for, and its exact radiance.
    pub answer: Answer,
    /// Content of the scene.
    pub description: SceneDescription,
}

/// Reads the table and its scenes.
///
/// # Errors
/// The first mistake in these files.
pub fn load(workspace: &Workspace) -> Result<Vec<ExtremeScene>> {
    let path = workspace.extreme_answers();
    let (answers, _) = arty::yaml::read::<Vec<Answer>>(&path)?;
    for answer in &answers {
        let named = |name: &String| answers.iter().any(|other| other.scene == *name);
        if answer.radiance.is_some() == answer.same_as.is_some() || !answer.same_as.iter().all(named) {
            let message = format!(
                "scene {}: give either `radiance` or `same_as` with a scene of the table",
                answer.scene
            );
            return Err(Error::file(&path, message));
        }
        if !(answer.tolerance > 0.0 && answer.tolerance < 1.0) || answer.size.contains(&0) {
            let message =
                format!("scene {}: `tolerance` must be between 0 and 1, `size` positive", answer.scene);
            return Err(Error::file(&path, message));
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
    fn every_scene_loads_and_every_skipped_technique_has_a_reason() {
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
