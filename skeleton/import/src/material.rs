//! From metallic-roughness materials to those of MTL files.

use std::collections::HashMap;

use arty::diagnostic::Diagnostic;
use gltf::material::AlphaMode;
use gltf::texture::WrappingMode;

use crate::document::{Document, named};
use crate::left_out::LeftOut;

/// Transmission above which a material becomes glass: there is nothing in between.
const GLASS: f32 = 0.5;

/// Roughness below which a metal becomes a mirror. The Phong lobe would have an exponent of some millions.
const MIRROR: f32 = 0.03;

/// Index of refraction of glass that does not say it, as in the specification of glTF.
const INDEX_OF_REFRACTION: f32 = 1.5;

/// A material of an MTL file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Material {
    /// Without white space; unique.
    pub(crate) name: String,
    pub(crate) lobes: Lobes,
    /// Radiance emitted from the front.
    pub(crate) emission: [f32; 3],
    /// File name of the diffuse texture, and the set of texture coordinates that it uses.
    pub(crate) texture: Option<(String, u32)>,
}

/// How a material scatters light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Lobes {
    /// Diffuse and Phong lobe.
    Opaque { diffuse: [f32; 3], specular: [f32; 3], exponent: f32 },
    /// Diffuse and mirror.
    Mirror { diffuse: [f32; 3], specular: [f32; 3] },
    /// Smooth glass.
    Glass { index: f32, transmittance: [f32; 3] },
}

/// The materials and images converted so far.
#[derive(Default)]
pub(crate) struct Materials {
    /// In the order in which they were met.
    pub(crate) all: Vec<Material>,
    by_index: HashMap<Option<usize>, usize>,
    /// Names and contents of the textures.
    pub(crate) images: Vec<(String, Vec<u8>)>,
    images_by_index: HashMap<usize, Option<String>>,
}

impl Materials {
    /// The index of a material, which is converted the first time. Textures are named after `stem`.
    pub(crate) fn index(
        &mut self,
        document: &Document,
        material: &gltf::Material<'_>,
        stem: &str,
        left_out: &mut LeftOut,
    ) -> Result<usize, Diagnostic> {
        if let Some(&index) = self.by_index.get(&material.index()) {
            return Ok(index);
        }
        let converted = self.convert(document, material, stem, left_out)?;
        self.all.push(converted);
        self.by_index.insert(material.index(), self.all.len() - 1);
        Ok(self.all.len() - 1)
    }

    fn convert(
        &mut self,
        document: &Document,
        material: &gltf::Material<'_>,
        stem: &str,
        left_out: &mut LeftOut,
    ) -> Result<Material, Diagnostic> {
        let item = match material.index() {
            Some(index) => named("material", material.name(), index),
            None => "the default material".to_owned(),
        };
        list_what_has_no_counterpart(material, &item, left_out);
        let lobes = lobes(material, &item, left_out);
        let texture = match material.pbr_metallic_roughness().base_color_texture() {
            None => None,
            Some(info) if matches!(&lobes, Lobes::Opaque { diffuse, .. } if *diffuse != [0.0; 3]) => {
                let texture = info.texture();
                let sampler = texture.sampler();
                let repeats = |mode| mode == WrappingMode::Repeat;
                left_out.add_if(!repeats(sampler.wrap_s()) || !repeats(sampler.wrap_t()), || {
                    format!("{item}: its texture is repeated, not clamped or mirrored")
                });
                left_out.add_if(info.texture_transform().is_some(), || {
                    format!("{item}: the transform of its texture")
                });
                let image = self.image(document, &texture.source(), stem, left_out)?;
                image.map(|name| (name, info.tex_coord()))
            }
            Some(_) => {
                left_out.add(format!("{item}: its base color texture, since it is a metal or glass"));
                None
            }
        };
        let emission = emission(material, &item, left_out);
        for (value, what) in [(&emission, "emission"), (&color_of(&lobes), "base color")] {
            if value.iter().any(|channel| !channel.is_finite() || *channel < 0.0) {
                return Err(document.error(&item, format!("its {what} {value:?} is not a color")));
            }
        }
        let name = self.unique(material.name().unwrap_or("material"));
        Ok(Material { name, lobes, emission, texture })
    }

    /// The file of an image; `None` if it is neither PNG nor JPEG.
    fn image(
        &mut self,
        document: &Document,
        image: &gltf::Image<'_>,
        stem: &str,
        left_out: &mut LeftOut,
    ) -> Result<Option<String>, Diagnostic> {
        if let Some(name) = self.images_by_index.get(&image.index()) {
            return Ok(name.clone());
        }
        let bytes = document.image(image)?;
        let extension = match bytes.as_slice() {
            [0x89, b'P', b'N', b'G', ..] => Some("png"),
            [0xff, 0xd8, 0xff, ..] => Some("jpg"),
            _ => None,
        };
        let item = named("image", image.name(), image.index());
        left_out.add_if(extension.is_none(), || format!("{item}: it is neither PNG nor JPEG"));
        let name = extension.map(|extension| format!("{stem}_{}.{extension}", image.index()));
        self.images.extend(name.clone().map(|name| (name, bytes)));
        self.images_by_index.insert(image.index(), name.clone());
        Ok(name)
    }

    /// A name for MTL files that no other material has.
    fn unique(&self, name: &str) -> String {
        let is_plain = |letter: char| letter.is_alphanumeric() || "_-.".contains(letter);
        let plain: String = name.chars().map(|letter| if is_plain(letter) { letter } else { '_' }).collect();
        let is_taken = |name: &str| self.all.iter().any(|other| other.name == name);
        if !plain.is_empty() && !is_taken(&plain) {
            return plain;
        }
        let numbered = |number: usize| format!("{plain}_{number}");
        (2..).map(numbered).find(|name| !is_taken(name)).unwrap_or(plain)
    }
}

fn list_what_has_no_counterpart(material: &gltf::Material<'_>, item: &str, left_out: &mut LeftOut) {
    let pbr = material.pbr_metallic_roughness();
    let transmission_texture = material.transmission().is_some_and(|it| it.transmission_texture().is_some());
    for (is_there, what) in [
        (material.normal_texture().is_some(), "its normal map"),
        (material.occlusion_texture().is_some(), "its occlusion map"),
        (material.emissive_texture().is_some(), "its emission, which comes from a texture"),
        (pbr.metallic_roughness_texture().is_some(), "its metallic-roughness map: it becomes diffuse"),
        (transmission_texture, "its transmission map"),
        (material.alpha_mode() == AlphaMode::Blend, "its transparency (alpha blend)"),
        (material.alpha_mode() == AlphaMode::Mask, "its transparency (alpha mask)"),
    ] {
        left_out.add_if(is_there, || format!("{item}: {what}"));
    }
}

fn lobes(material: &gltf::Material<'_>, item: &str, left_out: &mut LeftOut) -> Lobes {
    let pbr = material.pbr_metallic_roughness();
    let [red, green, blue, _] = pbr.base_color_factor();
    let base = [red, green, blue];
    let transmission = material.transmission().map_or(0.0, |it| it.transmission_factor());
    let is_mapped = pbr.metallic_roughness_texture().is_some();
    let metallic = if is_mapped { 0.0 } else { pbr.metallic_factor().clamp(0.0, 1.0) };
    let roughness = pbr.roughness_factor().clamp(0.0, 1.0);
    if transmission > GLASS {
        left_out.add_if(transmission < 1.0 || (roughness > MIRROR && !is_mapped), || {
            format!("{item}: it becomes smooth glass; its roughness and what it does not transmit")
        });
        let index = material.ior().filter(|index| *index >= 1.0).unwrap_or(INDEX_OF_REFRACTION);
        return Lobes::Glass { index, transmittance: base };
    }
    left_out.add_if(transmission > 0.0, || format!("{item}: its transmission of {transmission}"));
    left_out.add_if(metallic < 1.0, || {
        "the specular reflection of materials that are not metals: they become diffuse".to_owned()
    });
    let diffuse = base.map(|channel| channel * (1.0 - metallic));
    let specular = base.map(|channel| channel * metallic);
    if metallic > 0.0 && roughness < MIRROR {
        return Lobes::Mirror { diffuse, specular };
    }
    // GGX with α = roughness² has about the width of a Blinn-Phong lobe of exponent 2/α² − 2, and the lobe around the
    // mirrored direction has a quarter of that.
    let exponent = (0.25 * (2.0 / roughness.max(MIRROR).powi(4) - 2.0)).max(1.0);
    left_out.add_if(metallic > 0.0, || {
        format!("{item}: its rough reflection becomes a Phong lobe with the exponent {exponent:.0}")
    });
    Lobes::Opaque { diffuse, specular, exponent }
}

fn emission(material: &gltf::Material<'_>, item: &str, left_out: &mut LeftOut) -> [f32; 3] {
    if material.emissive_texture().is_some() {
        return [0.0; 3];
    }
    let strength = material.emissive_strength().unwrap_or(1.0);
    let emission = material.emissive_factor().map(|channel| channel * strength);
    left_out.add_if(emission != [0.0; 3] && material.double_sided(), || {
        format!("{item}: the emission of its back")
    });
    emission
}

fn color_of(lobes: &Lobes) -> [f32; 3] {
    match lobes {
        Lobes::Opaque { diffuse, specular, .. } | Lobes::Mirror { diffuse, specular } => {
            std::array::from_fn(|channel| diffuse[channel] + specular[channel])
        }
        Lobes::Glass { transmittance, .. } => *transmittance,
    }
}
