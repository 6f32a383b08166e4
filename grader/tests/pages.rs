//! The pages of a class and of its submissions, made by the program and used in a browser as a person would.
//!
//! Without Chromium the test says that it was left out. The checks of the rubric below need few samples, and seeds are
//! fixed: each run gives the same pages. With `ARTY_SCREENSHOTS=DIR`, pictures of the pages are left there to look at.

mod browser;

use std::path::{Path, PathBuf};
use std::process::Command;

use browser::Browser;
use serde_json::json;

const RUBRIC: &str = "
assignment: tiny
title: A few cheap checks
submission: { file: skeleton/src/algorithms/render_pt.rs, contract: path-tracer, solution: solution/src/algorithms/render_pt.rs }
techniques: [bsdf, nee, mis]
reference_technique: mis
pictures: [veach_mis]
tasks:
  - id: '1'
    title: Light
    points: 10
    checks:
      - { check: mean-bias, scene: point_plane, technique: mis, max_bounces: 1, required: true, tolerance: 0.01 }
      - { check: white-furnace, scene: furnace_diffuse, technique: mis, max_bounces: 3, tolerance: 0.01 }
      - { check: mis-weights, technique: mis, max_bounces: 1 }
      - { check: hidden-variants, technique: nee, max_bounces: 1, tolerance: 0.2 }
  - { id: '2', title: Why, points: 5, manual: true }
";

/// What somebody may be called who looks for trouble.
const EVIL: &str = "<script>document.title='taken'</script><img src=x onerror=document.title='taken'>";

fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).expect("it is there")
}

/// A graded class of four: right, untouched, one that does not compile, and one that panics with markup.
fn graded(folder: &Path) -> PathBuf {
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().expect("it has one")).expect("it can be made");
        std::fs::write(path, text).expect("it can be written");
    };
    write("rubric/rubric.yml", RUBRIC);
    write("rubric/starter.rs", &read("assignments/05-nee-mis/starter.rs"));
    write("class/ann/render_pt.rs", &read("solution/src/algorithms/render_pt.rs"));
    write("class/bob/render_pt.rs", &read("assignments/05-nee-mis/starter.rs"));
    write("class/cem/render_pt.rs", &format!("fn main( {{ {EVIL}"));
    write(
        "class/dan/render_pt.rs",
        &format!(
            "use arty::prelude::*;\npub struct PathTracer;\nimpl PathTracer {{ pub fn new(_: Settings) -> Self {{ Self }} }}\n\
             impl Integrator for PathTracer {{ fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {{ panic!(\"{EVIL}\") }} }}\n"
        ),
    );
    write(
        "roster.csv",
        &format!("login,first name,last name\nann,Ann,{EVIL}\nbob,Bob,B\ncem,Cem,C\ndan,Dan,D\neve,Eve,E\n"),
    );
    let output = Command::new(env!("CARGO_BIN_EXE_grader"))
        .args(["class", "class", "--roster", "roster.csv", "--assignment"])
        .arg(folder.join("rubric"))
        .current_dir(folder)
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    folder.join("class-report")
}

/// What a canvas shows, as a number that differs wherever pictures do.
const SHOWN: &str = "(() => { const c = document.querySelector('canvas.view'); let sum = 0; \
    const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
    for (let i = 0; i < d.length; i++) sum = (sum * 31 + d[i]) % 4294967291; return sum; })()";
const BRIGHTNESS: &str = "(() => { const c = document.querySelector('canvas.view'); \
    return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((a, b) => a + b, 0); })()";
const VIEW: &str = "document.querySelector('canvas.view')";
const PROBE: &str = "document.querySelector('.probe').textContent";
const REPLAY: &str = "document.querySelector('.replay').textContent";

#[test]
fn both_pages_do_what_a_person_expects() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = graded(folder.path());
    let ann = out.join("submissions/ann");
    nothing_hidden_is_in_the_students_edition(&out);
    what_a_page_must_not_do_is_seen(&mut browser, &ann.join("report.html"), folder.path());
    a_report_can_be_looked_at(&mut browser, &ann.join("report-tutor.html"));
    a_report_can_be_used_without_a_mouse(&mut browser, &ann.join("report.html"));
    a_class_can_be_sorted_and_searched(&mut browser, &out);
    if let Some(script) = browser::axe::script() {
        for page in [ann.join("report.html"), ann.join("report-tutor.html"), out.join("class.html")] {
            let found = browser::axe::violations(&mut browser, &script, &page);
            assert_eq!(found, "", "{}", page.display());
        }
    }
    for key in ["bob", "cem", "dan"] {
        for page in ["report.html", "report-tutor.html"] {
            browser.open(&out.join("submissions").join(key).join(page), 1000, 800);
            assert_eq!(browser.complaints(), Vec::<String>::new(), "{key}, {page}");
            assert_ne!(browser.text("document.title"), "taken", "{key}, {page}");
        }
    }
    if let Some(to) = std::env::var_os("ARTY_SCREENSHOTS") {
        look(&mut browser, &out, Path::new(&to));
    }
}

fn nothing_hidden_is_in_the_students_edition(out: &Path) {
    for key in ["ann", "bob", "cem", "dan"] {
        let read = |name: &str| {
            std::fs::read_to_string(out.join("submissions").join(key).join(name)).expect("it is there")
        };
        let (student, tutor) = (read("report.html"), read("report-tutor.html"));
        assert!(!student.contains("hidden-variants"), "{key}");
        assert!(key == "cem" || tutor.contains("hidden-variants"), "{key}: what compiles has such a check");
        assert!(student.len() < 3_000_000 && tutor.len() < 3_000_000, "{key}: {} bytes", tutor.len());
        let machine = out.parent().expect("it has one").display().to_string();
        assert!(!student.contains(&machine), "{key}: a path of the staff's machine");
    }
}

/// Were a submission's markup to get into a page, the policy would stop it, and this test would know.
fn what_a_page_must_not_do_is_seen(browser: &mut Browser, page: &Path, folder: &Path) {
    let text = std::fs::read_to_string(page).expect("it is there");
    let taken = folder.join("taken.html");
    for (markup, complaint) in [
        (EVIL, "Content Security Policy"),
        ("<img src='https://example.org/x.png'>", "Content Security Policy"),
        ("<link rel=stylesheet href='https://example.org/x.css'>", "Content Security Policy"),
    ] {
        std::fs::write(&taken, text.replacen("<main>", &format!("<main>{markup}"), 1))
            .expect("it can be written");
        browser.open(&taken, 1000, 800);
        let complaints = browser.complaints();
        assert!(complaints.iter().any(|it| it.contains(complaint)), "{markup}: {complaints:?}");
        assert_ne!(browser.text("document.title"), "taken");
    }
}

fn a_report_can_be_looked_at(browser: &mut Browser, page: &Path) {
    browser.open(page, 1280, 900);
    assert_eq!(browser.complaints(), Vec::<String>::new());
    assert_eq!(browser.ask("document.querySelectorAll('figure.pictures').length"), json!(2));
    assert_eq!(
        browser.ask("document.querySelectorAll('svg.plot').length"),
        json!(3),
        "weights, furnace, p-values"
    );

    // Techniques: BSDF sampling is noisier, and another picture.
    let mis = browser.ask(SHOWN);
    browser.click("document.querySelector('[data-strip=bsdf]')", (0.5, 0.5));
    assert_ne!(browser.ask(SHOWN), mis);
    assert!(browser.text(REPLAY).contains("--technique=bsdf"));
    browser.click("document.querySelector('[data-strip=mis]')", (0.5, 0.5));

    // Exposure, with the slider's own keys.
    let before = browser.ask(BRIGHTNESS).as_f64();
    browser.focus("document.querySelector('[name=exposure]')");
    for _ in 0..4 {
        browser.press("ArrowRight");
    }
    assert_eq!(browser.text("document.querySelector('[name=stops]').textContent"), "1");
    assert!(browser.ask(BRIGHTNESS).as_f64() > before, "one stop brighter");
    browser.click("document.querySelector('[name=exposure]')", (0.02, 0.5));
    assert!(browser.ask(BRIGHTNESS).as_f64() < before, "far darker");
    browser.focus(VIEW);
    browser.press("0");

    // The wipe: all of it is the reference.
    let submission = browser.ask(SHOWN);
    browser.focus("document.querySelector('[name=wipe]')");
    browser.press("Home");
    let wiped = browser.ask(SHOWN);
    browser.press("End");
    assert_eq!(browser.ask(SHOWN), submission, "and back");
    browser.click("document.querySelector('[name^=mode][value=reference]')", (0.5, 0.5));
    assert_eq!(browser.ask(SHOWN), wiped);
    assert_ne!(wiped, submission);
    for mode in ["difference", "z", "flip"] {
        let before = browser.ask(SHOWN);
        browser.click(&format!("document.querySelector('[name^=mode][value={mode}]')"), (0.5, 0.5));
        assert_ne!(browser.ask(SHOWN), before, "{mode}");
    }
    browser.click("document.querySelector('[name^=mode][value=submission]')", (0.5, 0.5));

    // The pixel under the mouse; a click holds it.
    browser.point(VIEW, (0.26, 0.51));
    let probe = browser.text(PROBE);
    assert!(probe.starts_with("pixel (41, 65)"), "{probe}");
    assert!(probe.contains("reference") && probe.contains("z "), "{probe}");
    browser.click(VIEW, (0.26, 0.51));
    browser.point(VIEW, (0.903, 0.903));
    assert!(browser.text(PROBE).starts_with("pixel (41, 65), held"), "{}", browser.text(PROBE));
    follow(&browser.text(REPLAY), page);
    browser.click(VIEW, (0.903, 0.903));
    assert!(browser.text(PROBE).starts_with("pixel (144, 115)\n"), "{}", browser.text(PROBE));

    // The paths of the worst pixel, of the technique that is shown; each other sample has other lines.
    let shown = "[...document.querySelectorAll('svg.paths.shown')].map((it) => it.dataset.technique).join()";
    let chosen = "document.querySelector('svg.paths.shown .chosen').outerHTML";
    browser.focus(VIEW);
    browser.press("p");
    assert_eq!(browser.text(shown), "mis");
    let probe = browser.text(PROBE);
    assert!(probe.contains(", held") && probe.contains("\nsample "), "{probe}");
    let lines = browser.text("document.querySelector('svg.paths.shown').innerHTML");
    assert!(lines.contains("bounce") && lines.contains("arrives") && lines.contains("blocked"), "{lines}");
    let before = (browser.text(chosen), browser.text(REPLAY));
    browser.press(".");
    let after = (browser.text(chosen), browser.text(REPLAY));
    assert!(before.0 != after.0 && before.1 != after.1, "{before:?} {after:?}");
    browser.press("b");
    assert_eq!(browser.text(shown), "bsdf");
    browser.press("m");
    browser.press("p");
    assert_eq!(browser.text(shown), "");
    browser.click(VIEW, (0.903, 0.903));
    browser.click(VIEW, (0.903, 0.903));

    // Zoom, towards the mouse.
    browser.turn_wheel(VIEW, (0.903, 0.903), -100.0);
    browser.wait("document.querySelector('[name=zoom]').value === '0.5'");
    browser.point(VIEW, (0.903, 0.903));
    let probe = browser.text(PROBE);
    assert!(probe.starts_with("pixel (144, 115)"), "{probe}");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Runs the command of a pixel, as somebody who has copied it.
fn follow(command: &str, page: &Path) {
    // In the folder in which the class was graded: that of `class-report/submissions/ann/report-tutor.html`.
    let folder = page.ancestors().nth(4).expect("it lies deep enough");
    let arguments = command.strip_prefix("cargo grader ").expect(command);
    let output = Command::new(env!("CARGO_BIN_EXE_grader"))
        .args(arguments.split(' '))
        .current_dir(folder)
        .output()
        .expect("it starts");
    assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
}

fn a_report_can_be_used_without_a_mouse(browser: &mut Browser, page: &Path) {
    browser.open(page, 1280, 900);
    // Everything that can be used is reached by Tab, and is named.
    let unnamed = "[...document.querySelectorAll('input, select, button')].filter((it) => !it.labels?.length && \
                   !it.textContent.trim()).length";
    assert_eq!(browser.ask(unnamed), json!(0));
    browser.focus("document.querySelector('summary')");
    let mut reached = false;
    for _ in 0..40 {
        browser.press("Tab");
        reached |= browser.ask(&format!("document.activeElement === {VIEW}")) == json!(true);
    }
    assert!(reached, "Tab leads to the pictures");
    browser.focus(VIEW);
    browser.press("ArrowRight");
    browser.press("ArrowDown");
    assert!(browser.text(PROBE).starts_with("pixel (81, 65)"), "{}", browser.text(PROBE));
    let submission = browser.ask(SHOWN);
    browser.press("2");
    let reference = browser.ask(SHOWN);
    assert_ne!(reference, submission);
    browser.press("f");
    assert_eq!(browser.ask(SHOWN), submission, "flipped back");
    browser.press("f");
    assert_eq!(browser.ask(SHOWN), reference);
    browser.press("1");
    browser.press("b");
    assert!(browser.text(REPLAY).contains("--technique=bsdf"));
    browser.press("+");
    assert_eq!(browser.text("document.querySelector('[name=zoom]').value"), "0.5");
    browser.press("e");
    assert_eq!(browser.text("document.querySelector('[name=exposure]').value"), "0.5");
    browser.press("0");
    browser.press("m");
    assert_eq!(browser.ask(SHOWN), submission, "all as it was");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

fn a_class_can_be_sorted_and_searched(browser: &mut Browser, out: &Path) {
    browser.open(&out.join("class.html"), 1280, 900);
    assert_eq!(browser.complaints(), Vec::<String>::new());
    assert_ne!(browser.text("document.title"), "taken");
    let order = "[...document.querySelector('table.sortable').tBodies[0].rows].filter((row) => !row.hidden)\
                 .map((row) => row.cells[0].textContent.trim()).join(' ')";
    assert_eq!(browser.text(order), "ann bob cem dan eve");
    let head = |text: &str| {
        format!(
            "[...document.querySelectorAll('table.sortable th button')].find((it) => it.textContent === '{text}')"
        )
    };
    let sorted = |text: &str| format!("{}.parentElement.getAttribute('aria-sort')", head(text));
    browser.click(&head("points"), (0.5, 0.5));
    assert_eq!(browser.text(&sorted("points")), "ascending");
    assert!(browser.text(order).ends_with("ann"), "{}", browser.text(order));
    // The same with the keyboard.
    browser.focus(&head("points"));
    browser.press("Enter");
    assert_eq!(browser.text(&sorted("points")), "descending");
    assert!(browser.text(order).starts_with("ann"), "{}", browser.text(order));
    browser.click(&head("student"), (0.5, 0.5));
    assert_eq!(browser.text(order), "ann bob cem dan eve");
    assert_eq!(browser.text(&sorted("points")), "none");
    browser.focus("document.querySelector('#filter')");
    for letter in ["c", "o", "m", "p", "i", "l", "e"] {
        browser.press(letter);
    }
    assert_eq!(browser.text(order), "cem");
    // Small pictures are there, and links lead to what is there.
    browser.wait("[...document.images].length > 0 && [...document.images].every((it) => it.scrollIntoView() || it.naturalWidth > 0)");
    let links = browser.ask("[...document.querySelectorAll('a')].map((it) => it.getAttribute('href'))");
    let links = links.as_array().expect("a list");
    assert!(links.len() >= 6, "{links:?}");
    for link in links.iter().filter_map(|link| link.as_str()) {
        assert!(out.join(link).is_file(), "{link}");
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Leaves pictures of the pages, for a person to look at.
fn look(browser: &mut Browser, out: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("it can be made");
    for (page, name) in [
        ("class.html", "class"),
        ("submissions/ann/report-tutor.html", "report"),
        ("submissions/bob/report.html", "wrong"),
    ] {
        for (look, width, media, scheme) in [
            ("light", 1280, "", "light"),
            ("dark", 1280, "", "dark"),
            ("narrow", 400, "", "light"),
            ("print", 800, "print", "light"),
        ] {
            let features = json!([{"name": "prefers-color-scheme", "value": scheme}]);
            browser.call("Emulation.setEmulatedMedia", json!({"media": media, "features": features}));
            browser.open(&out.join(page), width, 900);
            browser.screenshot(&to.join(format!("{name}-{look}.png")));
        }
    }
}
