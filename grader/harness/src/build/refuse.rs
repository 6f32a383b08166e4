//! Words that a submission must not contain, whatever the compiler says.
//!
//! `forbid(unsafe_code)` is a lint with holes: it does not cover naked functions (Rust 1.88). So a source with a word that
//! could have its code called from outside of `main` is refused before it is compiled, and so is one that cannot be
//! tokenized. Comments, strings and variables of such a name are allowed. The sandbox does not depend on this.

use std::str::FromStr;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A forbidden word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Refusal {
    /// Line, counted from 1.
    pub(crate) line: usize,
    /// The word, as in `#[no_mangle]`.
    pub(crate) what: String,
    /// Reason for the refusal, as a clause for the error message.
    pub(crate) why: &'static str,
}

/// Result of searching a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// Forbidden words by line; empty if there are none.
    Through(Vec<Refusal>),
    /// The source is not Rust from about this line on. If the compiler accepts it all the same, it is not run.
    Unreadable(usize),
}

/// Maximum number of refusals that are listed.
const LISTED: usize = 20;

const UNSAFE: &str = "unsafe code is forbidden: use safe Rust";
const FOREIGN: &str = "functions of other languages are forbidden: remove `extern`";
const ASSEMBLER: &str = "assembler is forbidden: use Rust";
const LINKER: &str = "attributes for the linker are forbidden: remove it";
const PROGRAM: &str = "the program around a submission is fixed: remove the attribute";

/// Attributes that control the linker or the kind of program.
const ATTRIBUTES: [(&str, &str); 21] = [
    ("naked", ASSEMBLER),
    ("no_mangle", LINKER),
    ("export_name", LINKER),
    ("link", LINKER),
    ("link_args", LINKER),
    ("link_name", LINKER),
    ("link_ordinal", LINKER),
    ("link_section", LINKER),
    ("linkage", LINKER),
    ("used", LINKER),
    ("ffi_const", LINKER),
    ("ffi_pure", LINKER),
    ("rustc_std_internal_symbol", LINKER),
    ("no_main", PROGRAM),
    ("no_std", PROGRAM),
    ("no_core", PROGRAM),
    ("no_builtins", PROGRAM),
    ("global_allocator", PROGRAM),
    ("alloc_error_handler", PROGRAM),
    ("panic_handler", PROGRAM),
    ("panic_runtime", PROGRAM),
];

/// Assembler macros, whose names nobody uses by chance.
const MACROS: [&str; 2] = ["global_asm", "naked_asm"];

/// Searches a source for forbidden words.
pub(crate) fn look(source: &str) -> Look {
    // What rustc passes over as a line for a shell may hide the beginning of a comment that it does not see.
    let start = source.strip_prefix('\u{feff}').unwrap_or(source);
    if start.starts_with("#!") && !start.starts_with("#![") {
        let why = "a submission is not a script: remove the line";
        return Look::Through(vec![Refusal { line: 1, what: "#!".to_owned(), why }]);
    }
    let look = match TokenStream::from_str(source) {
        Ok(tokens) => Look::Through(refusals(tokens)),
        Err(error) => Look::Unreadable(error.span().start().line),
    };
    // The lexer keeps every source for the sake of its spans.
    proc_macro2::extra::invalidate_current_thread_spans();
    look
}

fn refusals(tokens: TokenStream) -> Vec<Refusal> {
    let mut found = Vec::new();
    // Names that are an attribute if a macro makes one of them.
    let mut loose = Vec::new();
    let mut made_by_macro = false;
    // What is still to be looked at, with where that is. No recursion: parentheses may be nested as deeply as one likes.
    let mut waiting = vec![(tokens, Place::Code)];
    while let Some((tokens, place)) = waiting.pop() {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        for (index, token) in tokens.iter().enumerate() {
            let before = |back: usize| index.checked_sub(back).and_then(|index| tokens.get(index));
            let line = token.span().start().line;
            let mut refuse = |what: String, why| found.push(Refusal { line, what, why });
            match token {
                TokenTree::Group(group) => {
                    let brace = group.delimiter() == Delimiter::Brace;
                    let bracket = group.delimiter() == Delimiter::Bracket;
                    let attribute = is(before(1), '#') || is(before(1), '!') && is(before(2), '#');
                    let inner = match place {
                        Place::Attribute => Place::Attribute,
                        _ if bracket && attribute => Place::Attribute,
                        Place::Path if brace => Place::Path,
                        _ if brace && is(before(1), ':') && is(before(2), ':') => Place::Path,
                        _ => Place::Code,
                    };
                    waiting.push((group.stream(), inner));
                }
                TokenTree::Ident(identifier) => {
                    let written = identifier.to_string();
                    let name = written.strip_prefix("r#").unwrap_or(&written);
                    let known = ATTRIBUTES.iter().find(|(attribute, _)| *attribute == name);
                    let next = tokens.get(index + 1);
                    match known {
                        Some(&(attribute, why)) if place == Place::Attribute => {
                            refuse(format!("#[{attribute}]"), why);
                        }
                        Some(&(attribute, why)) => {
                            loose.push(Refusal { line, what: format!("#[{attribute}]"), why });
                        }
                        None => {}
                    }
                    // The raw forms of these two are names like any other.
                    if written == "unsafe" {
                        refuse("`unsafe`".to_owned(), UNSAFE);
                    }
                    let krate = matches!(next, Some(TokenTree::Ident(next)) if next == "crate");
                    if written == "extern" && !krate {
                        refuse("`extern`".to_owned(), FOREIGN);
                    }
                    let path = place == Place::Path || is(before(1), ':') && is(before(2), ':');
                    // A comparison has no group after the mark.
                    let call = is(next, '!') && matches!(tokens.get(index + 2), Some(TokenTree::Group(_)));
                    if MACROS.contains(&name) || name == "asm" && (path || call) {
                        refuse(format!("{name}!"), ASSEMBLER);
                    }
                }
                TokenTree::Punct(mark) => {
                    // A text is no attribute, as in `#[doc = $text]`.
                    let makes = mark.as_char() == '$' && !is(before(1), '=');
                    made_by_macro |= place == Place::Attribute && makes;
                }
                TokenTree::Literal(_) => {}
            }
        }
    }
    if made_by_macro {
        found.extend(loose);
    }
    found.sort_by_key(|refusal| refusal.line);
    found.dedup();
    found.truncate(LISTED);
    found
}

/// Context of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Within the brackets of an attribute.
    Attribute,
    /// Within the braces of a path, as in `use a::{b, c}`.
    Path,
    /// Anywhere else.
    Code,
}

fn is(token: Option<&TokenTree>, character: char) -> bool {
    matches!(token, Some(TokenTree::Punct(mark)) if mark.as_char() == character)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(source: &str) -> Vec<(usize, String)> {
        let Look::Through(refusals) = look(source) else { panic!("it can be read: {source}") };
        refusals.into_iter().map(|refusal| (refusal.line, refusal.what)).collect()
    }

    #[test]
    fn each_word_is_found_in_all_its_disguises() {
        for (source, what) in [
            ("\n#[r#naked] fn f() {}", "#[naked]"),
            ("\n#[cfg_attr(all(), cfg_attr(all(), no_mangle))] fn f() {}", "#[no_mangle]"),
            ("\n#![cfg_attr(not(any()), no_main)]", "#[no_main]"),
            ("\n# [link_section = \"x\"] static X: u8 = 0;", "#[link_section]"),
            ("\nmacro_rules! m { () => { #[used] static X: u8 = 0; } }", "#[used]"),
            ("\nuse core::arch::naked_asm as x;", "naked_asm!"),
            ("\nuse core::arch::{r#global_asm as x};", "global_asm!"),
            ("\nuse core::{arch::{asm as x}};", "asm!"),
            ("\nfn f() { core::arch::asm!(\"\") }", "asm!"),
            ("\nm!(unsafe);", "`unsafe`"),
            ("\nextern \"C\" fn f() {}", "`extern`"),
            ("\nm!(extern);", "`extern`"),
        ] {
            assert_eq!(found(source), [(2, what.to_owned())], "{source}");
        }
        let two = found("#[unsafe(naked)] fn f() {}");
        assert_eq!(two, [(1, "`unsafe`".to_owned()), (1, "#[naked]".to_owned())]);
        let passed = "macro_rules! m { ($a:meta) => { #[$a] fn f() {} } }\nm!(used);";
        assert_eq!(found(passed), [(2, "#[used]".to_owned())]);
        let hidden = "#!/*\nfn f() { unsafe {} }\n// */ fn g() {}";
        assert_eq!(found(hidden), [(1, "#!".to_owned())]);
    }

    #[test]
    fn honest_code_that_only_uses_such_words_is_not_hit() {
        let source = r##"
            #![allow(unused, unsafe_code)]
            // unsafe, #[naked], global_asm!
            #[derive(Clone)] #[doc = "#[used] unsafe"] #[must_use] struct Link { used: f32, link: f32, asm: f32 }
            fn start(used: f32, link: f32, asm: f32, naked: f32) -> Link { Link { used, link, asm: asm + naked } }
            fn f(x: &Link) -> f32 { let asm = x.asm; if asm != x.link { -asm as f32 } else { !(x.used as i32) as f32 } }
            macro_rules! twice { ($used:expr) => { $used + $used } }
            extern crate std as standard;
            fn g() -> &'static str { "unsafe extern naked_asm!" }
            fn h() { let r#unsafe = [1][0]; let _ = twice!(r#unsafe); }
        "##;
        assert_eq!(found(source), []);
    }

    #[test]
    fn no_source_takes_the_look_down() {
        assert_eq!(found(&("(".repeat(200_000) + &")".repeat(200_000))), []);
        assert_eq!(look("\n\" never ended"), Look::Unreadable(2));
        assert_eq!(found(&"unsafe {}\n".repeat(10_000)).len(), LISTED);
    }
}
