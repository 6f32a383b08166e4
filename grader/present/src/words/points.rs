//! Sums of points.

use verdict::report::{Points, Report};

use super::number::number_of_points;

/// The sum of points, what it does not cover, and how long it took: one line.
pub fn sum(report: &Report) -> String {
    let points = &report.points;
    let rest = not_covered(points);
    let rest = if rest.is_empty() { rest } else { format!("; {rest}") };
    format!(
        "{} of {}, graded automatically{rest} ({:.1} s)",
        points.earned,
        number_of_points(points.automatic_max),
        report.cost.total
    )
}

/// Points that only staff can decide.
pub(crate) fn staff_only(points: f64) -> String {
    let is = if points == 1.0 { "is" } else { "are" };
    format!("up to {} {is} added after submission", number_of_points(points))
}

/// What the sum of points does not cover; empty if it covers everything.
pub fn not_covered(points: &Points) -> String {
    let mut parts = Vec::new();
    if points.staff_only > 0.0 {
        parts.push(staff_only(points.staff_only));
    }
    match points.manual {
        Some(given) => parts.push(format!("your tutor gave {given} of {}", points.manual_max)),
        None if points.manual_max == 1.0 => parts.push("1 more is graded by your tutor".to_owned()),
        None if points.manual_max > 0.0 => {
            parts.push(format!("{} more are graded by your tutor", points.manual_max));
        }
        None => {}
    }
    parts.join("; ")
}
