//! A scene file: models, camera and lights.

use glam::DVec3;

use crate::number::{listed, precise, text};

/// One scene, written as `<name>.yml`.
pub(crate) struct SceneFile {
    /// The name without an ending.
    pub(crate) name: &'static str,
    /// Purpose of the scene: the comment at the top, line by line.
    pub(crate) about: &'static [&'static str],
    /// In the order of the file.
    pub(crate) models: Vec<ModelUse>,
    /// The camera.
    pub(crate) camera: Camera,
    /// Lights beside the emissive parts of the models.
    pub(crate) lights: Vec<Light>,
    /// Maximum number of bounces.
    pub(crate) max_bounces: u32,
}

/// An instance of a model.
pub(crate) struct ModelUse {
    /// Name of the model.
    pub(crate) model: &'static str,
    /// Transform, in the order of its steps.
    pub(crate) steps: Vec<Step>,
}

/// One step of a transform.
#[derive(Clone, Copy)]
pub(crate) enum Step {
    /// Equal in all directions.
    Scale(f64),
    /// About an axis through the origin, counter-clockwise seen from the axis' tip.
    Rotate { axis: DVec3, degrees: f64 },
    /// By a vector.
    Translate(DVec3),
}

/// A perspective camera.
pub(crate) struct Camera {
    /// The pinhole.
    pub(crate) eye: DVec3,
    /// The point at the centre of the image.
    pub(crate) center: DVec3,
    /// Horizontal angle of view in degrees.
    pub(crate) fov: f64,
}

/// A light that is given in the scene file itself.
pub(crate) enum Light {
    /// Equal intensity all around; `power` in watts.
    Point { position: DVec3, power: [f64; 3] },
    /// A cone; half-angles in degrees, `power` in watts.
    Spot { position: DVec3, target: DVec3, inner: f64, outer: f64, power: [f64; 3] },
    /// A triangle that emits from its front.
    Triangle { corners: [DVec3; 3], radiance: [f64; 3] },
}

impl ModelUse {
    /// A model as it is.
    pub(crate) fn plain(model: &'static str) -> Self {
        Self { model, steps: Vec::new() }
    }

    fn yaml(&self) -> String {
        if self.steps.is_empty() {
            return format!("  - \"{}.obj\"\n", self.model);
        }
        let steps: Vec<String> = self.steps.iter().map(Step::yaml).collect();
        format!("  - {{ file: \"{}.obj\", transform: [{}] }}\n", self.model, steps.join(", "))
    }
}

impl Step {
    fn yaml(&self) -> String {
        match *self {
            Self::Scale(factor) => format!("!scale {}", precise(factor)),
            Self::Rotate { axis, degrees } => {
                format!("!rotate {{ axis: {}, degrees: {} }}", listed(axis.to_array()), text(degrees))
            }
            Self::Translate(by) => format!("!translate {}", listed(by.to_array())),
        }
    }
}

impl Light {
    fn yaml(&self) -> String {
        let point = |point: DVec3| listed(point.to_array());
        match *self {
            Self::Point { position, power } => {
                format!("  - !point_light {{ position: {}, color: {} }}\n", point(position), listed(power))
            }
            Self::Spot { position, target, inner, outer, power } => format!(
                "  - !spot_light {{ position: {}, direction: {}, inner: {}, outer: {}, color: {} }}\n",
                point(position),
                point(target - position),
                text(inner),
                text(outer),
                listed(power)
            ),
            Self::Triangle { corners: [v0, v1, v2], radiance } => format!(
                "  - !triangle_light {{ v0: {}, v1: {}, v2: {}, color: {} }}\n",
                point(v0),
                point(v1),
                point(v2),
                listed(radiance)
            ),
        }
    }
}

impl SceneFile {
    /// The scene file.
    pub(crate) fn yaml(&self) -> String {
        let mut file = String::new();
        for line in self.about {
            file += &format!("# {line}\n");
        }
        file += "meshes:\n";
        for model in &self.models {
            file += &model.yaml();
        }
        let Camera { eye, center, fov } = self.camera;
        file += &format!(
            "camera: !perspective_camera {{ eye: {}, center: {}, up: [0, 1, 0], fov: {} }}\n",
            listed(eye.to_array()),
            listed(center.to_array()),
            precise(fov)
        );
        if !self.lights.is_empty() {
            file += "lights:\n";
            for light in &self.lights {
                file += &light.yaml();
            }
        }
        file += &format!("defaults: {{ width: 512, height: 412, max_bounces: {} }}\n", self.max_bounces);
        file
    }
}
