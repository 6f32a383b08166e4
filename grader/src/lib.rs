//! Judges hand-ins: builds them, runs them apart, compares what they render with what is right, reports.
//!
//! The way of a hand-in: [`submission`] reads it, [`build`] makes a program of it, [`host_process`] runs that
//! program, [`checks`] ask it for numbers and judge them with [`statistics`] against [`mod@reference`]s or closed
//! forms, [`mod@grade`] turns verdicts into points by the [`rubric`], [`report`] says what was found. [`mutants`] holds all of it to
//! hand-ins whose mistakes are known.

pub mod build;
pub mod checks;
pub mod commands;
pub mod error;
pub mod grade;
pub mod host_process;
pub mod mutants;
pub mod plan;
pub mod reference;
pub mod replay;
pub mod report;
pub mod rubric;
pub mod stability;
pub mod statistics;
pub mod submission;
pub mod workspace;
