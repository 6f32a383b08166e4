//! Tokens of a source without names, comments and layout, which are the first things changed in a copy.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A token. Values of literals are dropped.
enum Token {
    Name(String),
    Sign(char),
    Literal,
}

/// Hashes of the tokens of a source. All names outside of the vocabulary have the same hash, and so have all literals;
/// comments are skipped. A source that cannot be tokenized as Rust is split into words.
pub(super) fn tokens(source: &str, vocabulary: &BTreeSet<String>) -> Vec<u64> {
    let all = flatten(source).into_iter().map(|token| match token {
        Token::Name(name) if is_keyword(&name) || vocabulary.contains(&name) => hash(&name),
        Token::Name(_) => hash("a name"),
        Token::Sign(sign) => hash(sign.encode_utf8(&mut [0; 4])),
        Token::Literal => hash("a literal"),
    });
    all.collect()
}

/// All names in a source, except those in comments.
pub(super) fn names(source: &str) -> BTreeSet<String> {
    let names = flatten(source).into_iter().filter_map(|token| match token {
        Token::Name(name) => Some(name),
        Token::Sign(_) | Token::Literal => None,
    });
    names.collect()
}

fn flatten(source: &str) -> Vec<Token> {
    let Ok(stream) = source.parse::<TokenStream>() else {
        let words = source.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        return words.filter(|word| !word.is_empty()).map(|word| Token::Name(word.to_owned())).collect();
    };
    let mut tokens = Vec::new();
    // Not by recursion: brackets can be nested as deep as a file is long.
    let mut open = vec![(stream.into_iter(), None)];
    while let Some((stream, end)) = open.last_mut() {
        let Some(token) = stream.next() else {
            tokens.extend(end.map(Token::Sign));
            open.pop();
            continue;
        };
        match token {
            TokenTree::Group(group) if is_documentation(&group.stream()) => {
                // `///` and `//!` come as attributes, whose signs are there already.
                while let Some(Token::Sign('#' | '!')) = tokens.last() {
                    tokens.pop();
                }
            }
            TokenTree::Group(group) => {
                let (start, end) = match group.delimiter() {
                    Delimiter::Parenthesis => (Some('('), Some(')')),
                    Delimiter::Brace => (Some('{'), Some('}')),
                    Delimiter::Bracket => (Some('['), Some(']')),
                    Delimiter::None => (None, None),
                };
                tokens.extend(start.map(Token::Sign));
                open.push((group.stream().into_iter(), end));
            }
            TokenTree::Ident(ident) => tokens.push(Token::Name(ident.to_string())),
            TokenTree::Punct(punct) => tokens.push(Token::Sign(punct.as_char())),
            TokenTree::Literal(_) => tokens.push(Token::Literal),
        }
    }
    tokens
}

fn is_keyword(word: &str) -> bool {
    const KEYWORDS: [&str; 26] = [
        "as", "break", "const", "continue", "else", "enum", "false", "fn", "for", "if", "impl", "in", "let",
        "loop", "match", "mod", "mut", "ref", "return", "self", "struct", "trait", "true", "use", "where",
        "while",
    ];
    KEYWORDS.contains(&word)
}

fn is_documentation(stream: &TokenStream) -> bool {
    matches!(stream.clone().into_iter().next(), Some(TokenTree::Ident(ident)) if ident == "doc")
}

/// The first eight bytes of BLAKE3.
fn hash(text: &str) -> u64 {
    let mut first = [0; 8];
    first.copy_from_slice(&blake3::hash(text.as_bytes()).as_bytes()[..8]);
    u64::from_le_bytes(first)
}
