//! A collection of scenes, models and textures.

use crate::model::Model;
use crate::output::{Content, OutputFile};
use crate::scene_file::SceneFile;

/// Scenes with their models and textures.
#[derive(Default)]
pub(crate) struct Collection {
    /// Scenes; each names some of the models.
    pub(crate) scenes: Vec<SceneFile>,
    /// Models; several scenes may use the same one.
    pub(crate) models: Vec<Model>,
    /// PNG files by name.
    pub(crate) textures: Vec<(&'static str, Vec<u8>)>,
}

impl Collection {
    /// The model with this name.
    pub(crate) fn model(&self, name: &str) -> Option<&Model> {
        self.models.iter().find(|model| model.name == name)
    }

    /// All files to write.
    pub(crate) fn files(&self) -> Vec<OutputFile> {
        let text = |name: String, text: String| OutputFile { name, content: Content::Text(text) };
        let mut files = Vec::new();
        for scene in &self.scenes {
            files.push(text(format!("{}.yml", scene.name), scene.yaml()));
        }
        for model in &self.models {
            files.push(text(format!("{}.obj", model.name), model.obj()));
            files.push(text(format!("{}.mtl", model.name), model.mtl()));
        }
        for (name, png) in &self.textures {
            files.push(OutputFile { name: (*name).to_owned(), content: Content::Png(png.clone()) });
        }
        files
    }
}
