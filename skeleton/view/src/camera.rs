//! Moving the camera.

use arty::camera::CameraDescription;
use arty::math::Vec3;

/// Smallest angle between the view direction and the up direction, in degrees.
const POLE: f32 = 2.0;

/// A camera that can be moved, and where it was in the beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraControl {
    home: CameraDescription,
    now: CameraDescription,
}

/// Unit vectors of a camera, in world space.
struct Axes {
    forward: Vec3,
    right: Vec3,
    up: Vec3,
}

impl CameraControl {
    /// The camera of a scene.
    pub fn new(home: CameraDescription) -> Self {
        Self { home, now: home }
    }

    /// Where the camera is.
    pub fn now(&self) -> CameraDescription {
        self.now
    }

    /// Moves the camera to another place; [`home`](Self::home) stays the scene's.
    pub fn move_to(&mut self, camera: CameraDescription) {
        self.now = camera;
    }

    /// Moves the camera back to where it was in the beginning.
    pub fn home(&mut self) {
        self.now = self.home;
    }

    /// Moves the camera around the centre of the picture: to the right and up, in degrees.
    ///
    /// It does not get past the up direction.
    pub fn orbit(&mut self, right: f32, up: f32) {
        let axes = self.axes();
        let from_center = self.now.eye - self.now.center;
        let above = axes.forward.dot(-self.now.up.normalize()).clamp(-1.0, 1.0).asin().to_degrees();
        let up = (above + up).clamp(POLE - 90.0, 90.0 - POLE) - above;
        let lifted = rotate(from_center, axes.right, -up);
        self.now.eye = self.now.center + rotate(lifted, self.now.up.normalize(), right);
    }

    /// Shifts camera and centre in the plane of the picture, in widths of the picture at the distance of its centre.
    pub fn pan(&mut self, right: f32, up: f32) {
        let axes = self.axes();
        let width = 2.0 * (0.5 * self.now.fov).to_radians().tan() * self.distance();
        self.shift(width * (right * axes.right + up * axes.up));
    }

    /// Moves the camera towards the centre: a tenth of its distance per step, away from it for negative steps.
    pub fn zoom(&mut self, steps: f32) {
        let from_center = self.now.eye - self.now.center;
        self.now.eye = self.now.center + 0.9_f32.powf(steps) * from_center;
    }

    /// Walks: moves camera and centre, in distances between them.
    pub fn walk(&mut self, right: f32, up: f32, forward: f32) {
        let axes = self.axes();
        self.shift(self.distance() * (right * axes.right + up * axes.up + forward * axes.forward));
    }

    /// The camera as a line of a scene file.
    pub fn yaml(&self) -> String {
        let CameraDescription { eye, center, up, fov } = self.now;
        let list = |v: Vec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
        format!(
            "camera: !perspective_camera {{ eye: {}, center: {}, up: {}, fov: {fov} }}",
            list(eye),
            list(center),
            list(up)
        )
    }

    fn distance(&self) -> f32 {
        self.now.eye.distance(self.now.center)
    }

    fn shift(&mut self, by: Vec3) {
        self.now.eye += by;
        self.now.center += by;
    }

    fn axes(&self) -> Axes {
        let forward = (self.now.center - self.now.eye).normalize();
        let right = forward.cross(self.now.up).normalize();
        Axes { forward, right, up: right.cross(forward) }
    }
}

/// Rotates a vector about a unit axis, counter-clockwise as seen against the axis (Rodrigues' formula).
fn rotate(v: Vec3, axis: Vec3, degrees: f32) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    cos * v + sin * axis.cross(v) + (1.0 - cos) * axis.dot(v) * axis
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> CameraControl {
        let center = Vec3::new(0.0, 1.0, 0.0);
        CameraControl::new(CameraDescription {
            eye: Vec3::new(0.0, 1.0, 4.0),
            center,
            up: Vec3::Y,
            fov: 90.0,
        })
    }

    fn near(a: Vec3, b: Vec3) -> bool {
        a.distance(b) < 1e-5
    }

    #[test]
    fn orbiting_keeps_the_distance_and_goes_to_the_right_and_up() {
        let mut right = camera();
        right.orbit(90.0, 0.0);
        assert!(near(right.now().eye, Vec3::new(4.0, 1.0, 0.0)), "{:?}", right.now());
        let mut up = camera();
        up.orbit(0.0, 30.0);
        assert!(near(up.now().eye, Vec3::new(0.0, 3.0, 4.0 * 0.75_f32.sqrt())), "{:?}", up.now());
        assert_eq!(up.now().center, camera().now().center);
    }

    #[test]
    fn orbiting_stops_before_the_pole() {
        let mut camera = camera();
        for _ in 0..100 {
            camera.orbit(3.0, 10.0);
        }
        let direction = (camera.now().eye - camera.now().center).normalize();
        assert!((direction.y - (90.0 - POLE).to_radians().sin()).abs() < 1e-4, "{direction}");
        camera.orbit(0.0, -300.0);
        assert!(camera.now().eye.is_finite() && camera.now().eye.y < 1.0);
    }

    #[test]
    fn panning_and_walking_move_camera_and_centre_alike() {
        let mut camera = camera();
        camera.pan(0.5, 0.25);
        // The picture is 8 wide at distance 4.
        assert!(near(camera.now().eye, Vec3::new(4.0, 3.0, 4.0)), "{:?}", camera.now());
        camera.walk(-1.0, -0.5, 0.25);
        assert!(near(camera.now().eye, Vec3::new(0.0, 1.0, 3.0)), "{:?}", camera.now());
        assert!(near(camera.now().center, Vec3::new(0.0, 1.0, -1.0)), "{:?}", camera.now());
    }

    #[test]
    fn zooming_in_and_out_again_and_home_lead_back() {
        let mut control = camera();
        control.zoom(3.0);
        assert!((control.now().eye.z - 4.0 * 0.729).abs() < 1e-5);
        control.zoom(-3.0);
        assert!(near(control.now().eye, camera().now().eye));
        control.walk(0.3, 0.2, 0.1);
        control.home();
        assert_eq!(control, camera());
    }

    #[test]
    fn the_yaml_line_reads_back_as_the_same_camera() {
        let mut control = camera();
        control.orbit(17.0, 11.0);
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("scene.yml");
        std::fs::write(&file, format!("meshes: []\n{}\n", control.yaml())).expect("writing works");
        let loaded = arty::scene::file::load(&file).expect("a valid scene");
        assert_eq!(loaded.description.camera, control.now());
    }
}
