//! Linear least squares.

/// Coefficients of the least-squares fit y ≈ c₀ + c₁x₁ + … + c_Kx_K.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit<const K: usize> {
    /// c₀.
    pub intercept: f64,
    /// c₁ to c_K.
    pub slopes: [f64; K],
    /// Root mean square of the residuals.
    pub residual: f64,
}

/// Fits a hyperplane to points (x, y); `None` if there are too few points or they do not determine it.
pub fn fit<const K: usize>(points: &[([f64; K], f64)]) -> Option<Fit<K>> {
    if points.len() < 2 * (K + 1) {
        return None;
    }
    // The normal equations, with the right-hand side as the last column.
    let row = |point: &([f64; K], f64)| -> Vec<f64> {
        std::iter::once(1.0).chain(point.0).chain(std::iter::once(point.1)).collect()
    };
    let mut matrix = vec![vec![0.0; K + 2]; K + 1];
    for row in points.iter().map(row) {
        for i in 0..=K {
            for j in 0..K + 2 {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    let solution = solve(matrix)?;
    let predicted =
        |x: &[f64; K]| solution[0] + x.iter().zip(&solution[1..]).map(|(x, slope)| x * slope).sum::<f64>();
    let squares: f64 = points.iter().map(|(x, y)| (y - predicted(x)).powi(2)).sum();
    Some(Fit {
        intercept: solution[0],
        slopes: std::array::from_fn(|k| solution[k + 1]),
        residual: (squares / points.len() as f64).sqrt(),
    })
}

/// Intercept and slope of the weighted least-squares line through points (x, y), where `weight` is a function of y.
/// `None` if fewer than two different x have a weight.
pub fn line(points: &[(f64, f64)], weight: impl Fn(f64) -> f64) -> Option<[f64; 2]> {
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|&(x, y)| weight(y) * of(x, y)).sum::<f64>();
    let total = sum(&|_, _| 1.0);
    let (mean_x, mean_y) = (sum(&|x, _| x) / total, sum(&|_, y| y) / total);
    let spread = sum(&|x, _| (x - mean_x).powi(2));
    let slope = sum(&|x, y| (x - mean_x) * (y - mean_y)) / spread;
    slope.is_finite().then_some([mean_y - slope * mean_x, slope])
}

/// Gaussian elimination with partial pivoting; the last column is the right-hand side.
fn solve(mut matrix: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let count = matrix.len();
    for column in 0..count {
        let pivot =
            (column..count).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        matrix.swap(column, pivot);
        if matrix[column][column].abs() < 1e-9 {
            return None;
        }
        let pivot_row = matrix[column].clone();
        for (index, row) in matrix.iter_mut().enumerate() {
            if index != column {
                let factor = row[column] / pivot_row[column];
                row.iter_mut().zip(&pivot_row).for_each(|(value, pivot)| *value -= factor * pivot);
            }
        }
    }
    Some(matrix.iter().enumerate().map(|(i, row)| row[count] / row[i]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_fitted_by_weight_and_needs_two_places() {
        let points = [(1.0, 5.0), (2.0, 7.0), (4.0, 11.0), (8.0, -1e9)];
        let fitted = line(&points, |y| if y > 0.0 { 1.0 } else { 0.0 }).expect("two places");
        assert!((fitted[0] - 3.0).abs() < 1e-12 && (fitted[1] - 2.0).abs() < 1e-12, "{fitted:?}");
        assert_eq!(line(&points[..1], |_| 1.0), None);
    }

    #[test]
    fn a_plane_is_fitted_and_degenerate_points_are_refused() {
        let points: Vec<([f64; 2], f64)> = (0..10)
            .map(|i| [f64::from(i), f64::from(i * i % 7)])
            .map(|x| (x, 3.0 - 2.0 * x[0] + 0.5 * x[1]))
            .collect();
        let found = fit(&points).expect("ten points determine a plane");
        assert!((found.intercept - 3.0).abs() < 1e-9 && found.residual < 1e-9);
        assert!((found.slopes[0] + 2.0).abs() < 1e-9 && (found.slopes[1] - 0.5).abs() < 1e-9);
        assert_eq!(fit(&points[..5]), None);
        let line: Vec<([f64; 2], f64)> = points.iter().map(|(x, y)| ([x[0], 2.0 * x[0]], *y)).collect();
        assert_eq!(fit(&line), None);
    }
}
