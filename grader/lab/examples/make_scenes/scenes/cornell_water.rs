//! The box with water in it: figure 2 of the sheet.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Light, ModelUse, SceneFile};
use crate::scenes::cornell;
use crate::shapes::sheet;
use crate::surface::Surface;

/// Height of the water at rest: a third of the room.
const LEVEL: f64 = 0.67;

/// The water ends a little behind the room's walls, so that there is no gap between them.
const OVERLAP: f64 = 0.004;

/// Its front stands a little behind the room's opening, by more than the overlap: else the camera would see
/// the overlap past the edges of the walls.
const FRONT: f64 = cornell::Z[1] - 0.02;

const COLUMNS: usize = 48;
const ROWS: usize = 44;

/// Waves: the phase in radians is `along_x · x + along_z · z + shift`.
struct Wave {
    height: f64,
    along_x: f64,
    along_z: f64,
    shift: f64,
}

const WAVES: [Wave; 4] = [
    Wave { height: 0.016, along_x: 5.1, along_z: 1.3, shift: 0.4 },
    Wave { height: 0.012, along_x: -3.2, along_z: 6.4, shift: 1.9 },
    Wave { height: 0.008, along_x: 9.7, along_z: 4.1, shift: 2.7 },
    Wave { height: 0.005, along_x: 2.1, along_z: -12.3, shift: 0.8 },
];

impl Wave {
    fn phase(&self, x: f64, z: f64) -> f64 {
        self.along_x * x + self.along_z * z + self.shift
    }
}

fn height(x: f64, z: f64) -> f64 {
    LEVEL + WAVES.iter().map(|wave| wave.height * wave.phase(x, z).sin()).sum::<f64>()
}

/// The surface's normal, upwards: (−∂h/∂x, 1, −∂h/∂z), normalised.
fn normal(x: f64, z: f64) -> DVec3 {
    let slope = |along: fn(&Wave) -> f64| -> f64 {
        WAVES.iter().map(|wave| wave.height * along(wave) * wave.phase(x, z).cos()).sum()
    };
    dvec3(-slope(|wave| wave.along_x), 1.0, -slope(|wave| wave.along_z)).normalize()
}

fn mix(from: f64, to: f64, share: f64) -> f64 {
    from + (to - from) * share
}

/// The wavy surface, smooth, with its front above.
pub(crate) fn top() -> Surface {
    let [left, right] = [cornell::X[0] - OVERLAP, cornell::X[1] + OVERLAP];
    let mut top = sheet(COLUMNS, ROWS, |u, v| {
        let (x, z) = (mix(left, right, u), mix(FRONT, cornell::Z[0] - OVERLAP, v));
        dvec3(x, height(x, z), z)
    });
    top.normals = top.positions.iter().map(|position| normal(position.x, position.z)).collect();
    top
}

/// The water's side towards the camera, where the room is open. Its upper edge is the edge of [`top`].
pub(crate) fn front() -> Surface {
    let [left, right] = [cornell::X[0] - OVERLAP, cornell::X[1] + OVERLAP];
    sheet(COLUMNS, 1, |u, v| {
        let x = mix(left, right, u);
        dvec3(x, mix(-OVERLAP, height(x, FRONT), v), FRONT)
    })
}

pub(super) fn add_to(collection: &mut Collection) {
    let water = Material::glass("water", 1.33, [0.94, 0.985, 1.0]);
    let front_water = Material { name: "water_front", ..water.clone() };
    collection.models.push(
        Model::new("cornell_water", "Water that fills a third of cornell_room, with waves")
            .with(water, top())
            .with(front_water, front()),
    );
    collection.models.push(
        Model::new("cornell_water_light", "A light under the ceiling of cornell_room").with(
            Material::lamp("water_light", [9.5, 8.5, 6.5]),
            cornell::ceiling_light([-0.8, 0.0], [-0.4, 0.4]),
        ),
    );
    collection.scenes.push(SceneFile {
        name: "cornell_box_water",
        about: &[
            "The box filled to a third with water, under a point light and a light with an area.",
            "Figure 2 of the sheet: a material and a light given by delta distributions.",
            "Shadow rays do not pass through water. What lies in it gets its direct light only from rays",
            "that are refracted and then hit the area light; of the point light it gets only what other",
            "surfaces scatter. Each part of the picture needs another technique.",
        ],
        models: ["cornell_room", "cornell_blocks", "cornell_water", "cornell_water_light"]
            .map(ModelUse::plain)
            .into(),
        camera: cornell::camera(),
        lights: vec![Light::Point { position: dvec3(0.6, 1.55, 0.25), power: [10.0, 11.0, 13.0] }],
        max_bounces: 12,
    });
}
