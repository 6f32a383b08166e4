//! The measurements as files.

use std::path::Path;

use verdict::convergence::{Convergence, Estimate, Role};
use verdict::error::{Error, Result};

/// Writes all of it as JSON.
///
/// # Errors
/// If the file cannot be written.
pub fn save_json(convergence: &Convergence, path: &Path) -> Result<()> {
    arty::image::write_aside(path, |writer| serde_json::to_writer_pretty(writer, convergence))
        .map_err(|error| Error::Output(error.to_string()))
}

/// The columns before the estimates.
const COLUMNS: [&str; 9] = [
    "scene",
    "technique",
    "program",
    "role",
    "max_bounces",
    "samples_per_pixel",
    "renders",
    "cpu_seconds",
    "rays",
];

/// The estimates, each with the ends of its 95 % interval.
const ESTIMATES: [&str; 4] = ["relative_mse", "median_relative_mse", "trimmed_relative_mse", "mse"];

/// Writes one line for each point of each curve, as CSV with a header.
///
/// # Errors
/// If the file cannot be written.
pub fn save_csv(convergence: &Convergence, path: &Path) -> Result<()> {
    arty::image::write_aside(path, |writer| write(convergence, writer))
        .map_err(|error| Error::Output(error.to_string()))
}

fn write(convergence: &Convergence, writer: impl std::io::Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(writer);
    let estimates =
        ESTIMATES.iter().flat_map(|name| [(*name).to_owned(), format!("{name}_low"), format!("{name}_high")]);
    writer.write_record(COLUMNS.map(str::to_owned).into_iter().chain(estimates))?;
    for panel in &convergence.panels {
        for curve in &panel.curves {
            for point in &curve.points {
                let role = match curve.role {
                    Role::Submission => "submission",
                    Role::Rival => "rival",
                    Role::External => "external",
                    Role::Solution => "solution",
                    Role::Baseline => "baseline",
                };
                let first = [
                    panel.scene.clone(),
                    curve.technique.to_string(),
                    curve.name.clone(),
                    role.to_owned(),
                    panel.max_bounces.to_string(),
                    point.samples.to_string(),
                    point.renders.to_string(),
                    point.seconds.to_string(),
                    point.rays.to_string(),
                ];
                let estimates = [
                    Some(point.relative_mse),
                    point.median_relative_mse,
                    point.trimmed_relative_mse,
                    point.mse,
                ];
                // What is unknown is empty.
                let numbers = estimates.iter().flat_map(|estimate| match estimate {
                    Some(Estimate { value, interval: [low, high] }) => [value, low, high].map(f64::to_string),
                    None => Default::default(),
                });
                writer.write_record(first.into_iter().chain(numbers))?;
            }
        }
    }
    writer.flush()?;
    Ok(())
}
