//! Plots of a report's page. Each is a picture within the page, and follows the reader's colour scheme by `style.css`.

mod bars;
mod furnace;
mod p_values;
mod weights;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::convergence::{GRID, INK, PAPER, SUBMISSION};

pub(crate) use bars::{Bars, bars};
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

/// The font of labels, in the colour of text.
fn font(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}
