//! The test finds what it is for: samplers with one mistake each, and correct ones of different kinds.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use arty::environment::Environment;
use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::{Scene, SceneDescription};
use host::protocol::{SampledDirection, SampledDirections};
use verdict::check::{SampledMap, SamplingFlaw, SamplingTest};

use super::{SAMPLES, test_all};

/// What a sampler of these tests does differently.
#[derive(Clone, Copy, Debug, Default)]
struct Variant {
    /// Weights of rows have no sine.
    no_sine: bool,
    /// Texels are weighted by the mean of the channels.
    mean_of_channels: bool,
    /// Directions are uniform in (u, v) within a texel, with the density that belongs to this.
    uniform_in_uv: bool,
    /// … with the density of the other way.
    other_density: bool,
    /// The density is per (u, v) instead of solid angle.
    per_uv: bool,
    /// A part of a texel that samples are off to the right.
    shifted: f64,
    /// Directions are centres of texels.
    centres: bool,
    /// All directions are sampled alike.
    uniform: bool,
    /// Samples in a black map.
    in_the_dark: bool,
    /// Factor on the density of samples.
    factor: f32,
}

const RIGHT: Variant = Variant {
    no_sine: false,
    mean_of_channels: false,
    uniform_in_uv: false,
    other_density: false,
    per_uv: false,
    shifted: 0.0,
    centres: false,
    uniform: false,
    in_the_dark: false,
    factor: 1.0,
};

struct Tables<'a> {
    variant: Variant,
    environment: &'a Environment,
    sums: Vec<f64>,
}

impl<'a> Tables<'a> {
    fn new(variant: Variant, environment: &'a Environment) -> Self {
        let mut sums = vec![0.0];
        for index in 0..environment.width() * environment.height() {
            let row = index / environment.width();
            let texel = environment.texel(index % environment.width(), row);
            let value = |Rgb { r, g, b }: Rgb| f64::from(r + g + b) / 3.0;
            let luminance =
                if variant.mean_of_channels { value(texel) } else { f64::from(texel.luminance()) };
            let luminance = if variant.uniform { 1.0 } else { luminance };
            let sine = if variant.no_sine {
                1.0
            } else {
                (PI * (row as f64 + 0.5) / environment.height() as f64).sin()
            };
            sums.push(sums[index] + luminance * sine);
        }
        Self { variant, environment, sums }
    }

    fn total(&self) -> f64 {
        self.sums[self.sums.len() - 1]
    }

    fn sample(&self, sampler: &mut Sampler) -> Option<SampledDirection> {
        let (width, height) = (self.environment.width(), self.environment.height());
        if self.total() == 0.0 {
            let wi = Vec3::Y;
            return self.variant.in_the_dark.then(|| SampledDirection {
                wi,
                pdf: 1.0,
                density: self.pdf(wi),
            });
        }
        // Two numbers: one has not enough bits for a million texels.
        let (first, second) = sampler.next_2d();
        let random = (f64::from(first) + f64::from(second) / 16_777_216.0) * self.total();
        let texel = self.sums.partition_point(|&sum| sum <= random) - 1;
        let (column, row) = (texel % width, texel / width);
        let (right, down) = sampler.next_2d();
        let (right, down) =
            if self.variant.centres { (0.5, 0.5) } else { (f64::from(right), f64::from(down)) };
        let v = if self.variant.uniform_in_uv {
            (row as f64 + down) / height as f64
        } else {
            let cos = |row: usize| (PI * row as f64 / height as f64).cos();
            (cos(row) + down * (cos(row + 1) - cos(row))).clamp(-1.0, 1.0).acos() / PI
        };
        let u = (column as f64 + right + self.variant.shifted) / width as f64;
        let wi = self.environment.direction(u.fract() as f32, v as f32);
        let density = self.pdf(wi);
        (density > 0.0 || self.variant.shifted > 0.0).then_some(SampledDirection {
            wi,
            pdf: self.variant.factor * density,
            density,
        })
    }

    fn pdf(&self, wi: Vec3) -> f32 {
        let (width, height) = (self.environment.width(), self.environment.height());
        if self.total() == 0.0 {
            return 0.0;
        }
        let (u, v) = self.environment.uv(wi);
        let (column, row) = ((u * width as f32) as usize, ((v * height as f32) as usize).min(height - 1));
        let texel = row * width + column;
        let probability = (self.sums[texel + 1] - self.sums[texel]) / self.total();
        if probability == 0.0 {
            return 0.0;
        }
        let per_uv = probability * (width * height) as f64;
        let uniform_in_uv = self.variant.uniform_in_uv != self.variant.other_density;
        let density = if self.variant.per_uv {
            per_uv / (2.0 * PI * PI)
        } else if uniform_in_uv {
            per_uv / (2.0 * PI * PI * (PI * f64::from(v)).sin())
        } else {
            let cos = |row: usize| (PI * row as f64 / height as f64).cos();
            probability * width as f64 / (TAU * (cos(row) - cos(row + 1)))
        };
        density as f32
    }
}

fn tested(variant: Variant, seed: u64) -> SamplingTest {
    let mut sample = |scene: &SceneDescription, directions: Vec<Vec3>| {
        let scene = Scene::new(scene);
        let tables = Tables::new(variant, scene.environment().expect("it has one"));
        let samples = (0..SAMPLES)
            .map(|index| tables.sample(&mut Sampler::new(seed, (0, 0), u64::from(index))))
            .collect();
        let densities = directions.into_iter().map(|wi| tables.pdf(wi)).collect();
        Ok::<_, Infallible>(SampledDirections { samples, densities })
    };
    match test_all(seed, &mut sample) {
        Ok(test) => test,
    }
}

#[test]
fn correct_samplers_of_different_kinds_pass() {
    for seed in 0..3 {
        for variant in [RIGHT, Variant { uniform_in_uv: true, ..RIGHT }] {
            let test = tested(variant, seed);
            assert_eq!((test.flaw, test.maps), (None, 11), "{variant:?} {seed}: {test:?}");
        }
    }
}

#[test]
fn each_mistake_is_found_where_it_shows() {
    type Found = fn(SamplingFlaw) -> bool;
    let cases: [(Variant, SampledMap, Found); 11] = [
        (Variant { no_sine: true, ..RIGHT }, SampledMap::Constant, |flaw| {
            matches!(flaw, SamplingFlaw::Density { .. })
        }),
        (Variant { mean_of_channels: true, ..RIGHT }, SampledMap::Colours, |flaw| {
            matches!(flaw, SamplingFlaw::Density { .. })
        }),
        (Variant { uniform_in_uv: true, other_density: true, ..RIGHT }, SampledMap::Constant, |flaw| {
            flaw == SamplingFlaw::WithinTexels
        }),
        (Variant { other_density: true, ..RIGHT }, SampledMap::Constant, |flaw| {
            flaw == SamplingFlaw::WithinTexels
        }),
        (Variant { per_uv: true, ..RIGHT }, SampledMap::Constant, |flaw| flaw == SamplingFlaw::Integral),
        (Variant { shifted: 0.5, ..RIGHT }, SampledMap::Rough, |flaw| {
            matches!(flaw, SamplingFlaw::NoDensity | SamplingFlaw::Frequency { .. })
        }),
        (Variant { shifted: 0.02, ..RIGHT }, SampledMap::Rough, |flaw| {
            matches!(flaw, SamplingFlaw::NoDensity | SamplingFlaw::Frequency { .. })
        }),
        (Variant { centres: true, ..RIGHT }, SampledMap::Constant, |flaw| flaw == SamplingFlaw::WithinTexels),
        (Variant { uniform: true, ..RIGHT }, SampledMap::Rough, |flaw| {
            matches!(flaw, SamplingFlaw::Density { .. })
        }),
        (Variant { in_the_dark: true, ..RIGHT }, SampledMap::Black, |flaw| flaw == SamplingFlaw::InTheDark),
        (
            Variant { factor: 1.01, ..RIGHT },
            SampledMap::Constant,
            |flaw| matches!(flaw, SamplingFlaw::Disagree { share, .. } if share == 1.0),
        ),
    ];
    for (variant, map, is_expected) in cases {
        let test = tested(variant, 7);
        assert_eq!(test.map, map, "{variant:?}: {test:?}");
        assert!(test.flaw.is_some_and(is_expected), "{variant:?}: {test:?}");
    }
}
