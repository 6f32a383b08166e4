//! The figures of the exercise sheet.

use arty::image::Image;
use arty::integrator::{Settings, Technique};
use arty::math::Rgb;
use arty::scene::file::load;
use font8x8::UnicodeFonts;

use harness::build::SubmissionProgram;
use harness::workspace::Workspace;
use judge::reference::picture;
use verdict::error::Result;

/// Width and height of a panel in pixels, in the proportions of the command on the sheet.
const PANEL: (u32, u32) = (320, 257);

/// Height of the label strip in pixels.
const STRIP: usize = 24;

/// Gap between panels in pixels.
const GAP: usize = 8;

/// One rendering with its label.
pub struct Panel {
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

/// File names and panels of all figures.
pub const FIGURES: [(&str, &[Panel]); 3] = [
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

/// Renders the panels of a figure side by side.
///
/// # Errors
/// If a scene cannot be read or the program fails.
pub fn render(
    workspace: &Workspace,
    program: &SubmissionProgram,
    panels: &[Panel],
    seed: u64,
) -> Result<Image> {
    let mut pictures = Vec::new();
    for Panel { scene, settings, samples, label } in panels {
        let description = load(&workspace.scene_file(scene))?.description;
        pictures.push((picture(program, &description, *settings, PANEL, *samples, seed)?, *label));
    }
    Ok(side_by_side(&pictures))
}

/// Pictures side by side, each with its label below.
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
