//! A path in words and numbers, for the panel in the corner of the window.

use arty::math::Rgb;

use super::Traced;
use super::vertices::{Areas, Found, LightSample, Path};

/// Colour of plain text, `0x00RRGGBB`.
const PLAIN: u32 = 0xe8_e8_e8;
/// Colour of a path, and of light that it hits.
pub(super) const HIT: u32 = 0xff_e0_40;
/// Colour of a shadow ray that arrives.
pub(super) const ARRIVES: u32 = 0x40_e8_60;
/// Colour of a shadow ray that is blocked.
pub(super) const BLOCKED: u32 = 0xff_50_40;
/// Colour of a light sample without a shadow ray.
pub(super) const UNTESTED: u32 = 0xa0_a0_a0;

/// Lines about the chosen path, with their colours.
pub fn describe(traced: &Traced, lights: Areas<'_>) -> Vec<(String, u32)> {
    let (x, y) = traced.query.pixel;
    let sample = traced.query.sample;
    let technique = traced.query.settings.technique;
    let mut lines = vec![(format!("pixel ({x}, {y})  sample {sample}  {technique}"), PLAIN)];
    let path = match &traced.paths {
        Err(why) => {
            lines.push((why.clone(), BLOCKED));
            return lines;
        }
        Ok(paths) => paths.first().map(|recorded| Path::new(recorded, technique, lights)),
    };
    let Some(path) = path else { return lines };
    for (number, vertex) in path.vertices.iter().enumerate() {
        lines.push((format!("{number}  throughput {}", color(vertex.throughput)), PLAIN));
        lines.extend(vertex.emission.iter().flat_map(|found| found_lines("hits", found, HIT)));
        lines.extend(vertex.light_samples.iter().flat_map(light_sample));
    }
    if path.escaped.is_some() {
        lines.push(("   leaves the scene".to_owned(), PLAIN));
    }
    let without = if path.roulette { " without roulette" } else { "" };
    lines.push((format!("sum{without}     {}", color(path.sum())), PLAIN));
    lines.push((format!("your file returned {}", color(path.returned)), PLAIN));
    lines.push((", .  step   b  brightest   i  hide   Esc  close".to_owned(), UNTESTED));
    lines
}

fn light_sample(sample: &LightSample) -> [(String, u32); 2] {
    let (what, ink) = match sample.arrives {
        Some(true) => ("shadow ray arrives at", ARRIVES),
        Some(false) => ("shadow ray is blocked to", BLOCKED),
        None => ("no shadow ray to", UNTESTED),
    };
    found_lines(what, &sample.found, ink)
}

fn found_lines(what: &str, found: &Found, ink: u32) -> [(String, u32); 2] {
    let density = |density: Option<f32>| density.map_or("-".to_owned(), number);
    let Found { light, p_ne, p_brdf, weight, contribution } = *found;
    let (p_ne, p_brdf, weight) = (density(p_ne), density(p_brdf), number(weight));
    let numbers = format!("     p_ne {p_ne}  p_brdf {p_brdf}  w {weight}  adds {}", color(contribution));
    [(format!("   {what} light {light}"), ink), (numbers, ink)]
}

fn color(value: Rgb) -> String {
    value.to_array().map(number).join(" ")
}

/// Three significant digits.
fn number(value: f32) -> String {
    let size = value.abs();
    match size {
        _ if value == 0.0 => "0".to_owned(),
        _ if !(1e-3..1e4).contains(&size) => format!("{value:.2e}"),
        _ => format!("{value:.*}", (2 - size.log10().floor() as i32).max(0) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.00"),
            (0.012_345, "0.0123"),
            (123.4, "123"),
            (5e-7, "5.00e-7"),
            (f32::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
