//! The maps of the check: known by name, with radiances drawn from the grade's seed.

use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::EnvironmentDescription;
use glam::Quat;
use verdict::check::SampledMap;

/// The order in which the maps are tested: what most mistakes show in comes first.
pub(super) const ORDER: [SampledMap; 11] = [
    SampledMap::Constant,
    SampledMap::Rough,
    SampledMap::OneTexel,
    SampledMap::OneRow,
    SampledMap::OneColumn,
    SampledMap::Poles,
    SampledMap::Seam,
    SampledMap::Colours,
    SampledMap::Rotated,
    SampledMap::Black,
    SampledMap::BrightTexel,
];

/// A map. Radiances that are not given by its name depend on the seed.
pub(super) fn map(kind: SampledMap, seed: u64) -> EnvironmentDescription {
    let mut random = Sampler::new(seed, (0, 0), kind as u64);
    let mut texels = |width: u32, height: u32, mut radiance: Box<dyn FnMut(u32, u32, f32) -> Rgb>| {
        let mut texels = Vec::with_capacity((width * height) as usize);
        for row in 0..height {
            for column in 0..width {
                texels.push(radiance(column, row, random.next_1d()));
            }
        }
        EnvironmentDescription { width, height, texels, rotation: Quat::IDENTITY }
    };
    let only = |lit: bool| Rgb::gray(if lit { 2.0 } else { 0.0 });
    match kind {
        SampledMap::Constant => texels(12, 6, Box::new(|_, _, _| Rgb::gray(0.5))),
        SampledMap::OneTexel => texels(1, 1, Box::new(|_, _, random| Rgb::gray(0.1 + random))),
        SampledMap::Rough => texels(13, 7, Box::new(|_, _, random| rough(random))),
        SampledMap::OneRow => texels(9, 1, Box::new(|_, _, random| rough(0.3 + 0.7 * random))),
        SampledMap::OneColumn => texels(1, 9, Box::new(|_, _, random| rough(0.3 + 0.7 * random))),
        SampledMap::Poles => texels(4, 8, Box::new(move |_, row, _| only(row == 0 || row == 7))),
        SampledMap::Seam => texels(8, 4, Box::new(move |column, _, _| only(column == 0 || column == 7))),
        SampledMap::Colours => texels(6, 4, Box::new(|column, row, _| primary(column + row))),
        SampledMap::Rotated => EnvironmentDescription {
            rotation: Quat::from_axis_angle(Vec3::new(0.48, -0.6, 0.64), 2.3),
            ..texels(32, 16, Box::new(|_, _, random| rough(random)))
        },
        SampledMap::Black => texels(5, 3, Box::new(|_, _, _| Rgb::BLACK)),
        SampledMap::BrightTexel => {
            let place = (773, 300);
            texels(
                1000,
                1001,
                Box::new(move |column, row, _| Rgb::gray(if (column, row) == place { 1e6 } else { 1.0 })),
            )
        }
    }
}

/// A radiance between 0 and 1100; 0 with a probability of a fifth.
fn rough(random: f32) -> Rgb {
    let value = if random < 0.2 { 0.0 } else { (7.0 * random).exp() };
    Rgb::new(value, 0.7 * value, 0.4 * value)
}

fn primary(index: u32) -> Rgb {
    [Rgb::new(3.0, 0.0, 0.0), Rgb::new(0.0, 3.0, 0.0), Rgb::new(0.0, 0.0, 3.0)][(index % 3) as usize]
}
