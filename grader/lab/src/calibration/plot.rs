//! The plot: number of wrong variants found against processor time, for each test.

use plotters::prelude::*;

use super::{Line, Test};
use verdict::check::CheckId;

const SIZE: (u32, u32) = (720, 420);

/// From Okabe and Ito: distinguishable for colour-blind readers.
const COLORS: [RGBColor; 3] =
    [RGBColor(0x00, 0x9e, 0x73), RGBColor(0x1f, 0x83, 0xd6), RGBColor(0xd5, 0x5e, 0x00)];

/// Relative error that the fixed numbers of samples are chosen for.
pub(super) const DESIGN_ERROR: f64 = 0.02;

/// Processor times in seconds, ascending: one for each wrong variant that a test finds.
///
/// How wrong a submission is, is not known in advance: a fixed number of samples is at least the one that finds an error
/// of [`DESIGN_ERROR`] in the samples of the solution.
pub(super) fn times(lines: &[&Line], wrong: &[String], test: Test) -> Vec<f64> {
    let fixed = |check: &CheckId| {
        let is_designed = |line: &&&Line| {
            test != Test::Sequential && line.check == *check && line.test == test && line.bias == DESIGN_ERROR
        };
        lines.iter().find(is_designed).map_or(0.0, |line| line.paths())
    };
    let fastest = |variant: &String| {
        let of_it = lines.iter().filter(|line| line.variant == *variant && line.test == test && line.found());
        let seconds = |line: &&Line| line.paths().max(fixed(&line.check)) * line.seconds_per_path;
        of_it.map(seconds).min_by(f64::total_cmp)
    };
    let mut times: Vec<f64> = wrong.iter().filter_map(fastest).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// The plot as SVG; `None` if no test found anything.
pub fn svg(lines: &[&Line], wrong: &[String]) -> Option<String> {
    let curves = Test::ALL.map(|test| (test, times(lines, wrong, test)));
    let all = || curves.iter().flat_map(|(_, times)| times);
    let (min, max) = (all().copied().reduce(f64::min)?, all().copied().reduce(f64::max)?);
    let count = curves.iter().map(|(_, times)| times.len()).max()?;
    let mut text = String::new();
    {
        // Writing into a string cannot fail.
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).ok()?;
        let mut chart = ChartBuilder::on(&root)
            .caption("Wrong variants found by checks of means", ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(48)
            .build_cartesian_2d((0.7 * min..1.4 * max).log_scale(), 0..count + 1)
            .ok()?;
        chart
            .configure_mesh()
            .x_desc("processor time of rendering, in seconds")
            .y_desc("variants")
            .light_line_style(TRANSPARENT)
            .draw()
            .ok()?;
        for ((test, times), color) in curves.iter().zip(COLORS) {
            let steps = times.iter().zip(0..).flat_map(|(&time, found)| [(time, found), (time, found + 1)]);
            let end = times.last().map(|_| (1.4 * max, times.len()));
            chart
                .draw_series(LineSeries::new(steps.chain(end), color.stroke_width(2)))
                .ok()?
                .label(test.name())
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE.mix(0.8))
            .draw()
            .ok()?;
        root.present().ok()?;
    }
    Some(text)
}
