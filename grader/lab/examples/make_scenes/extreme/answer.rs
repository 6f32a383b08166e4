//! The expected radiance of each extreme scene, and the techniques that can render it: the file `answers.yml`.

use std::fmt::Write as _;

use crate::number::precise;
use crate::scene_file::SceneFile;

/// Expected result of a scene.
pub(crate) struct Answer {
    /// The expected image.
    pub(crate) truth: Truth,
    /// Derivation.
    pub(crate) because: &'static str,
    /// Techniques that cannot render it, with the reason.
    pub(crate) left_out: Vec<(&'static str, &'static str)>,
    /// Width and height of the image in pixels.
    pub(crate) size: [u32; 2],
    /// Relative error that single precision and the scene's own approximations explain.
    pub(crate) tolerance: f64,
    /// True if points of a submission depend on it; otherwise a failure is only reported.
    pub(crate) judged: bool,
}

/// The expected image.
pub(crate) enum Truth {
    /// This radiance in every pixel.
    Radiance(f64),
    /// The same mean as that of another scene.
    SameAs(&'static str),
}

impl Answer {
    /// An answer for pictures of 8 × 8 pixels, for all techniques.
    pub(crate) fn radiance(value: f64, because: &'static str) -> Self {
        Self::new(Truth::Radiance(value), because)
    }

    pub(super) fn new(truth: Truth, because: &'static str) -> Self {
        Self { truth, because, left_out: Vec::new(), size: [8, 8], tolerance: 1e-3, judged: false }
    }

    pub(super) fn without(mut self, technique: &'static str, why: &'static str) -> Self {
        self.left_out.push((technique, why));
        self
    }

    pub(super) fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    pub(super) fn sized(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    pub(super) fn judged(self) -> Self {
        Self { judged: true, ..self }
    }
}

/// All answers as YAML.
pub(crate) fn answers_file(scenes: &[SceneFile], answers: &[Answer]) -> String {
    let mut file = String::from(
        "# What each scene of this folder must show. Made by the example make_scenes, with the scenes.\n\
         #\n\
         # `radiance` is the radiance in every pixel and channel, `same_as` a scene with the same mean. `left_out` names\n\
         # the techniques that cannot show it, each with the reason. `judged` scenes count for points, the others are\n\
         # remarked on.\n",
    );
    for (scene, answer) in scenes.iter().zip(answers) {
        let truth = match answer.truth {
            Truth::Radiance(value) => format!("radiance: {}", precise(value)),
            Truth::SameAs(scene) => format!("same_as: {scene}"),
        };
        let [width, height] = answer.size;
        let lines = format!(
            "\n- scene: {}\n  {truth}\n  because: \"{}\"\n  max_bounces: {}\n  size: [{width}, {height}]\n  tolerance: \
             {}\n  judged: {}\n",
            scene.name,
            answer.because,
            scene.max_bounces,
            precise(answer.tolerance),
            answer.judged
        );
        file += &lines;
        if !answer.left_out.is_empty() {
            file += "  left_out:\n";
            for (technique, why) in &answer.left_out {
                writeln!(file, "    {technique}: \"{why}\"").expect("a string takes everything");
            }
        }
    }
    file
}
