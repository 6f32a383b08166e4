//! Flat shapes and blocks.

use glam::{DAffine3, DVec2, DVec3};

use crate::surface::Surface;

/// A rectangle given by its centre and by half of each side. Its front is the side of `right × up`.
pub(crate) fn rectangle(center: DVec3, right: DVec3, up: DVec3) -> Surface {
    tessellated_rectangle(center, right, up, 1, 1)
}

/// A [`rectangle`] of `columns · rows` pairs of triangles.
pub(crate) fn tessellated_rectangle(
    center: DVec3,
    right: DVec3,
    up: DVec3,
    columns: usize,
    rows: usize,
) -> Surface {
    sheet(columns, rows, |u, v| center + (2.0 * u - 1.0) * right + (2.0 * v - 1.0) * up)
}

/// A curved sheet of `columns · rows` pairs of triangles through `point(u, v)`, with u and v in \[0, 1\].
/// Its front is the side of `∂u × ∂v`.
pub(crate) fn sheet(columns: usize, rows: usize, point: impl Fn(f64, f64) -> DVec3) -> Surface {
    let mut positions = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            positions.push(point(column as f64 / columns as f64, row as f64 / rows as f64));
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let lower_left = row * (columns + 1) + column;
            let upper_left = lower_left + columns + 1;
            triangles.push([lower_left, lower_left + 1, upper_left + 1]);
            triangles.push([lower_left, upper_left + 1, upper_left]);
        }
    }
    Surface::new(positions, triangles)
}

/// A rectangle that faces up, at the height `y`, over the given ranges of x and z.
pub(crate) fn floor(y: f64, [x0, x1]: [f64; 2], [z0, z1]: [f64; 2]) -> Surface {
    let center = DVec3::new((x0 + x1) / 2.0, y, (z0 + z1) / 2.0);
    rectangle(center, DVec3::X * (x1 - x0) / 2.0, DVec3::NEG_Z * (z1 - z0) / 2.0)
}

/// A rectangle that faces down, at the height `y`, over the given ranges of x and z.
pub(crate) fn ceiling(y: f64, x: [f64; 2], z: [f64; 2]) -> Surface {
    floor(y, x, z).flipped()
}

/// The same rectangle with a texture laid over it `across` times along its first side, `along` times along
/// the other.
pub(crate) fn textured(mut rectangle: Surface, across: f64, along: f64) -> Surface {
    rectangle.uvs =
        [[0.0, 0.0], [across, 0.0], [0.0, along], [across, along]].map(DVec2::from_array).to_vec();
    rectangle
}

/// An upright rectangle centred at `center` that faces `target`.
pub(crate) fn panel_facing(center: DVec3, target: DVec3, half_width: f64, half_height: f64) -> Surface {
    panel(center, target - center, half_width, half_height)
}

/// A rectangle that faces along `normal`, with its width horizontal.
pub(crate) fn panel(center: DVec3, normal: DVec3, half_width: f64, half_height: f64) -> Surface {
    let normal = normal.normalize();
    let right = DVec3::Y.cross(normal).normalize();
    rectangle(center, right * half_width, normal.cross(right) * half_height)
}

/// Which faces of a block are made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bottom {
    /// The block stands on something: its lower face would only lie in the floor.
    Open,
    /// All six faces.
    Closed,
}

/// A block with its front outside. `foot` is the middle of its lower face; it is turned by `degrees` about
/// the vertical through it.
pub(crate) fn block(foot: DVec3, size: DVec3, degrees: f64, bottom: Bottom) -> Surface {
    tapered_block(foot, size, 1.0, degrees, bottom)
}

/// A [`block`] that gets narrower upwards: its top is `top_share` as wide and deep as its foot.
pub(crate) fn tapered_block(
    foot: DVec3,
    size: DVec3,
    top_share: f64,
    degrees: f64,
    bottom: Bottom,
) -> Surface {
    let placed = DAffine3::from_translation(foot) * DAffine3::from_rotation_y(degrees.to_radians());
    // Corner number 4x + 2y + z, each coordinate 0 or 1.
    let positions = (0..8)
        .map(|corner| {
            let [x, y, z] = [corner >> 2 & 1, corner >> 1 & 1, corner & 1].map(f64::from);
            let width = if y == 1.0 { top_share } else { 1.0 };
            placed.transform_point3(DVec3::new((x - 0.5) * width, y, (z - 0.5) * width) * size)
        })
        .collect();
    let mut faces = vec![
        [3, 7, 6, 2], // top
        [1, 5, 7, 3], // front, towards +z
        [4, 0, 2, 6], // back
        [5, 4, 6, 7], // right, towards +x
        [0, 1, 3, 2], // left
    ];
    if bottom == Bottom::Closed {
        faces.push([0, 4, 5, 1]);
    }
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Surface::new(positions, triangles)
}
