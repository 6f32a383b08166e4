//! OBJ files.

mod concave;
mod numbers;
mod outline;

use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};

use self::outline::{Outline, Parts};
use super::materials::Materials;
use super::text;
use super::transform::Placement;
use super::warnings::Warnings;
use crate::diagnostic::Diagnostic;
use crate::input::{self, Reference};
use crate::scene::{Mesh, MeshTriangle};

/// Enough for some ten million triangles; more would not fit into memory.
const MAX_BYTES: u64 = 1 << 30;

/// Reads an OBJ file and transforms its vertices to world space.
pub(super) fn read(
    file: &Path,
    named: &Reference,
    placement: &Placement,
    materials: &mut Materials,
    warnings: &mut Warnings,
) -> Result<Mesh, Diagnostic> {
    let text = input::read(file, MAX_BYTES, Some(named))?;
    let text = text::join_continued_lines(&text);
    let outline = Outline::new(file, &text, warnings)?;
    let mesh = numbers_of(file, &text, &outline)?;
    let materials = materials_of_runs(file, &outline, materials, warnings)?;

    let zero_normals = warn_of_zero_normals(file, &text, &mesh, placement, warnings);
    let positions = triples(&mesh.positions).map(|position| placement.position(position)).collect::<Vec<_>>();
    if !positions.iter().all(|position| position.is_finite()) {
        let problem = "the transform moves vertices beyond the range of single precision";
        return Err(input::unreadable(file, Some(named), problem));
    }
    Ok(Mesh {
        positions,
        // A normal of length zero is not referred to; any unit vector will do.
        normals: triples(&mesh.normals).map(|normal| placement.normal(normal).unwrap_or(Vec3::Z)).collect(),
        uvs: mesh.texcoords.chunks_exact(2).map(Vec2::from_slice).collect(),
        triangles: triangles(&mesh, &outline, &materials, placement, &zero_normals),
    })
}

fn triples(values: &[f32]) -> impl Iterator<Item = Vec3> {
    values.chunks_exact(3).map(Vec3::from_slice)
}

/// Reads the numbers with `tobj` and checks that they are finite.
fn numbers_of(file: &Path, text: &str, outline: &Outline<'_>) -> Result<tobj::Mesh, Diagnostic> {
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let blame = |problem: String| {
        numbers::first_wrong_line(file, text).unwrap_or_else(|| Diagnostic::about(file, problem))
    };
    let (models, _) = tobj::load_obj_buf(&mut Parts::new(text, &outline.geometry), &options, no_materials)
        .map_err(|error| blame(format!("cannot be read: {error}")))?;
    // Names of objects and materials are not passed to `tobj`, so there is a single mesh.
    let mut mesh = models.into_iter().next().map(|model| model.mesh).unwrap_or_default();
    let finite = |values: &[f32]| values.iter().all(|value| value.is_finite());
    if !(finite(&mesh.positions) && finite(&mesh.texcoords) && finite(&mesh.normals)) {
        return Err(blame("contains numbers that are not finite".into()));
    }
    let corners = 3 * outline.triangles;
    let complete = |indices: &[u32]| indices.is_empty() || indices.len() == corners;
    if mesh.indices.len() != corners || !complete(&mesh.texcoord_indices) || !complete(&mesh.normal_indices) {
        return Err(Diagnostic::about(file, "contains faces that cannot be triangulated"));
    }
    concave::triangulate(&mut mesh, &outline.polygons);
    Ok(mesh)
}

/// Finds the material of each run.
fn materials_of_runs(
    file: &Path,
    outline: &Outline<'_>,
    materials: &mut Materials,
    warnings: &mut Warnings,
) -> Result<Vec<u32>, Diagnostic> {
    let mut libraries = Vec::new();
    for &(line, names) in &outline.libraries {
        let named = Reference { file: file.to_owned(), line: Some(line) };
        for library in library_paths(file, names) {
            materials.read_library(&library, &named, warnings)?;
            libraries.push(library);
        }
    }
    outline
        .runs
        .iter()
        .map(|run| match run.material {
            Some((line, name)) if !libraries.is_empty() => {
                materials.find(&libraries, name, warnings)?.ok_or_else(|| {
                    let message = format!("no material `{name}` in {}", listed(&libraries));
                    Diagnostic::at(file, line, message)
                })
            }
            _ => {
                let why =
                    if libraries.is_empty() { "no `mtllib`" } else { "faces before the first `usemtl`" };
                let message = format!("{why}: using a grey diffuse material");
                warnings.once((file, "default material"), Diagnostic::about(file, message));
                Ok(materials.default_material())
            }
        })
        .collect()
}

/// The files named by `mtllib`: a single name, which may contain spaces, or several names separated by spaces.
fn library_paths(file: &Path, names: &str) -> Vec<PathBuf> {
    let whole = text::relative_to(file, names);
    let several: Vec<_> = names.split_ascii_whitespace().map(|name| text::relative_to(file, name)).collect();
    if !whole.exists() && several.iter().all(|path| path.exists()) { several } else { vec![whole] }
}

fn listed(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// For each normal, whether its length is zero. Warns if there are any.
fn warn_of_zero_normals(
    file: &Path,
    text: &str,
    mesh: &tobj::Mesh,
    placement: &Placement,
    warnings: &mut Warnings,
) -> Vec<bool> {
    let zero: Vec<bool> = triples(&mesh.normals).map(|normal| placement.normal(normal).is_none()).collect();
    let count = zero.iter().filter(|zero| **zero).count();
    if count > 0 {
        let message = format!("normals of length zero: {count}; their triangles are shaded flat");
        warnings.add(Diagnostic { file: file.to_owned(), line: numbers::first_zero_normal(text), message });
    }
    zero
}

/// Combines the data from `tobj` and the outline for each triangle.
fn triangles(
    mesh: &tobj::Mesh,
    outline: &Outline<'_>,
    materials: &[u32],
    placement: &Placement,
    zero_normals: &[bool],
) -> Vec<MeshTriangle> {
    // A reflection reverses the orientation; swapping two corners restores it.
    let corner = |indices: &[u32], triangle: usize| {
        let [a, b, c] = [0, 1, 2].map(|corner| indices[3 * triangle + corner]);
        if placement.mirrors { [a, c, b] } else { [a, b, c] }
    };
    let mut triangles = Vec::with_capacity(outline.triangles);
    for (number, (run, &material)) in outline.runs.iter().zip(materials).enumerate() {
        let end = outline.runs.get(number + 1).map_or(outline.triangles, |next| next.first);
        triangles.extend((run.first..end).map(|triangle| {
            MeshTriangle {
                positions: corner(&mesh.indices, triangle),
                normals: run
                    .normals
                    .then(|| corner(&mesh.normal_indices, triangle))
                    .filter(|normals| !normals.iter().any(|&normal| zero_normals[normal as usize])),
                uvs: run.uvs.then(|| corner(&mesh.texcoord_indices, triangle)),
                material,
            }
        }));
    }
    triangles
}
