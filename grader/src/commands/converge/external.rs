//! Measurements from elsewhere: times and errors of a renderer that is not ours, as a CSV.

use std::path::Path;

use arty::integrator::Technique;
use classroom::table::{Row, Table};
use verdict::convergence::{Bias, Convergence, Curve, Estimate, Panel, Point, Role};
use verdict::error::{Error, Result};

/// Measurements from one file.
pub(super) struct External {
    file: String,
    rows: Vec<Measurement>,
}

/// One row: the error of one rendering, or the mean error of several.
struct Measurement {
    line: u64,
    scene: String,
    /// `None` if it is to be shown beside every technique.
    technique: Option<Technique>,
    program: String,
    seconds: f64,
    relative_mse: f64,
}

impl External {
    /// Reads a table with the columns `scene`, `seconds` and `relative_mse`, and optionally `technique` and `program`.
    ///
    /// # Errors
    /// If it cannot be read, a column is missing, or a cell is invalid.
    pub(super) fn load(path: &Path) -> Result<Self> {
        let table = Table::load(path)?;
        let file = path.display().to_string();
        let column = |name: &str| table.header.iter().position(|title| title.trim() == name);
        let required = |name: &str| {
            column(name)
                .ok_or_else(|| Error::file(path, format!("there is no column `{name}` in its first line")))
        };
        let (scene, seconds, error) = (required("scene")?, required("seconds")?, required("relative_mse")?);
        let (technique, program) = (column("technique"), column("program"));
        let stem = path.file_stem().map_or_else(|| file.clone(), |stem| stem.to_string_lossy().into_owned());
        let measurement = |row: &Row| -> Result<Measurement> {
            let at = |message: String| Error::Input(format!("{file}:{}: {message}", row.line));
            let positive = |column: usize| {
                let text = row.cell(column);
                let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
                number
                    .ok_or_else(|| at(format!("{}: `{text}` is not a number above 0", table.header[column])))
            };
            let optional =
                |column: Option<usize>| column.map(|column| row.cell(column)).filter(|text| !text.is_empty());
            Ok(Measurement {
                line: row.line,
                scene: row.cell(scene).to_owned(),
                technique: optional(technique).map(str::parse).transpose().map_err(at)?,
                program: optional(program).unwrap_or(&stem).to_owned(),
                seconds: positive(seconds)?,
                relative_mse: positive(error)?,
            })
        };
        let rows = table.rows.iter().map(measurement).collect::<Result<Vec<_>>>()?;
        Ok(Self { file, rows })
    }

    /// Checks that all scenes are measured.
    ///
    /// # Errors
    /// If one is not.
    pub(super) fn check(&self, scenes: &[String]) -> Result<()> {
        match self.rows.iter().find(|row| !scenes.contains(&row.scene)) {
            Some(Measurement { line, scene, .. }) => Err(Error::Input(format!(
                "{}:{line}: scene `{scene}` is not measured; add --scene={scene}",
                self.file
            ))),
            None => Ok(()),
        }
    }

    /// Adds one curve for each program to each panel with its scene and technique.
    pub(super) fn add_to(&self, convergence: &mut Convergence) {
        for panel in &mut convergence.panels {
            let mut programs: Vec<&str> = Vec::new();
            for row in self.of(panel) {
                if !programs.contains(&row.program.as_str()) {
                    programs.push(&row.program);
                }
            }
            let curves: Vec<Curve> = programs.iter().map(|program| self.curve(panel, program)).collect();
            let is_before = |curve: &&Curve| !matches!(curve.role, Role::Solution | Role::Baseline);
            let place = panel.curves.iter().take_while(is_before).count();
            panel.curves.splice(place..place, curves);
        }
    }

    fn of<'a>(&'a self, panel: &Panel) -> impl Iterator<Item = &'a Measurement> {
        let (scene, technique) = (panel.scene.clone(), panel.technique);
        self.rows
            .iter()
            .filter(move |row| row.scene == scene && row.technique.is_none_or(|its| its == technique))
    }

    fn curve(&self, panel: &Panel, program: &str) -> Curve {
        let point = |row: &Measurement| Point {
            samples: 0,
            renders: 1,
            seconds: row.seconds,
            rays: 0.0,
            relative_mse: Estimate::without_interval(row.relative_mse),
            median_relative_mse: None,
            trimmed_relative_mse: None,
            mse: None,
        };
        let mut points: Vec<Point> = self.of(panel).filter(|row| row.program == program).map(point).collect();
        points.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        Curve {
            name: program.to_owned(),
            role: Role::External,
            technique: panel.technique,
            points,
            slope: None,
            efficiency: None,
            relative_cost: None,
            seconds_to_target: None,
            cost: None,
            bias: Bias::NotTested,
            heavy_tailed: false,
            non_finite: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(text: &str) -> Result<External> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("other.csv");
        std::fs::write(&path, text).expect("it can be written");
        External::load(&path)
    }

    #[test]
    fn rows_become_curves_in_the_panel_of_their_scene_and_technique() {
        let text = "scene,technique,seconds,relative_mse,program\nbox,mis,2,0.1,fast\nbox,,1,0.5,\nbox,nee,1,0.4,fast\n";
        let external = load(text).expect("it is valid");
        assert!(external.check(&["box".to_owned()]).is_ok());
        let panel = Panel {
            scene: "box".to_owned(),
            technique: Technique::Mis,
            max_bounces: 8,
            target: 0.1,
            reference_noise: 0.0,
            yardstick: None,
            curves: Vec::new(),
        };
        let mut convergence = Convergence { panels: vec![panel], ..Convergence::default() };
        external.add_to(&mut convergence);
        let curves = convergence.panels[0].curves.iter();
        let curves: Vec<_> =
            curves.map(|curve| (curve.name.as_str(), curve.points[0].relative_mse.value)).collect();
        assert_eq!(curves, [("fast", 0.1), ("other", 0.5)]);
    }

    #[test]
    fn invalid_tables_are_one_clear_error() {
        let message = |text: &str| match load(text) {
            Err(error) => error.to_string(),
            Ok(external) => external.check(&["box".to_owned()]).expect_err("it is not measured").to_string(),
        };
        assert!(message("scene,relative_mse\n").contains("no column `seconds`"));
        assert!(message("scene,seconds,relative_mse\nbox,-1,2\n").contains("csv:2: seconds: `-1`"));
        assert!(
            message("scene,seconds,relative_mse,technique\nbox,1,2,x\n").contains("unknown technique `x`")
        );
        assert!(message("scene,seconds,relative_mse\ncellar,1,2\n").contains("--scene=cellar"));
    }
}
