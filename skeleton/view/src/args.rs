//! Command-line arguments of the window.

use std::path::PathBuf;

use arty::camera::CameraDescription;
use arty::integrator::Technique;
use arty::math::Vec3;
use clap::{Parser, value_parser};

/// Shows a scene in a window and refines the picture. The key `?` shows all keys.
///
/// The picture is the one that `arty` renders with the same options and number of samples.
#[derive(Clone, Debug, PartialEq, Parser)]
#[command(name = "arty --view", version, max_term_width = 100)]
pub struct Args {
    /// The scene file (YAML), or the name of a scene in scenes/
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,

    /// Estimator of the path tracer
    #[arg(long, value_enum, default_value_t = Technique::Mis)]
    pub technique: Technique,

    /// Maximum number of bounces: 0 = emission only, 1 = direct light [default: the scene's, else 8]
    #[arg(long, value_name = "N")]
    pub max_bounces: Option<u32>,

    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,

    /// Width in pixels [default: proportional to --height, else the scene's, else 512]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SIDE))]
    pub width: Option<u32>,

    /// Height in pixels [default: proportional to --width, else the scene's, else 412]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SIDE))]
    pub height: Option<u32>,

    /// Stop refining at this number of samples per pixel [default: never]
    #[arg(short, long, value_name = "N", value_parser = value_parser!(u64).range(1..))]
    pub samples: Option<u64>,

    /// Exposure in stops; may be negative
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = exposure)]
    pub exposure: f32,

    /// Show the error against this OpenEXR reference in the title, and let the wipe compare with it
    #[arg(long, value_name = "REF.exr")]
    pub reference: Option<PathBuf>,

    /// Compile the algorithm again whenever its file is saved, and go on with the same camera and window
    #[arg(long)]
    pub watch: bool,

    /// Show the paths of this pixel: column and row from the upper left
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<(u32, u32)>,

    /// With --pixel: show the path of this sample first
    #[arg(long, value_name = "N", default_value_t = 0, requires = "pixel")]
    pub sample: u64,

    /// Number of threads [default: one per processor]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// Where the camera is after a reload: eye, centre, up and field of view.
    #[arg(long, hide = true, value_parser = camera, allow_hyphen_values = true)]
    pub camera: Option<CameraDescription>,

    /// Where the window is after a reload: left edge, upper edge, width and height.
    #[arg(long, hide = true, value_parser = place, allow_hyphen_values = true)]
    pub place: Option<Place>,
}

/// Where a window is on the screen, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Left edge.
    pub left: i32,
    /// Upper edge.
    pub top: i32,
    /// Width of what is inside.
    pub width: u32,
    /// Height of what is inside.
    pub height: u32,
}

/// Maximum width and height: that of a screen, generously.
const MAX_SIDE: i64 = 8192;

impl Args {
    /// The arguments that open the same window again.
    pub fn to_line(&self) -> Vec<String> {
        let mut line = vec![
            format!("--technique={}", self.technique),
            format!("--seed={}", self.seed),
            format!("--exposure={}", self.exposure),
        ];
        let mut add = |name: &str, value: Option<String>| {
            line.extend(value.map(|value| format!("--{name}={value}")));
        };
        add("max-bounces", self.max_bounces.map(|n| n.to_string()));
        add("width", self.width.map(|n| n.to_string()));
        add("height", self.height.map(|n| n.to_string()));
        add("samples", self.samples.map(|n| n.to_string()));
        add("reference", self.reference.as_ref().map(|path| path.display().to_string()));
        add("threads", self.threads.map(|n| n.to_string()));
        add("pixel", self.pixel.map(|(x, y)| format!("{x},{y}")));
        add("sample", self.pixel.map(|_| self.sample.to_string()));
        add("camera", self.camera.map(camera_text));
        let place = |Place { left, top, width, height }| format!("{left},{top},{width},{height}");
        add("place", self.place.map(place));
        line.extend(self.watch.then(|| "--watch".to_owned()));
        line.push("--".to_owned());
        line.push(self.scene.display().to_string());
        line
    }
}

fn exposure(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops| (-100.0..=100.0).contains(stops));
    stops.ok_or_else(|| "must be a number of stops from -100 to 100".to_owned())
}

/// Reads numbers separated by commas.
fn numbers<T: std::str::FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let parsed: Option<Vec<T>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    parsed?.try_into().ok()
}

fn pixel(text: &str) -> Result<(u32, u32), String> {
    numbers(text).map(|[x, y]| (x, y)).ok_or_else(|| "must be two whole numbers, such as 120,80".to_owned())
}

fn place(text: &str) -> Result<Place, String> {
    let [left, top, width, height]: [i64; 4] = numbers(text).ok_or("must be four whole numbers")?;
    let side = |value: i64| u32::try_from(value).map_err(|error| error.to_string());
    let edge = |value: i64| i32::try_from(value).map_err(|error| error.to_string());
    Ok(Place { left: edge(left)?, top: edge(top)?, width: side(width)?, height: side(height)? })
}

fn camera(text: &str) -> Result<CameraDescription, String> {
    let [ex, ey, ez, cx, cy, cz, ux, uy, uz, fov] = numbers(text).ok_or("must be ten numbers")?;
    let camera = CameraDescription {
        eye: Vec3::new(ex, ey, ez),
        center: Vec3::new(cx, cy, cz),
        up: Vec3::new(ux, uy, uz),
        fov,
    };
    let is_valid = camera.eye.distance(camera.center) > 0.0 && camera.up.length() > 0.0 && fov > 0.0;
    is_valid.then_some(camera).ok_or_else(|| "not a camera".to_owned())
}

fn camera_text(camera: CameraDescription) -> String {
    let CameraDescription { eye, center, up, fov } = camera;
    let numbers = [eye, center, up].into_iter().flat_map(|vector| vector.to_array()).chain([fov]);
    numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &[&str]) -> Result<Args, clap::Error> {
        Args::try_parse_from(std::iter::once("arty").chain(line.iter().copied()))
    }

    #[test]
    fn a_window_opens_again_as_it_was() {
        let plain = read(&["x.yml"]).expect("valid");
        let moved = Args {
            technique: Technique::Nee,
            max_bounces: Some(3),
            exposure: -1.5,
            reference: Some("r.exr".into()),
            watch: true,
            pixel: Some((3, 4)),
            sample: 17,
            camera: Some(CameraDescription {
                eye: Vec3::new(-0.1, 1e-7, 3.0),
                center: Vec3::ZERO,
                up: Vec3::Y,
                fov: 39.5,
            }),
            place: Some(Place { left: -20, top: 5, width: 640, height: 480 }),
            ..plain.clone()
        };
        for args in [plain, moved] {
            let line = args.to_line();
            let words: Vec<&str> = line.iter().map(String::as_str).collect();
            assert_eq!(read(&words).expect("valid"), args);
        }
    }

    #[test]
    fn invalid_values_are_refused_with_the_expected_ones() {
        for (option, expected) in [
            ("--pixel=3", "two whole numbers"),
            ("--width=0", "1..=8192"),
            ("--exposure=NaN", "from -100 to 100"),
            ("--camera=0,0,0,0,0,0,0,1,0,39", "not a camera"),
            ("--sample=3", "--pixel"),
            ("--output=x.png", "--output"),
        ] {
            let error = read(&["x.yml", option]).expect_err(option).to_string();
            assert!(error.contains(expected), "{option}: {error}");
        }
    }
}
