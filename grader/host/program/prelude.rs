// The beginning of the fixed program around a submission. The submission's module follows, then `main`, which depends on
// the assignment's contract. The student's file is placed beside it, and one call of rustc compiles both against the
// prebuilt framework.

// A submission that prints must not lose time to it: these take the place of the standard library's macros in the module
// below. What is printed can be seen in a replay only.
#[allow(unused_macros, reason = "few submissions print")]
macro_rules! print { ($($line:tt)*) => { host::printed(format_args!($($line)*)) }; }
#[allow(unused_macros, reason = "few submissions print")]
macro_rules! println {
    () => { host::printed(format_args!("")) };
    ($($line:tt)*) => { host::printed(format_args!($($line)*)) };
}
#[allow(unused_macros, reason = "few submissions print")]
macro_rules! eprint { ($($line:tt)*) => { print!($($line)*) }; }
#[allow(unused_macros, reason = "few submissions print")]
macro_rules! eprintln { ($($line:tt)*) => { println!($($line)*) }; }
#[allow(unused_macros, reason = "few submissions print")]
macro_rules! dbg {
    () => { host::printed(format_args!("line {}", line!())) };
    ($value:expr $(,)?) => {
        // `match` keeps temporaries alive for as long as the standard library's `dbg!` does.
        match $value {
            value => {
                host::printed(format_args!("{} = {:?}", stringify!($value), &value));
                value
            }
        }
    };
    ($($value:expr),+ $(,)?) => { ($(dbg!($value)),+,) };
}
