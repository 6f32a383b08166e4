//! Features of scenes, and whether they are closed.

mod common;

use arty::math::{Rgb, Vec2, Vec3};
use arty::scene::{Features, LightDescription, Material, Scene, SceneDescription, Specular, Texture};
use common::scenes::{add, add_lights, black, diffuse, empty, glass, icosphere, mirror, phong, quad, room};

fn features(scene: &SceneDescription) -> Features {
    Scene::new(scene).features().clone()
}

fn with(triangles: &[[Vec3; 3]], material: Material) -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, triangles, material);
    scene
}

const LOW: Vec3 = Vec3::new(-1.0, -2.0, -3.0);
const HIGH: Vec3 = Vec3::new(1.5, 1.0, 2.0);

#[test]
fn an_empty_scene_has_no_features() {
    let features = features(&empty());
    assert_eq!((features.triangles, features.area_lights, features.point_lights), (0, 0, 0));
    assert!(!features.closed && !features.hierarchy && !features.has_lights());
}

#[test]
fn each_kind_of_surface_and_light_is_counted() {
    let mut scene = empty();
    let square = quad(Vec3::new(0.0, 0.0, -2.0), Vec3::X, Vec3::Y);
    for (number, material) in [
        diffuse(0.5),
        phong(0.5, 10.0),
        mirror(0.5),
        glass(1.5),
        Material { diffuse: Rgb::WHITE, ..mirror(0.5) },
        black(),
        Material { emission: Rgb::WHITE, ..black() },
        phong(0.0, 10.0),
        mirror(0.0),
    ]
    .into_iter()
    .enumerate()
    {
        let place = |vertex: Vec3| vertex + number as f32 * Vec3::NEG_Z;
        add(&mut scene, &square.iter().map(|triangle| triangle.map(place)).collect::<Vec<_>>(), material);
    }
    add_lights(&mut scene, &square);
    scene.lights.push(LightDescription::Point { position: Vec3::ONE, power: Rgb::WHITE });
    let direction = Vec3::X;
    scene.lights.push(LightDescription::Spot {
        position: Vec3::ONE,
        direction,
        inner: 1.0,
        outer: 2.0,
        power: Rgb::WHITE,
    });
    let features = features(&scene);
    assert_eq!(features.triangles, 20);
    assert_eq!((features.area_lights, features.point_lights), (4, 2));
    assert_eq!(features.delta_surfaces, 6, "mirror, glass, coated mirror; not one that reflects nothing");
    assert_eq!(features.glossy_surfaces, 2);
    assert_eq!(features.lit_surfaces, 6, "diffuse, glossy, coated mirror");
    assert_eq!((features.textured_surfaces, features.smooth_surfaces), (0, 0));
    assert!(features.has_lights() && !features.closed);
}

#[test]
fn textures_and_normals_are_counted_where_they_are_used() {
    let mut scene = with(&quad(Vec3::NEG_Z, Vec3::X, Vec3::Y), diffuse(0.5));
    scene.textures.push(Texture { width: 1, height: 1, texels: vec![[255; 3]] });
    scene.materials[0].diffuse_map = Some(0);
    scene.meshes[0].uvs = vec![Vec2::ZERO];
    scene.meshes[0].normals = vec![Vec3::Z];
    scene.meshes[0].triangles[1].normals = Some([0; 3]);
    let features = features(&scene);
    assert_eq!((features.textured_surfaces, features.smooth_surfaces), (2, 1));
}

#[test]
fn a_room_is_closed_unless_it_has_a_hole() {
    let walls = room(LOW, HIGH);
    assert!(features(&with(&walls, diffuse(0.5))).closed);
    for left_out in 0..walls.len() {
        let mut walls = walls.clone();
        walls.remove(left_out);
        assert!(!features(&with(&walls, diffuse(0.5))).closed);
    }
    assert!(features(&with(&icosphere(Vec3::ZERO, 1.0, 2, true), diffuse(0.5))).closed, "front or back");
    let mut outside = with(&walls, diffuse(0.5));
    outside.camera.eye = 2.0 * HIGH;
    assert!(!features(&outside).closed, "seen from outside");
}

#[test]
fn a_room_can_be_closed_by_lights_and_several_materials() {
    let walls = room(LOW, HIGH);
    let mut scene = with(&walls[..7], diffuse(0.5));
    add(&mut scene, &walls[7..10], mirror(0.9));
    add_lights(&mut scene, &walls[10..]);
    assert!(features(&scene).closed);
}

#[test]
fn glass_does_not_enclose_the_camera() {
    let ball = icosphere(Vec3::ZERO, 1.0, 1, true);
    assert!(!features(&with(&ball, glass(1.5))).closed);
    let opaque = Specular::Glass { index: 1.5, reflectance: Rgb::BLACK, transmittance: Rgb::BLACK };
    assert!(features(&with(&ball, Material { specular: opaque, ..black() })).closed);
    // A glass ball around the camera in a closed room.
    let mut scene = with(&room(2.0 * LOW, 2.0 * HIGH), diffuse(0.5));
    add(&mut scene, &ball, glass(1.5));
    assert!(features(&scene).closed);
}

#[test]
fn triangles_without_an_area_are_ignored_with_a_warning() {
    let mut scene = with(&quad(Vec3::NEG_Z, Vec3::X, Vec3::Y), diffuse(0.5));
    add(&mut scene, &[[Vec3::ZERO, Vec3::X, 2.0 * Vec3::X], [Vec3::ONE; 3], [Vec3::NAN; 3]], diffuse(0.5));
    let scene = Scene::new(&scene);
    assert_eq!(scene.features().triangles, 2);
    assert!(scene.warnings()[0].contains('3'), "{:?}", scene.warnings());
}

#[test]
fn scenes_outside_the_reliable_sizes_and_offsets_give_a_warning() {
    let warnings = |size: f32, offset: f32| {
        let corner = Vec3::splat(offset);
        Scene::new(&with(&quad(corner, size * Vec3::X, size * Vec3::Y), diffuse(0.5))).warnings().to_vec()
    };
    assert!(warnings(1.0, 0.0).is_empty());
    assert!(warnings(1.0, 500.0).is_empty());
    assert!(warnings(1.0, 2000.0)[0].contains("away from the origin"));
    assert!(warnings(1e-5, 0.0)[0].contains("has a size of"));
    assert!(warnings(1e6, 0.0)[0].contains("has a size of"));
}
