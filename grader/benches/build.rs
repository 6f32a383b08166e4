//! How long it takes from a hand-in's source to its running process.
//!
//! `cargo bench -p grader`. The framework is built before, as for a grade.

use std::path::PathBuf;

use criterion::{Criterion, criterion_group, criterion_main};
use grader::build::{Framework, compile};
use grader::host_process::HostProcess;
use grader::workspace::Workspace;

fn build(criterion: &mut Criterion) {
    let workspace = Workspace::find().expect("the bench runs in the workspace");
    let framework = Framework::build(&workspace).expect("the framework builds");
    let source = |file: PathBuf| std::fs::read_to_string(file).expect("the file can be read");
    let mut group = criterion.benchmark_group("hand-in");
    group.sample_size(20);
    for (name, file) in [("starter", workspace.student_file()), ("solution", workspace.solution_file())] {
        let source = source(file);
        group.bench_function(format!("compile {name}"), |b| {
            b.iter(|| compile(&framework, &source).expect("rustc runs").expect("the file compiles"));
        });
    }

    let program = compile(&framework, &source(workspace.solution_file()))
        .expect("rustc runs")
        .expect("the file compiles");
    let scene = arty::scene::file::load(&workspace.scene_file("cornell_box"))
        .expect("the scene is in the collection")
        .description;
    group.bench_function("start, load cornell_box, end", |b| {
        b.iter(|| {
            let mut process = HostProcess::start(&program, 1).expect("the program starts");
            process.load(&scene).expect("the pipe holds").expect("the scene loads")
        });
    });
    group.finish();
}

criterion_group!(benches, build);
criterion_main!(benches);
