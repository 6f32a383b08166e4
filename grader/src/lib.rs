//! Judges hand-ins: builds them, runs them apart, compares what they render with what is right, reports.
//!
//! The way of a hand-in: [`intake`] finds the [`submission`] in what was sent, [`build`] makes a program of it,
//! [`host_process`] runs that program in a [`sandbox`], [`checks`] ask it for numbers and judge them with [`statistics`] against [`mod@reference`]s or closed
//! forms, [`mod@grade`] turns verdicts into points by the [`rubric`], [`report`] says what was found. [`mutants`] holds all of it to
//! hand-ins whose mistakes are known; [`convergence`] measures error against run time, for no points.
//! [`export`] writes reports the way other systems want them; [`handout`] makes what students get.

pub mod build;
pub mod calibration;
pub mod checks;
pub mod class;
pub mod commands;
pub mod convergence;
pub mod diagnosis;
pub mod error;
pub mod export;
pub mod grade;
pub mod handout;
pub mod host_process;
pub mod image_error;
pub mod intake;
pub mod marks;
pub mod memory;
pub mod mutants;
pub mod plan;
pub mod policy;
pub mod reference;
pub mod replay;
pub mod report;
pub mod rubric;
pub mod sandbox;
pub mod scan;
pub mod stability;
pub mod statistics;
pub mod submission;
pub mod table;
pub mod text;
mod tree_hash;
mod trial;
pub mod workspace;
