//! **arty**: a small physically based renderer for teaching light transport.
//!
//! An [`Integrator`](integrator::Integrator) estimates the radiance that arrives along a ray; all else is here to
//! serve it. To read the code, follow this order: each module needs only those above it.
//!
//! | module | what it is about |
//! |---|---|
//! | [`math`] | colours, directions, maps from random numbers to directions |
//! | [`sampler`] | random numbers, a stream for each (seed, pixel, sample) |
//! | [`ray`] | rays |
//! | [`accel`] | finding the triangle that a ray hits |
//! | [`bsdf`] | how surfaces scatter light |
//! | [`light`] | light sources |
//! | [`camera`] | from pixels to rays |
//! | [`scene`] | scenes: their files, what they have, what a ray hits in them |
//! | [`integrator`] | what a light transport algorithm is |
//! | [`film`], [`render`](mod@render) | gathering samples |
//! | [`srgb`], `image` | pictures in memory, in files, in a viewer |
//! | `cli` | the program around all this |
//! | `probe` | what the grader may script, switch off and count; in no other build |
//!
//! # Units and conventions
//! Positions and directions are in world space, right-handed. Directions are unit vectors that point away from the
//! surface, towards the viewer (`wo`) or the light (`wi`). Radiance is in W·sr⁻¹·m⁻², where the metre is the
//! scene's unit of length. Densities of directions are per solid angle, densities of points on lights per area.
//! Lights emit from their front only: the side from which their vertices run counter-clockwise.

pub mod accel;
pub mod bsdf;
pub mod camera;
#[cfg(feature = "cli")]
pub mod cli;
mod dedup;
pub mod diagnostic;
pub mod film;
#[cfg(feature = "files")]
pub mod image;
#[cfg(feature = "files")]
mod input;
pub mod integrator;
pub mod light;
pub mod math;
pub mod prelude;
#[cfg(feature = "probe")]
pub mod probe;
pub mod ray;
pub mod render;
pub mod sampler;
pub mod scene;
pub mod srgb;
#[cfg(feature = "files")]
pub mod yaml;
