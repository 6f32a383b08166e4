//! Saving pictures: PNG as shown, OpenEXR with linear data.

use arty::cli::Algorithm;
use arty::film::Pixel;
use arty::image::exr::{ExrFile, Precision};
use arty::image::write_png;
use arty::scene::SceneDescription;

use crate::look::{Look, ToneMap};
use crate::orders::Save;
use crate::part::{Part, image};
use crate::renderer::Setup;
use crate::view::{View, name};

/// Saves each part as `<stem>-<technique>.png` and `.exr`. Returns the names of the files, for a message.
///
/// # Errors
///
/// Why a file cannot be written, or that there is nothing to save yet.
pub(crate) fn save(order: &Save, setup: &Setup, view: &View, parts: &[Part]) -> Result<String, String> {
    let mut names = Vec::new();
    for part in parts {
        if part.progress().samples == 0 {
            return Err("nothing to save yet: no pixel has all of its first sample".to_owned());
        }
        let mut path = order.stem.clone().into_os_string();
        path.push(format!("-{}.png", name(part.algorithm)));
        let path = std::path::PathBuf::from(path);
        let mean = image(part.film(), Pixel::mean);
        let Look { exposure, tone_map } = order.look;
        let written = match tone_map {
            ToneMap::Clamp => write_png(&path, &mean, exposure),
            ToneMap::Reinhard => {
                let shown = image(part.film(), |pixel| order.look.apply(pixel.mean()));
                write_png(&path, &shown, 0.0)
            }
        };
        written.map_err(|error| error.to_string())?;
        let linear = path.with_extension("exr");
        exr(setup, view, part).write(&linear, Precision::Full).map_err(|error| error.to_string())?;
        names.extend([path, linear].map(|path| path.display().to_string()));
    }
    Ok(names.join(", "))
}

/// The mean, its variance, and how they were rendered.
fn exr(setup: &Setup, view: &View, part: &Part) -> ExrFile {
    let film = part.film();
    let mut file = ExrFile::new(&image(film, Pixel::mean));
    if film.samples() > 1 {
        file = file.with_layer("variance", &image(film, Pixel::variance_of_mean));
    }
    let scene = SceneDescription { camera: view.camera, ..(*setup.description).clone() };
    file = file
        .with_metadata("arty:scene_hash", scene.hash())
        .with_metadata("arty:seed", setup.seed.to_string())
        .with_metadata("arty:samples_per_pixel", film.samples().to_string())
        .with_metadata("arty:render_seconds", format!("{:.6}", part.time().as_secs_f64()));
    match part.algorithm {
        Algorithm::Debug(_) => file.with_metadata("arty:show", name(part.algorithm)),
        Algorithm::PathTracer(settings) => file
            .with_metadata("arty:technique", settings.technique.to_string())
            .with_metadata("arty:max_bounces", settings.max_bounces.to_string()),
    }
}
