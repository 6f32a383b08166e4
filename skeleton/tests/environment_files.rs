//! The key `environment` of scene files, and the maps that it names.

#![cfg(feature = "files")]

use std::path::PathBuf;

use arty::diagnostic::Diagnostic;
use arty::image::Image;
use arty::image::exr::{ExrFile, Precision};
use arty::math::{Rgb, Vec3};
use arty::scene::file::load;
use arty::scene::{EnvironmentDescription, Scene, SceneDescription};

const CAMERA: &str =
    "camera: !perspective_camera { eye: [0, 1, 4], center: [0, 1, 0], up: [0, 1, 0], fov: 40 }\n";

/// A folder with maps and a scene file.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes an OpenEXR map.
    fn map(&self, name: &str, width: usize, texels: Vec<Rgb>) {
        let image = Image::from_pixels(width, texels.len() / width, texels);
        ExrFile::new(&image).write(&self.path(name), Precision::Full).expect("a map");
    }

    /// Loads a scene with this environment.
    fn load(&self, environment: &str) -> Result<SceneDescription, Diagnostic> {
        let scene = self.path("scene.yml");
        std::fs::write(&scene, format!("meshes: []\n{CAMERA}environment: {environment}\n")).expect("a file");
        load(&scene).map(|loaded| loaded.description)
    }

    fn environment(&self, text: &str) -> EnvironmentDescription {
        let description = self.load(text).unwrap_or_else(|error| panic!("{error}"));
        description.environment.expect("it has one")
    }

    fn refused(&self, text: &str) -> String {
        self.load(text).expect_err(text).to_string()
    }
}

fn texels() -> Vec<Rgb> {
    (0..6).map(|index| Rgb::new(index as f32, 0.5, 1e-30)).collect()
}

#[test]
fn an_openexr_map_loads_texel_by_texel() {
    let folder = Folder::new();
    folder.map("sky.exr", 3, texels());
    let map = folder.environment("{ file: sky.exr }");
    assert_eq!((map.width, map.height, &map.texels), (3, 2, &texels()));
    assert_eq!(map.rotation.to_array(), [0.0, 0.0, 0.0, 1.0]);
    let map = folder.environment("{ file: sky.exr, scale: 0.5, rotate: { axis: [0, 2, 0], degrees: 90 } }");
    assert_eq!(map.texels[4], 0.5 * texels()[4]);
    let turned = map.rotation * Vec3::NEG_Z;
    assert!((turned - Vec3::NEG_X).length() < 1e-6, "counter-clockwise seen from above: {turned}");
}

#[test]
fn the_radiance_of_a_scene_is_that_of_its_map() {
    let folder = Folder::new();
    folder.map("sky.exr", 3, texels());
    let scene = Scene::new(&folder.load("{ file: sky.exr }").expect("a scene"));
    let environment = scene.environment().expect("it has one");
    assert_eq!((environment.width(), environment.height()), (3, 2));
    assert_eq!(environment.radiance(Vec3::new(0.0, 0.6, -0.8)), texels()[1], "ahead and up: upper middle");
    assert_eq!(environment.radiance(Vec3::new(0.8, -0.6, 0.0)), texels()[5], "right and down: lower right");
    assert!(scene.features().environment && !scene.features().has_lights());
    assert!(scene.features().to_string().contains("environment        yes"));
}

#[test]
fn a_radiance_hdr_map_loads() {
    let folder = Folder::new();
    // Two pixels: red, green, blue with a common exponent, (128/256, 64/256, 0) · 2^(130 − 128) and black.
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
    bytes.extend([128, 64, 0, 130, 0, 0, 0, 0]);
    std::fs::write(folder.path("sky.hdr"), &bytes).expect("a map");
    let map = folder.environment("{ file: sky.hdr }");
    assert_eq!((map.width, map.height, map.texels), (2, 1, vec![Rgb::new(2.0, 1.0, 0.0), Rgb::BLACK]));
    std::fs::write(folder.path("sky.hdr"), &bytes[..bytes.len() - 3]).expect("a cut map");
    assert!(folder.refused("{ file: sky.hdr }").contains("cannot be read"));
}

#[test]
fn a_constant_is_a_map_of_one_texel() {
    let map = Folder::new().environment("{ color: [1, 2, 3] }");
    assert_eq!((map.width, map.height, map.texels), (1, 1, vec![Rgb::new(1.0, 2.0, 3.0)]));
}

#[test]
fn a_scene_without_an_environment_has_the_hash_of_its_other_parts() {
    let folder = Folder::new();
    let plain =
        SceneDescription { environment: None, ..folder.load("{ color: [1, 1, 1] }").expect("a scene") };
    // The hash before scenes could have an environment: references of such scenes stay valid.
    assert_eq!(plain.hash(), "b7de174bdc097d73aad3bc2dc3e2540f77e20084b5d666e49cadb90ffc30cb40");
    let hashes = ["{ color: [1, 1, 1] }", "{ color: [1, 1, 2] }"]
        .map(|text| folder.load(text).expect("a scene").hash());
    assert!(hashes[0] != hashes[1] && !hashes.contains(&plain.hash()), "{hashes:?}");
}

#[test]
fn what_is_no_environment_is_refused_with_the_reason() {
    let folder = Folder::new();
    folder.map("negative.exr", 2, vec![Rgb::WHITE, Rgb::new(1.0, -1e-3, 1.0)]);
    folder.map("nan.exr", 1, vec![Rgb::WHITE, Rgb::new(f32::NAN, 1.0, 1.0)]);
    folder.map("bright.exr", 1, vec![Rgb::gray(1e38)]);
    folder.map("sky.exr", 3, texels());
    std::fs::write(folder.path("text.exr"), "sky").expect("a file");
    std::fs::write(folder.path("empty.hdr"), "").expect("a file");
    let gray =
        ExrFile { width: 1, height: 1, channels: [("Y".to_owned(), vec![1.0])].into(), ..ExrFile::default() };
    gray.write(&folder.path("gray.exr"), Precision::Full).expect("a map");
    for (text, words) in [
        ("{ file: negative.exr }", ["negative.exr:", "column 1 and row 0", "scene.yml:3"]),
        ("{ file: nan.exr }", ["column 0 and row 1", "NaN", "finite"]),
        ("{ file: bright.exr, scale: 10 }", ["column 0 and row 0", "scale 10", "finite"]),
        ("{ file: missing.exr }", ["missing.exr:", "no such file", "scene.yml:3"]),
        ("{ file: text.exr }", ["text.exr:", "neither an OpenEXR nor a Radiance HDR image", "scene.yml:3"]),
        ("{ file: empty.hdr }", ["empty.hdr:", "neither an OpenEXR nor a Radiance HDR image", "scene.yml:3"]),
        ("{ file: gray.exr }", ["gray.exr:", "no channels R, G and B", "scene.yml:3"]),
        ("{ file: sky.exr, scale: -1 }", ["scene.yml:3:", "`scale` is -1", "negative"]),
        ("{ file: sky.exr, rotate: { axis: [0, 0, 0], degrees: 1 } }", ["scene.yml:3:", "axis", "zero"]),
        ("{ file: sky.exr, color: [1, 1, 1] }", ["scene.yml:3:", "`file` and a `color`", "one of them"]),
        ("{ color: [1, 1, 1], scale: 2 }", ["scene.yml:3:", "`scale`", "`color`"]),
        ("{ }", ["scene.yml:3:", "neither a `file` nor a `color`", ""]),
        ("{ fiel: sky.exr }", ["scene.yml:3:", "`fiel`", "`file`"]),
        ("{ color: [1, -1, 1] }", ["scene.yml:3:", "environment.color", "non-negative"]),
        ("sky.exr", ["scene.yml:3:", "`color`", "`file`"]),
    ] {
        let error = folder.refused(text);
        for word in words {
            assert!(error.contains(word), "{text}, without `{word}`: {error}");
        }
    }
}
