//! Options of the original program that clap does not support.

use std::ffi::OsString;

/// Rewrites `-sx` and `-sy` to `--width` and `--height`; clap would parse `-sx` as `-s x`.
///
/// Applies to `-sx`, `-sy`, `-sx=N` and `-sy=N`, before any `--`.
pub(super) fn rewrite(arguments: impl Iterator<Item = OsString>) -> impl Iterator<Item = OsString> {
    let mut options_ended = false;
    arguments.map(move |argument| {
        options_ended |= argument == "--";
        match argument.to_str().and_then(long_option) {
            Some(long) if !options_ended => long.into(),
            _ => argument,
        }
    })
}

fn long_option(argument: &str) -> Option<String> {
    let (option, value) = match argument.split_once('=') {
        Some((option, value)) => (option, Some(value)),
        None => (argument, None),
    };
    let long = match option {
        "-sx" => "--width",
        "-sy" => "--height",
        _ => return None,
    };
    Some(value.map_or(long.to_owned(), |value| format!("{long}={value}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rewritten(line: &str) -> String {
        let arguments: Vec<OsString> = rewrite(line.split(' ').map(OsString::from)).collect();
        arguments.join(" ".as_ref()).into_string().expect("text")
    }

    #[test]
    fn the_two_options_become_long_ones() {
        assert_eq!(rewritten("arty -sx 64 -sy 48 x.yml"), "arty --width 64 --height 48 x.yml");
        assert_eq!(rewritten("arty -sx=64 -sy=48"), "arty --width=64 --height=48");
    }

    #[test]
    fn all_other_arguments_stay() {
        for line in ["arty -s 8 -s8 -sx8 -syz", "arty --width=3", "arty -- -sx 64", "arty x=-sx"] {
            assert_eq!(rewritten(line), line);
        }
    }
}
