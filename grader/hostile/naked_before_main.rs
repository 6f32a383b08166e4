//! Its assembler names a function to the linker, so that it runs before `main`, when the host has not tightened anything.
//! It tries all that must not work, and tells what did.

use std::fs::{File, read, read_dir};
use std::net::{TcpListener, TcpStream, UdpSocket};
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::process::Command;
use std::sync::Mutex;

use arty::prelude::*;

/// What it could do; nothing as long as it has not run.
static REACHED: Mutex<Option<Vec<String>>> = Mutex::new(None);

/// A system call: the number first.
#[unsafe(naked)]
extern "C" fn call(number: i64, one: i64, two: i64, three: i64, four: i64) -> i64 {
    core::arch::naked_asm!(
        "mov rax, rdi",
        "mov rdi, rsi",
        "mov rsi, rdx",
        "mov rdx, rcx",
        "mov r10, r8",
        "xor r8d, r8d",
        "syscall",
        "ret",
    )
}

extern "C" fn first() {
    let mut reached = Vec::new();
    let mut check = |what: String, works: bool| {
        if works {
            reached.push(what);
        }
    };
    for file in [
        "/etc/passwd",
        "/etc/hostname",
        "@ROOT@/solution/src/algorithms/render_pt.rs",
        "@ROOT@/Cargo.toml",
        "/proc/self/maps",
        "/proc/self/mem",
        "/proc/self/status",
        "/bin/true",
        "render_pt.rs",
        "main.rs",
    ] {
        check(format!("open {file}"), File::open(file).is_ok());
    }
    check("read the program around it".to_owned(), read("main.rs").is_ok());
    for folder in ["/", "/tmp", ".", "..", "@ROOT@/references", "/proc"] {
        check(format!("list {folder}"), read_dir(folder).is_ok());
    }
    for file in ["/tmp/arty-owned", "arty-owned", "/dev/shm/arty-owned", "submission"] {
        let open = File::options().create(true).append(true).open(file);
        check(format!("write {file}"), open.is_ok());
    }
    for program in ["/usr/bin/id", "/bin/true", "/bin/sh", "./submission"] {
        check(format!("start {program}"), Command::new(program).output().is_ok());
        let path = format!("{program}\0");
        if program != "./submission" {
            check(format!("become {program}"), call(59, path.as_ptr() as i64, 0, 0, 0) != -13);
        }
    }
    check("connect".to_owned(), TcpStream::connect("127.0.0.1:@PORT@").is_ok());
    check("listen".to_owned(), TcpListener::bind("127.0.0.1:0").is_ok());
    check("UDP".to_owned(), UdpSocket::bind("127.0.0.1:0").is_ok());
    check("a pair of sockets".to_owned(), UnixStream::pair().is_ok());
    check("a datagram".to_owned(), UnixDatagram::unbound().is_ok());
    let parent = call(110, 0, 0, 0, 0);
    check(format!("its parent's number {parent}"), parent > 0);
    let own = call(39, 0, 0, 0, 0);
    let file = c"/tmp".as_ptr() as i64;
    let (grader, limit) = (i64::from(@GRADER@), [0_u64; 2]);
    for (what, [number, one, two, three, four]) in [
        ("signal all", [62, -1, 0, 0, 0]),
        ("signal the grader", [62, grader, 0, 0, 0]),
        ("signal a thread of the grader", [234, grader, grader, 0, 0]),
        ("abort the grader", [234, grader, grader, 6, 0]),
        ("queue a signal", [129, grader, 0, 0, 0]),
        ("end itself from outside", [234, own, own, 9, 0]),
        ("take hold of the grader", [434, grader, 0, 0, 0]),
        ("trace the grader", [101, 16, grader, 0, 0]),
        ("be traced", [101, 0, 0, 0, 0]),
        ("read the grader's memory", [310, grader, 0, 0, 0]),
        ("have signals sent by a file", [72, 0, 8, grader, 0]),
        ("fork", [57, 0, 0, 0, 0]),
        ("vfork", [56, 0x4111, 0, 0, 0]),
        ("clone", [56, 17, 0, 0, 0]),
        ("unshare", [272, 0x1000_0000, 0, 0, 0]),
        ("a socket", [41, 1, 1, 0, 0]),
        ("stat", [4, file, 0, 0, 0]),
        ("stat at", [262, -100, file, 0, 0]),
        ("a path that is not opened", [257, -100, file, 0x20_0000, 0]),
        ("access", [21, file, 0, 0, 0]),
        ("change modes", [90, c"submission".as_ptr() as i64, 0o777, 0, 0]),
        ("change owners", [92, c"submission".as_ptr() as i64, 0, 0, 0]),
        ("remove", [87, c"main.rs".as_ptr() as i64, 0, 0, 0]),
        ("rename", [82, c"main.rs".as_ptr() as i64, c"x".as_ptr() as i64, 0, 0]),
        ("a folder", [83, c"x".as_ptr() as i64, 0o777, 0, 0]),
        ("a link", [88, c"/etc/passwd".as_ptr() as i64, c"x".as_ptr() as i64, 0, 0]),
        ("a hard link", [86, c"submission".as_ptr() as i64, c"x".as_ptr() as i64, 0, 0]),
        ("another folder", [80, file, 0, 0, 0]),
        ("another root", [161, file, 0, 0, 0]),
        ("another user", [105, 0, 0, 0, 0]),
        ("a file in memory", [319, c"x".as_ptr() as i64, 0, 0, 0]),
        ("execute a file that is open", [322, 0, c"".as_ptr() as i64, 0, 0]),
        ("shared memory", [29, 0, 4096, 0o600, 0]),
        ("io_uring", [425, 1, 0, 0, 0]),
        ("bpf", [321, 0, 0, 0, 0]),
        ("userfaultfd", [323, 1, 0, 0, 0]),
        ("mount", [165, file, file, 0, 0]),
        ("a key", [250, 0, -3, 1, 0]),
        ("higher limits", [302, 0, 7, limit.as_ptr() as i64, 0]),
        ("limits of the grader", [302, grader, 7, 0, 0]),
    ] {
        check(what.to_owned(), call(number, one, two, three, four) != -1);
    }
    *REACHED.lock().unwrap() = Some(reached);
}

#[unsafe(naked)]
extern "C" fn place() {
    core::arch::naked_asm!(
        ".pushsection .init_array, \"aw\"",
        ".balign 8",
        ".quad {first}",
        ".popsection",
        "ret",
        first = sym first,
    )
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        place();
        match &*REACHED.lock().unwrap() {
            Some(reached) if reached.is_empty() => panic!("it ran before main, and reached nothing"),
            Some(reached) => panic!("BREACH: {reached:?}"),
            None => panic!("it did not run before main"),
        }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
