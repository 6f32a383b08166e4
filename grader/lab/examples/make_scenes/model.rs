//! An OBJ file with its MTL file.

use std::fmt::Write as _;

use crate::number::{precise, spaced, spaced_precisely, text};
use crate::surface::Surface;

/// A model: some parts, each of one material. Written as `<name>.obj` and `<name>.mtl`.
pub(crate) struct Model {
    /// The name without an ending.
    pub(crate) name: &'static str,
    /// Description, the first line of the file.
    pub(crate) about: &'static str,
    /// In the order of the file.
    pub(crate) parts: Vec<Part>,
}

/// The part of a model with one material.
pub(crate) struct Part {
    /// Its triangles.
    pub(crate) surface: Surface,
    /// Also the part's name: one material, one part.
    pub(crate) material: Material,
}

/// A material in the terms of MTL. Build it with one of the functions below.
#[derive(Clone)]
pub(crate) struct Material {
    /// Its name in both files.
    pub(crate) name: &'static str,
    /// Kd.
    pub(crate) diffuse: [f64; 3],
    /// Ks.
    pub(crate) specular: [f64; 3],
    /// Ns.
    pub(crate) exponent: f64,
    /// Ke, a radiance.
    pub(crate) emission: [f64; 3],
    /// map_Kd.
    pub(crate) texture: Option<&'static str>,
    /// illum, with its parameters.
    pub(crate) model: Illumination,
}

/// An illumination model of MTL.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Illumination {
    /// illum 1.
    Diffuse,
    /// illum 2: diffuse and a Phong lobe.
    Glossy,
    /// illum 3: diffuse and a mirror.
    DiffuseAndMirror,
    /// illum 5.
    Mirror,
    /// illum 7, with Ni and Tf.
    Glass { index: f64, transmittance: [f64; 3] },
}

const BLACK: [f64; 3] = [0.0; 3];

impl Material {
    /// Diffuse only.
    pub(crate) fn diffuse(name: &'static str, diffuse: [f64; 3]) -> Self {
        Self {
            name,
            diffuse,
            specular: BLACK,
            exponent: 1.0,
            emission: BLACK,
            texture: None,
            model: Illumination::Diffuse,
        }
    }

    /// Diffuse and a Phong lobe.
    pub(crate) fn glossy(name: &'static str, diffuse: [f64; 3], specular: [f64; 3], exponent: f64) -> Self {
        Self { specular, exponent, model: Illumination::Glossy, ..Self::diffuse(name, diffuse) }
    }

    /// A perfect mirror.
    pub(crate) fn mirror(name: &'static str, specular: [f64; 3]) -> Self {
        Self { specular, model: Illumination::Mirror, ..Self::diffuse(name, BLACK) }
    }

    /// Partly diffuse, partly a perfect mirror.
    pub(crate) fn part_mirror(name: &'static str, diffuse: [f64; 3], specular: [f64; 3]) -> Self {
        Self { specular, model: Illumination::DiffuseAndMirror, ..Self::diffuse(name, diffuse) }
    }

    /// Smooth glass; `index` is that of the medium behind the front, relative to the one before it.
    pub(crate) fn glass(name: &'static str, index: f64, transmittance: [f64; 3]) -> Self {
        let model = Illumination::Glass { index, transmittance };
        Self { specular: [1.0; 3], model, ..Self::diffuse(name, BLACK) }
    }

    /// A light that reflects nothing.
    pub(crate) fn lamp(name: &'static str, radiance: [f64; 3]) -> Self {
        Self { emission: radiance, ..Self::diffuse(name, BLACK) }
    }

    /// The same material, emitting as well.
    pub(crate) fn emitting(self, radiance: [f64; 3]) -> Self {
        Self { emission: radiance, ..self }
    }

    /// The same material, with its diffuse colour multiplied by a texture.
    pub(crate) fn textured(self, file: &'static str) -> Self {
        Self { texture: Some(file), ..self }
    }

    /// True if its front emits light.
    pub(crate) fn is_lamp(&self) -> bool {
        self.emission != BLACK
    }

    fn mtl(&self) -> String {
        let mut lines = format!("newmtl {}\nKd {}\n", self.name, spaced(self.diffuse));
        if self.specular != BLACK {
            lines += &format!("Ks {}\n", spaced(self.specular));
        }
        if self.model == Illumination::Glossy {
            lines += &format!("Ns {}\n", precise(self.exponent));
        }
        if self.is_lamp() {
            lines += &format!("Ke {}\n", spaced_precisely(self.emission));
        }
        if let Illumination::Glass { index, transmittance } = self.model {
            lines += &format!("Ni {}\nTf {}\n", text(index), spaced(transmittance));
        }
        let number = match self.model {
            Illumination::Diffuse => 1,
            Illumination::Glossy => 2,
            Illumination::DiffuseAndMirror => 3,
            Illumination::Mirror => 5,
            Illumination::Glass { .. } => 7,
        };
        lines += &format!("illum {number}\n");
        if let Some(file) = self.texture {
            lines += &format!("map_Kd {file}\n");
        }
        lines
    }
}

impl Model {
    /// A model without parts.
    pub(crate) fn new(name: &'static str, about: &'static str) -> Self {
        Self { name, about, parts: Vec::new() }
    }

    /// The same with one more part.
    pub(crate) fn with(mut self, material: Material, surface: Surface) -> Self {
        self.parts.push(Part { surface, material });
        self
    }

    /// Total number of triangles.
    pub(crate) fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.surface.triangles.len()).sum()
    }

    /// The MTL file.
    pub(crate) fn mtl(&self) -> String {
        let materials: Vec<String> = self.parts.iter().map(|part| part.material.mtl()).collect();
        format!("# Materials of {}.obj\n\n{}", self.name, materials.join("\n"))
    }

    /// The OBJ file.
    pub(crate) fn obj(&self) -> String {
        let mut file = format!("# {}\n", self.about);
        line(
            &mut file,
            format_args!("# {} triangles, made by the example make_scenes", self.triangle_count()),
        );
        line(&mut file, format_args!("mtllib {}.mtl", self.name));
        // OBJ counts from 1, over the whole file, and each of its three lists by itself.
        let [mut first_position, mut first_normal, mut first_uv] = [1; 3];
        for Part { surface, material } in &self.parts {
            line(&mut file, format_args!("\no {}\nusemtl {}", material.name, material.name));
            for position in &surface.positions {
                line(&mut file, format_args!("v {}", spaced(position.to_array())));
            }
            for normal in &surface.normals {
                line(&mut file, format_args!("vn {}", spaced(normal.to_array())));
            }
            for uv in &surface.uvs {
                line(&mut file, format_args!("vt {} {}", text(uv.x), text(uv.y)));
            }
            for triangle in &surface.triangles {
                let [a, b, c] = triangle.map(|corner| {
                    let position = first_position + corner;
                    match (surface.uvs.is_empty(), surface.normals.is_empty()) {
                        (true, true) => format!("{position}"),
                        (true, false) => format!("{position}//{}", first_normal + corner),
                        (false, true) => format!("{position}/{}", first_uv + corner),
                        (false, false) => {
                            format!("{position}/{}/{}", first_uv + corner, first_normal + corner)
                        }
                    }
                });
                line(&mut file, format_args!("f {a} {b} {c}"));
            }
            first_position += surface.positions.len();
            first_normal += surface.normals.len();
            first_uv += surface.uvs.len();
        }
        file
    }
}

fn line(file: &mut String, content: std::fmt::Arguments<'_>) {
    writeln!(file, "{content}").expect("a string takes everything");
}
