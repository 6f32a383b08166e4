//! A quantity measured over many decades of one parameter.

use serde::Serialize;

/// Measurements along one axis.
#[derive(Clone, Debug, Serialize)]
pub struct Sweep {
    /// Its name, and that of its files.
    pub name: &'static str,
    /// Description, the caption of the plot.
    pub about: &'static str,
    /// Label of the x axis.
    pub axis: &'static str,
    /// Label of the y axis.
    pub measure: &'static str,
    /// Largest absolute value of y that is right.
    pub limit: f64,
    /// The curves.
    pub series: Vec<Series>,
}

/// One curve.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    /// Its name.
    pub name: String,
    /// Ascending in x.
    pub points: Vec<Point>,
}

/// One measurement.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Point {
    /// The parameter.
    pub x: f64,
    /// The measured value; not finite if there is none.
    pub y: f64,
    /// The part of y that noise alone would explain.
    pub noise: f64,
    /// Samples that were NaN, infinite or negative.
    pub anomalies: u64,
    /// A remark, such as a warning of the loader.
    pub note: String,
}

impl Point {
    /// True if it is right within limit and noise.
    pub fn is_right(&self, limit: f64) -> bool {
        self.anomalies == 0 && self.y.abs() <= limit + self.noise
    }
}

impl Series {
    /// The longest range of x in which every point is right; `None` if there is none.
    pub fn right_range(&self, limit: f64) -> Option<[f64; 2]> {
        let mut best: Option<(usize, [f64; 2])> = None;
        let mut start = 0;
        for (index, point) in self.points.iter().enumerate() {
            if !point.is_right(limit) {
                start = index + 1;
            } else if best.is_none_or(|(length, _)| index + 1 - start > length) {
                best = Some((index + 1 - start, [self.points[start].x, point.x]));
            }
        }
        best.map(|(_, range)| range)
    }
}

/// Powers of ten, both ends included.
pub fn decades(first: i32, last: i32) -> impl Iterator<Item = f64> + Clone {
    (first..=last).map(|exponent| 10f64.powi(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_is_the_longest_run_without_an_error_or_an_anomaly() {
        let point = |x: f64, y: f64, anomalies| Point { x, y, anomalies, ..Point::default() };
        let series = |points: Vec<Point>| Series { name: String::new(), points };
        let some = series(vec![
            point(1.0, 0.0, 0),
            point(2.0, f64::NAN, 0),
            point(3.0, -1e-4, 0),
            point(4.0, 1e-4, 0),
            point(5.0, 0.0, 1),
            point(6.0, 0.5, 0),
        ]);
        assert_eq!(some.right_range(1e-3), Some([3.0, 4.0]));
        assert_eq!(series(vec![point(1.0, 1.0, 0)]).right_range(1e-3), None);
        assert_eq!(series(Vec::new()).right_range(1e-3), None);
    }
}
