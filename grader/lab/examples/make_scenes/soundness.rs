//! Requirements on every scene before it is written.

use std::collections::BTreeSet;

use crate::collection::Collection;
use crate::model::{Model, Part};
use crate::scene_file::Light;
use crate::surface::Surface;

/// One line for each fault; none if all is well.
pub(crate) fn faults(collection: &Collection) -> Vec<String> {
    let mut faults = faults_of_names(collection);
    for scene in &collection.scenes {
        for light in &scene.lights {
            faults.extend(light_fault(light).map(|fault| format!("{}: {fault}", scene.name)));
        }
    }
    for model in &collection.models {
        faults.extend(model_faults(model, collection));
    }
    faults
}

/// Requirements that also hold for scenes with degenerate triangles and lights.
pub(crate) fn faults_of_names(collection: &Collection) -> Vec<String> {
    let mut faults = Vec::new();
    let mut names = BTreeSet::new();
    for file in collection.files("scene.schema.json") {
        if !names.insert(file.name.clone()) {
            faults.push(format!("{}: made twice", file.name));
        }
    }
    for scene in &collection.scenes {
        for model in &scene.models {
            if collection.model(model.model).is_none() {
                faults.push(format!("{}: has no model {}", scene.name, model.model));
            }
        }
    }
    for model in &collection.models {
        let used = collection.scenes.iter().flat_map(|scene| &scene.models);
        if !used.into_iter().any(|used| used.model == model.name) {
            faults.push(format!("{}: no scene uses it", model.name));
        }
    }
    faults
}

fn light_fault(light: &Light) -> Option<&'static str> {
    match *light {
        Light::Point { .. } => None,
        Light::Spot { position, target, inner, outer, .. } => {
            let is_cone = position != target && 0.0 < outer && inner <= outer && outer <= 180.0;
            (!is_cone).then_some("a spot light without a cone")
        }
        Light::Triangle { corners: [a, b, c], .. } => {
            ((b - a).cross(c - a).length() < 1e-6).then_some("a triangle light without an area")
        }
    }
}

fn model_faults(model: &Model, collection: &Collection) -> Vec<String> {
    let mut faults = Vec::new();
    for part in &model.parts {
        let mut report = |fault: &str| {
            faults.push(format!("{}, part {}: {fault}", model.name, part.material.name));
        };
        surface_faults(&part.surface).into_iter().for_each(&mut report);
        material_faults(part, collection).into_iter().for_each(&mut report);
    }
    faults
}

fn surface_faults(surface: &Surface) -> Vec<&'static str> {
    let mut faults = Vec::new();
    let count = surface.positions.len();
    if surface.triangles.is_empty() || surface.triangles.iter().flatten().any(|&corner| corner >= count) {
        return vec!["no triangles, or corners that do not exist"];
    }
    if !surface.positions.iter().all(|position| position.is_finite()) {
        faults.push("a position that is no number");
    }
    if surface.triangles.iter().any(|triangle| surface.cross(triangle).length() < 1e-6) {
        faults.push("a triangle without an area");
    }
    if !surface.normals.is_empty() {
        if surface.normals.len() != count {
            faults.push("normals for some corners only");
        } else if surface.triangles.iter().any(|triangle| {
            let front = surface.cross(triangle).normalize();
            triangle.iter().any(|&corner| surface.normals[corner].dot(front) < 0.5)
        }) {
            faults.push("a normal more than 60 degrees away from the front");
        }
    }
    if !surface.uvs.is_empty() && surface.uvs.len() != count {
        faults.push("texture coordinates for some corners only");
    }
    faults
}

fn material_faults(part: &Part, collection: &Collection) -> Vec<&'static str> {
    let mut faults = Vec::new();
    let material = &part.material;
    if (0..3).any(|channel| material.diffuse[channel] + material.specular[channel] > 1.0) {
        faults.push("it reflects more light than it gets");
    }
    if let Some(file) = material.texture {
        if part.surface.uvs.is_empty() {
            faults.push("a texture without texture coordinates");
        }
        if !collection.textures.iter().any(|(name, _)| *name == file) {
            faults.push("a texture that is not made");
        }
    }
    faults
}
