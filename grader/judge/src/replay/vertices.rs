//! Reconstructing the vertices of a path from the calls of the solution.

use arty::integrator::Technique;
use arty::scene::SceneDescription;
use verdict::replay::{FoundLight, RecordedCall, ReplayedPath, Vertex};

/// The vertices of a path of the solution, whose order of calls is known. Densities and weights are computed in double
/// precision from the recorded values.
pub fn vertices(path: &ReplayedPath, technique: Technique, description: &SceneDescription) -> Vec<Vertex> {
    let lights = light_count(description);
    let mut vertices: Vec<Vertex> = Vec::new();
    let mut throughput = 1.0;
    // Position of the last bounce and density of its direction; `None` at the camera and after a delta bounce.
    let mut last: Option<([f64; 3], f64)> = None;
    let mut here = [0.0; 3];
    let mut steps = path.calls.iter().peekable();
    while let Some(step) = steps.next() {
        match step.function.as_str() {
            "Scene::intersect" => {
                let Some(point) = step.got("point") else { break };
                here = triple(point);
                let bounce = vertices.len() as u32;
                vertices.push(Vertex { bounce, throughput, hit: None, light_sample: None });
            }
            "Hit::emission" => {
                let light = found_by_hit(step, technique, last, here, lights, throughput);
                if let Some(vertex) = vertices.last_mut() {
                    vertex.hit = light;
                }
            }
            "Light::sample_direct" => {
                let rest: Vec<&RecordedCall> = steps
                    .clone()
                    .take_while(|step| !matches!(step.function.as_str(), "Bsdf::sample" | "Scene::intersect"))
                    .collect();
                if let Some(vertex) = vertices.last_mut() {
                    vertex.light_sample = found_by_sample(step, &rest, here, lights, throughput);
                }
            }
            "Bsdf::sample" => {
                let (Some(f), Some(cos), Some(pdf)) = (step.got("f"), step.number("cos"), step.number("pdf"))
                else {
                    break;
                };
                throughput *= f64::from(f.get(1).copied().unwrap_or(0.0)) * cos / pdf;
                let is_delta = step.number("is_delta") == Some(1.0);
                last = (!is_delta).then_some((here, pdf));
            }
            _ => {}
        }
    }
    vertices
}

fn light_count(description: &SceneDescription) -> f64 {
    arty::scene::Scene::new(description).lights().len() as f64
}

fn triple(values: &[f32]) -> [f64; 3] {
    std::array::from_fn(|i| values.get(i).map_or(f64::NAN, |&value| f64::from(value)))
}

fn squared_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}

fn found_by_hit(
    step: &RecordedCall,
    technique: Technique,
    last: Option<([f64; 3], f64)>,
    here: [f64; 3],
    lights: f64,
    throughput: f64,
) -> Option<FoundLight> {
    let radiance = f64::from(*step.got("radiance")?.get(1)?);
    let density = last.map(|(_, density)| density);
    let other_density = match last.filter(|_| technique == Technique::Mis) {
        Some((from, _)) => {
            Some(step.number("pdf_area")? * squared_distance(from, here) / step.number("cos_light")? / lights)
        }
        None => None,
    };
    let weight = match other_density {
        Some(other) => density.map_or(1.0, |density| density / (density + other)),
        None if technique == Technique::Nee && density.is_some() => 0.0,
        None => 1.0,
    };
    Some(FoundLight { density, other_density, weight, contribution: throughput * radiance * weight })
}

/// Light found by a light sample. `rest` are the later calls that belong to it.
fn found_by_sample(
    step: &RecordedCall,
    rest: &[&RecordedCall],
    here: [f64; 3],
    lights: f64,
    throughput: f64,
) -> Option<FoundLight> {
    let find = |function: &str| rest.iter().find(|step| step.function == function);
    let f = f64::from(*find("Bsdf::eval")?.got("f")?.get(1)?);
    let distance = squared_distance(here, triple(step.got("point")?));
    let density = step.number("pdf_area")? * distance / step.number("cos_light")? / lights;
    let other_density = find("Bsdf::pdf").and_then(|step| step.number("pdf"));
    let weight = other_density.map_or(1.0, |other| density / (density + other));
    let visible = find("Scene::occluded").and_then(|step| step.number("occluded")) == Some(0.0);
    let cos = find("Hit::cos").and_then(|step| step.number("cos")).unwrap_or(0.0);
    let emitted = f64::from(*step.got("emitted")?.get(1)?);
    let contribution = if visible { throughput * f * emitted * cos * weight / density } else { 0.0 };
    Some(FoundLight { density: Some(density), other_density, weight, contribution })
}
