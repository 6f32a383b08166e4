//! A path as tables.

use std::io::{self, Write};

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{ContentArrangement, Table};

use verdict::replay::{NamedValue, ReplayedPath, Vertex};

use crate::words::count;

/// Writes a path, call by call, and its vertices where they are known.
///
/// # Errors
/// If it cannot be written.
pub fn print(
    out: &mut impl Write,
    title: &str,
    path: &ReplayedPath,
    vertices: Option<&[Vertex]>,
) -> io::Result<()> {
    writeln!(out, "{title}: radiance {}", written(&path.radiance))?;
    let mut table = new_table(&["", "call", "given", "got"]);
    for (index, step) in path.calls.iter().enumerate() {
        let got = if step.got.is_empty() { "None".to_owned() } else { listed(&step.got) };
        table.add_row([(index + 1).to_string(), step.function.clone(), listed(&step.given), got]);
    }
    writeln!(out, "{table}")?;
    if path.left_out > 0 {
        writeln!(
            out,
            "… and {} left out",
            count(usize::try_from(path.left_out).unwrap_or(usize::MAX), "call")
        )?;
    }
    let Some(vertices) = vertices else { return Ok(()) };
    let mut table = new_table(&[
        "bounce",
        "throughput",
        "found by",
        "density",
        "other density",
        "weight",
        "contribution",
    ]);
    for vertex in vertices {
        let ways = [("hit", &vertex.hit), ("light sample", &vertex.light_sample)];
        let found = || ways.iter().filter_map(|(way, light)| Some((*way, light.as_ref()?)));
        let row = |way: &str, rest: [String; 4]| {
            let start = [vertex.bounce.to_string(), format!("{:.4e}", vertex.throughput), way.to_owned()];
            start.into_iter().chain(rest).collect::<Vec<_>>()
        };
        let density = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.4e}"));
        for (way, light) in found() {
            let weight = format!("{:.6}", light.weight);
            let contribution = format!("{:.4e}", light.contribution);
            table.add_row(row(
                way,
                [density(light.density), density(light.other_density), weight, contribution],
            ));
        }
        if found().next().is_none() {
            table.add_row(row("–", std::array::from_fn(|_| String::new())));
        }
    }
    writeln!(out, "Vertices (green channel; densities per solid angle; without Russian roulette):\n{table}")
}

fn new_table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table
        .load_style(UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_header(header.iter().copied());
    table
}

fn listed(values: &[NamedValue]) -> String {
    let one = |value: &NamedValue| match &value.word {
        Some(word) => format!("{} {word}", value.name),
        None if value.numbers.is_empty() => value.name.clone(),
        None => format!("{} {}", value.name, written(&value.numbers)),
    };
    values.iter().map(one).collect::<Vec<_>>().join("\n")
}

/// Numbers with as many digits as tell them apart from their neighbours in single precision.
fn written(numbers: &[f32]) -> String {
    let one = |value: &f32| match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..1e6 => value.to_string(),
        _ if value.is_finite() => format!("{value:e}"),
        _ => value.to_string(),
    };
    let all: Vec<String> = numbers.iter().map(one).collect();
    if let [one] = all.as_slice() { one.clone() } else { format!("({})", all.join(", ")) }
}
