//! Sources as tokens without what is changed first when somebody else's file is handed in: names, comments, layout.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Tokens of a source, each as a hash. Names that are not of the vocabulary are all alike, and so are literals of one
/// kind; comments are none. A source that is not made of Rust's tokens is taken by its words.
pub(super) fn tokens(source: &str, vocabulary: &BTreeSet<String>) -> Vec<u64> {
    let Ok(stream) = source.parse::<TokenStream>() else {
        return words(source).map(|word| hash(name(word, vocabulary))).collect();
    };
    let mut hashes = Vec::new();
    // Not by recursion: brackets can be nested as deep as a file is long.
    let mut open = vec![(stream.into_iter(), "")];
    while let Some((stream, end)) = open.last_mut() {
        let Some(token) = stream.next() else {
            hashes.push(hash(end));
            open.pop();
            continue;
        };
        match token {
            TokenTree::Group(group) if is_documentation(&group.stream()) => {}
            TokenTree::Group(group) => {
                let (start, end) = match group.delimiter() {
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                hashes.push(hash(start));
                open.push((group.stream().into_iter(), end));
            }
            TokenTree::Ident(ident) => hashes.push(hash(name(&ident.to_string(), vocabulary))),
            TokenTree::Punct(punct) => hashes.push(hash(punct.as_char().encode_utf8(&mut [0; 4]))),
            TokenTree::Literal(_) => hashes.push(hash("literal")),
        }
    }
    hashes
}

/// The words of a source: names, keywords and numbers.
pub(super) fn words(source: &str) -> impl Iterator<Item = &str> {
    source.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}

fn name<'a>(word: &'a str, vocabulary: &BTreeSet<String>) -> &'a str {
    const KEYWORDS: [&str; 26] = [
        "as", "break", "const", "continue", "else", "enum", "false", "fn", "for", "if", "impl", "in", "let",
        "loop", "match", "mod", "mut", "ref", "return", "self", "struct", "trait", "true", "use", "where",
        "while",
    ];
    if KEYWORDS.contains(&word) || vocabulary.contains(word) { word } else { "name" }
}

/// `///` and `//!` come as attributes.
fn is_documentation(stream: &TokenStream) -> bool {
    matches!(stream.clone().into_iter().next(), Some(TokenTree::Ident(ident)) if ident == "doc")
}

/// The first eight bytes of BLAKE3.
fn hash(text: &str) -> u64 {
    let mut first = [0; 8];
    first.copy_from_slice(&blake3::hash(text.as_bytes()).as_bytes()[..8]);
    u64::from_le_bytes(first)
}
