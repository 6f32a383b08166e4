//! Plots of a report's page. Each is a picture within the page, and follows the reader's colour scheme by `style.css`.

mod bars;
mod furnace;
mod p_values;
mod weights;

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::convergence::{GRID, INK, PAPER, SUBMISSION};

pub use bars::{Bars, bars};
pub(super) use furnace::furnace;
pub(super) use p_values::p_values;
pub(super) use weights::weights;

/// Width and height in pixels.
const SIZE: (u32, u32) = (460, 300);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failure<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

/// Draws a plot; `label` says in a few words of our own what it shows, for those who cannot see it.
fn svg(label: &str, draw: impl FnOnce(&Area<'_>) -> Option<()>) -> Option<String> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        area.fill(&PAPER).ok()?;
        draw(&area)?;
        area.present().ok()?;
    }
    let begin = format!("<svg class=\"plot\" role=\"img\" aria-label=\"{label}\" ");
    Some(text.replacen("<svg ", &begin, 1))
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Empty axes; `labels` is the room for those of the upright one, in pixels.
fn chart<'a, 'b>(
    area: &'a Area<'b>,
    labels: u32,
    x: Range<f64>,
    y: Range<f64>,
) -> Result<Chart<'a, 'b>, Failure<'b>> {
    ChartBuilder::on(area).margin(10).x_label_area_size(38).y_label_area_size(labels).build_cartesian_2d(x, y)
}

/// The font of labels, in the colour of text.
fn font(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}
