//! Checks of the scenes that do not use the renderer.

use std::collections::BTreeMap;

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::output::{Content, OutputFile, differences};
use crate::raycast::{PlacedTriangle, camera_directions, first_hit, placed_triangles};
use crate::scene_file::{Light, SceneFile};
use crate::scenes::{cornell, cornell_water, light_behind_wall, mesh, veach_mis};
use crate::shapes::{Bottom, block};
use crate::surface::Surface;
use crate::{extreme, number, scenes, scenes_folder, solids, soundness};

fn scene<'a>(collection: &'a Collection, name: &str) -> (&'a SceneFile, Vec<PlacedTriangle>) {
    let scene = collection.scenes.iter().find(|scene| scene.name == name).expect("the scene exists");
    (scene, placed_triangles(collection, scene))
}

fn is_furnace(scene: &SceneFile) -> bool {
    scene.name.starts_with("furnace")
}

/// The same directions each time, spread evenly over the sphere (a Fibonacci lattice).
fn even_directions(count: usize) -> impl Iterator<Item = DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |index| {
        let z = 1.0 - (2.0 * index as f64 + 1.0) / count as f64;
        let angle = golden_angle * index as f64;
        let radius = (1.0 - z * z).sqrt();
        dvec3(radius * angle.cos(), radius * angle.sin(), z)
    })
}

/// True if each edge belongs to exactly two triangles, which run along it in opposite directions.
fn is_closed(surface: &Surface) -> bool {
    let mut uses: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for &[a, b, c] in &surface.triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *uses.entry(edge).or_default() += 1;
        }
    }
    uses.iter().all(|(&(from, to), &count)| count == 1 && uses.get(&(to, from)) == Some(&1))
}

/// The volume inside a closed surface, positive if its front is outside (Gauss' theorem).
fn signed_volume(surface: &Surface) -> f64 {
    let corners = surface.triangles.iter().map(|triangle| surface.corners(triangle));
    corners.map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
}

#[test]
fn the_committed_files_are_what_would_be_written() {
    for files in [scenes::all().files("scene.schema.json"), extreme::all().files()] {
        assert_eq!(differences(&scenes_folder(), &files), Vec::<String>::new());
    }
}

/// Total size of files in bytes.
fn size_of(files: &[OutputFile]) -> usize {
    let bytes = |file: &OutputFile| match &file.content {
        Content::Text(text) => text.len(),
        Content::Png(bytes) => bytes.len(),
        Content::Map(image) => 12 * image.pixels().len(),
    };
    files.iter().map(bytes).sum()
}

#[test]
fn all_scenes_together_stay_small() {
    let size = size_of(&scenes::all().files("scene.schema.json"));
    assert!(size < 12_000_000, "{size} bytes");
}

#[test]
fn all_scenes_are_sound() {
    assert_eq!(soundness::faults(&scenes::all()), Vec::<String>::new());
}

#[test]
fn extreme_scenes_have_an_answer_each_and_stay_small() {
    let extremes = extreme::all();
    assert_eq!(soundness::faults_of_names(&extremes.collection), Vec::<String>::new());
    assert_eq!(extremes.collection.scenes.len(), extremes.answers.len());
    for (scene, answer) in extremes.collection.scenes.iter().zip(&extremes.answers) {
        assert!(answer.left_out.len() < 3, "{}: no technique is left", scene.name);
        if let extreme::Truth::SameAs(other) = answer.truth {
            assert!(extremes.collection.scenes.iter().any(|scene| scene.name == other), "{other}");
        }
    }
    let size = size_of(&extremes.files());
    assert!(size < 1_000_000, "{size} bytes");
}

#[test]
fn numbers_of_any_magnitude_are_written_in_full() {
    assert_eq!(number::precise(1e-20), "1e-20");
    assert_eq!(number::precise(0.25), "0.25");
    assert_eq!(number::precise(-1e20), "-1e20");
    assert_eq!(number::precise(1.0 / 3.0).parse(), Ok(1.0 / 3.0));
}

#[test]
fn numbers_are_written_short() {
    assert_eq!(number::text(2.0), "2");
    assert_eq!(number::text(-0.25), "-0.25");
    assert_eq!(number::text(-0.000_01), "0");
    assert_eq!(number::text(120.0), "120");
}

#[test]
fn solids_are_closed_with_their_front_outside() {
    let pi = std::f64::consts::PI;
    let block = block(dvec3(1.0, 2.0, 3.0), dvec3(1.0, 2.0, 3.0), 20.0, Bottom::Closed);
    assert!(is_closed(&block));
    assert!((signed_volume(&block) - 6.0).abs() < 1e-2);

    let sphere = solids::icosphere(dvec3(0.0, 5.0, 0.0), 2.0, 4);
    assert!(is_closed(&sphere));
    assert!((signed_volume(&sphere) / (4.0 / 3.0 * pi * 8.0) - 1.0).abs() < 0.01);

    // A rope of length 14 or so and radius 0.26 or so.
    let knot = solids::knot(&mesh::RESOLUTION);
    assert!(is_closed(&knot));
    assert!((2.0..4.5).contains(&signed_volume(&knot)), "volume {}", signed_volume(&knot));
}

#[test]
fn triangle_counts_are_as_the_descriptions_say() {
    let collection = scenes::all();
    assert_eq!(scene(&collection, "cornell_box").1.len(), 32);
    assert_eq!(scene(&collection, "furnace_diffuse").1.len(), 5120);
    let rope = scene(&collection, "mesh").1.iter().filter(|triangle| triangle.material == "rope").count();
    assert_eq!(rope, 50_400);
    let (many_lights, triangles) = scene(&collection, "many_lights");
    let triangle_lights = triangles.iter().filter(|triangle| triangle.is_lamp).count();
    let others = many_lights.lights.iter().filter(|light| !matches!(light, Light::Triangle { .. })).count();
    assert_eq!(triangle_lights + others, 12);
}

#[test]
fn furnaces_are_closed_and_face_inwards() {
    let collection = scenes::all();
    for name in ["furnace_diffuse", "furnace_glossy", "furnace_mirror"] {
        let sphere = &collection.model(name).expect("the model exists").parts[0].surface;
        assert!(is_closed(sphere), "{name}");
        for triangle in scene(&collection, name).1 {
            assert!(triangle.front().dot(-triangle.centroid().normalize()) > 0.95, "{name}");
        }
    }
}

#[test]
fn lights_shine_at_something() {
    let collection = scenes::all();
    for scene in collection.scenes.iter().filter(|scene| !is_furnace(scene)) {
        let triangles = placed_triangles(&collection, scene);
        let lamps: Vec<_> = triangles.iter().filter(|triangle| triangle.is_lamp).collect();
        let useful = lamps
            .iter()
            .filter(|lamp| {
                first_hit(&triangles, lamp.centroid() + 1e-4 * lamp.front(), lamp.front()).is_some()
            })
            .count();
        // The spheres of veach_mis shine up as well as down.
        let least = if scene.name == "veach_mis" { 0.6 } else { 1.0 };
        assert!(useful as f64 >= least * lamps.len() as f64, "{}: {useful} of {}", scene.name, lamps.len());
    }
}

#[test]
fn lights_keep_away_from_what_they_light() {
    let collection = scenes::all();
    for scene in collection.scenes.iter().filter(|scene| !is_furnace(scene)) {
        let triangles = placed_triangles(&collection, scene);
        let mut seen = BTreeMap::new();
        for lamp in triangles.iter().filter(|triangle| triangle.is_lamp) {
            // The large mesh takes its time; few directions do for a light that hangs high above it.
            let count = if triangles.len() > 10_000 { 60 } else { 400 };
            for corner in lamp.corners.map(|corner| corner.lerp(lamp.centroid(), 0.01)) {
                for direction in even_directions(count).filter(|direction| direction.dot(lamp.front()) > 0.0)
                {
                    if let Some((distance, _)) = first_hit(&triangles, corner, direction) {
                        let nearest = seen.entry(lamp.material).or_insert(distance);
                        *nearest = distance.min(*nearest);
                    }
                }
            }
        }
        for (lamp, distance) in seen {
            assert!(distance > 0.3, "{}: {lamp} is only {distance} away from something", scene.name);
        }
    }
}

#[test]
fn pictures_show_the_scene_whether_wide_or_square() {
    let collection = scenes::all();
    for scene in &collection.scenes {
        let triangles = placed_triangles(&collection, scene);
        for (width, height) in [(16, 16), (16, 13)] {
            let directions = camera_directions(scene, width, height);
            let hits = directions
                .iter()
                .filter(|&&direction| first_hit(&triangles, scene.camera.eye, direction).is_some())
                .count();
            let share = hits as f64 / directions.len() as f64;
            // Between the tiles of point_grid and above the floor of grazing is nothing, and behind others the environment.
            let is_open = ["point_grid", "grazing"].contains(&scene.name)
                || collection.environments.contains_key(scene.name);
            let least = if is_open { 0.5 } else { 0.7 };
            assert!(share > least, "{} at {width} × {height}: only {share} is filled", scene.name);
        }
    }
}

#[test]
fn cameras_of_closed_forms_see_the_plane_only() {
    let collection = scenes::all();
    // A square picture of four_lights has the corner of a light in it, the wide one that is compared has not.
    for (name, height) in
        [("point_plane", 16), ("area_plane", 16), ("polygon_plane", 16), ("four_lights", 13)]
    {
        let (scene, triangles) = scene(&collection, name);
        for direction in camera_directions(scene, 16, height) {
            let hit =
                first_hit(&triangles, scene.camera.eye, direction).map(|(_, triangle)| triangle.material);
            assert_eq!(hit, Some("plane"), "{name}");
        }
    }
}

#[test]
fn mirrors_show_the_light_to_the_camera() {
    let collection = scenes::all();
    let (scene, triangles) = scene(&collection, "mirror_light");
    let reflected_hits = camera_directions(scene, 16, 16)
        .into_iter()
        .filter_map(|direction| {
            let (distance, triangle) = first_hit(&triangles, scene.camera.eye, direction)?;
            let point = scene.camera.eye + distance * direction;
            let reflected = direction.reflect(triangle.front());
            (triangle.material == "mirror").then(|| first_hit(&triangles, point, reflected))?
        })
        .filter(|(_, triangle)| triangle.material == "high_light")
        .count();
    assert!(reflected_hits >= 3, "the light fills only {reflected_hits} of the 256 pixels");
}

#[test]
fn plates_mirror_the_row_of_lights() {
    let collection = scenes::all();
    let (scene, triangles) = scene(&collection, "veach_mis");
    for (name, [y, z], _, _) in veach_mis::PLATES {
        let center = dvec3(0.0, y, z);
        let view = (center - scene.camera.eye).normalize();
        let (distance, seen) = first_hit(&triangles, scene.camera.eye, view).expect("the plate is seen");
        assert_eq!(seen.material, name);
        assert!((distance - center.distance(scene.camera.eye)).abs() < 1e-3, "{name}");
        let reflected = view.reflect(veach_mis::mirroring_normal(center));
        assert!(reflected.dot((veach_mis::ROW - center).normalize()) > 1.0 - 1e-6, "{name}");
    }
}

#[test]
fn water_has_no_gaps() {
    let (top, front) = (cornell_water::top(), cornell_water::front());
    let columns = front.positions.len() / 2;
    assert_eq!(top.positions[..columns], front.positions[columns..]);
    for point in &top.positions {
        assert!((0.6..0.72).contains(&point.y), "the water is {} high", point.y);
    }
    let [left, right] = [top.positions[0].x, top.positions[columns - 1].x];
    assert!(left < cornell::X[0] && cornell::X[1] < right);
    assert!(top.positions.iter().any(|point| point.z < cornell::Z[0]));
}

#[test]
fn a_shadow_ray_that_does_not_end_at_its_light_meets_a_wall() {
    let collection = scenes::all();
    let (scene, triangles) = scene(&collection, "light_behind_wall");
    let Light::Point { position: point_light, .. } = scene.lights[0] else {
        panic!("the scene has a point light");
    };
    let left_light =
        triangles.iter().find(|triangle| triangle.material == "left_light").expect("it is there").centroid();
    // Each light with the surface that it is there to light. The rooms are open at the front, where a few rays
    // get out.
    for (light, lit_material) in [(point_light, "floor"), (left_light, "wedge")] {
        let (mut blocked, mut all) = (0, 0);
        for direction in camera_directions(scene, 64, 64) {
            let Some((distance, seen)) = first_hit(&triangles, scene.camera.eye, direction) else { continue };
            let point = scene.camera.eye + distance * direction;
            if seen.material == lit_material && (point.x > 0.0) == (light.x > 0.0) {
                let onwards = (light - point).normalize();
                all += 1;
                blocked += usize::from(first_hit(&triangles, light + 1e-3 * onwards, onwards).is_some());
            }
        }
        assert!(all > 50 && blocked * 10 > all * 9, "only {blocked} of {all} rays meet a wall");
    }
}

#[test]
fn the_wall_behind_the_light_gets_no_direct_light() {
    let collection = scenes::all();
    let (scene, triangles) = scene(&collection, "light_behind_wall");
    let Light::Point { position: point_light, .. } = scene.lights[0] else {
        panic!("the scene has a point light");
    };
    let mut on_wall = 0;
    for direction in camera_directions(scene, 64, 64) {
        let Some((distance, triangle)) = first_hit(&triangles, scene.camera.eye, direction) else { continue };
        if triangle.material != "left_wall" {
            continue;
        }
        on_wall += 1;
        let point = scene.camera.eye + distance * direction;
        assert!((point.x - light_behind_wall::X[0]).abs() < 1e-9);
        for lamp in triangles.iter().filter(|triangle| triangle.is_lamp) {
            assert!((point - lamp.centroid()).dot(lamp.front()) < 0.0);
        }
        let towards = point_light - point;
        let (blocked_at, _) =
            first_hit(&triangles, point + 1e-6 * DVec3::X, towards.normalize()).expect("a wall is between");
        assert!(blocked_at < towards.length() - 0.1);
    }
    assert!(on_wall > 100, "the wall fills only {on_wall} of 4096 pixels");
}
