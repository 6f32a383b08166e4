//! The cached program of the solution is compiled once, and again if it is damaged.

use std::time::Duration;

use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::reference::Oracle;

#[test]
fn the_solution_is_compiled_again_only_if_its_cached_program_is_damaged() {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let assignment = Assignment::open(&workspace, "05-nee-mis").expect("it is sound");
    let framework = assignment.framework(&workspace).expect("the framework builds");
    let compile_time = || {
        let oracle =
            Oracle::of(&workspace, &assignment, &framework).expect("it can be read").expect("it is there");
        oracle.program().expect("it compiles").compile_time
    };
    compile_time();
    assert_eq!(compile_time(), Duration::ZERO, "it was kept");

    let folder = workspace.framework_target().join("answers");
    let kept = || -> Vec<_> {
        let entries =
            std::fs::read_dir(&folder).expect("it is there").map(|entry| entry.expect("it is").path());
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "program")).collect()
    };
    let [program] = &kept()[..] else { panic!("one program is kept, not {}", kept().len()) };
    let mut bytes = std::fs::read(program).expect("it can be read");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(program, bytes).expect("it can be written");
    assert!(compile_time() > Duration::ZERO, "it is damaged");
    assert_eq!(compile_time(), Duration::ZERO, "it was kept once more");
}
