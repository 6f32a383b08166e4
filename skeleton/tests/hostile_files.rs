//! Readers on damaged files: each one returns a scene or a single clear error, quickly and without a panic.
//!
//! The corpus is committed: the small scenes of `scenes/extreme/`, the broken files of `tests/broken/`, and one EXR file.
//! Each case damages one of these files in a few places. The cases are the same in every run and take some seconds.

#![cfg(feature = "files")]

use std::path::{Path, PathBuf};

use arty::image::exr::ExrFile;
use arty::scene::Scene;
use arty::scene::file::load;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed};

/// A modification of a file.
#[derive(Clone, Debug)]
enum Damage {
    /// Replaces a byte.
    Set(Index, u8),
    /// Removes a piece.
    Cut(Index, usize),
    /// Duplicates a piece.
    Repeat(Index, usize),
    /// Inserts a token of [`WORDS`].
    Insert(Index, usize),
    /// Truncates the file.
    End(Index),
}

/// Tokens with a meaning in one of the formats.
const WORDS: [&str; 22] = [
    "-1",
    "0",
    "1e39",
    "1e-46",
    "NaN",
    "inf",
    "4294967296",
    "99999999999999999999",
    "\n",
    "\r",
    "\0",
    "\u{feff}",
    "/",
    "//",
    "\\\n",
    "[",
    "}",
    "&a ",
    "*a",
    "!scale ",
    "f 1 1 1\n",
    "- ",
];

fn damage() -> impl Strategy<Value = Damage> {
    let piece = 1..40usize;
    prop_oneof![
        (any::<Index>(), any::<u8>()).prop_map(|(at, byte)| Damage::Set(at, byte)),
        (any::<Index>(), piece.clone()).prop_map(|(at, length)| Damage::Cut(at, length)),
        (any::<Index>(), piece).prop_map(|(at, length)| Damage::Repeat(at, length)),
        (any::<Index>(), 0..WORDS.len()).prop_map(|(at, word)| Damage::Insert(at, word)),
        any::<Index>().prop_map(Damage::End),
    ]
}

fn damaged(mut bytes: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    for damage in damages {
        if bytes.is_empty() {
            break;
        }
        let piece = |at: &Index, length: usize| {
            let start = at.index(bytes.len());
            start..(start + length).min(bytes.len())
        };
        match damage {
            Damage::Set(at, byte) => {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            Damage::Cut(at, length) => drop(bytes.drain(piece(at, *length))),
            Damage::Repeat(at, length) => {
                let piece = piece(at, *length);
                let copy = bytes[piece.clone()].to_vec();
                bytes.splice(piece.start..piece.start, copy);
            }
            Damage::Insert(at, word) => {
                let at = at.index(bytes.len());
                bytes.splice(at..at, WORDS[*word].bytes());
            }
            Damage::End(at) => bytes.truncate(at.index(bytes.len())),
        }
    }
    bytes
}

/// The same cases in each run.
fn config(cases: u32) -> Config {
    Config {
        cases,
        rng_seed: RngSeed::Fixed(5),
        rng_algorithm: RngAlgorithm::ChaCha,
        failure_persistence: None,
        max_shrink_iters: 200,
        ..Config::default()
    }
}

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The small files in a folder with one of these extensions.
fn corpus(folder: &Path, endings: &[&str]) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the corpus is there")
        .map(|entry| entry.expect("it can be listed").path())
        .filter(|path| path.extension().is_some_and(|ending| endings.iter().any(|&it| ending == it)))
        .map(|path| {
            let name = path.file_name().expect("it has a name").to_string_lossy().into_owned();
            (name, std::fs::read(&path).expect("it can be read"))
        })
        .filter(|(_, bytes)| bytes.len() < 3000)
        .collect();
    files.sort();
    files
}

/// The files of a scene that uses all features.
fn scene_folder() -> Vec<(&'static str, Vec<u8>)> {
    let extreme = project().join("scenes/extreme");
    let read = |name: &str| std::fs::read(extreme.join(name)).expect("the corpus is there");
    let scene = b"meshes:\n  - room.obj\n  - { file: prism.obj, transform: [!scale 2, !rotate { axis: [0, 1, 0], degrees: \
        30 }, !translate [0, 1, 0]] }\ncamera: !perspective_camera { eye: [0, 1, 4], center: [0, 1, 0], up: [0, 1, 0], fov: \
        40 }\nlights:\n  - !point_light { position: [0, 2, 0], color: [10, 10, 10] }\n  - !spot_light { position: [0, 2, 0], \
        direction: [0, -1, 0], inner: 20, outer: 30, color: [10, 10, 10] }\n  - !triangle_light { v0: [0, 2, 0], v1: [1, 2, \
        0], v2: [0, 2, 1], color: [5, 5, 5] }\ndefaults: { width: 8, height: 8, max_bounces: 8 }\n";
    vec![
        ("scene.yml", scene.to_vec()),
        ("room.obj", read("room.obj")),
        ("room.mtl", read("room.mtl")),
        ("prism.obj", read("prism.obj")),
        ("prism.mtl", read("prism.mtl")),
    ]
}

/// Reads a scene and builds it if it is valid.
fn try_scene(path: &Path) {
    match load(path) {
        Ok(loaded) => {
            let scene = Scene::new(&loaded.description);
            assert!(scene.features().triangles <= 10_000);
        }
        Err(diagnostic) => {
            let message = diagnostic.to_string();
            assert!(!message.trim().is_empty() && message.lines().count() <= 3, "{message}");
        }
    }
}

proptest! {
    #![proptest_config(config(1500))]

    #[test]
    fn a_damaged_scene_is_a_scene_or_one_clear_error(
        file in 0..5usize,
        damages in vec(damage(), 1..5),
    ) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for (index, (name, bytes)) in scene_folder().into_iter().enumerate() {
            let bytes = if index == file { damaged(bytes, &damages) } else { bytes };
            std::fs::write(folder.path().join(name), bytes).expect("it can be written");
        }
        try_scene(&folder.path().join("scene.yml"));
    }

    #[test]
    fn broken_files_with_more_damage_are_errors(
        file in any::<Index>(),
        damages in vec(damage(), 1..3),
    ) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = corpus(&project().join("skeleton/tests/broken"), &["yml", "obj", "mtl"]);
        let (name, bytes) = &files[file.index(files.len())];
        std::fs::write(folder.path().join(name), damaged(bytes.clone(), &damages)).expect("it can be written");
        let scene = folder.path().join("scene.yml");
        let camera = "camera: !perspective_camera { eye: [0, 1, 4], center: [0, 1, 0], up: [0, 1, 0], fov: 40 }\n";
        match name.rsplit_once('.') {
            Some((_, "obj")) => std::fs::write(&scene, format!("meshes: [\"{name}\"]\n{camera}")),
            Some((_, "mtl")) => std::fs::write(&scene, format!("meshes: [a.obj]\n{camera}")).and_then(|()| {
                let mesh = format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
                std::fs::write(folder.path().join("a.obj"), mesh)
            }),
            _ => std::fs::copy(folder.path().join(name), &scene).map(|_| ()),
        }
        .expect("it can be written");
        try_scene(&scene);
    }

    #[test]
    fn a_damaged_exr_file_is_an_image_or_one_clear_error(damages in vec(damage(), 1..6)) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.exr");
        let bytes = std::fs::read(project().join("references/area_plane.exr")).expect("the corpus is there");
        std::fs::write(&path, damaged(bytes, &damages)).expect("it can be written");
        match ExrFile::read(&path) {
            Ok(file) => {
                let samples = file.width * file.height;
                prop_assert!(file.channels.values().all(|channel| channel.len() == samples));
            }
            Err(diagnostic) => prop_assert!(!diagnostic.message.trim().is_empty()),
        }
    }
}

#[test]
fn the_undamaged_corpus_can_be_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, bytes) in scene_folder() {
        std::fs::write(folder.path().join(name), bytes).expect("it can be written");
    }
    let loaded = load(&folder.path().join("scene.yml")).expect("it is sound");
    assert_eq!((loaded.description.meshes.len(), loaded.description.lights.len()), (2, 3));
    assert!(ExrFile::read(&project().join("references/area_plane.exr")).is_ok());
    assert!(corpus(&project().join("skeleton/tests/broken"), &["yml", "obj", "mtl"]).len() > 50);
}
