//! The MIS weights of a submission, beside those of the balance heuristic.

use plotters::prelude::*;

use super::{Failure, GRID, INK, SUBMISSION, font, svg};
use crate::convergence::OTHER;
use verdict::check::MeasuredWeights;

/// Draws both weights over the ratio of the densities; `None` if none was measured.
pub(crate) fn weights(weights: &MeasuredWeights) -> Option<String> {
    if weights.points.is_empty() {
        return None;
    }
    svg("MIS weights against the ratio of the densities", |area| draw(weights, area).ok())
}

fn draw<'a>(weights: &MeasuredWeights, area: &super::Area<'a>) -> Result<(), Failure<'a>> {
    let measured: Vec<[f64; 3]> = weights.points.iter().map(|point| point.map(f64::from)).collect();
    let (mut min, mut max) = (-1.0f64, 1.0f64);
    let (mut low, mut high) = (0.0f64, 1.0f64);
    for [ratio, light, bsdf] in &measured {
        (min, max) = (min.min(*ratio), max.max(*ratio));
        // A weight of 1000 would flatten all others; it is drawn at the edge.
        (low, high) = (low.min(light.min(*bsdf)).max(-1.0), high.max(light.max(*bsdf)).min(3.0));
    }
    let room = 0.06 * (high - low);
    let mut chart = super::chart(area, 48, min - 0.1..max + 0.1, low - room..high + room)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .x_labels(5)
        .y_labels(6)
        .x_label_formatter(&|exponent| power(*exponent))
        .y_label_formatter(&|weight| format!("{weight:.1}"))
        .x_desc("p_L / p_B")
        .y_desc("weight")
        .label_style(font(12))
        .axis_desc_style(font(13))
        .draw()?;
    let balance = |rising: bool| {
        let steps = (0..=120).map(move |i| min + (max - min) * f64::from(i) / 120.0);
        steps.map(move |exponent| {
            let light = 1.0 / (1.0 + 10.0_f64.powf(-exponent));
            (exponent, if rising { light } else { 1.0 - light })
        })
    };
    chart.draw_series(LineSeries::new(balance(true), INK.stroke_width(1)))?;
    chart.draw_series(LineSeries::new(balance(false), INK.stroke_width(1)))?;
    let within = |weight: f64| weight.clamp(low, high);
    chart
        .draw_series(measured.iter().map(|it| Circle::new((it[0], within(it[1])), 3, SUBMISSION.filled())))?;
    chart.draw_series(
        measured.iter().map(|it| Circle::new((it[0], within(it[2])), 3, OTHER.stroke_width(2))),
    )?;
    Ok(())
}

/// Powers of ten as people write them.
fn power(exponent: f64) -> String {
    let value = 10.0_f64.powf(exponent);
    let digits = if value >= 1.0 { 0 } else { (-exponent).ceil() as usize };
    format!("{value:.digits$}")
}
