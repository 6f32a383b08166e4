//! Valid files: their contents arrive in the description.

#![cfg(feature = "files")]

use std::path::{Path, PathBuf};

use arty::math::Rgb;
use arty::scene::file::{Loaded, load};
use arty::scene::{LightDescription, Material, Mesh, Specular};
use glam::{Vec2, Vec3};

const CAMERA: &str =
    "camera: !perspective_camera { eye: [0, 1, 4], center: [0, 1, 0], up: [0, 1, 0], fov: 40 }\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Temporary files of a scene.
struct Files(tempfile::TempDir);

impl Files {
    fn new(files: &[(&str, &str)]) -> Self {
        let files_of_scene = Self(tempfile::tempdir().expect("a temporary folder"));
        files.iter().for_each(|(name, text)| files_of_scene.write(name, text.as_bytes()));
        files_of_scene
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: &[u8]) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, content).expect("a file");
    }

    fn load(&self) -> Loaded {
        load(&self.path("scene.yml")).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Loads a scene with one mesh.
fn load_obj(obj: &str, mtl: &str) -> Loaded {
    let scene = format!("meshes: [a.obj]\n{CAMERA}");
    Files::new(&[("scene.yml", &scene), ("a.obj", obj), ("a.mtl", mtl)]).load()
}

/// Loads a scene with one mesh under a transform.
fn transformed(steps: &str, obj: &str) -> Mesh {
    let scene = format!("meshes: [{{ file: a.obj, transform: [{steps}] }}]\n{CAMERA}");
    Files::new(&[("scene.yml", &scene), ("a.obj", obj)]).load().description.meshes.remove(0)
}

/// Loads the material `m` with these statements; returns it with the warnings.
fn material(statements: &str) -> (Material, Vec<String>) {
    let obj = format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}");
    let mut loaded = load_obj(&obj, &format!("newmtl m\n{statements}\n"));
    let warnings = loaded.warnings.into_iter().map(|warning| warning.message).collect();
    (loaded.description.materials.remove(0), warnings)
}

/// The corners of a triangle of a mesh.
fn corners(mesh: &Mesh, triangle: usize) -> [Vec3; 3] {
    mesh.triangles[triangle].positions.map(|index| mesh.positions[index as usize])
}

fn close(a: Vec3, b: Vec3) -> bool {
    a.distance(b) < 1e-6
}

const ORIGINAL: &str = "\
meshes: [\"a.obj\"]
camera: !perspective_camera
  eye: [0.0, 1.0, 4]
  center: [0, 1, 0]
  up: [0, 1, 0]
  fov: 40
lights:
  - !point_light
    position: [0, 2, 0]
    color: [10, 20, 30]
  - !triangle_light
    v0: [0, 2, 0]
    v1: [1, 2, 0]
    v2: [0, 2, 1]
    color: [5, 5, 5]
";

#[test]
fn the_original_format_loads() {
    let loaded = Files::new(&[("scene.yml", ORIGINAL), ("a.obj", TRIANGLE)]).load();
    let scene = loaded.description;
    assert_eq!((scene.camera.eye, scene.camera.fov), (Vec3::new(0.0, 1.0, 4.0), 40.0));
    assert_eq!((scene.camera.center, scene.camera.up), (Vec3::Y, Vec3::Y));
    let position = Vec3::new(0.0, 2.0, 0.0);
    let point = LightDescription::Point { position, power: Rgb::new(10.0, 20.0, 30.0) };
    let vertices = [position, Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 1.0)];
    assert_eq!(scene.lights, [point, LightDescription::Triangle { vertices, radiance: Rgb::gray(5.0) }]);
    assert_eq!(corners(&scene.meshes[0], 0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(scene.materials[0].diffuse, Rgb::gray(0.5));
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].message.contains("grey"), "{}", loaded.warnings[0]);
}

#[test]
fn the_keys_beyond_the_original_format_load() {
    let spot =
        "!spot_light { position: [0, 2, 0], direction: [0, -3, 0], inner: 20, outer: 30, color: [1, 2, 3] }";
    let text = format!("meshes: []\n{CAMERA}lights: [{spot}]\ndefaults: {{ width: 512, max_bounces: 0 }}\n");
    let loaded = Files::new(&[("scene.yml", &text)]).load();
    let defaults = loaded.description.defaults;
    assert_eq!((defaults.width, defaults.height, defaults.max_bounces), (Some(512), None, Some(0)));
    let LightDescription::Spot { direction, inner, outer, .. } = loaded.description.lights[0] else {
        panic!("{:?}", loaded.description.lights);
    };
    assert_eq!((direction, inner, outer), (Vec3::new(0.0, -3.0, 0.0), 20.0, 30.0));
    assert!(loaded.warnings.is_empty());
}

#[test]
fn line_endings_and_a_byte_order_mark_have_no_effect() {
    let obj = format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}");
    let mtl = "newmtl m\nKd 0.1 0.2 0.3\nmap_Kd a.png\n";
    let files = Files::new(&[("scene.yml", ORIGINAL), ("a.obj", &obj), ("a.mtl", mtl)]);
    image::RgbImage::new(2, 2).save(files.path("a.png")).expect("an image");
    let hash = files.load().description.hash();
    for (name, text) in [("scene.yml", ORIGINAL), ("a.obj", obj.as_str()), ("a.mtl", mtl)] {
        files.write(name, format!("\u{feff}{}", text.replace('\n', "\r\n")).as_bytes());
    }
    let loaded = files.load();
    assert_eq!(loaded.description.hash(), hash);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn white_space_comments_and_continued_lines_are_read() {
    let obj = "  v\t0 0\t0 # origin\n\tv 1 0 0#\nv 0 1 \\\n0\nv 1 1 0\n#\n\nusemtl\tm # 1\nf 1 2 \\\r\n3\nmtllib\ta.mtl\nf 2 4 3 # end";
    let loaded = load_obj(obj, "\tnewmtl\tm # 1\n  Kd\t.5 # half\n");
    let mesh = &loaded.description.meshes[0];
    assert_eq!(corners(mesh, 0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(corners(mesh, 1), [Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(loaded.description.materials[0].diffuse, Rgb::gray(0.5));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn steps_of_a_transform_apply_in_the_order_given() {
    let first_x = |steps| corners(&transformed(steps, TRIANGLE), 0)[1];
    assert_eq!(first_x("!scale 2, !translate [0, 1, 0]"), Vec3::new(2.0, 1.0, 0.0));
    assert_eq!(first_x("!translate [0, 1, 0], !scale [2, 3, 4]"), Vec3::new(2.0, 3.0, 0.0));
    assert!(close(first_x("!rotate { axis: [0, 0, 2], degrees: 90 }"), Vec3::Y));
    assert_eq!(first_x("!matrix [0,0,1,5, 1,0,0,6, 0,1,0,7, 0,0,0,1]"), Vec3::new(5.0, 7.0, 7.0));
    assert_eq!(first_x(""), Vec3::X);
}

#[test]
fn a_transform_of_many_steps_is_rounded_once() {
    let third = "!rotate { axis: [1, 2, 3], degrees: 1 }, ".repeat(360);
    let turned = corners(&transformed(&third, "v 0.1 0 0\nv 1 0.3 0\nv 0 1 0.7\nf 1 2 3\n"), 0);
    assert_eq!(turned[1], Vec3::new(1.0, 0.3, turned[1].z));
    assert!(turned[1].z.abs() < 1e-12);
}

#[test]
fn a_reflected_mesh_keeps_its_orientation() {
    // A tetrahedron whose faces run counter-clockwise seen from outside.
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn -1 -1 -1\nf 1//1 3//1 2//1\nf 1//1 2//1 4//1\n\
               f 1//1 4//1 3//1\nf 2//1 3//1 4//1\n";
    for steps in ["!scale 1", "!scale [-2, 1, 1]", "!scale [-1, -1, 1]", "!scale -1"] {
        let mesh = transformed(steps, obj);
        let middle = mesh.positions.iter().sum::<Vec3>() / 4.0;
        for triangle in 0..4 {
            let [a, b, c] = corners(&mesh, triangle);
            assert!((b - a).cross(c - a).dot(a - middle) > 0.0, "{steps}, triangle {triangle}");
        }
        assert!(mesh.normals[0].dot(mesh.positions[0] - middle) > 0.0, "{steps}: the normal at the corner");
    }
}

#[test]
fn negative_indices_count_backwards_from_their_line() {
    let obj = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -1 -4 2\n";
    let mesh = transformed("", obj);
    assert_eq!(corners(&mesh, 0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(corners(&mesh, 1), [Vec3::splat(5.0), Vec3::ZERO, Vec3::ZERO]);
}

#[test]
fn vertices_may_follow_the_faces_that_use_them() {
    let mesh = transformed("", "o a\nf 1 2 3\no b\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    assert_eq!(corners(&mesh, 0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn polygons_are_triangulated_with_their_attributes_and_materials() {
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nvt 0 0\nvt 1 0.5\nvn 0 0 2\n\
               g one\nusemtl a\nf 1/1/1 2/1/1 3/2/1 4/1/1 5/1/1\no two\nf 1 2 3\nusemtl b\nf 3//1 4//1 5//1\nl 1 2 3\np 1\n";
    let loaded = load_obj(obj, "newmtl b\nKd 0.1\nnewmtl a\nKd 0.2\nnewmtl unused\nmap_Kd missing.png\n");
    let mesh = &loaded.description.meshes[0];
    assert_eq!(mesh.triangles.len(), 5);
    for triangle in 0..3 {
        assert_eq!(corners(mesh, triangle)[0], Vec3::ZERO);
        assert!(mesh.triangles[triangle].uvs.is_some() && mesh.triangles[triangle].normals.is_some());
    }
    assert_eq!(corners(mesh, 2)[1..], [Vec3::new(1.0, 2.0, 0.0), Vec3::Y]);
    let uvs = mesh.triangles[0].uvs.expect("it has some").map(|index| mesh.uvs[index as usize]);
    assert_eq!(uvs, [Vec2::ZERO, Vec2::ZERO, Vec2::new(1.0, 0.5)]);
    assert_eq!((mesh.triangles[3].uvs, mesh.triangles[3].normals), (None, None));
    assert!(mesh.triangles[4].uvs.is_none());
    let normals = mesh.triangles[4].normals.expect("it has some");
    assert_eq!(normals.map(|index| mesh.normals[index as usize]), [Vec3::Z; 3]);
    let names: Vec<_> = mesh
        .triangles
        .iter()
        .map(|triangle| loaded.description.materials[triangle.material as usize].name.as_str())
        .collect();
    assert_eq!(names, ["a", "a", "a", "a", "b"]);
    let lines: Vec<_> = loaded.warnings.iter().map(|warning| warning.line).collect();
    assert_eq!(lines, [Some(17), Some(18)], "{:?}", loaded.warnings);
}

#[test]
fn colours_of_some_vertices_are_ignored() {
    let obj = "v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0 0 0.5 1 # red\nf 1 2 3\n";
    let loaded = load_obj(obj, "");
    assert_eq!(corners(&loaded.description.meshes[0], 0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn a_concave_polygon_has_its_own_area() {
    let obj = "v 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nv 0 0 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n";
    let loaded = load_obj(obj, "");
    let mesh = &loaded.description.meshes[0];
    let area = |triangle: usize| {
        let [a, b, c] = corners(mesh, triangle);
        // Positive: towards the same side as the polygon, whose corners are counter-clockwise.
        (b - a).cross(c - a).z / 2.0
    };
    let areas: Vec<f32> = (0..mesh.triangles.len()).map(area).collect();
    assert_eq!((areas.len(), areas.iter().sum::<f32>()), (2, 1.0), "{areas:?}");
    assert!(areas.iter().all(|area| *area > 0.0), "{areas:?}");
}

#[test]
fn normals_of_length_zero_give_flat_shading_and_one_warning() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1e-30\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1//1 2//2 3//2\n";
    let loaded = load_obj(obj, "");
    let mesh = &loaded.description.meshes[0];
    let normals = mesh.triangles[0].normals.expect("short is not zero");
    assert_eq!(mesh.normals[normals[0] as usize], Vec3::Z);
    assert_eq!(mesh.triangles[1].normals, None);
    let flat: Vec<_> = loaded.warnings.iter().filter(|warning| warning.message.contains("flat")).collect();
    assert_eq!((flat.len(), flat[0].line), (1, Some(5)));
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-6));
}

#[test]
fn illumination_models_are_read_as_documented() {
    let values = "Kd 0.1\nKs 0.2 0.3 0.4\nNs 7\nNi 1.3\nTf 0.9\nKe 1 2 3\n";
    let ks = Rgb::new(0.2, 0.3, 0.4);
    let glass = Specular::Glass { index: 1.3, reflectance: ks, transmittance: Rgb::gray(0.9) };
    for illum in 0..=10 {
        let (material, warnings) = material(&format!("{values}illum {illum}"));
        let (specular, has_diffuse) = match illum {
            5 => (Specular::Mirror { reflectance: ks }, false),
            3 => (Specular::Mirror { reflectance: ks }, true),
            4 | 6 | 7 | 9 => (glass, false),
            _ => (Specular::Phong { reflectance: ks, exponent: 7.0 }, true),
        };
        assert_eq!(material.specular, specular, "illum {illum}");
        assert_eq!(material.diffuse, if has_diffuse { Rgb::gray(0.1) } else { Rgb::BLACK }, "illum {illum}");
        assert_eq!(material.emission, Rgb::new(1.0, 2.0, 3.0));
        assert!(warnings.is_empty(), "{warnings:?}");
    }
}

#[test]
fn missing_statements_of_a_material_have_defaults() {
    let (plain, warnings) = material("Kd 0.1\nKs 0 0 0");
    assert_eq!((plain.specular, warnings.len()), (Specular::None, 0));
    let (glass, warnings) = material("illum 7");
    let white = Rgb::WHITE;
    assert_eq!(glass.specular, Specular::Glass { index: 1.5, reflectance: white, transmittance: white });
    assert!(warnings.len() == 1 && warnings[0].contains("`Ni`"), "{warnings:?}");
    let (phong, warnings) = material("Ks 0.5");
    assert_eq!(phong.specular, Specular::Phong { reflectance: Rgb::gray(0.5), exponent: 1.0 });
    assert!(warnings.len() == 1 && warnings[0].contains("`Ns`"), "{warnings:?}");
}

#[test]
fn materials_that_violate_energy_conservation_are_corrected_with_a_warning() {
    let (phong, warnings) = material("Kd 1.5 0.5 0.5\nKs 0.5\nNs 1");
    assert_eq!(phong.diffuse, Rgb::new(0.75, 0.25, 0.25));
    assert_eq!(phong.specular, Specular::Phong { reflectance: Rgb::gray(0.25), exponent: 1.0 });
    assert!(warnings.len() == 1 && warnings[0].contains("`Kd` + `Ks`"), "{warnings:?}");
    let (mirror, warnings) = material("illum 5\nKs 2 0.5 1");
    assert_eq!(mirror.specular, Specular::Mirror { reflectance: Rgb::new(1.0, 0.5, 1.0) });
    assert!(warnings.len() == 1 && warnings[0].contains("`Ks`"), "{warnings:?}");
    let (_, warnings) = material("Kd 0.700001\nKs 0.300001\nNs 1");
    assert!(warnings.is_empty(), "rounded decimals give no warning: {warnings:?}");
}

#[test]
fn unsupported_statements_give_one_warning_and_harmless_ones_none() {
    let (_, warnings) =
        material("Ka 1 1 1\nd 0.5\nTr 0.5\nKm 1\nPr 1\nmap_bump a.png\nmap_bump b.png\nshiny yes");
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings[0].contains("`map_bump`") && warnings[1].contains("`shiny`"));
}

#[test]
fn textures_of_all_formats_become_rgb_and_each_file_is_read_once() {
    let obj = format!("mtllib maps\\a.mtl\nusemtl a\n{TRIANGLE}usemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");
    let mtl = "newmtl a\nmap_Kd deep\\my wood.png\nnewmtl b\nKd 0.5\nmap_Kd ../maps/deep/my wood.png\nnewmtl c\nmap_Kd grey.png\n";
    let scene = format!("meshes: [models/a.obj, ./models/a.obj]\n{CAMERA}");
    let files = Files::new(&[("scene.yml", &scene), ("models/a.obj", &obj), ("models/maps/a.mtl", mtl)]);
    let maps = files.path("models/maps");
    std::fs::create_dir_all(maps.join("deep")).expect("a folder");
    let deep = image::ImageBuffer::from_fn(2, 1, |x, _| image::Rgba([65535 * x as u16, 257 * 3, 0, 100]));
    image::DynamicImage::ImageRgba16(deep).save(maps.join("deep/my wood.png")).expect("an image");
    image::GrayImage::from_pixel(1, 3, image::Luma([9])).save(maps.join("grey.png")).expect("an image");
    let loaded = files.load();
    let textures = &loaded.description.textures;
    assert_eq!(textures.len(), 2);
    assert_eq!((textures[0].width, textures[0].height), (2, 1));
    assert_eq!(textures[0].texels, [[0, 3, 0], [255, 3, 0]]);
    assert_eq!(textures[1].texels, [[9, 9, 9]; 3]);
    let materials = &loaded.description.materials;
    let maps: Vec<_> = materials.iter().map(|material| material.diffuse_map).collect();
    assert_eq!(maps, [Some(0), Some(0), Some(1)], "the same material of the same file is one, too");
    assert_eq!((materials[0].diffuse, materials[1].diffuse), (Rgb::WHITE, Rgb::gray(0.5)));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn texture_rows_are_stored_from_the_top() {
    let obj = format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}");
    let scene = format!("meshes: [a.obj]\n{CAMERA}");
    for name in ["a.png", "a.bmp", "a.tga"] {
        let mtl = format!("newmtl m\nmap_Kd {name}\n");
        let files = Files::new(&[("scene.yml", &scene), ("a.obj", &obj), ("a.mtl", &mtl)]);
        let picture = image::RgbImage::from_fn(1, 2, |_, y| image::Rgb([100 * y as u8, 1, 2]));
        picture.save(files.path(name)).expect("an image");
        assert_eq!(files.load().description.textures[0].texels, [[0, 1, 2], [100, 1, 2]], "{name}");
    }
}

#[test]
fn several_libraries_on_one_line_are_read() {
    let obj = format!("mtllib a.mtl b.mtl\nusemtl b\n{TRIANGLE}");
    let scene = format!("meshes: [a.obj]\n{CAMERA}");
    let files = [
        ("scene.yml", scene.as_str()),
        ("a.obj", &obj),
        ("a.mtl", "newmtl a\n"),
        ("b.mtl", "newmtl b\nKd 0.3\n"),
    ];
    assert_eq!(Files::new(&files).load().description.materials[0].diffuse, Rgb::gray(0.3));
}

#[test]
fn a_bare_file_name_is_relative_to_the_current_folder() {
    let error = load(Path::new("no_such_scene.yml")).expect_err("it does not exist");
    assert_eq!(error.file, Path::new("no_such_scene.yml"));
}
