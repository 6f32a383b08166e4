//! What happens at the ends of what a renderer meets: very small and very large, very near and very far, very dim and
//! very bright.
//!
//! [`answers`] reads the table of `scenes/extreme/`, which says what each scene must show, [`measure`] renders a scene
//! and compares. [`sweeps`] take one number through many decades until the renderer breaks, and [`mod@write`] makes tables
//! and plots of that. All of this is about any program; `cargo lab limits` asks the solution, the check
//! `stability` a submission.

pub mod sweep;
pub mod sweeps;
pub mod write;
