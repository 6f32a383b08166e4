use arty::math::{Rgb, Vec3};

use super::*;

fn viewer(technique: Technique) -> Viewer {
    let camera = CameraDescription { eye: Vec3::Z, center: Vec3::ZERO, up: Vec3::Y, fov: 60.0 };
    Viewer::new(camera, Settings { technique, max_bounces: 2 }, (400, 300), true)
}

fn press(viewer: &mut Viewer, keys: &str) {
    for key in keys.chars() {
        assert_eq!(viewer.key(Key::Character(key)), None, "{key}");
    }
}

fn technique(viewer: &Viewer) -> Technique {
    viewer.settings.technique
}

#[test]
fn r_cycles_through_the_techniques_and_digits_pick_one() {
    let mut viewer = viewer(Technique::Mis);
    let mut seen = Vec::new();
    for _ in 0..3 {
        press(&mut viewer, "r");
        seen.push(technique(&viewer));
    }
    assert_eq!(seen, Technique::ALL);
    for (key, expected) in ["1", "2", "3"].into_iter().zip(Technique::ALL) {
        press(&mut viewer, key);
        let settings = Settings { technique: expected, max_bounces: 2 };
        assert_eq!(viewer.view().algorithm, Algorithm::PathTracer(settings));
    }
}

#[test]
fn bounces_change_the_picture_and_do_not_get_negative() {
    let mut viewer = viewer(Technique::Nee);
    press(&mut viewer, "]");
    assert_eq!(viewer.settings.max_bounces, 3);
    press(&mut viewer, "[[[[[");
    assert_eq!(viewer.settings.max_bounces, 0);
}

#[test]
fn what_is_only_shown_differently_is_not_rendered_again() {
    let mut viewer = viewer(Technique::Nee);
    let view = viewer.view();
    press(&mut viewer, "++-t? ,.bi");
    viewer.mouse(Gesture::Divider(30.0));
    assert_eq!(viewer.view(), view);
    assert_eq!((viewer.look.exposure, viewer.paused, viewer.help, viewer.numbers), (0.5, true, true, false));
    press(&mut viewer, "0");
    assert_eq!(viewer.look.exposure, 0.0);
}

#[test]
fn normals_and_albedo_are_switched_on_and_off() {
    let mut viewer = viewer(Technique::Nee);
    let radiance = viewer.view();
    press(&mut viewer, "n");
    assert_eq!(viewer.view().algorithm, Algorithm::Debug(DebugView::Normals));
    press(&mut viewer, "l");
    assert_eq!(viewer.view().algorithm, Algorithm::Debug(DebugView::Albedo));
    press(&mut viewer, "l");
    assert_eq!(viewer.view(), radiance);
}

#[test]
fn the_camera_follows_keys_and_mouse_and_home_leads_back() {
    let mut viewer = viewer(Technique::Nee);
    let home = viewer.view();
    for key in [Key::Left, Key::Up, Key::Character('w'), Key::Character('e')] {
        let before = viewer.view();
        viewer.key(key);
        assert_ne!(viewer.view().camera, before.camera, "{key:?}");
    }
    for gesture in [Gesture::Orbit(10.0, 0.0), Gesture::Pan(0.0, 5.0), Gesture::Zoom(-2.0)] {
        let before = viewer.view();
        viewer.mouse(gesture);
        assert_ne!(viewer.view().camera, before.camera, "{gesture:?}");
    }
    viewer.key(Key::Home);
    assert_eq!(viewer.view(), home);
}

#[test]
fn the_wipe_compares_with_a_technique_then_the_reference_then_nothing() {
    let mut viewer = viewer(Technique::Nee);
    press(&mut viewer, "v");
    assert_eq!(viewer.wipe, Some(Right::Technique(Technique::Mis)));
    assert_eq!(viewer.view().algorithms().len(), 2);
    press(&mut viewer, "c");
    assert_eq!(viewer.wipe, Some(Right::Technique(Technique::Bsdf)));
    press(&mut viewer, "1");
    assert_eq!(viewer.wipe, Some(Right::Technique(Technique::Nee)), "never the same at both sides");
    press(&mut viewer, "g");
    assert_eq!(viewer.view().balance, Balance::EqualTime);
    press(&mut viewer, "v");
    assert_eq!(viewer.view().against, Some(Against::Reference));
    press(&mut viewer, "v");
    assert_eq!(viewer.view().against, None);
}

#[test]
fn a_click_asks_for_the_paths_of_the_part_below_it() {
    let mut viewer = viewer(Technique::Nee);
    press(&mut viewer, "v");
    viewer.mouse(Gesture::Click(10.9, 20.0));
    let left = viewer.query.expect("paths");
    assert_eq!((left.pixel, left.settings.technique), ((10, 20), Technique::Nee));
    viewer.mouse(Gesture::Click(390.0, 20.0));
    assert_eq!(viewer.query.map(|query| query.settings.technique), Some(Technique::Mis));
    viewer.mouse(Gesture::Click(400.0, 20.0));
    assert_eq!(viewer.query.map(|query| query.pixel), Some((390, 20)), "a click beside the picture");
    viewer.key(Key::Left);
    assert_eq!(viewer.query.map(|query| query.camera), Some(left.camera), "paths stay when the camera moves");
}

#[test]
fn samples_are_stepped_through_and_the_brightest_is_found() {
    let mut viewer = viewer(Technique::Nee);
    viewer.mouse(Gesture::Click(10.0, 20.0));
    press(&mut viewer, "...,");
    let query = viewer.query.expect("paths");
    assert_eq!(query.sample, 2);
    let values = [0.5, 3.0, 0.1, 3.0].map(Rgb::gray).to_vec();
    let traced = Traced { query, values, paths: Ok(Vec::new()) };
    viewer.take(traced.clone());
    press(&mut viewer, "b");
    assert_eq!(viewer.query.map(|query| query.sample), Some(1), "the first of equals");
    let with_nan = Traced { values: vec![Rgb::WHITE, Rgb::gray(f32::NAN)], ..traced.clone() };
    assert_eq!(with_nan.brightest(), Some(1));
    viewer.traced = None;
    viewer.take(traced);
    assert_eq!(viewer.traced, None, "paths that arrive too late are dropped");
}

#[test]
fn escape_closes_paths_then_keys_then_the_wipe() {
    let mut viewer = viewer(Technique::Nee);
    viewer.mouse(Gesture::Click(10.0, 20.0));
    press(&mut viewer, "v?");
    let state = |viewer: &Viewer| (viewer.query.is_some(), viewer.help, viewer.wipe.is_some());
    let mut seen = Vec::new();
    for _ in 0..3 {
        viewer.key(Key::Escape);
        seen.push(state(&viewer));
    }
    assert_eq!(seen, [(false, true, true), (false, false, true), (false, false, false)]);
}
