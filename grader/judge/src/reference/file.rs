//! References as EXR files.
//!
//! The main image is the mean at the largest number of bounces, so that any viewer shows the scene. All other data is
//! in layers: `bounces1.mean`, `bounces1.variance` (of the mean), `bounces1.nee.deviation`, `bounces1.nee.skewness`,
//! and `bounces1.emission-off.mean` etc. for views with `emission_on_hit: off`.

use std::collections::BTreeMap;
use std::path::Path;

use arty::image::Image;
use arty::image::exr::{ExrFile, Precision};
use arty::integrator::Technique;
use arty::math::Rgb;
use arty::scene::SceneDescription;

use super::{Moments, Reference, ReferenceView, SIZE};
use verdict::error::{Error, Result};
use verdict::rubric::{EmissionOnHit, View};

const SCENE_HASH: &str = "arty:scene_hash";
const PROVENANCE: &str = "arty:";
const EMISSION_OFF: &str = ".emission-off";

/// Writes a reference. Equal references give equal bytes.
///
/// # Errors
/// If it has no view, or the file cannot be written.
pub fn save(reference: &Reference, path: &Path) -> Result<()> {
    let Some(last) = reference.views.values().next_back() else {
        return Err(Error::Harness(format!("{}: the reference has no view", path.display())));
    };
    let mut file = ExrFile::new(&to_image(&last.mean)).with_metadata(SCENE_HASH, &reference.scene_hash);
    for (key, value) in &reference.provenance {
        file = file.with_metadata(format!("{PROVENANCE}{key}"), value);
    }
    for (view, images) in &reference.views {
        let name = |rest: &str| format!("{}.{rest}", layer_name(view));
        file = file.with_layer(&name("mean"), &to_image(&images.mean));
        file = file.with_layer(&name("variance"), &to_image(&images.variance_of_mean));
        for (technique, moments) in &images.techniques {
            file = file.with_layer(&name(&format!("{technique}.deviation")), &to_image(&moments.deviation));
            file = file.with_layer(&name(&format!("{technique}.skewness")), &to_image(&moments.skewness));
        }
    }
    file.write(path, Precision::Full).map_err(|error| Error::Output(error.to_string()))
}

/// Reads the reference of a scene.
///
/// # Errors
/// If it does not exist, shows another version of the scene, or holds invalid data.
pub fn load(path: &Path, scene: &str, description: &SceneDescription) -> Result<Reference> {
    let renew = format!("create it with `cargo lab reference {scene}`");
    if !path.is_file() {
        return Err(Error::file(path, format!("there is no reference for the scene `{scene}`; {renew}")));
    }
    let file = ExrFile::read(path)?;
    let scene_hash = file.metadata.get(SCENE_HASH).cloned().unwrap_or_default();
    if scene_hash != description.hash() {
        return Err(Error::file(path, format!("stale: the scene `{scene}` has changed since; {renew}")));
    }
    if (file.width, file.height) != (SIZE.0 as usize, SIZE.1 as usize) {
        let (width, height) = SIZE;
        return Err(Error::file(path, format!("the image is not {width} × {height} pixels; {renew}")));
    }
    let layer = |name: &str| file.layer(name).map(|image| from_image(&image));
    let broken = || Error::file(path, format!("a layer is missing or holds invalid numbers; {renew}"));
    let mut views = BTreeMap::new();
    for view in file.channels.keys().filter_map(|channel| view_of(channel)) {
        let name = |rest: &str| format!("{}.{rest}", layer_name(&view));
        let mut images = ReferenceView {
            mean: layer(&name("mean")).ok_or_else(broken)?,
            variance_of_mean: layer(&name("variance")).ok_or_else(broken)?,
            techniques: BTreeMap::new(),
        };
        for technique in Technique::ALL.map(Technique::name) {
            let deviation = layer(&name(&format!("{technique}.deviation")));
            let skewness = layer(&name(&format!("{technique}.skewness")));
            if let (Some(deviation), Some(skewness)) = (deviation, skewness) {
                images.techniques.insert(technique, Moments { deviation, skewness });
            }
        }
        if !is_sound(&images) {
            return Err(broken());
        }
        views.insert(view, images);
    }
    let provenance = file
        .metadata
        .iter()
        .filter_map(|(key, value)| Some((key.strip_prefix(PROVENANCE)?.to_owned(), value.clone())))
        .filter(|(key, _)| key != "scene_hash")
        .collect();
    Ok(Reference { scene_hash, views, provenance })
}

/// Name of the layers of a view: `bounces8`, or `bounces8.emission-off`.
pub(super) fn layer_name(view: &View) -> String {
    let emission = if view.emission_on_hit == EmissionOnHit::Off { EMISSION_OFF } else { "" };
    format!("bounces{}{emission}", view.max_bounces)
}

/// The view of a channel named `bounces8.mean.R` or `bounces8.emission-off.mean.R`; `None` for other channels.
fn view_of(channel: &str) -> Option<View> {
    let name = channel.strip_prefix("bounces")?.strip_suffix(".mean.R")?;
    let (bounces, emission_on_hit) = match name.strip_suffix(EMISSION_OFF) {
        Some(bounces) => (bounces, EmissionOnHit::Off),
        None => (name, EmissionOnHit::On),
    };
    Some(View { max_bounces: bounces.parse().ok()?, emission_on_hit })
}

fn is_sound(images: &ReferenceView) -> bool {
    let values = |list: &[[f64; 3]], sound: fn(f64) -> bool| list.iter().flatten().all(|&value| sound(value));
    let not_negative = |value: f64| value.is_finite() && value >= 0.0;
    values(&images.mean, not_negative)
        && values(&images.variance_of_mean, not_negative)
        && images.techniques.values().all(|moments| {
            values(&moments.deviation, not_negative) && values(&moments.skewness, f64::is_finite)
        })
}

fn to_image(values: &[[f64; 3]]) -> Image {
    let pixels = values.iter().map(|value| Rgb::from(value.map(|channel| channel as f32))).collect();
    Image::from_pixels(SIZE.0 as usize, SIZE.1 as usize, pixels)
}

fn from_image(image: &Image) -> Vec<[f64; 3]> {
    image.pixels().iter().map(|pixel| pixel.to_array().map(f64::from)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;

    fn scene(fov: f32) -> SceneDescription {
        let mut scene = scenes::empty();
        scene.camera.fov = fov;
        scene
    }

    fn reference() -> Reference {
        let pixels = |value: f64| (0..256).map(|i| [value, f64::from(i), 0.5]).collect::<Vec<_>>();
        let techniques =
            BTreeMap::from([("nee", Moments { deviation: pixels(2.0), skewness: pixels(-1.0) })]);
        let images = |value| ReferenceView {
            mean: pixels(value),
            variance_of_mean: pixels(0.25),
            techniques: techniques.clone(),
        };
        Reference {
            scene_hash: scene(40.0).hash(),
            views: BTreeMap::from([
                (View { max_bounces: 1, emission_on_hit: EmissionOnHit::On }, images(1.0)),
                (View { max_bounces: 8, emission_on_hit: EmissionOnHit::Off }, images(4.0)),
                (View { max_bounces: 8, emission_on_hit: EmissionOnHit::On }, images(8.0)),
            ]),
            provenance: [("seed", "7"), ("batches", "64"), ("bounces1.technique", "mis")]
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .into(),
        }
    }

    #[test]
    fn a_reference_round_trips() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("box.exr");
        save(&reference(), &path).expect("it can be saved");
        assert_eq!(load(&path, "box", &scene(40.0)).expect("it can be loaded"), reference());
    }

    #[test]
    fn equal_references_have_equal_bytes() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let bytes = |name: &str| {
            let path = folder.path().join(name);
            save(&reference(), &path).expect("it can be saved");
            std::fs::read(path).expect("it can be read")
        };
        assert_eq!(bytes("a.exr"), bytes("b.exr"));
    }

    #[test]
    fn a_reference_of_another_scene_is_refused_with_the_command_that_renews_it() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("box.exr");
        let message =
            |scene: SceneDescription| load(&path, "box", &scene).expect_err("it is refused").to_string();
        assert!(message(scene(40.0)).contains("cargo lab reference box"), "there is none");
        save(&reference(), &path).expect("it can be saved");
        let stale = message(scene(41.0));
        assert!(stale.contains("stale") && stale.contains("cargo lab reference box"), "{stale}");
    }
}
