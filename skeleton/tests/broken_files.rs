//! Broken scene files, meshes, materials and images are refused with a helpful message.

#![cfg(feature = "files")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use arty::diagnostic::Diagnostic;
use arty::scene::file::load;

/// A file in `tests/broken`, the line of the error, and words that the message must contain.
type Case = (&'static str, Option<usize>, &'static [&'static str]);

#[rustfmt::skip]
const CASES: &[Case] = &[
    ("empty.yml", None, &["is empty"]),
    ("only_a_comment.yml", None, &["is empty"]),
    ("control_character.yml", Some(2), &["control characters"]),
    ("very_long_value.yml", Some(2), &["camera.fov", "…", "field of view"]),
    ("not_utf8.yml", Some(2), &["UTF-8"]),
    ("syntax.yml", None, &[]),
    ("tab_indent.yml", Some(2), &["tab"]),
    ("list_at_top.yml", Some(1), &["sequence", "`meshes`"]),
    ("unknown_key.yml", Some(3), &["`ligths`", "`lights`"]),
    ("key_twice.yml", Some(2), &["duplicate", "`meshes`"]),
    ("no_camera.yml", Some(1), &["missing", "`camera`"]),
    ("no_meshes.yml", Some(1), &["missing", "`meshes`"]),
    ("unknown_camera.yml", Some(2), &["`fisheye`", "`perspective_camera`"]),
    ("camera_without_tag.yml", Some(2), &["tag"]),
    ("camera_unknown_key.yml", Some(4), &["`centre`", "`center`"]),
    ("camera_no_fov.yml", Some(2), &["missing", "`fov`"]),
    ("fov_180.yml", Some(2), &["camera.fov", "180"]),
    ("fov_is_a_word.yml", Some(2), &["wide", "field of view"]),
    ("eye_is_center.yml", Some(2), &["`eye`", "`center`", "same point"]),
    ("up_is_parallel.yml", Some(2), &["`up`", "parallel"]),
    ("up_is_zero.yml", Some(2), &["`up`", "zero"]),
    ("infinite_eye.yml", Some(2), &["camera.eye", "finite"]),
    ("too_large_for_single.yml", Some(2), &["camera.eye", "finite"]),
    ("two_coordinates.yml", Some(2), &["camera.eye", "length 2", "3"]),
    ("unknown_light.yml", Some(5), &["`sun`", "`point_light`", "`spot_light`"]),
    ("negative_color.yml", Some(6), &["color", "-1", "non-negative"]),
    ("spot_inner_greater.yml", Some(4), &["`inner` is 30", "`outer` is 20"]),
    ("spot_outer_zero.yml", Some(4), &["`outer` is 0"]),
    ("spot_no_direction.yml", Some(4), &["`direction`", "zero"]),
    ("flat_triangle_light.yml", Some(4), &["no area"]),
    ("width_zero.yml", Some(5), &["defaults.width", "1 to 65536"]),
    ("height_too_large.yml", Some(3), &["defaults.height", "65536"]),
    ("bounces_negative.yml", Some(3), &["defaults.max_bounces", "0 or more"]),
    ("scale_zero.yml", Some(2), &["singular"]),
    ("rotate_no_axis.yml", Some(4), &["axis", "zero"]),
    ("matrix_of_15.yml", Some(4), &["length 15", "16"]),
    ("matrix_projective.yml", Some(4), &["last row"]),
    ("unknown_transform.yml", Some(4), &["`shear`", "`rotate`"]),
    ("mesh_is_a_number.yml", Some(1), &["7", "OBJ"]),
    ("alias_bomb.yml", Some(1), &["unknown", "`a`"]),
    ("alias_bomb_in_a_vector.yml", Some(2), &["sequence", "OBJ"]),
    ("deep_brackets.yml", Some(1), &["brackets"]),
    ("deep_dashes.yml", Some(2), &[]),
    ("tab_in_a_name.yml", Some(1), &["`models\table.obj`", "tab", "single quotes"]),
    ("unknown_escape.yml", Some(1), &["escape", "single quotes"]),
    ("two_documents.yml", None, &["more than one document"]),
    ("cycle.yml", Some(1), &[]),
    ("garbage_statement.obj", Some(4), &["`hello`", "not a statement"]),
    ("vertex_two_numbers.obj", Some(2), &["`v`", "3 numbers", "has 2"]),
    ("vertex_five_numbers.obj", Some(2), &["3 numbers", "has 5"]),
    ("vertex_is_a_word.obj", Some(2), &["`zero`"]),
    ("vertex_two_points.obj", Some(2), &["`0.0.0`"]),
    ("vertex_nan.obj", Some(2), &["`nan`", "not finite"]),
    ("vertex_overflow.obj", Some(2), &["`1e99`", "not finite"]),
    ("vertex_weight_zero.obj", Some(2), &["weight 0"]),
    ("normal_two_numbers.obj", Some(4), &["`vn`", "has 2"]),
    ("uv_one_number.obj", Some(4), &["`vt`", "2 numbers"]),
    ("index_zero.obj", Some(4), &["start at 1"]),
    ("index_too_large.obj", Some(4), &["vertex 4", "only 3"]),
    ("index_of_uv_too_large.obj", Some(5), &["texture coordinate 2", "only 1"]),
    ("index_of_normal_missing.obj", Some(4), &["normal 1", "only 0"]),
    ("relative_index_too_far.obj", Some(4), &["vertex -4", "3"]),
    ("index_overflow.obj", Some(4), &["whole number"]),
    ("index_is_a_word.obj", Some(4), &["`three`"]),
    ("four_parts.obj", Some(4), &["three parts"]),
    ("corner_without_vertex.obj", Some(4), &[]),
    ("mixed_corners.obj", Some(5), &["same form"]),
    ("face_two_corners.obj", Some(4), &["3 corners", "has 2"]),
    ("face_empty.obj", Some(4), &["3 corners", "has 0"]),
    ("usemtl_nothing.obj", Some(4), &["`usemtl`"]),
    ("mtllib_nothing.obj", Some(1), &["`mtllib`"]),
    ("usemtl_unknown.obj", Some(5), &["`golden`", "good.mtl"]),
    ("not_utf8.obj", Some(4), &["UTF-8"]),
    ("kd_two_numbers.mtl", Some(2), &["`Kd`", "3 numbers", "has 2"]),
    ("kd_spectral.mtl", Some(2), &["`spectral`"]),
    ("kd_negative.mtl", Some(3), &["`Kd`", "-0.5", "negative"]),
    ("ke_nan.mtl", Some(2), &["`Ke`", "not finite"]),
    ("ns_negative.mtl", Some(3), &["`Ns`", "negative"]),
    ("ns_nothing.mtl", Some(2), &["`Ns`", "one number"]),
    ("ni_zero.mtl", Some(3), &["`Ni`", "greater than 0"]),
    ("illum_11.mtl", Some(2), &["`illum`", "0 to 10", "11"]),
    ("illum_half.mtl", Some(2), &["`illum`", "1.5"]),
    ("newmtl_nothing.mtl", Some(1), &["`newmtl`"]),
    ("before_newmtl.mtl", Some(2), &["`Kd`", "first `newmtl`"]),
    ("map_nothing.mtl", Some(2), &["`map_Kd`", "image"]),
    ("not_utf8.mtl", Some(2), &["UTF-8"]),
    ("empty.png", None, &["image", "named in"]),
    ("text.png", None, &["image", "named in"]),
    ("truncated.png", None, &["image"]),
    ("bad_checksum.png", None, &["image"]),
    ("huge.png", None, &["image", "named in"]),
    ("zero_size.png", None, &["image"]),
    ("not_an_image_name.txt", None, &["image"]),
    ("truncated.bmp", None, &["image"]),
    ("truncated.tga", None, &["image"]),
];

/// Intact files that others refer to.
const INTACT: [&str; 2] = [".gitattributes", "good.mtl"];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken")
}

/// Loads a scene that uses `file` according to its extension.
fn load_with(file: &Path) -> Result<arty::scene::file::Loaded, Diagnostic> {
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: String| {
        let path = scratch.path().join(name);
        std::fs::write(&path, text).expect("a temporary file");
        path
    };
    let obj = |library: &Path| {
        let library = library.display();
        write("scene.obj", format!("mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"))
    };
    let scene = |mesh: &Path| {
        let camera = "!perspective_camera { eye: [0, 0, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40 }";
        write("scene.yml", format!("meshes: ['{}']\ncamera: {camera}\n", mesh.display()))
    };
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("yml") => load(file),
        Some("obj") => load(&scene(file)),
        Some("mtl") => load(&scene(&obj(file))),
        _ => {
            let image = file.display();
            load(&scene(&obj(&write("scene.mtl", format!("newmtl m\nmap_Kd {image}\n")))))
        }
    }
}

#[test]
fn every_broken_file_is_refused_with_its_name_line_and_reason() {
    let mut problems = Vec::new();
    for (name, line, words) in CASES {
        let file = folder().join(name);
        match load_with(&file) {
            Ok(_) => problems.push(format!("{name} was accepted")),
            Err(error) => {
                let wrong_line = line.is_some_and(|line| error.line != Some(line));
                let missing = words.iter().find(|word| !error.message.contains(**word));
                if error.file != file || wrong_line || missing.is_some() {
                    problems.push(format!("{name}, line {line:?}, without {missing:?}: {error}"));
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn every_file_in_the_folder_is_tested() {
    let there: BTreeSet<String> = std::fs::read_dir(folder())
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("a name"))
        .filter(|name| !INTACT.contains(&name.as_str()))
        .collect();
    let tested = CASES.iter().map(|(name, ..)| (*name).to_owned()).collect();
    assert_eq!(there, tested);
}

#[test]
fn truncated_images_are_refused() {
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let picture = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([(6 * x) as u8, (8 * y) as u8, 77]));
    for name in ["cut.jpg", "cut.png", "cut.bmp", "cut.tga"] {
        let file = scratch.path().join(name);
        picture.save(&file).expect("an image");
        let whole = std::fs::read(&file).expect("the image");
        load_with(&file).expect("the whole image is fine");
        for kept in [1, 2, 10, whole.len() / 3, whole.len() / 2, whole.len() - 100] {
            std::fs::write(&file, &whole[..kept]).expect("a cut image");
            let error = load_with(&file).expect_err(&format!("{name} cut to {kept} of {}", whole.len()));
            assert_eq!(error.file, file);
            assert!(error.message.contains("scene.mtl:2"), "{error}");
        }
    }
}

#[test]
fn missing_files_folders_and_oversized_files_are_refused() {
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let missing = load(&scratch.path().join("missing.yml")).expect_err("it is missing");
    assert!(missing.message.contains("no such file"), "{missing}");
    let is_folder = load(scratch.path()).expect_err("it is a folder");
    assert!(is_folder.message.contains("folder"), "{is_folder}");

    // Sparse files take no disk space.
    for (name, bytes) in
        [("huge.yml", 5 << 20), ("huge.obj", 2 << 30), ("huge.mtl", 1 << 30), ("huge.png", 2 << 30)]
    {
        let file = scratch.path().join(name);
        std::fs::File::create(&file).and_then(|file| file.set_len(bytes)).expect("a sparse file");
        let error = load_with(&file).expect_err(name);
        assert!(error.message.contains("at most"), "{error}");
        assert_eq!(error.file, file);
    }
}

#[test]
fn a_missing_file_is_reported_with_the_place_where_it_is_named() {
    let scratch = tempfile::tempdir().expect("a temporary folder");
    for (name, place) in [("no.obj", "scene.yml:1"), ("no.mtl", "scene.obj:1"), ("no.png", "scene.mtl:2")] {
        let file = scratch.path().join(name);
        let error = load_with(&file).expect_err(name);
        assert_eq!(error.file, file);
        assert!(error.message.contains("no such file") && error.message.contains(place), "{error}");
    }
}
