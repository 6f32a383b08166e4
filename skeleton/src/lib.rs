//! **arty**: a small physically based renderer for teaching light transport.
//!
//! Students start with the [`prelude`].
//!
//! An [`Integrator`](integrator::Integrator) estimates the radiance that arrives along a ray; everything else serves
//! it. Read the modules in this order: each one needs only those above it.
//!
//! | module | contents |
//! |---|---|
//! | [`math`] | colours, directions, maps from random numbers to directions |
//! | `dedup` | deduplication of geometry |
//! | `probe` | instrumentation for grader and window; without effect in every other build |
//! | [`sampler`] | random numbers, one stream for each (seed, pixel, sample) |
//! | [`ray`] | rays |
//! | [`accel`] | the acceleration structure: which triangle a ray hits |
//! | [`bsdf`] | how surfaces scatter light |
//! | [`light`] | light sources |
//! | [`environment`] | light that arrives from outside of the scene |
//! | [`camera`] | from pixels to rays |
//! | [`diagnostic`] | errors and warnings about input files |
//! | `input` | checks of input files, text files |
//! | `yaml` | YAML files |
//! | [`srgb`] | the sRGB transfer curve, exposure |
//! | `image` | images in memory, in files, in a viewer |
//! | [`scene`] | scenes: files, geometry, materials, what a ray hits |
//! | [`integrator`] | the interface of light transport algorithms |
//! | [`prelude`] | what an integrator needs, in one import |
//! | [`film`] | accumulation of samples |
//! | [`render`](mod@render) | from an integrator to a film |
//! | `cli` | the command line |
//!
//! # Units and conventions
//! Positions and directions are in world space, right-handed. Directions are unit vectors that point away from the
//! surface, towards the viewer (`wo`) or the light (`wi`). Radiance is in W·sr⁻¹·m⁻², where the metre is the
//! scene's unit of length. Densities of directions are per solid angle, densities of points on lights per area.
//! Lights emit from their front only: the side from which their vertices are counter-clockwise.

pub mod math;

mod dedup;
#[cfg(feature = "probe")]
pub mod probe;
// The same names without effect.
#[cfg(not(feature = "probe"))]
#[path = "no_probe.rs"]
mod probe;

pub mod sampler;

pub mod accel;
pub mod bsdf;
pub mod camera;
pub mod environment;
pub mod light;
pub mod ray;

pub mod diagnostic;
#[cfg(feature = "files")]
pub mod image;
#[cfg(feature = "files")]
mod input;
pub mod scene;
pub mod srgb;
#[cfg(feature = "files")]
pub mod yaml;

pub mod film;
pub mod integrator;
pub mod prelude;
pub mod render;

#[cfg(feature = "cli")]
pub mod cli;
