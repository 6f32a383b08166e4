//! **white-furnace**: inside a closed surface that emits the uniform radiance L_e, the image has a closed form.
//!
//! - A diffuse surface or mirror with albedo ρ: L_e (1 + ρ + … + ρᵏ) after up to k bounces. Each k is tested, and
//!   c_k = (L_k − L_{k−1}) / (L_e ρᵏ), which should be 1, shows which bounce is wrong.
//! - Any other surface, after one bounce: L_e (1 + ∫ f cos θ dω), by quadrature.
//! - Glass in front of a black emitting surface: L_e, if all paths end within the maximum number of bounces.
//!
//! The expected means do not depend on the reference; only the expected variance does.

mod albedo;

use arty::ray::Ray;
use arty::scene::{Material, Scene, Specular};

use verdict::check::{BounceEnergy, CheckKind, Evidence, FurnaceTest, WhyNot};
use verdict::error::Error;
use verdict::rubric::CheckSpec;

use super::closed_form::Pixels;
use super::context::{replay_of, switches_of};
use super::means::{self, Anomalies, Picture};
use super::{
    Check, CheckOutcome, GradeContext, JobError, Observation, Quantity, SceneWithReference, mean_bias,
};
use crate::reference::SIZE;
use crate::statistics::expected::Expected;
use crate::statistics::sequential::{Decision, Judgement};
use albedo::Quadrature;

/// Rays per pixel for albedos that depend on the angle.
const RAYS: u32 = 16;

pub(super) struct WhiteFurnace;

impl Check for WhiteFurnace {
    fn kind(&self) -> CheckKind {
        CheckKind::WhiteFurnace
    }

    fn applies(&self, scene: &SceneWithReference, _: &CheckSpec) -> Result<(), WhyNot> {
        Furnace::recognise(scene).map(drop)
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let scene = context.scene(spec);
        let furnace = Furnace::recognise(scene).map_err(|why| {
            Error::Input(format!("{}: the scene is not a white furnace ({why:?})", spec.id()))
        })?;
        let orders = furnace.orders(spec.max_bounces);
        let noise = mean_bias::expected(spec, &scene.reference)?;
        let scenes = [&scene.description];
        let mut process = context.start()?;
        let loaded = [process.load_with(&scene.description, switches_of(spec))?];
        let (mut anomalies, mut judgements) = (Anomalies::default(), Vec::new());
        for &order in &orders {
            let Pixels { mean, error } = furnace.picture(&scene.scene, order);
            let expected = Expected { mean, error, ..noise.clone() };
            let mut picture = Picture::of(context, spec, &scenes, &expected);
            picture.settings.max_bounces = order;
            picture.screening_level /= orders.len() as f64;
            picture.seed ^= u64::from(order).rotate_right(8);
            judgements.push(picture.judge_in(&mut process, &loaded, &mut anomalies)?);
        }
        // Report the first biased picture, or else the first inconclusive one, or else the last.
        let first = |decision| judgements.iter().position(|judgement| judgement.decision == decision);
        let worst = first(Decision::Biased).or(first(Decision::Unclear)).unwrap_or(judgements.len() - 1);
        let evidence = FurnaceTest {
            test: means::mean_test(&judgements[worst], spec.tolerance),
            max_bounces: orders[worst],
            energy: if orders.len() > 1 { furnace.energy(&judgements) } else { Vec::new() },
        };
        let samples = judgements.iter().map(|judgement| judgement.samples).sum();
        let outcome = means::conclude(&judgements[worst], Evidence::WhiteFurnace(evidence), samples);
        // A path with fewer bounces is a prefix of one with more, so that this target replays all of them.
        Ok(outcome.with(anomalies.numerics(Some(replay_of(spec)))))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::WhiteFurnace(furnace) = evidence else { return Vec::new() };
        let of = |(bounces, energy): (u32, &BounceEnergy)| {
            Observation::ratio(Quantity::BounceEnergy(bounces), energy.relative, 0.0)
        };
        Observation::of_mean(&furnace.test).into_iter().chain((0..).zip(&furnace.energy).map(of)).collect()
    }
}

/// A closed scene that emits uniformly.
struct Furnace {
    emission: [f64; 3],
    walls: Walls,
}

/// Scattering of the walls.
enum Walls {
    /// Their albedo is this constant, whatever the angle.
    Uniform([f64; 3]),
    /// Glossy walls: the albedo depends on the angle of incidence.
    Glossy,
    /// They are black, and all other surfaces are clear glass.
    Background,
}

impl Furnace {
    fn recognise(scene: &SceneWithReference) -> Result<Self, WhyNot> {
        let SceneWithReference { description, scene, .. } = scene;
        if !scene.features().closed {
            return Err(WhyNot::NotEnclosed);
        }
        let triangles = description.meshes.iter().flat_map(|mesh| &mesh.triangles);
        let mut used: Vec<u32> = triangles.map(|triangle| triangle.material).collect();
        used.sort_unstable();
        used.dedup();
        let used: Vec<&Material> = used.iter().map(|&index| &description.materials[index as usize]).collect();
        let (walls, inner): (Vec<&Material>, Vec<&Material>) =
            used.into_iter().partition(|material| !material.emission.is_black());
        let [wall] = walls[..] else { return Err(WhyNot::NotUniform) };
        let emission = wall.emission.to_array().map(f64::from);
        let black = wall.diffuse.is_black() && wall.specular == Specular::None;
        let share = |color: arty::math::Rgb| color.to_array().map(f64::from);
        let walls = match wall.specular {
            _ if !description.lights.is_empty() => return Err(WhyNot::NotUniform),
            _ if !inner.is_empty() => {
                if !(black && inner.iter().all(|material| is_clear_glass(material))) {
                    return Err(WhyNot::NotUniform);
                }
                Walls::Background
            }
            _ if wall.diffuse_map.is_some() => return Err(WhyNot::NotUniform),
            Specular::None => Walls::Uniform(share(wall.diffuse)),
            Specular::Mirror { reflectance } if wall.diffuse.is_black() => Walls::Uniform(share(reflectance)),
            _ => Walls::Glossy,
        };
        Ok(Self { emission, walls })
    }

    /// The maximum numbers of bounces that are tested.
    fn orders(&self, max_bounces: u32) -> Vec<u32> {
        match self.walls {
            Walls::Uniform(_) => (0..=max_bounces).collect(),
            Walls::Glossy => (0..=max_bounces.min(1)).collect(),
            Walls::Background => vec![max_bounces],
        }
    }

    /// Exact radiance of each pixel with up to `order` bounces, and its error.
    fn picture(&self, scene: &Scene, order: u32) -> Pixels {
        match self.walls {
            Walls::Uniform(_) => self.constant(std::array::from_fn(|channel| self.series(channel, order))),
            Walls::Glossy if order > 0 => self.glossy_picture(scene),
            Walls::Glossy | Walls::Background => self.constant(self.emission),
        }
    }

    /// The same radiance in all pixels, without an error.
    fn constant(&self, radiance: [f64; 3]) -> Pixels {
        let count = (SIZE.0 * SIZE.1) as usize;
        Pixels { mean: vec![radiance; count], error: vec![[0.0; 3]; count] }
    }

    /// L_e (1 + ρ + … + ρᵏ).
    fn series(&self, channel: usize, order: u32) -> f64 {
        let Walls::Uniform(albedo) = self.walls else { return self.emission[channel] };
        (0..=order).map(|bounce| self.emission[channel] * albedo[channel].powi(bounce as i32)).sum()
    }

    /// The albedo varies over a pixel, and its quadrature has an error, too.
    fn glossy_picture(&self, scene: &Scene) -> Pixels {
        let quadrature = Quadrature::new();
        let mut quadrature_error: f64 = 0.0;
        let radiance = |ray: &Ray| {
            let hit = scene.intersect(ray).ok_or(WhyNot::NotEnclosed)?;
            let albedo = quadrature.albedo(ray, &hit);
            quadrature_error = quadrature_error.max(albedo.error);
            Ok(std::array::from_fn(|c| self.emission[c] * (1.0 + albedo.value[c])))
        };
        // In a closed scene, every ray hits something.
        let mut pixels =
            Pixels::integrate(scene, RAYS, radiance).unwrap_or_else(|_| self.constant(self.emission));
        for error in &mut pixels.error {
            (0..3).for_each(|channel| error[channel] += self.emission[channel] * quadrature_error);
        }
        pixels
    }

    /// c_k for k = 0, 1, …, from the means of the whole image; empty if there is no series. Pictures of different
    /// orders are independent.
    fn energy(&self, judgements: &[Judgement]) -> Vec<BounceEnergy> {
        if !matches!(self.walls, Walls::Uniform(_)) {
            return Vec::new();
        }
        // The green channel suffices, since an error of a bounce is the same factor in each channel.
        let exact = |order: usize| self.series(1, order as u32);
        let seen = |order: usize| exact(order) * (1.0 + judgements[order].whole.relative());
        let margin = |order: usize| exact(order) * judgements[order].whole.relative_margin(CONFIDENCE);
        let of = |order: usize| {
            let (seen, exact, margin) = match order {
                0 => (seen(0), exact(0), margin(0)),
                _ => (
                    seen(order) - seen(order - 1),
                    exact(order) - exact(order - 1),
                    margin(order).hypot(margin(order - 1)),
                ),
            };
            let margin = Some(margin / exact).filter(|margin| margin.is_finite());
            BounceEnergy { relative: seen / exact, margin }
        };
        let energy: Vec<BounceEnergy> = (0..judgements.len()).map(of).collect();
        if energy.iter().all(|energy| energy.relative.is_finite()) { energy } else { Vec::new() }
    }
}

/// Confidence of the intervals of energies, as of all intervals in reports.
const CONFIDENCE: f64 = 0.99;

fn is_clear_glass(material: &Material) -> bool {
    let clear = |color: arty::math::Rgb| color == arty::math::Rgb::WHITE;
    let glass = matches!(
        material.specular,
        Specular::Glass { reflectance, transmittance, .. } if clear(reflectance) && clear(transmittance)
    );
    glass && material.diffuse.is_black()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::test_scenes;

    #[test]
    fn the_series_converges_to_its_limit() {
        let furnace = Furnace { emission: [0.5, 1.0, 0.0], walls: Walls::Uniform([0.5, 0.0, 0.9]) };
        assert_eq!((furnace.series(0, 0), furnace.series(0, 2)), (0.5, 0.875));
        assert!((furnace.series(0, 60) - 1.0).abs() < 1e-12);
        assert_eq!((furnace.series(1, 7), furnace.series(2, 7)), (1.0, 0.0));
    }

    /// References are rendered, closed forms are not. One of 4 · 768 deviates exceeds 6 in one of 160,000 sets of
    /// references. The enclosures are polyhedra, so that the closed form has an error of its own.
    #[test]
    fn closed_forms_agree_with_references() {
        for (name, order, tolerance) in [
            ("furnace_diffuse", 3, 1e-3),
            ("furnace_glossy", 1, 2e-3),
            ("furnace_mirror", 4, 1e-3),
            ("furnace_glass", 64, 5e-3),
        ] {
            let scene = test_scenes::load(name);
            let furnace = Furnace::recognise(&scene).unwrap_or_else(|why| panic!("{name}: {why:?}"));
            let view = verdict::rubric::View {
                max_bounces: order,
                emission_on_hit: verdict::rubric::EmissionOnHit::On,
            };
            let rendered = &scene.reference.views[&view];
            let pixels = furnace.picture(&scene.scene, order);
            for (pixel, (exact, error)) in pixels.mean.iter().zip(&pixels.error).enumerate() {
                for channel in 0..3 {
                    let (exact, seen) = (exact[channel], rendered.mean[pixel][channel]);
                    let noise = rendered.variance_of_mean[pixel][channel].sqrt().hypot(error[channel]);
                    let allowed = 6.0 * noise + tolerance * exact;
                    assert!(
                        (exact - seen).abs() <= allowed,
                        "{name}, pixel {pixel}: {seen} instead of {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn other_scenes_are_refused_with_the_reason() {
        for (name, expected) in [("cornell_box", WhyNot::NotEnclosed), ("furnace_cap", WhyNot::NotUniform)] {
            assert_eq!(Furnace::recognise(&test_scenes::load(name)).err(), Some(expected), "{name}");
        }
    }

    /// In a sphere with an emitting fraction f of its area, the reflected radiance is f L_e (ρ + … + ρᵏ) everywhere.
    #[test]
    fn a_sphere_with_an_emitting_cap_is_lit_uniformly() {
        let scene = test_scenes::load("furnace_cap");
        let area = |index: u32| -> f64 {
            let mesh = &scene.description.meshes[0];
            let triangles = mesh.triangles.iter().filter(|triangle| triangle.material == index);
            triangles
                .map(|triangle| {
                    let [a, b, c] =
                        triangle.positions.map(|corner| mesh.positions[corner as usize].as_dvec3());
                    (b - a).cross(c - a).length() / 2.0
                })
                .sum()
        };
        let (cap, wall) = (&scene.description.materials[0], &scene.description.materials[1]);
        let share = area(0) / (area(0) + area(1));
        assert!(!cap.emission.is_black() && wall.emission.is_black());
        assert!((share - 0.2).abs() < 0.01, "{share}");
        let view =
            verdict::rubric::View { max_bounces: 8, emission_on_hit: verdict::rubric::EmissionOnHit::On };
        let rendered = &scene.reference.views[&view];
        for channel in 0..3 {
            let (emission, albedo) =
                (f64::from(cap.emission.to_array()[channel]), f64::from(wall.diffuse.to_array()[channel]));
            let exact: f64 = (1..=8).map(|k| share * emission * albedo.powi(k)).sum();
            // Pixels that show part of the cap also contain its emission.
            let dark = rendered.mean.iter().filter(|mean| mean[channel] < exact + 0.05 * emission);
            let (sum, count) = dark.fold((0.0, 0), |(sum, count), mean| (sum + mean[channel], count + 1));
            let seen = sum / f64::from(count);
            assert!(
                count > 100 && (seen / exact - 1.0).abs() < 0.01,
                "channel {channel}: {seen} instead of {exact}"
            );
        }
    }
}
