//! A collection of scenes, models, textures and maps of environments.

use std::collections::BTreeMap;

use arty::image::Image;

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
    /// Environments as YAML, by the names of their scenes.
    pub(crate) environments: BTreeMap<&'static str, &'static str>,
    /// OpenEXR files by name.
    pub(crate) maps: Vec<(&'static str, Image)>,
}

impl Collection {
    /// The model with this name.
    pub(crate) fn model(&self, name: &str) -> Option<&Model> {
        self.models.iter().find(|model| model.name == name)
    }

    /// All files to write. `schema` is the path from them to the schema of scene files, which editors look for.
    pub(crate) fn files(&self, schema: &str) -> Vec<OutputFile> {
        let text = |name: String, text: String| OutputFile { name, content: Content::Text(text) };
        let mut files = Vec::new();
        for scene in &self.scenes {
            let environment = self.environments.get(scene.name);
            let environment = environment.map_or(String::new(), |it| format!("environment: {it}\n"));
            let content = format!("# yaml-language-server: $schema={schema}\n{}{environment}", scene.yaml());
            files.push(text(format!("{}.yml", scene.name), content));
        }
        for model in &self.models {
            files.push(text(format!("{}.obj", model.name), model.obj()));
            files.push(text(format!("{}.mtl", model.name), model.mtl()));
        }
        for (name, png) in &self.textures {
            files.push(OutputFile { name: (*name).to_owned(), content: Content::Png(png.clone()) });
        }
        for (name, map) in &self.maps {
            files.push(OutputFile { name: (*name).to_owned(), content: Content::Map(map.clone()) });
        }
        files
    }
}
