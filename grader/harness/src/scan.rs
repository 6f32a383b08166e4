//! Uses of files, processes or the network in a submission's source.
//!
//! The findings tell a person which line asks for something that the sandbox refuses. They guarantee nothing, cost no
//! points by themselves, and the sandbox does not depend on them. Comments and strings are skipped.

use std::str::FromStr;

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use verdict::submission::SourceFinding;

/// Maximum number of findings.
const LISTED: usize = 20;

/// Modules of the standard library that reach out of the process, and why a submission does not need them.
const MODULES: [(&str, &str); 6] = [
    ("process", "a submission must not start or end processes"),
    ("fs", "a submission cannot access files"),
    ("net", "a submission cannot access the network"),
    ("env", "a submission cannot read the environment"),
    ("os", "a submission cannot use the operating system"),
    ("path", "a submission cannot access files"),
];

/// Macros that read files or variables of the compiling machine, and why a submission does not need them.
const MACROS: [(&str, &str); 5] = [
    ("include", "a submission must be a single file"),
    ("include_str", "a submission cannot read files, not even at compile time"),
    ("include_bytes", "a submission cannot read files, not even at compile time"),
    ("env", "a submission cannot read the environment, not even at compile time"),
    ("option_env", "a submission cannot read the environment, not even at compile time"),
];

/// Macros that print.
const PRINTING: [&str; 5] = ["print", "println", "eprint", "eprintln", "dbg"];

/// Lines of a source that print, counted from 1. Comments and strings are skipped; a source that is not Rust has none.
pub fn prints(source: &str) -> Vec<usize> {
    let Ok(tokens) = TokenStream::from_str(source) else { return Vec::new() };
    let (mut lines, mut waiting) = (Vec::new(), vec![tokens]);
    while let Some(tokens) = waiting.pop() {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        for (index, token) in tokens.iter().enumerate() {
            let calls = |next: &TokenTree| is_punctuation(next, '!');
            if name(token).is_some_and(|name| PRINTING.contains(&name.as_str()))
                && tokens.get(index + 1).is_some_and(calls)
            {
                lines.push(token.span().start().line);
            }
            if let TokenTree::Group(group) = token {
                waiting.push(group.stream());
            }
        }
    }
    lines.sort_unstable();
    lines.dedup();
    lines.truncate(LISTED);
    lines
}

/// Finds such uses in a source. A source that is not Rust has no findings: the compiler reports it.
pub fn scan(source: &str) -> Vec<SourceFinding> {
    let Ok(tokens) = TokenStream::from_str(source) else { return Vec::new() };
    let mut findings = Vec::new();
    // What is still to be looked at, with whether it is a list of names below `std`. No recursion: parentheses may be
    // nested as deeply as a student likes.
    let mut waiting = vec![(tokens, false)];
    while let Some((tokens, below_std)) = waiting.pop() {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        for (index, token) in tokens.iter().enumerate() {
            let rest = &tokens[index..];
            if let TokenTree::Group(group) = token {
                let list = index.checked_sub(3).map(|start| &tokens[start..]);
                let of_std = group.delimiter() == Delimiter::Brace && list.is_some_and(is_path_into_std);
                waiting.push((group.stream(), of_std));
            }
            let starts = index == 0 || is_punctuation(&tokens[index - 1], ',');
            let found = macro_call(rest)
                .or_else(|| attribute(rest))
                .or_else(|| is_path_into_std(rest).then(|| module(rest.get(3)?)).flatten())
                .or_else(|| (below_std && starts).then(|| module(token)).flatten());
            findings.extend(found.map(|(what, why)| SourceFinding {
                line: token.span().start().line,
                what,
                why: why.to_owned(),
            }));
        }
    }
    findings.sort_by_key(|finding| finding.line);
    findings.dedup();
    findings.truncate(LISTED);
    findings
}

/// Matches `std::` or `core::`.
fn is_path_into_std(tokens: &[TokenTree]) -> bool {
    matches!(tokens, [root, one, two, ..]
        if matches!(name(root).as_deref(), Some("std" | "core")) && is_punctuation(one, ':') && is_punctuation(two, ':'))
}

fn module(token: &TokenTree) -> Option<(String, &'static str)> {
    let name = name(token)?;
    let (module, why) = MODULES.iter().find(|(module, _)| *module == name)?;
    Some((format!("std::{module}"), why))
}

fn macro_call(tokens: &[TokenTree]) -> Option<(String, &'static str)> {
    let name = tokens.first().and_then(name)?;
    tokens.get(1).filter(|token| is_punctuation(token, '!'))?;
    let (called, why) = MACROS.iter().find(|(called, _)| *called == name)?;
    Some((format!("{called}!"), why))
}

/// Matches `#[path = …]`, in `cfg_attr` too.
fn attribute(tokens: &[TokenTree]) -> Option<(String, &'static str)> {
    let [mark, TokenTree::Group(group), ..] = tokens else { return None };
    let attribute: Vec<TokenTree> = group.stream().into_iter().collect();
    let sets_path = |tokens: &[TokenTree]| matches!(tokens, [path, equals, ..] if name(path).as_deref() == Some("path") && is_punctuation(equals, '='));
    let conditional = attribute.first().and_then(name).as_deref() == Some("cfg_attr");
    let inner: Vec<TokenTree> = match attribute.get(1) {
        Some(TokenTree::Group(group)) if conditional => group.stream().into_iter().collect(),
        _ => Vec::new(),
    };
    let found = is_punctuation(mark, '#')
        && (sets_path(&attribute) || (0..inner.len()).any(|start| sets_path(&inner[start..])));
    found.then(|| ("#[path]".to_owned(), "a submission must be a single file"))
}

/// An identifier without the `r#` of raw ones.
fn name(token: &TokenTree) -> Option<String> {
    let TokenTree::Ident(identifier) = token else { return None };
    let name = identifier.to_string();
    Some(name.strip_prefix("r#").map_or(name.clone(), str::to_owned))
}

fn is_punctuation(token: &TokenTree, character: char) -> bool {
    matches!(token, TokenTree::Punct(mark) if mark.as_char() == character)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(source: &str) -> Vec<(usize, String)> {
        scan(source).into_iter().map(|finding| (finding.line, finding.what)).collect()
    }

    #[test]
    fn what_reaches_out_is_named_with_its_line() {
        for (source, what) in [
            ("\nfn f() -> &'static str { include_str!(\"x\") }", "include_str!"),
            ("\nconst X: &[u8] = std::r#include_bytes!(\"x\");", "include_bytes!"),
            ("\n#[path = \"x.rs\"] mod x;", "#[path]"),
            ("\n#[cfg_attr(all(), path = \"x.rs\")] mod x;", "#[path]"),
            ("\nconst X: &str = env!(\"X\");", "env!"),
            ("\nfn f() { std::process::exit(0) }", "std::process"),
            ("\nuse std::fs::File;", "std::fs"),
            ("\nuse std::{f32::consts::PI, net};", "std::net"),
            ("\nuse ::std::{cell::Cell, r#fs::File};", "std::fs"),
            ("\nuse std::os::fd::FromRawFd;", "std::os"),
        ] {
            assert_eq!(found(source), [(2, what.to_owned())], "{source}");
        }
    }

    #[test]
    fn honest_code_that_only_mentions_such_words_is_not_hit() {
        let source = r##"
            // Do not use std::fs or include_str!("x") here, nor #[path = "x"].
            /// std::process::exit
            use std::{f32::consts::PI, sync::Mutex};
            fn path(process: f32, fs: f32, net: f32, env: f32) -> f32 { process * fs + net * env * PI }
            struct S { path: f32 }
            fn g() { let s = "std::net include_str!(\"x\")"; let r = r#"env!("X")"#; println!("{s} {r}"); }
            #[derive(Clone)] struct Path { fs: Mutex<f32> }
            use std::cell::{Cell as process};
        "##;
        assert_eq!(found(source), []);
    }

    #[test]
    fn lines_that_print_are_named() {
        let source = "// println!()\nfn f() {\n    println!(\"dbg!\"); dbg!(1);\n    if true { eprint!(\"x\") }\n}\nfn print() {}";
        assert_eq!(prints(source), [3, 4]);
    }

    #[test]
    fn no_source_takes_the_scan_down() {
        let deep = "(".repeat(200_000) + &")".repeat(200_000);
        assert_eq!(found(&deep), []);
        assert_eq!(found("\" never ended"), []);
        assert_eq!(found(&"include_str!(\"x\");\n".repeat(10_000)).len(), LISTED);
    }
}
