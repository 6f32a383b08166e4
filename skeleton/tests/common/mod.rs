//! Shared by the tests of the renderer; each test uses a part of it.
#![allow(dead_code, reason = "each test program is compiled with all of it")]

pub(crate) mod formulas;
pub(crate) mod quadrature;
pub(crate) mod scenes;
pub(crate) mod statistics;
