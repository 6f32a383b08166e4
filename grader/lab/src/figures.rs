//! The figures of the exercise sheet.

use arty::image::Image;
use arty::integrator::{Settings, Technique};
use arty::math::Rgb;
use arty::scene::file::load;
use font8x8::UnicodeFonts;

use harness::assignment_folder::AssignmentFolder;
use harness::build::SubmissionProgram;
use harness::workspace::Workspace;
use judge::reference::picture;
use serde::Deserialize;
use verdict::error::Result;

/// Width and height of a panel in pixels, in the proportions of the command on the sheet.
const PANEL: (u32, u32) = (320, 257);

/// Height of the label strip in pixels.
const STRIP: usize = 24;

/// Gap between panels in pixels.
const GAP: usize = 8;

/// Contents of `figures.yml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FiguresFile {
    figures: Vec<Figure>,
}

/// Pictures of the solution, side by side.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Name of the file, `figure1.png`.
    pub file: String,
    /// The pictures, from left to right.
    pub panels: Vec<Panel>,
}

/// One rendering with its label.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Panel {
    scene: String,
    technique: Technique,
    max_bounces: u32,
    /// Samples per pixel.
    samples: u64,
    label: String,
}

/// The figures of an assignment; none if it has no `figures.yml`.
///
/// # Errors
/// If the file is malformed.
pub fn figures(assignment: &AssignmentFolder) -> Result<Vec<Figure>> {
    let file = assignment.figures_file();
    Ok(if file.is_file() { arty::yaml::read::<FiguresFile>(&file)?.0.figures } else { Vec::new() })
}

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
    for Panel { scene, technique, max_bounces, samples, label } in panels {
        let description = load(&workspace.scene_file(scene))?.description;
        let settings = Settings { technique: *technique, max_bounces: *max_bounces };
        pictures.push((picture(program, &description, settings, PANEL, *samples, seed)?, label.as_str()));
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
