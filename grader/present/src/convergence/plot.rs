//! The plot: relative MSE over processor time, samples or rays, both logarithmic, one panel for each scene and technique.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::words::count;
use verdict::convergence::{Bias, Convergence, Curve, Panel, Point, Role};

/// Width and height of a panel in pixels.
const PANEL: (u32, u32) = (560, 420);

/// Colours that a dark background replaces; the others are legible on both.
pub(crate) const INK: RGBColor = RGBColor(0x20, 0x21, 0x24);
pub(crate) const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xfe);
pub(crate) const GRID: RGBColor = RGBColor(0xe4, 0xe4, 0xe7);

/// In the order of submissions; from Okabe and Ito, whom colour-blind readers can tell apart.
const SUBMISSIONS: [RGBColor; 5] = [
    RGBColor(0x1f, 0x83, 0xd6),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0xc0, 0x5c, 0x9c),
    RGBColor(0xb8, 0x86, 0x0b),
    RGBColor(0x3a, 0xa6, 0xc4),
];
/// The submission's colour in plots of one submission, and that of what stands beside it.
pub(crate) const SUBMISSION: RGBColor = SUBMISSIONS[0];
pub(crate) const OTHER: RGBColor = SUBMISSIONS[1];
const SOLUTION: RGBColor = RGBColor(0x00, 0x9e, 0x73);
const BASELINE: RGBColor = RGBColor(0x8a, 0x8f, 0x98);

/// What a dark background changes. It names colours, since a picture within a page has no style of its own.
const DARK: &str = "<style>@media (prefers-color-scheme: dark) {\
svg.convergence [fill=\"#FFFFFE\"] { fill: #17181c } svg.convergence [fill=\"#202124\"] { fill: #e6e6e9 } \
svg.convergence [stroke=\"#202124\"] { stroke: #e6e6e9 } svg.convergence [stroke=\"#E4E4E7\"] { stroke: #33353c } \
}</style>";

/// Horizontal axis of an error curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Processor time.
    Seconds,
    /// Samples per pixel.
    Samples,
    /// Rays, shadow rays included.
    Rays,
}

impl Axis {
    /// The position of a point; not positive if it is unknown.
    fn of(self, point: &Point) -> f64 {
        match self {
            Self::Seconds => point.seconds,
            Self::Samples => point.samples as f64,
            Self::Rays => point.rays,
        }
    }

    fn description(self, threads: usize) -> String {
        match self {
            Self::Seconds => {
                format!("processor time of one rendering in seconds ({})", count(threads, "thread"))
            }
            Self::Samples => "samples per pixel".to_owned(),
            Self::Rays => "rays of one rendering, shadow rays included".to_owned(),
        }
    }

    /// Position and error of the points of a curve that can be drawn, with the points.
    fn drawn(self, curve: &Curve) -> impl Iterator<Item = (f64, f64, &Point)> {
        let place = move |point| (self.of(point), point.relative_mse.value, point);
        curve.points.iter().map(place).filter(|(x, error, _)| *x > 0.0 && *error > 0.0)
    }
}

/// Draws all panels; `None` if there is nothing to draw. Background and text follow the reader's colour scheme.
pub fn svg(convergence: &Convergence, axis: Axis) -> Option<String> {
    let panels: Vec<&Panel> =
        convergence.panels.iter().filter(|panel| Frame::around(panel, axis).is_some()).collect();
    if panels.is_empty() {
        return None;
    }
    let columns = panels.len().min(2);
    let rows = panels.len().div_ceil(columns);
    let mut text = String::new();
    {
        let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        // Writing into a string cannot fail; a panel that cannot be drawn stays empty.
        root.fill(&PAPER).ok()?;
        for (panel, area) in panels.iter().zip(root.split_evenly((rows, columns))) {
            draw(panel, (axis, convergence.threads), &area).ok()?;
        }
        root.present().ok()?;
    }
    Some(text.replacen("<svg ", "<svg class=\"convergence\" ", 1).replacen('>', &format!(">{DARK}"), 1))
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failure<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

/// The ranges of the axes, as decimal logarithms.
struct Frame {
    x: (f64, f64),
    error: (f64, f64),
}

impl Frame {
    fn around(panel: &Panel, axis: Axis) -> Option<Self> {
        let drawn = || panel.curves.iter().flat_map(|curve| axis.drawn(curve));
        let range = |values: &mut dyn Iterator<Item = f64>, margin: f64| -> Option<(f64, f64)> {
            let (min, max) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), value| {
                (min.min(value), max.max(value))
            });
            (min <= max).then(|| (min.log10() - margin, max.log10() + margin))
        };
        let ends = drawn().flat_map(|(_, _, point)| {
            let [low, high] = point.relative_mse.interval;
            // An interval that reaches zero has no end to be drawn.
            [low.max(0.5 * point.relative_mse.value), high, point.relative_mse.value]
        });
        let floors = panel.curves.iter().filter_map(floor);
        Some(Self {
            x: range(&mut drawn().map(|(x, ..)| x), 0.12)?,
            error: with_room(range(&mut ends.chain(floors), 0.15)?, panel.curves.len() + 1),
        })
    }
}

/// A range with room above it for as many lines of text as the names of the curves take.
fn with_room((min, max): (f64, f64), lines: usize) -> (f64, f64) {
    const LINE: f64 = 16.0;
    const HEIGHT: f64 = PANEL.1 as f64 - 90.0;
    let share = ((lines as f64 + 1.0) * LINE / HEIGHT).min(0.5);
    // Curves fall, and the names stand on the right: half of the room is there anyway.
    (min, max + 0.5 * share / (1.0 - share) * (max - min))
}

/// Where a curve flattens.
fn floor(curve: &Curve) -> Option<f64> {
    match curve.bias {
        Bias::Found { relative_squared } => Some(relative_squared).filter(|&bias| bias > 0.0),
        _ => None,
    }
}

fn draw<'a>(panel: &Panel, (axis, threads): (Axis, usize), area: &Area<'a>) -> Result<(), Failure<'a>> {
    let Some(frame) = Frame::around(panel, axis) else { return Ok(()) };
    let font = |size: i32| ("sans-serif", size).into_font().color(&INK);
    let title = format!("{}, {}", panel.scene, panel.technique);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(title, font(17))
        .x_label_area_size(42)
        .y_label_area_size(58)
        .build_cartesian_2d(frame.x.0..frame.x.1, frame.error.0..frame.error.1)?;
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .x_label_formatter(&|exponent| axis_label(*exponent))
        .y_label_formatter(&|exponent| axis_label(*exponent))
        .x_labels(6)
        .y_labels(7)
        .x_desc(axis.description(threads))
        .y_desc("relative MSE")
        .label_style(font(12))
        .axis_desc_style(font(13))
        .draw()?;
    if let Some(guide) = guide(panel, axis, &frame) {
        let line = DashedLineSeries::new(guide, 2, 5, INK.stroke_width(1));
        chart
            .draw_series(line)?
            .label("slope −1")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], INK));
    }
    let mut submissions = SUBMISSIONS.iter().cycle();
    for curve in &panel.curves {
        let color = match curve.role {
            Role::Submission | Role::Rival | Role::External => *submissions.next().unwrap_or(&INK),
            Role::Solution => SOLUTION,
            Role::Baseline => BASELINE,
        };
        draw_curve(&mut chart, (curve, color), axis, &frame)?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(PAPER.mix(0.85))
        .label_font(font(12))
        .draw()
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn draw_curve<'b>(
    chart: &mut Chart<'_, 'b>,
    (curve, color): (&Curve, RGBColor),
    axis: Axis,
    frame: &Frame,
) -> Result<(), Failure<'b>> {
    let at: Vec<(f64, f64)> = axis.drawn(curve).map(|(x, error, _)| (x.log10(), error.log10())).collect();
    let width = if curve.role == Role::Submission { 3 } else { 2 };
    let slope = curve.slope.map_or(String::new(), |slope| format!(", slope {:.2}", slope.value));
    let bias = floor(curve).map_or(String::new(), |bias| format!(", bias {:.1} %", 100.0 * bias.sqrt()));
    chart
        .draw_series(LineSeries::new(at.clone(), color.stroke_width(width)))?
        .label(format!("{}{slope}{bias}", curve.name))
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(width)));
    chart.draw_series(at.iter().map(|&place| Circle::new(place, 3, color.filled())))?;
    // A bar to zero or below ends at the edge of the plot.
    let end = |value: f64| if value > 0.0 { value.log10().max(frame.error.0) } else { frame.error.0 };
    let bars = axis.drawn(curve).map(|(x, _, point)| {
        let [low, high] = point.relative_mse.interval;
        let x = x.log10();
        PathElement::new([(x, end(low)), (x, end(high))], color.stroke_width(1))
    });
    chart.draw_series(bars)?;
    if let Some(bias) = floor(curve) {
        let line = [(frame.x.0, bias.log10()), (frame.x.1, bias.log10())];
        chart.draw_series(DashedLineSeries::new(line, 7, 5, color.stroke_width(1)))?;
    }
    Ok(())
}

/// The number behind a decimal logarithm, in two digits.
fn axis_label(exponent: f64) -> String {
    let digits = format!("{:.1e}", 10.0_f64.powf(exponent));
    digits.parse().map_or(digits, |value: f64| value.to_string())
}

/// The line of slope −1 through the first point of the solution, within the frame.
fn guide(panel: &Panel, axis: Axis, frame: &Frame) -> Option<[(f64, f64); 2]> {
    let solution = panel.curves.iter().find(|curve| curve.role == Role::Solution);
    let curve = solution.or_else(|| panel.curves.first())?;
    let (x, error, _) = axis.drawn(curve).next()?;
    let level = error.log10() + x.log10();
    let (first, last) = (frame.x.0.max(level - frame.error.1), frame.x.1.min(level - frame.error.0));
    (first < last).then_some([(first, level - first), (last, level - last)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use arty::integrator::Technique;
    use verdict::convergence::Estimate;

    fn curve(role: Role, floor: f64) -> Curve {
        let point = |k: i32| {
            let seconds = 0.01 * 4.0_f64.powi(k);
            let value = 0.02 / seconds + floor;
            let around = Estimate { value, interval: [0.9 * value, 1.1 * value] };
            Point {
                samples: 4_u64.pow(k as u32),
                renders: 2,
                seconds,
                rays: 0.0,
                relative_mse: around,
                median_relative_mse: Some(around),
                trimmed_relative_mse: None,
                mse: None,
            }
        };
        Curve {
            name: "<b>&".to_owned(),
            role,
            technique: Technique::Mis,
            points: (0..5).map(point).collect(),
            slope: None,
            efficiency: None,
            relative_cost: None,
            seconds_to_target: None,
            cost: None,
            bias: if floor > 0.0 { Bias::Found { relative_squared: floor } } else { Bias::NotTested },
            heavy_tailed: false,
            non_finite: 0,
        }
    }

    fn drawn(floor: f64, axis: Axis) -> Option<String> {
        let panel = Panel {
            scene: "box".to_owned(),
            technique: Technique::Mis,
            max_bounces: 8,
            target: 0.1,
            reference_noise: 0.0,
            yardstick: None,
            curves: vec![curve(Role::Submission, floor), curve(Role::Solution, 0.0)],
        };
        svg(&Convergence { threads: 1, panels: vec![panel], ..Convergence::default() }, axis)
    }

    #[test]
    fn a_plot_names_its_curves_escaped_and_shows_a_bias() {
        let text = drawn(0.04, Axis::Seconds).expect("there are points");
        assert!(text.starts_with("<svg class=\"convergence\"") && text.contains("prefers-color-scheme"));
        assert!(text.contains("&lt;b&gt;&amp;") && !text.contains("<b>"), "a submission's name is no markup");
        assert!(text.contains("bias 20.0 %"));
        assert!(!drawn(0.0, Axis::Samples).expect("there are points").contains("bias"));
    }

    #[test]
    fn an_axis_has_its_name_and_only_points_whose_place_is_known() {
        assert!(drawn(0.0, Axis::Samples).expect("there are points").contains("samples per pixel"));
        assert_eq!(drawn(0.0, Axis::Rays), None, "the number of rays is unknown");
    }

    #[test]
    fn without_points_there_is_no_plot() {
        assert_eq!(svg(&Convergence::default(), Axis::Seconds), None);
    }

    #[test]
    fn axes_have_plain_numbers() {
        assert_eq!([-2.5, 0.0, 1.0, 2.5].map(axis_label), ["0.0032", "1", "10", "320"]);
    }
}
