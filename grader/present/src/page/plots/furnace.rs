//! How many times light counts that is scattered k times, in a furnace.

use plotters::prelude::*;

use super::{Failure, GRID, INK, SUBMISSION, font, svg};
use verdict::report::CheckResult;

/// Draws the coefficients of a furnace with their intervals; `None` if the check has fewer than two.
pub(crate) fn furnace(check: &CheckResult) -> Option<String> {
    if check.coefficients.len() < 2 || check.coefficients.iter().any(|c| !c.is_finite()) {
        return None;
    }
    svg("coefficients of a furnace", |area| draw(check, area).ok())
}

fn draw<'a>(check: &CheckResult, area: &super::Area<'a>) -> Result<(), Failure<'a>> {
    let margin = |k: usize| check.coefficient_margins.get(k).copied().unwrap_or(0.0);
    let seen: Vec<(f64, f64, f64)> =
        check.coefficients.iter().enumerate().map(|(k, &c)| (k as f64, c, margin(k))).collect();
    // At least a tenth on either side, so that a hair's breadth does not look like a fault.
    let least = seen.iter().map(|(_, c, margin)| c - margin).fold(0.9, f64::min);
    let most = seen.iter().map(|(_, c, margin)| c + margin).fold(1.1, f64::max);
    let room = 0.08 * (most - least);
    let last = (seen.len() - 1) as f64;
    let mut chart = super::chart(area, 52, -0.4..last + 0.4, least - room..most + room)?;
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
        .x_desc("scattered k times")
        .y_desc("counted so many times")
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
