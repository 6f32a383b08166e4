//! A minimal ray caster to check scenes with. It shares no code with the renderer.

use glam::{DMat4, DVec3};

use crate::collection::Collection;
use crate::scene_file::{Light, SceneFile, Step};

/// One triangle of a scene, in world space.
pub(crate) struct PlacedTriangle {
    pub(crate) corners: [DVec3; 3],
    /// Name of its material.
    pub(crate) material: &'static str,
    pub(crate) is_lamp: bool,
}

impl PlacedTriangle {
    pub(crate) fn centroid(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / 3.0
    }

    pub(crate) fn front(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).normalize()
    }

    /// Distance along a ray (Möller and Trumbore 1997); none if it misses.
    fn distance(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let [a, b, c] = self.corners;
        let (ab, ac) = (b - a, c - a);
        let across = direction.cross(ac);
        let determinant = ab.dot(across);
        if determinant == 0.0 {
            return None;
        }
        let from_a = origin - a;
        let u = from_a.dot(across) / determinant;
        let v = direction.dot(from_a.cross(ab)) / determinant;
        let distance = ac.dot(from_a.cross(ab)) / determinant;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 1e-6).then_some(distance)
    }
}

/// All triangles of a scene, emissive ones and triangle lights included.
pub(crate) fn placed_triangles(collection: &Collection, scene: &SceneFile) -> Vec<PlacedTriangle> {
    let mut triangles = Vec::new();
    for used in &scene.models {
        let model = collection.model(used.model).expect("each model is there");
        let transform = used.steps.iter().fold(DMat4::IDENTITY, |sum, &step| matrix(step) * sum);
        for part in &model.parts {
            let place = |position| transform.transform_point3(position);
            triangles.extend(part.surface.triangles.iter().map(|triangle| PlacedTriangle {
                corners: part.surface.corners(triangle).map(place),
                material: part.material.name,
                is_lamp: part.material.is_lamp(),
            }));
        }
    }
    for light in &scene.lights {
        if let Light::Triangle { corners, .. } = *light {
            triangles.push(PlacedTriangle { corners, material: "triangle_light", is_lamp: true });
        }
    }
    triangles
}

fn matrix(step: Step) -> DMat4 {
    match step {
        Step::Scale(factor) => DMat4::from_scale(DVec3::splat(factor)),
        Step::Rotate { axis, degrees } => DMat4::from_axis_angle(axis.normalize(), degrees.to_radians()),
        Step::Translate(by) => DMat4::from_translation(by),
    }
}

/// The closest triangle that a ray hits, and its distance.
pub(crate) fn first_hit(
    triangles: &[PlacedTriangle],
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, &PlacedTriangle)> {
    triangles
        .iter()
        .filter_map(|triangle| Some((triangle.distance(origin, direction)?, triangle)))
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
}

/// Unit directions through the pixel centres of an image.
pub(crate) fn camera_directions(scene: &SceneFile, width: usize, height: usize) -> Vec<DVec3> {
    let forwards = (scene.camera.center - scene.camera.eye).normalize();
    let right = forwards.cross(DVec3::Y).normalize();
    let up = right.cross(forwards);
    let half_width = (scene.camera.fov.to_radians() / 2.0).tan();
    let pixel = 2.0 * half_width / width as f64;
    let place = |index: usize, count: usize| (index as f64 + 0.5 - count as f64 / 2.0) * pixel;
    (0..height)
        .flat_map(|row| (0..width).map(move |column| (column, row)))
        .map(|(column, row)| (forwards + right * place(column, width) - up * place(row, height)).normalize())
        .collect()
}
