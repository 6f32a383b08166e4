//! Numbers as written to files: at most four decimals, the same on every machine.

use glam::DVec3;

/// Resolution of written numbers: steps per unit.
///
/// Sines and the like differ in their last bits from one platform's library to the next. Four decimals are
/// far coarser than that, and at the size of our scenes far finer than anyone can see.
const STEPS: f64 = 1e4;

/// The nearest number that can be written.
pub(crate) fn snap(value: f64) -> f64 {
    (value * STEPS).round() / STEPS
}

/// The nearest point that can be written.
pub(crate) fn snap_point(point: DVec3) -> DVec3 {
    DVec3::new(snap(point.x), snap(point.y), snap(point.z))
}

/// A number without trailing zeros, and without a sign if it is zero.
pub(crate) fn text(value: f64) -> String {
    let fixed = format!("{value:.4}");
    let short = fixed.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

/// A number of any magnitude: as [`text`] writes it if four decimals hold it, else in full.
pub(crate) fn precise(value: f64) -> String {
    match value.abs() {
        magnitude if magnitude < 1e6 && (snap(value) - value).abs() <= 1e-12 * magnitude => text(value),
        1e-4..1e6 => format!("{value}"),
        _ => format!("{value:e}"),
    }
}

/// Three numbers separated by spaces, as in OBJ files.
pub(crate) fn spaced(values: [f64; 3]) -> String {
    values.map(text).join(" ")
}

/// Three numbers of any magnitude, separated by spaces.
pub(crate) fn spaced_precisely(values: [f64; 3]) -> String {
    values.map(precise).join(" ")
}

/// Three numbers of any magnitude as a YAML list.
pub(crate) fn listed(values: [f64; 3]) -> String {
    format!("[{}]", values.map(precise).join(", "))
}
