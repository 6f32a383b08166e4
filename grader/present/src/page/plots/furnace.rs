//! Energy per bounce in a white furnace.

use plotters::prelude::*;

use super::{Failure, GRID, INK, SUBMISSION, font, svg};
use verdict::check::{BounceEnergy, FurnaceTest};

/// Draws the energy of each bounce with its interval; `None` if there are fewer than two.
pub(crate) fn furnace(test: &FurnaceTest) -> Option<String> {
    if test.energy.len() < 2 || !test.energy.iter().all(BounceEnergy::is_finite) {
        return None;
    }
    svg("energy per bounce relative to exact", |area| draw(&test.energy, area).ok())
}

fn draw<'a>(energy: &[BounceEnergy], area: &super::Area<'a>) -> Result<(), Failure<'a>> {
    let point =
        |(k, bounce): (usize, &BounceEnergy)| (k as f64, bounce.relative, bounce.margin.unwrap_or(0.0));
    let seen: Vec<(f64, f64, f64)> = energy.iter().enumerate().map(point).collect();
    // At least a tenth on either side, so that a hair's breadth does not look like a fault.
    let min = seen.iter().map(|(_, c, margin)| c - margin).fold(0.9, f64::min);
    let max = seen.iter().map(|(_, c, margin)| c + margin).fold(1.1, f64::max);
    let room = 0.08 * (max - min);
    let last = (seen.len() - 1) as f64;
    let mut chart = super::chart(area, 52, -0.4..last + 0.4, min - room..max + room)?;
    let whole = |k: &f64| if (k - k.round()).abs() < 1e-6 { format!("{k:.0}") } else { String::new() };
    chart
        .configure_mesh()
        .disable_x_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .x_labels(seen.len().min(12))
        .x_label_formatter(&whole)
        .y_label_formatter(&|c| format!("{c:.2}"))
        .y_labels(6)
        .x_desc("bounces")
        .y_desc("energy / exact")
        .label_style(font(12))
        .axis_desc_style(font(13))
        .draw()?;
    let right = [(-0.4, 1.0), (last + 0.4, 1.0)];
    chart.draw_series(DashedLineSeries::new(right, 5, 4, INK.stroke_width(1)))?;
    let bars = seen.iter().map(|&(k, c, margin)| {
        PathElement::new([(k, c - margin), (k, c + margin)], SUBMISSION.stroke_width(2))
    });
    chart.draw_series(bars)?;
    chart.draw_series(seen.iter().map(|&(k, c, _)| Circle::new((k, c), 4, SUBMISSION.filled())))?;
    Ok(())
}
