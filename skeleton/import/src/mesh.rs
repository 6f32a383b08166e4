//! Triangles in world space.

use arty::diagnostic::Diagnostic;
use glam::{DMat3, DMat4, DVec3};
use gltf::mesh::{Mode, Primitive, Semantic};

use crate::accessor::{indices, vectors};
use crate::document::Document;
use crate::left_out::LeftOut;

/// A triangle mesh with one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Part {
    /// The mesh and the node that it comes from, for readers of the file.
    pub(crate) title: String,
    /// Positions in world space.
    pub(crate) positions: Vec<[f32; 3]>,
    /// Shading normals in world space, one per position; empty if it has none.
    pub(crate) normals: Vec<[f32; 3]>,
    /// Texture coordinates, one per position, from the lower left; empty if it has none.
    pub(crate) uvs: Vec<[f32; 2]>,
    /// Counter-clockwise seen from the front.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Index of the material.
    pub(crate) material: usize,
}

/// Reads a primitive; `None` if it has no triangles. `uv_set` is the set of texture coordinates that its texture uses.
///
/// # Errors
/// If its data are not valid.
pub(crate) fn read(
    document: &Document,
    primitive: &Primitive<'_>,
    to_world: &DMat4,
    uv_set: Option<u32>,
    item: &str,
    left_out: &mut LeftOut,
) -> Result<Option<Part>, Diagnostic> {
    let colors = primitive.attributes().any(|(semantic, _)| matches!(semantic, Semantic::Colors(_)));
    left_out.add_if(colors, || format!("{item}: its vertex colors"));
    left_out.add_if(primitive.morph_targets().len() > 0, || format!("{item}: its shape keys"));
    let mode = primitive.mode();
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        left_out.add(format!("{item}: its lines or points"));
        return Ok(None);
    }
    let positions =
        primitive.get(&Semantic::Positions).ok_or_else(|| document.error(item, "it has no positions"))?;
    let positions = vectors::<3>(document, &positions, &format!("{item}, positions"))?;
    let order = match primitive.indices() {
        Some(accessor) => indices(document, &accessor, positions.len(), &format!("{item}, indices"))?,
        None => (0..positions.len() as u32).collect(),
    };
    let of_each_vertex = |count: usize, what: &str| {
        let problem = || document.error(item, format!("{count} {what} for {} positions", positions.len()));
        if count == positions.len() { Ok(()) } else { Err(problem()) }
    };
    let mut normals = Vec::new();
    if let Some(accessor) = primitive.get(&Semantic::Normals) {
        normals = vectors::<3>(document, &accessor, &format!("{item}, normals"))?;
        of_each_vertex(normals.len(), "normals")?;
    }
    let mut uvs = Vec::new();
    if let Some(set) = uv_set {
        match primitive.get(&Semantic::TexCoords(set)) {
            Some(accessor) => {
                uvs = vectors::<2>(document, &accessor, &format!("{item}, texture coordinates"))?;
                of_each_vertex(uvs.len(), "texture coordinates")?;
            }
            None => left_out.add(format!("{item}: its texture, since it has no texture coordinates")),
        }
    }
    let matrix = DMat3::from_mat4(*to_world);
    let mirrors = matrix.determinant() < 0.0;
    // Times the determinant, this is the inverse transpose; its sign alone matters for a direction.
    let cofactors = DMat3::from_cols(
        matrix.y_axis.cross(matrix.z_axis),
        matrix.z_axis.cross(matrix.x_axis),
        matrix.x_axis.cross(matrix.y_axis),
    ) * if mirrors { -1.0 } else { 1.0 };
    let normal = |normal: [f32; 3]| (cofactors * double(normal)).normalize_or_zero().as_vec3().to_array();
    let position = |at: [f32; 3]| to_world.transform_point3(double(at)).as_vec3();
    let placed: Vec<_> = positions.iter().map(|at| position(*at)).collect();
    if placed.iter().any(|at| !at.is_finite()) {
        return Err(document.error(item, "a position in world space exceeds single precision"));
    }
    Ok(Some(Part {
        title: item.to_owned(),
        positions: placed.into_iter().map(|at| at.to_array()).collect(),
        normals: normals.into_iter().map(normal).collect(),
        // The origin of images is their upper left corner there, their lower left corner here.
        uvs: uvs.into_iter().map(|[u, v]| [u, 1.0 - v]).collect(),
        triangles: triangles(mode, &order, mirrors),
        material: 0,
    }))
}

fn double(vector: [f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}

/// The triangles of a list, strip or fan. A reflection reverses their orientation, and so must their order.
fn triangles(mode: Mode, order: &[u32], mirrors: bool) -> Vec<[u32; 3]> {
    let all: Vec<[u32; 3]> = match mode {
        Mode::TriangleStrip => {
            let turned = |(index, of): (usize, &[u32])| {
                if index % 2 == 0 { [of[0], of[1], of[2]] } else { [of[1], of[0], of[2]] }
            };
            order.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => {
            order.get(1..).unwrap_or_default().windows(2).map(|edge| [order[0], edge[0], edge[1]]).collect()
        }
        _ => order.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect(),
    };
    if mirrors { all.into_iter().map(|[a, b, c]| [a, c, b]).collect() } else { all }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_the_orientation() {
        let order = [0, 1, 2, 3, 4];
        assert_eq!(triangles(Mode::TriangleStrip, &order, false), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        assert_eq!(triangles(Mode::TriangleFan, &order, false), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert_eq!(triangles(Mode::Triangles, &order, true), [[0, 2, 1]]);
        assert!(triangles(Mode::TriangleFan, &[], false).is_empty());
    }
}
