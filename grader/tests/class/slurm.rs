//! A class on a real Slurm of two nodes, one of which is lost in the middle.
//!
//! Needs the Debian packages `slurm-wlm` and `munge`, and root. `.ci/run` installs them and runs this test; so does
//! `cargo test -p grader --test class slurm -- --ignored` where they are installed.

use std::fs::File;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use classroom::class::shard::Shard;

use crate::course::{Course, solution};
use crate::shards::tables;

/// Number of submissions of each shard.
const STUDENTS: usize = 6;

/// Folders of the shards, and the logs of their tasks.
const SHARDS: [(&str, &str); 2] =
    [("many/shard-1-of-2", "many/slurm-1.log"), ("many/shard-2-of-2", "many/slurm-2.log")];

/// Submits the job in the arguments, and waits until no job is left.
const SUBMIT_AND_WAIT: &str = "\"$@\"; for _ in $(seq 1000); do queue=$(squeue -h) && [ -z \"$queue\" ] && exit; sleep 0.5; done; exit 1";

/// Keys of students, the same number for each of two shards.
fn students() -> Vec<String> {
    let of_shard = |index| {
        let shard = Shard { index, count: 2 };
        (0..).map(|number| format!("s{number}")).filter(move |key| shard.contains(key)).take(STUDENTS)
    };
    of_shard(1).chain(of_shard(2)).collect()
}

/// Name and content of each record of a shard.
fn records(course: &Course, shard: &str) -> Vec<(String, String)> {
    let mut records: Vec<_> = course
        .records(shard)
        .into_iter()
        .map(|path| (path.display().to_string(), std::fs::read_to_string(path).expect("it is there")))
        .collect();
    records.sort();
    records
}

#[test]
#[ignore = "needs Slurm, munge and root: .ci/run installs them and runs this test"]
fn a_node_that_is_lost_costs_nothing_but_what_was_in_flight() {
    let solution = solution();
    let course = Course::new(&[]);
    for student in students() {
        course.write(&format!("class/{student}/render_pt.rs"), &format!("// {student}\n{solution}"));
    }
    course.run(&["--out=one"]);

    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let log = File::create(course.path("log")).expect("it can be made");
    let rubric = course.path("rubric").display().to_string();
    let mut child = Command::new(here.join("tests/class/slurm.sh"))
        .arg(course.path("slurm"))
        .args(["bash", "-c", SUBMIT_AND_WAIT, "submit"])
        .arg(here.join("../assignments/05-nee-mis/ci/class-slurm.sh"))
        .args(["2", "class", "--no-report", "--allow-sandbox=none", "--assignment", &rubric])
        .env("GRADER", env!("CARGO_BIN_EXE_grader"))
        .env("OUT", "many")
        .env("CPUS_PER_TASK", "1")
        .env("MEM_PER_CPU", "1G")
        .env("MERGE_OPTIONS", format!("--no-report --assignment={rubric}"))
        .current_dir(course.path("."))
        .stdout(log.try_clone().expect("it is open"))
        .stderr(log)
        .spawn()
        .expect("bash starts");

    let start = Instant::now();
    let mut wait_until = |what: &str, is_so: &dyn Fn() -> bool| {
        while !is_so() {
            assert!(start.elapsed() < Duration::from_secs(600), "not within 600 s: {what}");
            let ended = child.try_wait().expect("it can be asked");
            assert!(ended.is_none(), "ended before {what}: {}", course.read("log"));
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    wait_until("both shards have a result", &|| {
        SHARDS.iter().all(|(shard, _)| !course.records(shard).is_empty())
    });
    course.write("slurm/lose-n2", "");
    wait_until("the node is lost", &|| course.path("slurm/lost-n2").exists());
    let lost: usize = course.read("slurm/lost-n2").trim().parse().expect("the number of its task");
    let (shard, shard_log) = SHARDS[lost - 1];
    let before = records(&course, shard);
    assert!(before.len() < STUDENTS, "it was lost before its end");
    assert!(child.wait().expect("it ends").success(), "{}", course.read("log"));

    assert_eq!(tables(&course, "many"), tables(&course, "one"));
    let kept = before.len();
    let told = course.read(shard_log);
    let expected = format!("shard {lost} of 2: {} graded now, {kept} unchanged", STUDENTS - kept);
    assert!(told.contains(&expected), "{expected}: {told}");
    let after = records(&course, shard);
    assert!(before.iter().all(|record| after.contains(record)), "what was graded is not graded again");
}
