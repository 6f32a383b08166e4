//! The table of all comparisons.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::planted::PLANTED;
use super::records::Record;
use verdict::convergence::{Bias, Curve, Estimate, Panel};

/// Intervals that held the truth, of those that there were.
#[derive(Clone, Copy, Default)]
struct Held {
    held: u64,
    of: u64,
}

impl Held {
    fn add(&mut self, estimate: Option<Estimate>, truth: f64) {
        if let Some(estimate) = estimate.filter(Estimate::has_interval) {
            self.held += u64::from(estimate.holds(truth));
            self.of += 1;
        }
    }

    fn cell(self) -> String {
        match self.of {
            0 => "–".to_owned(),
            of => format!("{:.1} % of {of}", 100.0 * self.held as f64 / of as f64),
        }
    }
}

/// Results of one scene under one load, or of all.
#[derive(Clone, Copy, Default)]
struct Row {
    comparisons: u64,
    error: Held,
    slope: Held,
    efficiency: Held,
    cost: Held,
    time: Held,
    biases: Held,
    heavy: Held,
}

impl Row {
    fn add(&mut self, panel: &Panel, variance: f64) {
        self.comparisons += 1;
        for (index, curve) in panel.curves.iter().enumerate() {
            for point in &curve.points {
                self.error.add(Some(point.relative_mse), variance / point.samples as f64);
            }
            self.slope.add(curve.slope, -1.0);
            // The machine's speed is that of this comparison, as the other curve shows it.
            let other = panel.curves.get(1 - index.min(1)).and_then(|other| other.cost);
            if let Some(cost) = other {
                let truth = cost.overhead + cost.seconds.value * variance / panel.target;
                self.time.add(curve.seconds_to_target, truth);
            }
            self.biases.of += 1;
            self.biases.held += u64::from(matches!(curve.bias, Bias::Found { .. }));
            self.heavy.of += 1;
            self.heavy.held += u64::from(curve.heavy_tailed);
        }
        if let Some(first) = panel.curves.first() {
            self.efficiency.add(first.efficiency, 1.0);
            self.cost.add(first.relative_cost, 1.0);
        }
    }

    fn line(&self, scene: &str, load: &str) -> String {
        let Self { comparisons, error, slope, efficiency, cost, time, biases, heavy } = self;
        let cells = [error, slope, efficiency, cost, time].map(|held| held.cell()).join(" | ");
        format!(
            "| {scene} | {load} | {comparisons} | {cells} | {} of {} | {} of {} |\n",
            biases.held, biases.of, heavy.held, heavy.of
        )
    }
}

/// Relative variance of one sample per pixel by scene: the mean over all lengths of all comparisons.
fn variances(records: &[&Record]) -> BTreeMap<String, f64> {
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for record in records.iter().filter(|record| record.planted.is_none()) {
        let curves = record.panel.iter().flat_map(|panel| &panel.curves);
        for point in curves.flat_map(|curve| &curve.points) {
            let (sum, count) = sums.entry(record.scene.clone()).or_default();
            *sum += point.samples as f64 * point.relative_mse.value;
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(scene, (sum, count))| (scene, sum / count)).collect()
}

/// The table as Markdown. `command` made it.
pub fn table(records: &[&Record], command: &str) -> String {
    let variances = variances(records);
    let mut rows: BTreeMap<(&str, usize), Row> = BTreeMap::new();
    let mut all: BTreeMap<usize, Row> = BTreeMap::new();
    for record in records.iter().filter(|record| record.planted.is_none()) {
        let (Some(panel), Some(&variance)) = (&record.panel, variances.get(&record.scene)) else { continue };
        rows.entry((&record.scene, record.load)).or_default().add(panel, variance);
        all.entry(record.load).or_default().add(panel, variance);
    }
    let load = |load: usize| if load == 0 { "none".to_owned() } else { format!("{load} threads") };
    let lines: String = rows.iter().map(|((scene, busy), row)| row.line(scene, &load(*busy))).collect();
    let sums: String = all.iter().map(|(busy, row)| row.line("**all**", &load(*busy))).collect();
    let mut text = format!(
        "# Coverage of convergence measurements\n\nMade by `{command}`.\n\n\
         The solution was measured beside itself, with `mis`. Each cell is the share of 95 % intervals that held the truth: the \
         error of each length (truth: the mean of all comparisons; none is given where tails are heavy), the slope (−1), efficiency and cost of a sample relative to \
         the other (1), and the time to the target error (truth: that error's samples, at the speed that the other curve \
         shows). \"Load\" is what this command added; whatever else the machine did comes on top. Measured in processor \
         time, one thread.\n\n\
         | scene | load | comparisons | error | slope | efficiency | cost | time to error | false biases | heavy tails |\n\
         |---|---|---|---|---|---|---|---|---|---|\n{lines}{sums}"
    );
    text += "\n## Planted differences\n\nPrograms made from the solution. \"Shown\" means: the interval excludes the solution's value and \
             the estimate is near what was planted (cost 1.05 to 1.15, efficiency 0.4 to 0.6, slope above −0.5), or the bias is found. The other columns are medians over the comparisons.\n\n\
             | difference | comparisons | shown | cost of a sample | efficiency | slope |\n|---|---|---|---|---|---|\n";
    for kind in PLANTED {
        let curves: Vec<&Curve> = records
            .iter()
            .filter(|record| record.planted == Some(kind))
            .filter_map(|record| record.panel.as_ref()?.curves.first())
            .collect();
        let shown = curves.iter().filter(|curve| kind.is_shown(curve)).count();
        let median = |of: fn(&Curve) -> Option<Estimate>| {
            let mut values: Vec<f64> = curves.iter().filter_map(|curve| Some(of(curve)?.value)).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).map_or("–".to_owned(), |value| format!("{value:.2}"))
        };
        let medians = [
            median(|curve| curve.relative_cost),
            median(|curve| curve.efficiency),
            median(|curve| curve.slope),
        ];
        // Writing into a string cannot fail.
        let _ = writeln!(text, "| {} | {} | {shown} | {} |", kind.title(), curves.len(), medians.join(" | "));
    }
    text
}
