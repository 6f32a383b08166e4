//! Time from a submission's source to its running process, and the share of the sandbox in it.
//!
//! `cargo bench -p harness`. The framework is built before the measurement, as for a grade.

use std::path::PathBuf;

use criterion::{Criterion, criterion_group, criterion_main};
use harness::assignment::AssignmentOption;
use harness::build::compile;
use harness::host_process::HostProcess;
use harness::sandbox::Limits;
use harness::workspace::Workspace;

fn build(criterion: &mut Criterion) {
    let workspace = Workspace::find().expect("the bench runs in the workspace");
    let assignment = AssignmentOption::default().open(&workspace).expect("there is one");
    let framework = assignment.framework(&workspace).expect("the framework builds");
    let source = |file: PathBuf| std::fs::read_to_string(file).expect("the file can be read");
    let scene = arty::scene::file::load(&workspace.scene_file("cornell_box"))
        .expect("the scene is in the collection")
        .description;
    let mut group = criterion.benchmark_group("submission");
    group.sample_size(20);
    for (name, sandbox) in [("", true), (", no sandbox", false)] {
        let limits = Limits { sandbox, ..Limits::default() };
        for (which, file) in
            [("starter", assignment.folder.starter_file()), ("solution", assignment.solution_file())]
        {
            let source = source(file);
            group.bench_function(format!("compile {which}{name}"), |b| {
                b.iter(|| {
                    compile(&framework, &source, &limits).expect("rustc runs").expect("the file compiles")
                });
            });
        }
        let program = compile(&framework, &source(assignment.solution_file()), &limits)
            .expect("rustc runs")
            .expect("the file compiles");
        group.bench_function(format!("start, end{name}"), |b| {
            b.iter(|| HostProcess::start(&program, 1).expect("the program starts"));
        });
        group.bench_function(format!("start, load cornell_box, end{name}"), |b| {
            b.iter(|| {
                let mut process = HostProcess::start(&program, 1).expect("the program starts");
                process.load(&scene).expect("the scene loads")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, build);
criterion_main!(benches);
