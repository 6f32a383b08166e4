//! From MTL definitions to energy-conserving materials.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::mtl::{self, Definition, Definitions};
use super::text;
use super::texture::Textures;
use super::warnings::Warnings;
use crate::diagnostic::Diagnostic;
use crate::input::Reference;
use crate::math::Rgb;
use crate::scene::{Material, Specular, Texture};
use crate::srgb::srgb_to_linear_u8;

/// Tolerance for sums of reflectances above 1: decimals in a file are rounded.
const TOLERANCE: f32 = 1e-5;

/// The materials and textures read so far, and their files.
#[derive(Default)]
pub(super) struct Materials {
    materials: Vec<Material>,
    textures: Textures,
    libraries: HashMap<PathBuf, Definitions>,
    indices: HashMap<(PathBuf, String), u32>,
    default: Option<u32>,
}

impl Materials {
    /// Reads an MTL file, unless it has been read before.
    pub(super) fn read_library(
        &mut self,
        file: &Path,
        named: &Reference,
        warnings: &mut Warnings,
    ) -> Result<(), Diagnostic> {
        if !self.libraries.contains_key(file) {
            self.libraries.insert(file.to_owned(), mtl::read(file, named, warnings)?);
        }
        Ok(())
    }

    /// The index of the material `name`, from the last of `libraries` that defines it; `None` if none does.
    pub(super) fn find(
        &mut self,
        libraries: &[PathBuf],
        name: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<u32>, Diagnostic> {
        let definition =
            |library: &'_ PathBuf| Some((library.clone(), self.libraries.get(library)?.get(name)?.clone()));
        let Some((library, definition)) = libraries.iter().rev().find_map(definition) else {
            return Ok(None);
        };
        let key = (library, name.to_owned());
        if let Some(&index) = self.indices.get(&key) {
            return Ok(Some(index));
        }
        let material = self.material(&key.0, name, &definition, warnings)?;
        let index = push(&mut self.materials, material);
        self.indices.insert(key, index);
        Ok(Some(index))
    }

    /// The index of the material for faces without one.
    pub(super) fn default_material(&mut self) -> u32 {
        let material = Material {
            name: "default".into(),
            diffuse: Rgb::gray(0.5),
            diffuse_map: None,
            specular: Specular::None,
            emission: Rgb::BLACK,
        };
        let materials = &mut self.materials;
        *self.default.get_or_insert_with(|| push(materials, material))
    }

    /// All materials and textures.
    pub(super) fn into_parts(self) -> (Vec<Material>, Vec<Texture>) {
        (self.materials, self.textures.into_vec())
    }

    fn material(
        &mut self,
        file: &Path,
        name: &str,
        definition: &Definition,
        warnings: &mut Warnings,
    ) -> Result<Material, Diagnostic> {
        let mut warn = |message: String| {
            warnings.add(Diagnostic::at(file, definition.line, format!("material `{name}`: {message}")));
        };
        let emission = definition.ke.unwrap_or(Rgb::BLACK);
        let smooth = |specular| Material {
            name: name.to_owned(),
            diffuse: Rgb::BLACK,
            diffuse_map: None,
            specular,
            emission,
        };
        match definition.illum {
            Some(5) => {
                let reflectance = at_most_one(definition.ks.unwrap_or(Rgb::WHITE), "Ks", &mut warn);
                Ok(smooth(Specular::Mirror { reflectance }))
            }
            Some(4 | 6 | 7 | 9) => {
                let index = index_of_refraction(definition, file, &mut warn)?;
                let reflectance = at_most_one(definition.ks.unwrap_or(Rgb::WHITE), "Ks", &mut warn);
                let transmittance = at_most_one(definition.tf.unwrap_or(Rgb::WHITE), "Tf", &mut warn);
                Ok(smooth(Specular::Glass { index, reflectance, transmittance }))
            }
            _ => {
                let diffuse_map = match &definition.map_kd {
                    Some((line, image)) => {
                        let named = Reference { file: file.to_owned(), line: Some(*line) };
                        Some(self.textures.index(&text::relative_to(file, image), &named)?)
                    }
                    None => None,
                };
                let brightest = diffuse_map.map_or(Rgb::WHITE, |map| brightest_texel(self.textures.get(map)));
                let unset = if diffuse_map.is_some() { Rgb::WHITE } else { Rgb::BLACK };
                let (diffuse, ks) = conserve_energy(
                    definition.kd.unwrap_or(unset),
                    brightest,
                    definition.ks.unwrap_or(Rgb::BLACK),
                    &mut warn,
                );
                let specular = match definition.illum {
                    _ if ks.is_black() => Specular::None,
                    Some(3) => Specular::Mirror { reflectance: ks },
                    _ => Specular::Phong { reflectance: ks, exponent: phong_exponent(definition, &mut warn) },
                };
                Ok(Material { name: name.to_owned(), diffuse, diffuse_map, specular, emission })
            }
        }
    }
}

/// Adds a material and returns its index, which fits into 32 bits because of the limits on file sizes.
fn push(materials: &mut Vec<Material>, material: Material) -> u32 {
    materials.push(material);
    (materials.len() - 1) as u32
}

fn index_of_refraction(
    definition: &Definition,
    file: &Path,
    warn: &mut impl FnMut(String),
) -> Result<f32, Diagnostic> {
    match definition.ni {
        Some((line, 0.0)) => Err(Diagnostic::at(file, line, "`Ni` of glass must be greater than 0")),
        Some((_, index)) => Ok(index),
        None => {
            warn("`Ni` is missing for glass; using 1.5".into());
            Ok(1.5)
        }
    }
}

fn phong_exponent(definition: &Definition, warn: &mut impl FnMut(String)) -> f32 {
    definition.ns.unwrap_or_else(|| {
        warn("`Ns` is missing; using the exponent 1".into());
        1.0
    })
}

/// Limits each channel to 1.
fn at_most_one(factor: Rgb, keyword: &str, warn: &mut impl FnMut(String)) -> Rgb {
    if factor.max_channel() > 1.0 {
        warn(format!("`{keyword}` is greater than 1, which violates energy conservation; limited to 1"));
    }
    factor.map(|channel| channel.min(1.0))
}

/// Scales `Kd` and `Ks` by a common factor if they reflect more light than they receive at the brightest texel. The same
/// factor for all channels keeps the hue.
fn conserve_energy(kd: Rgb, brightest: Rgb, ks: Rgb, warn: &mut impl FnMut(String)) -> (Rgb, Rgb) {
    let max = (kd * brightest + ks).max_channel();
    if max <= 1.0 + TOLERANCE {
        return (kd, ks);
    }
    warn(format!("`Kd` + `Ks` is {max}, which violates energy conservation; both are divided by it"));
    (kd / max, ks / max)
}

/// The maximum of each channel, as a linear value.
fn brightest_texel(texture: &Texture) -> Rgb {
    let largest = texture.texels.iter().fold([0; 3], |largest: [u8; 3], texel| {
        [0, 1, 2].map(|channel| largest[channel].max(texel[channel]))
    });
    Rgb::from(largest.map(srgb_to_linear_u8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_conserved_at_the_brightest_texel() {
        let mut warnings = Vec::new();
        let mut warn = |message| warnings.push(message);
        let half = Rgb::gray(0.5);
        assert_eq!(conserve_energy(Rgb::WHITE, half, half, &mut warn), (Rgb::WHITE, half));
        let (kd, ks) = conserve_energy(Rgb::gray(0.9), Rgb::WHITE, Rgb::new(0.3, 0.1, 0.0), &mut warn);
        assert!(((kd + ks).max_channel() - 1.0).abs() < 1e-6);
        assert!((ks.r / ks.g - 3.0).abs() < 1e-6);
        // A sum that exceeds 1 by rounding only is not corrected.
        conserve_energy(Rgb::gray(0.7), Rgb::WHITE, Rgb::gray(0.300_001), &mut warn);
        assert_eq!(warnings.len(), 1);
    }
}
