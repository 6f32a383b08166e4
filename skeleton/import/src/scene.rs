//! From the nodes of a scene to meshes, lights and the camera.

use arty::diagnostic::Diagnostic;
use arty::scene::LightDescription;
use glam::{DMat4, Mat4};
use gltf::Node;

use crate::camera::{self, View};
use crate::document::{Document, named};
use crate::left_out::LeftOut;
use crate::light;
use crate::material::Materials;
use crate::mesh::{self, Part};

/// Options of an import.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Lumens per watt: glTF has candela where the renderer has watts. Blender's exporter multiplies its watts by 683.
    pub lumens_per_watt: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { lumens_per_watt: 683.0 }
    }
}

/// Extensions that are converted or listed item by item.
const KNOWN_EXTENSIONS: [&str; 5] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_texture_transform",
];

/// A converted scene.
pub(crate) struct Converted {
    pub(crate) view: View,
    pub(crate) lights: Vec<LightDescription>,
    pub(crate) parts: Vec<Part>,
    pub(crate) materials: Materials,
    pub(crate) left_out: LeftOut,
}

/// Converts the default scene of a file. Textures are named after `stem`.
///
/// # Errors
/// The first item that is not valid.
pub(crate) fn convert(document: &Document, stem: &str, options: Options) -> Result<Converted, Diagnostic> {
    let mut left_out = LeftOut::default();
    let gltf = &document.gltf;
    for extension in gltf.extensions_used().filter(|name| !KNOWN_EXTENSIONS.contains(name)) {
        left_out.add(format!("the extension {extension}"));
    }
    left_out.add_if(gltf.animations().len() > 0, || "animations".to_owned());
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    left_out
        .add_if(gltf.scenes().len() > 1, || format!("{} other scenes of the file", gltf.scenes().len() - 1));
    let mut walk = Walk {
        document,
        stem,
        options,
        view: None,
        lights: Vec::new(),
        parts: Vec::new(),
        materials: Materials::default(),
        left_out,
    };
    // Depth first, in the order of the file. A tree visits no node twice.
    let roots = scene.iter().flat_map(gltf::Scene::nodes).map(|node| (node, DMat4::IDENTITY));
    let mut open: Vec<(Node<'_>, DMat4)> = roots.collect();
    open.reverse();
    let mut is_visited = vec![false; gltf.nodes().len()];
    while let Some((node, parent)) = open.pop() {
        if std::mem::replace(&mut is_visited[node.index()], true) {
            let item = named("node", node.name(), node.index());
            return Err(document.error(&item, "it has two parents, or is its own descendant"));
        }
        let to_world = parent * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        walk.visit(&node, &to_world)?;
        let children: Vec<_> = node.children().map(|child| (child, to_world)).collect();
        open.extend(children.into_iter().rev());
    }
    let Walk { view, lights, parts, materials, mut left_out, .. } = walk;
    let view = view.unwrap_or_else(|| {
        left_out.add("a camera: the file has none that can be used, so one looks at everything");
        camera::in_front_of(parts.iter().flat_map(|part| part.positions.iter().copied()))
    });
    Ok(Converted { view, lights, parts, materials, left_out })
}

/// What has been converted so far.
struct Walk<'a> {
    document: &'a Document,
    stem: &'a str,
    options: Options,
    view: Option<View>,
    lights: Vec<LightDescription>,
    parts: Vec<Part>,
    materials: Materials,
    left_out: LeftOut,
}

impl Walk<'_> {
    fn visit(&mut self, node: &Node<'_>, to_world: &DMat4) -> Result<(), Diagnostic> {
        let document = self.document;
        if let Some(camera) = node.camera() {
            let view = camera::convert(document, &camera, to_world, &mut self.left_out)?;
            self.left_out.add_if(view.is_some() && self.view.is_some(), || {
                format!("{}: the first camera is used", named("camera", camera.name(), camera.index()))
            });
            self.view = self.view.or(view);
        }
        if let Some(light) = node.light() {
            let lumens_per_watt = self.options.lumens_per_watt;
            let light = light::convert(document, &light, to_world, lumens_per_watt, &mut self.left_out)?;
            self.lights.extend(light);
        }
        let Some(mesh) = node.mesh() else { return Ok(()) };
        self.left_out.add_if(node.skin().is_some(), || {
            format!("{}: its armature", named("node", node.name(), node.index()))
        });
        let name = named("mesh", mesh.name(), mesh.index());
        for primitive in mesh.primitives() {
            let item = match mesh.primitives().len() {
                1 => name.clone(),
                _ => format!("{name}, primitive {}", primitive.index()),
            };
            let material =
                self.materials.index(document, &primitive.material(), self.stem, &mut self.left_out)?;
            let uv_set = self.materials.all[material].texture.as_ref().map(|(_, set)| *set);
            let part = mesh::read(document, &primitive, to_world, uv_set, &item, &mut self.left_out)?;
            self.parts.extend(part.map(|part| Part { material, ..part }));
        }
        Ok(())
    }
}
