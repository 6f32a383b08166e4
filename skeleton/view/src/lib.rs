//! **arty-view**: the renderer's window, `cargo view SCENE.yml`.
//!
//! The window refines a picture while keys and mouse move the camera, compares two techniques side by side, and draws the
//! paths of a pixel over the picture. It takes its algorithms as the command line does: a function that makes the
//! integrator for an [`Algorithm`](arty::cli::Algorithm).
//!
//! All state is kept apart from the window, which only passes on what keys and mouse do and shows the result. Read the
//! modules in this order:
//!
//! | module | contents |
//! |---|---|
//! | [`view`] | what a picture depends on |
//! | [`camera`] | moving the camera |
//! | [`look`] | exposure and tone map |
//! | [`keys`], [`pointer`](mod@pointer) | what keys and mouse mean |
//! | [`viewer`] | the state of the window, and what changes it |
//! | [`schedule`] | which pass comes next: coarse pictures first, then samples |
//! | [`part`], [`reference`](mod@reference) | a picture while it is refined, and what it is compared with |
//! | `orders`, [`renderer`] | the thread that renders the latest view |
//! | [`path`](mod@path) | the paths of a pixel: recorded calls, vertices, drawing |
//! | [`canvas`], [`fit`], [`paint`], [`title`] | what is in the window |
//! | `save` | image files |
//! | [`args`], [`reload`] | command line; compiling the algorithm again |
//! | `window`, `program` | the window itself and the program; with the feature `window` only |

pub mod args;
pub mod camera;
pub mod canvas;
pub mod fit;
pub mod keys;
pub mod look;
mod orders;
pub mod paint;
pub mod part;
pub mod path;
pub mod pointer;
#[cfg(feature = "window")]
mod program;
pub mod reference;
pub mod reload;
pub mod renderer;
mod save;
pub mod schedule;
pub mod title;
pub mod view;
pub mod viewer;
#[cfg(feature = "window")]
mod window;

pub use orders::Save;
#[cfg(feature = "window")]
pub use program::{Program, run};
