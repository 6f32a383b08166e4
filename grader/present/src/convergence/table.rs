//! The measurements on a terminal.

use std::io::{self, Write};

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{Cell, CellAlignment, ContentArrangement, Table};

use verdict::convergence::{Bias, Convergence, Curve, Estimate, NotMeasured, Panel, Role};

use crate::words::count;

/// Prints one table for each scene and technique.
pub fn print_table(convergence: &Convergence) {
    // The reader may be gone (`… | head`).
    let _ = write(&mut io::stdout().lock(), convergence);
}

fn write(out: &mut impl Write, convergence: &Convergence) -> io::Result<()> {
    for panel in &convergence.panels {
        writeln!(
            out,
            "\n{}, {}, {}",
            panel.scene,
            panel.technique,
            count(panel.max_bounces as usize, "bounce")
        )?;
        writeln!(out, "{}", table(panel))?;
    }
    let threads = count(convergence.threads, "thread");
    writeln!(
        out,
        "Seconds are processor time, {threads} each. In brackets: 95 % intervals. Efficiency and cost of a sample are relative to \
         the program with 1. \"heavy tails\": few renderings make up most of the error, whose interval is unknown; compare medians."
    )?;
    convergence.left_out.iter().try_for_each(|entry| writeln!(out, "{}", not_measured(entry)))
}

/// Prints one sentence for each submission and scene.
pub fn print_sentences(convergence: &Convergence) {
    for panel in &convergence.panels {
        for sentence in sentences(panel) {
            let _ = writeln!(io::stdout(), "{sentence}");
        }
    }
    for entry in &convergence.left_out {
        let _ = writeln!(io::stdout(), "{}", not_measured(entry));
    }
}

/// What was not measured, and why.
pub(crate) fn not_measured(entry: &NotMeasured) -> String {
    let NotMeasured { program, scene, why } = entry;
    let place = if scene.is_empty() { String::new() } else { format!(" in {scene}") };
    format!("skipped: {program}{place}: {why}")
}

/// What a panel says of each submission.
pub fn sentences(panel: &Panel) -> Vec<String> {
    let submissions = panel.curves.iter().filter(|curve| curve.role == Role::Submission);
    submissions.filter_map(|curve| sentence(panel, curve)).collect()
}

fn sentence(panel: &Panel, curve: &Curve) -> Option<String> {
    let point = curve.points.last()?;
    let mut text = format!("{}, {}", panel.scene, panel.technique);
    if panel.curves.iter().filter(|curve| curve.role == Role::Submission).count() > 1 {
        text += &format!(", {}", curve.name);
    }
    text += &format!(": relative MSE {} after {} s", number(point.relative_mse.value), number(point.seconds));
    for other in panel.curves.iter().filter(|other| other.role != Role::Submission) {
        if let Some(point) = other.points.last() {
            text += &format!(", {} {}", other.name, number(point.relative_mse.value));
            if curve.points.last().is_some_and(|own| differ(own.seconds, point.seconds)) {
                text += &format!(" after {} s", number(point.seconds));
            }
        }
    }
    if let Some(slope) = curve.slope {
        text += &format!("; slope {} (−1 is expected)", with_interval(slope));
    }
    if let (Some(efficiency), Some(yardstick)) = (curve.efficiency, &panel.yardstick) {
        text += &format!("; efficiency {} relative to {yardstick}", with_interval(efficiency));
        if let Some(cost) = curve.relative_cost {
            text += &format!(", time for each sample {}", with_interval(cost));
        }
    }
    if let Bias::Found { .. } = curve.bias {
        text += &format!("; the curve flattens at a bias of {}", bias(curve));
    }
    if curve.heavy_tailed {
        text += "; heavy tails: few renderings make up most of the error, so that its interval is unknown";
    }
    Some(text)
}

/// True if two times differ by more than a tenth.
fn differ(a: f64, b: f64) -> bool {
    (a / b).ln().abs() > 0.1
}

fn table(panel: &Panel) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_HORIZONTAL_ONLY).set_content_arrangement(ContentArrangement::Dynamic).set_header([
        "program".to_owned(),
        "relative MSE, longest".to_owned(),
        "median".to_owned(),
        "slope (−1)".to_owned(),
        "bias".to_owned(),
        "efficiency".to_owned(),
        "cost of a sample".to_owned(),
        format!("time to {}", number(panel.target)),
    ]);
    for curve in &panel.curves {
        let last = curve.points.last();
        let error = last.map_or("–".to_owned(), |point| {
            let tails = if curve.heavy_tailed { ", heavy tails" } else { "" };
            format!("{} after {} s{tails}", with_interval(point.relative_mse), number(point.seconds))
        });
        let target = match (curve.seconds_to_target, last) {
            (Some(seconds), _) => format!("{} s", with_interval(seconds)),
            (None, Some(point)) => format!("> {} s", number(point.seconds)),
            (None, None) => "–".to_owned(),
        };
        table.add_row(
            [
                curve.name.clone(),
                error,
                last.and_then(|point| point.median_relative_mse).map_or("–".to_owned(), with_interval),
                curve.slope.map_or("–".to_owned(), with_interval),
                bias(curve),
                curve.efficiency.map_or("–".to_owned(), with_interval),
                curve.relative_cost.map_or("–".to_owned(), with_interval),
                target,
            ]
            .into_iter()
            .enumerate()
            .map(|(index, text)| {
                let side = if index == 0 { CellAlignment::Left } else { CellAlignment::Right };
                Cell::new(text).set_alignment(side)
            }),
        );
    }
    table
}

/// The root of the relative squared bias, if the judge's test found one.
fn bias(curve: &Curve) -> String {
    match curve.bias {
        Bias::Found { relative_squared } => format!("{:.1} %", 100.0 * relative_squared.sqrt()),
        Bias::NotFound { detectable: Some(detectable) } => format!("none ≥ {:.1} %", 100.0 * detectable),
        Bias::NotFound { detectable: None } => "none seen".to_owned(),
        Bias::NotTested => "–".to_owned(),
    }
}

fn with_interval(Estimate { value, interval: [low, high] }: Estimate) -> String {
    if low == high {
        // Unknown, or relative to itself.
        return number(value);
    }
    format!("{} [{}, {}]", number(value), number(low), number(high))
}

/// Three digits, without zeros that say nothing.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || (0.01..1000.0).contains(&value.abs()) {
        let digits = (2.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 4.0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.0, "0.0000"),
            (1.0, "1.00"),
            (-0.987, "-0.987"),
            (0.0123, "0.0123"),
            (1.5e-4, "1.5e-4"),
            (123.4, "123"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
