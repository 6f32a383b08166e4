//! `cargo lab figures`.

use std::process::ExitCode;

use arty::image::{Image, write_png};
use arty::integrator::{Settings, Technique};
use arty::math::Rgb;
use arty::scene::file::load;
use font8x8::UnicodeFonts;

use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::reference::Oracle;
use judge::reference::picture;
use verdict::error::{Error, Result};

/// Render the figures of the sheet with the solution.
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: Assignment,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 5)]
    seed: u64,
}

/// Width and height of each panel: the proportions of the sheet's command line.
const PANEL: (u32, u32) = (320, 257);

/// Height of the strip with the label.
const STRIP: usize = 24;

/// Pixels between panels.
const GAP: usize = 8;

/// One picture of a figure.
struct Panel {
    scene: &'static str,
    settings: Settings,
    samples: u64,
    label: &'static str,
}

const fn panel(
    scene: &'static str,
    technique: Technique,
    max_bounces: u32,
    samples: u64,
    label: &'static str,
) -> Panel {
    Panel { scene, settings: Settings { technique, max_bounces }, samples, label }
}

const FIGURES: [(&str, &[Panel]); 3] = [
    (
        "figure1.png",
        &[
            panel("cornell_box", Technique::Bsdf, 8, 100, "BSDF sampling, 100 spp"),
            panel("cornell_box", Technique::Nee, 1, 10, "direct light only, 10 spp"),
            panel("cornell_box", Technique::Nee, 8, 10, "NEE, 10 spp"),
        ],
    ),
    (
        "figure2.png",
        &[
            panel("cornell_box_water", Technique::Bsdf, 8, 64, "water: BSDF sampling, 64 spp"),
            panel("cornell_box_water", Technique::Nee, 8, 64, "water: NEE, 64 spp"),
            panel("cornell_box_point", Technique::Bsdf, 8, 64, "point: BSDF sampling, 64 spp"),
            panel("cornell_box_point", Technique::Nee, 8, 64, "point: NEE, 64 spp"),
        ],
    ),
    (
        "figure3.png",
        &[
            panel("cornell_box_glossy", Technique::Bsdf, 8, 16, "BSDF sampling, 16 spp"),
            panel("cornell_box_glossy", Technique::Nee, 8, 16, "NEE, 16 spp"),
            panel("cornell_box_glossy", Technique::Mis, 8, 16, "MIS, 16 spp"),
        ],
    ),
];

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let folder = workspace.assignment(&arguments.assignment.name).join("figures");
    std::fs::create_dir_all(&folder).map_err(|error| Error::file(&folder, error))?;
    let program = Oracle::required(&workspace)?;
    for (name, panels) in FIGURES {
        eprintln!("{name} …");
        let mut pictures = Vec::new();
        for Panel { scene, settings, samples, label } in panels {
            let description = load(&workspace.scene_file(scene))?.description;
            let image = picture(&program, &description, *settings, PANEL, *samples, arguments.seed)?;
            pictures.push((image, *label));
        }
        write_png(&folder.join(name), &side_by_side(&pictures), 0.0)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The pictures beside each other, each with its label below.
fn side_by_side(pictures: &[(Image, &str)]) -> Image {
    let (width, height) = (PANEL.0 as usize, PANEL.1 as usize);
    let mut figure = Image::new(pictures.len() * (width + GAP) - GAP, height + STRIP);
    figure.pixels_mut().fill(Rgb::WHITE);
    for (index, (picture, label)) in pictures.iter().enumerate() {
        let left = index * (width + GAP);
        for y in 0..height {
            for x in 0..width {
                figure[(left + x, y)] = picture[(x, y)];
            }
        }
        write_label(&mut figure, label, left, height + (STRIP - 8) / 2);
    }
    figure
}

/// Writes black letters of 8 × 8 pixels.
fn write_label(figure: &mut Image, label: &str, left: usize, top: usize) {
    for (index, letter) in label.chars().enumerate() {
        let Some(rows) = font8x8::BASIC_FONTS.get(letter) else { continue };
        for (y, row) in rows.into_iter().enumerate() {
            for x in (0..8).filter(|x| row & (1 << x) != 0) {
                figure[(left + 8 * index + x, top + y)] = Rgb::BLACK;
            }
        }
    }
}
