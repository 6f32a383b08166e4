//! Paths drawn over the picture.

use arty::camera::Camera;
use arty::math::Vec3;

use super::Traced;
use super::describe::{ARRIVES, BLOCKED, HIT, UNTESTED};
use super::vertices::{Areas, Path};
use crate::canvas::{Canvas, Ink};
use crate::fit::Fit;

/// Draws the chosen path, and those after it faintly, as seen by a camera for the size of the picture.
pub fn draw(canvas: &mut Canvas<'_>, fit: &Fit, camera: &Camera, traced: &Traced, lights: Areas<'_>) {
    let Ok(paths) = &traced.paths else { return };
    let technique = traced.query.settings.technique;
    let mut pen = Pen { canvas, fit, camera };
    for (index, recorded) in paths.iter().enumerate().rev() {
        pen.path(&Path::new(recorded, technique, lights), index == 0);
    }
}

struct Pen<'a, 'b> {
    canvas: &'a mut Canvas<'b>,
    fit: &'a Fit,
    camera: &'a Camera,
}

impl Pen<'_, '_> {
    fn path(&mut self, path: &Path, chosen: bool) {
        let (width, cover) = if chosen { (2.0, 1.0) } else { (1.0, 0.15) };
        let mut from = path.origin;
        for vertex in &path.vertices {
            self.segment(from, vertex.point, width, Ink(HIT, cover));
            from = vertex.point;
        }
        if let Some(direction) = path.escaped {
            // Long enough to show where it goes.
            let length = path.vertices.last().map_or(1.0, |vertex| vertex.point.distance(path.origin));
            self.segment(from, from + 0.3 * length * direction, width, Ink(HIT, 0.5 * cover));
        }
        for vertex in &path.vertices {
            for sample in &vertex.light_samples {
                let color = match sample.arrives {
                    Some(true) => ARRIVES,
                    Some(false) => BLOCKED,
                    None => UNTESTED,
                };
                self.segment(vertex.point, sample.point, width, Ink(color, cover));
            }
        }
        if chosen {
            for (number, vertex) in path.vertices.iter().enumerate() {
                self.mark(vertex.point, number);
            }
        }
    }

    /// Marks a vertex by its number.
    fn mark(&mut self, point: Vec3, number: usize) {
        let seen = self.camera.project(point);
        if seen.z > 0.0 {
            let (x, y) = self.fit.to_window((seen.x, seen.y));
            self.canvas.disc((x, y), 4.0, Ink(0x00_00_00, 1.0));
            self.canvas.disc((x, y), 3.0, Ink(HIT, 1.0));
            self.canvas.text(x as i32 + 6, y as i32 - 4, 1, &number.to_string(), Ink(0xff_ff_ff, 1.0));
        }
    }

    /// Draws the part of a segment that is in front of the camera.
    fn segment(&mut self, from: Vec3, to: Vec3, width: f32, ink: Ink) {
        let depth = |point: Vec3| self.camera.project(point).z;
        let (a, b) = (depth(from), depth(to));
        let near = 1e-3 * a.max(b);
        if near.is_nan() || near <= 0.0 {
            return;
        }
        let cut = |behind: Vec3, at: f32, other: Vec3, other_at: f32| {
            if at >= near { behind } else { behind + (near - at) / (other_at - at) * (other - behind) }
        };
        let place = |point: Vec3| {
            let seen = self.camera.project(point);
            self.fit.to_window((seen.x, seen.y))
        };
        let (start, end) = (place(cut(from, a, to, b)), place(cut(to, b, from, a)));
        self.canvas.line(start, end, width, ink);
    }
}
