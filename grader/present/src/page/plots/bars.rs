//! Histograms.

use plotters::prelude::*;

use super::{Failure, GRID, INK, SUBMISSION, font, svg};

/// Bars of equal width.
pub struct Bars<'a> {
    /// What it shows, for those who cannot see it.
    pub label: &'a str,
    /// The text below the axis.
    pub axis: &'a str,
    /// Where the first bar begins and the last one ends.
    pub range: (f64, f64),
    /// How many are in each bar.
    pub counts: &'a [usize],
    /// How many should be in each, and between which counts nineteen of twenty bars should end.
    pub expected: Option<(f64, [f64; 2])>,
}

/// Draws a histogram; `None` if there is nothing to draw.
pub fn bars(histogram: &Bars<'_>) -> Option<String> {
    let max = histogram.counts.iter().copied().max().filter(|&max| max > 0)?;
    svg(histogram.label, |area| draw(histogram, max as f64, area).ok())
}

fn draw<'a>(histogram: &Bars<'_>, max: f64, area: &super::Area<'a>) -> Result<(), Failure<'a>> {
    let &Bars { axis, range, counts, expected, .. } = histogram;
    let top = 1.1 * expected.map_or(max, |(_, [_, high])| max.max(high));
    let mut chart = super::chart(area, 44, range.0..range.1, 0.0..top)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .x_labels(6)
        .y_labels(5)
        .y_label_formatter(&|count| format!("{count:.0}"))
        .x_desc(axis)
        .label_style(font(12))
        .axis_desc_style(font(13))
        .draw()?;
    let width = (range.1 - range.0) / counts.len() as f64;
    let bar = |(index, &count): (usize, &usize)| {
        let (left, right) = (range.0 + width * index as f64, range.0 + width * (index + 1) as f64);
        let gap = 0.06 * width;
        Rectangle::new([(left + gap, 0.0), (right - gap, count as f64)], SUBMISSION.filled())
    };
    chart.draw_series(counts.iter().enumerate().map(bar))?;
    if let Some((mean, [low, high])) = expected {
        let across = |y: f64| PathElement::new([(range.0, y), (range.1, y)], INK.stroke_width(1));
        chart.draw_series([across(mean)])?;
        for end in [low, high] {
            chart.draw_series(DashedLineSeries::new(
                [(range.0, end), (range.1, end)],
                4,
                4,
                INK.stroke_width(1),
            ))?;
        }
    }
    Ok(())
}
