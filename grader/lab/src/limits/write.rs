//! Tables and plots of what was measured.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use plotters::prelude::*;

use super::sweep::{Series, Sweep};
use judge::extreme::measure::Finding;
use verdict::error::{Error, Result};

/// The least value that a plot shows: zero has no place on a logarithmic axis.
const LEAST: f64 = 1e-9;

/// The greatest value that a plot of errors shows; what is not a number stands there too.
const MOST: f64 = 1e2;

/// Writes a text file, whole or not at all.
///
/// # Errors
/// If it cannot be written.
pub fn text(path: &Path, content: &str) -> Result<()> {
    Ok(arty::image::write_aside(path, |writer| writer.write_all(content.as_bytes()))?)
}

/// A sweep as CSV: a line for each measurement.
pub fn csv(sweep: &Sweep) -> String {
    let mut lines = format!("series,{},{},noise,anomalies,note\n", sweep.axis, sweep.measure);
    for Series { name, points } in &sweep.series {
        for point in points {
            let note = point.note.replace('"', "'");
            let _ = writeln!(
                lines,
                "\"{name}\",{:e},{:.3e},{:.3e},{},\"{note}\"",
                point.x, point.y, point.noise, point.anomalies
            );
        }
    }
    lines
}

/// A sweep as a plot, both axes logarithmic.
///
/// # Errors
/// If it cannot be drawn.
pub fn svg(sweep: &Sweep) -> Result<String> {
    let mut image = String::new();
    draw(sweep, &mut image)
        .map_err(|error| Error::Harness(format!("the plot of {}: {error}", sweep.name)))?;
    Ok(image)
}

fn draw(sweep: &Sweep, image: &mut String) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let shown = |y: f64| if y.is_finite() { y.abs().clamp(LEAST, MOST) } else { MOST };
    let xs = || sweep.series.iter().flat_map(|series| &series.points).map(|point| point.x);
    let (first, last) = xs().fold((f64::INFINITY, 0.0f64), |(first, last), x| (first.min(x), last.max(x)));
    let area = SVGBackend::with_string(image, (760, 420)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(sweep.about, ("sans-serif", 13))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d((first..last.max(10.0 * first)).log_scale(), (LEAST..MOST).log_scale())?;
    let power = |value: &f64| format!("{value:.0e}");
    chart
        .configure_mesh()
        .x_desc(sweep.axis)
        .y_desc(sweep.measure)
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (index, series) in sweep.series.iter().enumerate() {
        let color = Palette99::pick(index).to_rgba();
        let points: Vec<(f64, f64)> = series.points.iter().map(|point| (point.x, shown(point.y))).collect();
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(2)))?
            .label(series.name.as_str())
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
        // A cross where samples were no radiance.
        let broken = series.points.iter().filter(|point| point.anomalies > 0 || !point.y.is_finite());
        chart.draw_series(broken.map(|point| Cross::new((point.x, shown(point.y)), 4, color)))?;
    }
    chart.configure_series_labels().background_style(WHITE.mix(0.8)).border_style(BLACK).draw()?;
    area.present()?;
    Ok(())
}

/// Everything as Markdown.
pub fn markdown(findings: &[Finding], sweeps: &[Sweep], command: &str) -> String {
    let mut text = format!(
        "# Limits of the framework\n\nMade by `{command}`; do not edit. Errors are relative; times are this machine's.\n\n\
         ## How far a number can go\n\nA sweep is right where the error is below its limit and what noise explains, and no \
         sample is NaN, infinite or negative. `broken` counts measurements beyond that range; what happens there stands in \
         the CSV beside each plot.\n\n| sweep | curve | measured | right | limit | broken | first warning of the loader \
         |\n|---|---|---|---|---:|---:|---|\n"
    );
    for sweep in sweeps.iter().filter(|sweep| sweep.limit.is_finite()) {
        for series in &sweep.series {
            let Some((first, last)) = series.points.first().zip(series.points.last()) else { continue };
            let right = series
                .right_range(sweep.limit)
                .map_or("nowhere".to_owned(), |[from, to]| format!("{from:.0e} to {to:.0e}"));
            let broken = series.points.iter().filter(|point| !point.is_right(sweep.limit)).count();
            let warned = |point: &&super::sweep::Point| !point.note.is_empty() && point.x >= 1.0;
            let warning = series
                .points
                .iter()
                .find(warned)
                .map_or("–".to_owned(), |point| format!("{:.0e}", point.x));
            let _ = writeln!(
                text,
                "| [{name}]({name}.svg) | {} | {:.0e} to {:.0e} | {right} | {:.0e} | {broken} | {warning} |",
                series.name,
                first.x,
                last.x,
                sweep.limit,
                name = sweep.name
            );
        }
    }
    text +=
        "\n## What size costs\n\n| sweep | curve | from | to | growth: cost ∝ x^ |\n|---|---|---|---|---:|\n";
    for sweep in sweeps.iter().filter(|sweep| sweep.limit.is_infinite()) {
        for series in &sweep.series {
            let Some((first, last)) = series.points.first().zip(series.points.last()) else { continue };
            let _ = writeln!(
                text,
                "| [{name}]({name}.svg) | {} | {:.2e} at {:.0e} | {:.2e} at {:.0e} | {:.2} |",
                series.name,
                first.y,
                first.x,
                last.y,
                last.x,
                growth(series),
                name = sweep.name
            );
        }
    }
    text += "\n## The extreme scenes\n\n`resolution` is the relative error that the test would have seen.\n\n| scene | \
             technique | should be | is | error | resolution | NaN, inf | negative | |\n|---|---|---:|---:|---:|---:|---:|---:|---|\n";
    for finding in findings {
        let Finding { truth, measured, allowed, .. } = finding;
        let _ = writeln!(
            text,
            "| {} | {} | {truth:.4e} | {:.4e} | {:+.1e} | {:.1e} | {} | {} | {} |",
            finding.scene,
            finding.settings.technique,
            measured.mean,
            measured.error(*truth),
            allowed,
            measured.non_finite,
            measured.negative,
            if finding.is_right() { "right" } else { "**wrong**" }
        );
    }
    text
}

/// The exponent of the cost over the upper half of the sweep, where what is constant no longer matters.
fn growth(series: &Series) -> f64 {
    let half = &series.points[series.points.len() / 2..];
    match (half.first(), half.last()) {
        (Some(first), Some(last)) if first.y > 0.0 && last.y > 0.0 && last.x > first.x => {
            (last.y / first.y).ln() / (last.x / first.x).ln()
        }
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::sweep::Point;
    use super::*;

    #[test]
    fn anything_can_be_drawn_and_written() {
        let point =
            |x: f64, y: f64| Point { x, y, noise: 0.0, anomalies: u64::from(y > 1.0), note: "\"a\"".into() };
        let values = [0.0, -1e-3, f64::NAN, f64::INFINITY, 1e300];
        let points =
            values.into_iter().enumerate().map(|(i, y)| point(10f64.powi(30 * i as i32 - 60), y)).collect();
        let series =
            vec![Series { name: "a".into(), points }, Series { name: "empty".into(), points: Vec::new() }];
        let sweep = Sweep { name: "a", about: "b", axis: "x", measure: "y", limit: 1e-3, series };
        assert!(svg(&sweep).expect("it is drawn").contains("</svg>"));
        assert_eq!(csv(&sweep).lines().count(), 6);
        assert!(csv(&sweep).contains("\"'a'\""));
        let text = markdown(&[], &[sweep], "command");
        assert!(text.contains("| 1e-60 to 1e-30 |"), "{text}");
    }
}
