//! Small .glb files, converted and read by the renderer.

mod common;

use std::path::Path;

use arty::math::{Rgb, Vec3};
use arty::scene::{LightDescription, SceneDescription, Specular, file};
use arty_import::{Imported, Options, import};
use common::Glb;
use serde_json::json;

/// Converts a file and reads what was written.
fn converted(glb: &Glb) -> (Imported, SceneDescription) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let source = glb.write(folder.path());
    let imported = import(&source, "room", Options::default()).expect("it is valid");
    let written = imported.write(folder.path(), false).expect("it can be written");
    let loaded = file::load(&written).unwrap_or_else(|error| panic!("{error}"));
    (imported, loaded.description)
}

fn error(glb: &Glb) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    import(&glb.write(folder.path()), "room", Options::default()).expect_err("it is broken").to_string()
}

fn lists(imported: &Imported, item: &str) -> bool {
    imported.left_out.iter().any(|left| left.contains(item))
}

#[test]
fn a_mesh_stands_where_the_nodes_place_it() {
    let mut glb = Glb::new();
    let mesh = glb.square("Square", None);
    let child = glb.push("nodes", json!({ "mesh": mesh, "scale": [2.0, 1.0, 1.0] }));
    // A quarter turn about y takes z to x.
    let half = 0.5f32.sqrt();
    glb.node(
        json!({ "children": [child], "rotation": [0.0, half, 0.0, half], "translation": [10.0, 0.0, 0.0] }),
    );
    let (imported, scene) = converted(&glb);
    assert_eq!(imported.triangles, 2);
    let mesh = &scene.meshes[0];
    let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-5;
    assert!(mesh.positions.iter().any(|at| near(*at, Vec3::new(10.0, -1.0, 2.0))), "{:?}", mesh.positions);
    assert!(mesh.normals.iter().all(|normal| near(*normal, Vec3::X)), "{:?}", mesh.normals);
    assert!(faces(&scene, Vec3::X));
}

/// True if all triangles face this direction.
fn faces(scene: &SceneDescription, direction: Vec3) -> bool {
    let mesh = &scene.meshes[0];
    mesh.triangles.iter().all(|triangle| {
        let [a, b, c] = triangle.positions.map(|index| mesh.positions[index as usize]);
        (b - a).cross(c - a).normalize().dot(direction) > 0.999
    })
}

#[test]
fn a_mirrored_mesh_keeps_its_front() {
    let mut glb = Glb::new();
    let mesh = glb.square("Square", None);
    glb.node(json!({ "mesh": mesh, "scale": [-1.0, 1.0, 1.0] }));
    let (_, scene) = converted(&glb);
    assert!(faces(&scene, Vec3::Z), "the reflection is in the plane of the square");
    assert!(scene.meshes[0].normals.iter().all(|normal| normal.z > 0.999));
}

#[test]
fn the_camera_sees_what_it_saw() {
    let mut glb = Glb::new();
    let perspective = json!({ "yfov": std::f32::consts::FRAC_PI_2, "aspectRatio": 2.0, "znear": 0.1 });
    let camera = glb.push("cameras", json!({ "type": "perspective", "perspective": perspective }));
    let half = 0.5f32.sqrt();
    // A quarter turn about x makes it look up.
    glb.node(json!({ "camera": camera, "translation": [1.0, 2.0, 3.0], "rotation": [half, 0.0, 0.0, half] }));
    let mesh = glb.square("Square", None);
    glb.node(json!({ "mesh": mesh }));
    let (imported, scene) = converted(&glb);
    let camera = &scene.camera;
    assert_eq!(camera.eye, Vec3::new(1.0, 2.0, 3.0));
    assert!(((camera.center - camera.eye).normalize() - Vec3::Y).length() < 1e-6);
    assert!((camera.up.normalize() - Vec3::Z).length() < 1e-6);
    // Half the height is 1 at distance 1, half the width is 2.
    assert!((camera.fov - 2.0 * 2.0f32.atan().to_degrees()).abs() < 1e-4, "{}", camera.fov);
    assert_eq!((scene.defaults.width, scene.defaults.height), (Some(512), Some(256)));
    assert!(!lists(&imported, "camera"), "{:?}", imported.left_out);
}

#[test]
fn intensities_become_powers() {
    let mut glb = Glb::new();
    glb.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    // What Blender writes for lamps of 100 W.
    let candela = 100.0 * 683.0 / (4.0 * std::f64::consts::PI);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "point", "intensity": candela, "color": [1.0, 0.5, 0.0], "name": "Lamp" },
        { "type": "spot", "intensity": candela, "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.4 } },
        { "type": "directional", "intensity": 3.0, "name": "Sun" },
    ] } });
    for light in 0..3 {
        let extension = json!({ "KHR_lights_punctual": { "light": light } });
        glb.node(json!({ "translation": [0.0, 5.0, 0.0], "extensions": extension }));
    }
    let mesh = glb.square("Square", None);
    glb.node(json!({ "mesh": mesh }));
    let (imported, scene) = converted(&glb);
    let near = |a: f32, b: f64| (f64::from(a) - b).abs() < 1e-4 * b.abs().max(1.0);
    let [
        LightDescription::Point { position, power },
        LightDescription::Spot { direction, inner, outer, power: spot, .. },
    ] = scene.lights.as_slice()
    else {
        panic!("{:?}", scene.lights)
    };
    assert_eq!(*position, Vec3::new(0.0, 5.0, 0.0));
    assert!(near(power.r, 100.0) && near(power.g, 50.0) && power.b == 0.0, "{power:?}");
    assert_eq!(*direction, Vec3::NEG_Z);
    assert!(near(*inner, 0.2f64.to_degrees()) && near(*outer, 0.4f64.to_degrees()));
    // A cone holds this fraction of the power of all directions.
    let fraction = 0.5 * (1.0 - 0.5 * (0.2f64.cos() + 0.4f64.cos()));
    assert!(near(spot.g, 100.0 * fraction), "{spot:?}");
    assert!(lists(&imported, "light `Sun`: it is directional"), "{:?}", imported.left_out);
}

#[test]
fn materials_have_the_nearest_counterpart() {
    let mut glb = Glb::new();
    let factors = |color: [f32; 4], metallic: f32, roughness: f32| json!({ "baseColorFactor": color, "metallicFactor": metallic, "roughnessFactor": roughness });
    let materials = [
        json!({ "name": "Wall paint", "pbrMetallicRoughness": factors([0.8, 0.4, 0.2, 1.0], 0.0, 0.5) }),
        json!({ "name": "Mirror", "pbrMetallicRoughness": factors([0.9, 0.9, 0.9, 1.0], 1.0, 0.0) }),
        json!({ "name": "Brass", "pbrMetallicRoughness": factors([0.9, 0.7, 0.3, 1.0], 1.0, 0.4) }),
        json!({ "name": "Glass", "pbrMetallicRoughness": factors([1.0, 1.0, 1.0, 1.0], 0.0, 0.0),
            "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1.0 },
                            "KHR_materials_ior": { "ior": 1.33 } } }),
        json!({ "name": "Lamp", "emissiveFactor": [1.0, 0.5, 0.0], "doubleSided": true,
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 12.0 } } }),
        json!({ "name": "Wall/paint" }),
    ];
    for material in materials {
        let index = glb.push("materials", material);
        let mesh = glb.square("Square", Some(index));
        glb.node(json!({ "mesh": mesh }));
    }
    let (imported, scene) = converted(&glb);
    let of =
        |name: &str| scene.materials.iter().find(|it| it.name == name).unwrap_or_else(|| panic!("{name}"));
    let paint = of("Wall_paint");
    assert_eq!((paint.diffuse, paint.specular), (Rgb::new(0.8, 0.4, 0.2), Specular::None));
    let Specular::Mirror { reflectance } = of("Mirror").specular else { panic!("{:?}", of("Mirror")) };
    assert_eq!(reflectance, Rgb::gray(0.9));
    let Specular::Phong { reflectance, exponent } = of("Brass").specular else { panic!("{:?}", of("Brass")) };
    assert_eq!(reflectance, Rgb::new(0.9, 0.7, 0.3));
    // α = 0.16, so a quarter of 2/α² − 2.
    assert!((exponent - 19.03).abs() < 0.01, "{exponent}");
    let Specular::Glass { index, .. } = of("Glass").specular else { panic!("{:?}", of("Glass")) };
    assert_eq!(index, 1.33);
    assert_eq!(of("Lamp").emission, Rgb::new(12.0, 6.0, 0.0));
    of("Wall_paint_2");
    for item in ["material `Lamp`: the emission of its back", "materials that are not metals", "Phong lobe"] {
        assert!(lists(&imported, item), "{item}: {:?}", imported.left_out);
    }
}

/// The bytes of a PNG file of two pixels, red above blue.
fn picture() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture =
        image::RgbImage::from_fn(1, 2, |_, y| image::Rgb(if y == 0 { [255, 0, 0] } else { [0, 0, 255] }));
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("it is encoded");
    bytes.into_inner()
}

#[test]
fn a_texture_is_not_upside_down() {
    let mut glb = Glb::new();
    let view = glb.view(&picture());
    let image = glb.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    let texture = glb.push("textures", json!({ "source": image }));
    let pbr = json!({ "baseColorTexture": { "index": texture }, "metallicFactor": 0.0 });
    let material = glb.push("materials", json!({ "name": "Poster", "pbrMetallicRoughness": pbr }));
    let mesh = glb.square("Square", Some(material));
    glb.node(json!({ "mesh": mesh }));
    let (_, scene) = converted(&glb);
    assert_eq!(scene.textures[0].texels, [[255, 0, 0], [0, 0, 255]]);
    let mesh = &scene.meshes[0];
    // The texture's upper edge is where v is 1 here, and where y is 1 on the square.
    for triangle in &mesh.triangles {
        for (at, uv) in triangle.positions.iter().zip(triangle.uvs.expect("it has texture coordinates")) {
            assert_eq!(mesh.positions[*at as usize].y > 0.0, mesh.uvs[uv as usize].y > 0.5);
        }
    }
}

#[test]
fn everything_else_is_listed() {
    let mut glb = Glb::new();
    let texture = json!({ "index": 0 });
    let view = glb.view(&picture());
    glb.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    glb.push("textures", json!({ "source": 0 }));
    let material = json!({ "name": "Bumpy", "normalTexture": texture, "emissiveTexture": texture, "alphaMode": "BLEND",
                           "pbrMetallicRoughness": { "metallicRoughnessTexture": texture } });
    let material = glb.push("materials", material);
    let mesh = glb.square("Square", Some(material));
    let colors = glb.floats(&[[1.0f32; 4]; 4]);
    glb.json["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    glb.node(json!({ "mesh": mesh }));
    let lines = glb.square("Lines", None);
    glb.json["meshes"][lines]["primitives"][0]["mode"] = json!(1);
    glb.node(json!({ "mesh": lines }));
    let orthographic = json!({ "xmag": 1.0, "ymag": 1.0, "znear": 0.1, "zfar": 10.0 });
    let camera = glb.push("cameras", json!({ "type": "orthographic", "orthographic": orthographic }));
    glb.node(json!({ "camera": camera }));
    glb.json["extensionsUsed"] = json!(["EXT_nonsense"]);
    let (imported, _) = converted(&glb);
    for item in [
        "the extension EXT_nonsense",
        "material `Bumpy`: its normal map",
        "material `Bumpy`: its emission, which comes from a texture",
        "material `Bumpy`: its metallic-roughness map",
        "material `Bumpy`: its transparency",
        "mesh `Square`: its vertex colors",
        "mesh `Lines`: its lines or points",
        "camera 0: it is orthographic",
        "a camera: the file has none",
    ] {
        assert!(lists(&imported, item), "{item}: {:#?}", imported.left_out);
    }
}

#[test]
fn errors_name_the_file_and_the_item() {
    type Change = fn(&mut Glb);
    let broken = |change: Change| {
        let mut glb = Glb::new();
        let mesh = glb.square("Square", None);
        glb.node(json!({ "mesh": mesh }));
        change(&mut glb);
        error(&glb)
    };
    let cases: [(Change, &str); 12] = [
        (
            |glb| glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99),
            "mesh `Square`: it refers to an accessor that does not exist",
        ),
        (
            |glb| {
                let camera = json!({ "type": "perspective", "orthographic":
                                     { "xmag": 1.0, "ymag": 1.0, "znear": 0.1, "zfar": 10.0 } });
                glb.push("cameras", camera);
            },
            "camera 0: it has no field of view",
        ),
        (
            |glb| {
                glb.push("images", json!({ "bufferView": 0 }));
            },
            "image 0: it has no data or no MIME type",
        ),
        (|glb| glb.json["accessors"][3]["count"] = json!(7), "mesh `Square`, indices: its data exceed"),
        (|glb| glb.json["accessors"][1]["type"] = json!("VEC2"), "mesh `Square`, normals: expected 3"),
        (|glb| glb.json["accessors"][1]["count"] = json!(3), "mesh `Square`: 3 normals for 4 positions"),
        (|glb| glb.bytes[0..4].copy_from_slice(&f32::NAN.to_le_bytes()), "positions: its vector 0 is NaN"),
        (|glb| *glb.bytes.last_mut().expect("an index") = 9, "index 2307 of 4 vertices"),
        (|glb| glb.json["nodes"][0]["children"] = json!([0]), "node 0: it has two parents"),
        (|glb| glb.json["nodes"][0]["mesh"] = json!(3), "nodes[0].mesh"),
        (
            |glb| glb.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]),
            "extensionsRequired[0]",
        ),
        (|glb| glb.json["bufferViews"][0]["byteLength"] = json!(1 << 20), "positions: its data exceed"),
    ];
    for (change, expected) in cases {
        let message = broken(change);
        assert!(message.contains("room.glb: ") && message.contains(expected), "{expected}: {message}");
    }
}

#[test]
fn files_beside_a_gltf_file_are_read_and_no_others() {
    let mut glb = Glb::new();
    let mesh = glb.square("Square", None);
    glb.node(json!({ "mesh": mesh }));
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("a b.bin"), &glb.bytes).expect("it can be written");
    let with = |uri: &str| {
        let mut json = glb.json.clone();
        json["buffers"] = json!([{ "byteLength": glb.bytes.len(), "uri": uri }]);
        json.as_object_mut()
            .expect("an object")
            .retain(|_, it| it.as_array().is_none_or(|list| !list.is_empty()));
        let path = folder.path().join("room.gltf");
        std::fs::write(&path, json.to_string()).expect("it can be written");
        import(&path, "room", Options::default())
    };
    assert_eq!(with("a%20b.bin").expect("it is beside it").triangles, 2);
    for (uri, expected) in [
        ("../secret.bin", "not a file below the folder"),
        ("/etc/hostname", "not a file below the folder"),
        ("https://example.org/a.bin", "not a file below the folder"),
        ("missing.bin", "missing.bin: cannot be read"),
        ("data:application/octet-stream;base64,AAAA", "3 bytes instead of"),
    ] {
        let message = with(uri).expect_err(uri).to_string();
        assert!(message.contains(expected) && message.contains("buffer 0"), "{uri}: {message}");
    }
}

#[test]
fn existing_files_are_kept() {
    let mut glb = Glb::new();
    let mesh = glb.square("Square", None);
    glb.node(json!({ "mesh": mesh }));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let imported = import(&glb.write(folder.path()), "room", Options::default()).expect("it is valid");
    let obj = folder.path().join("room.obj");
    std::fs::write(&obj, "mine").expect("it can be written");
    let message = imported.write(folder.path(), false).expect_err("it exists").to_string();
    assert!(message.contains("room.obj: exists already"), "{message}");
    assert!(!Path::exists(&folder.path().join("room.mtl")), "nothing is written");
    imported.write(folder.path(), true).expect("it may be replaced");
    assert!(std::fs::read_to_string(&obj).expect("it is there").starts_with("mtllib"));
}

/// Bytes changed at random never make it panic, and whatever is converted can be loaded or is refused with a message.
#[test]
fn broken_files_are_refused_without_a_panic() {
    let mut glb = Glb::new();
    let view = glb.view(&picture());
    let image = glb.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    let texture = glb.push("textures", json!({ "source": image }));
    let pbr = json!({ "baseColorTexture": { "index": texture } });
    let material = glb.push("materials", json!({ "pbrMetallicRoughness": pbr }));
    let mesh = glb.square("Square", Some(material));
    glb.node(json!({ "mesh": mesh, "scale": [1.0, 2.0, 3.0] }));
    let whole = glb.to_bytes();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("room.glb");
    let mut state = 5u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let (mut refused, mut accepted) = (0, 0);
    for _ in 0..1500 {
        let mut bytes = whole.clone();
        for _ in 0..=random(2) {
            let at = random(bytes.len());
            // Mostly digits, which change sizes and indices without breaking the syntax.
            bytes[at] = if bytes[at].is_ascii_digit() { b'0' + random(10) as u8 } else { random(256) as u8 };
        }
        bytes.truncate(if random(8) == 0 { random(bytes.len()) } else { bytes.len() });
        std::fs::write(&path, &bytes).expect("it can be written");
        match import(&path, "room", Options::default()) {
            Ok(_) => accepted += 1,
            Err(error) => {
                assert!(error.to_string().contains("room.glb"), "{error}");
                refused += 1;
            }
        }
    }
    assert!(refused > 300 && accepted > 100, "{refused} refused, {accepted} accepted");
}
