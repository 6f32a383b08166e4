//! Tokens of a source without names, comments and layout, which are the first things changed in a copy.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};

/// A token. Values of literals are dropped.
enum Token {
    Name(String),
    Sign(char),
    Literal,
}

/// A token as it is compared.
pub(super) struct HashedToken {
    /// Hash of the token.
    pub(super) hash: u64,
    /// Line on which it begins, counted from 0.
    pub(super) line: usize,
}

/// The tokens of a source. All names outside of the vocabulary have the same hash, and so have all literals;
/// comments are skipped. A source that cannot be tokenized as Rust is split into words.
pub(super) fn tokens(source: &str, vocabulary: &BTreeSet<String>) -> Vec<HashedToken> {
    let hash = |token| match token {
        Token::Name(name) if is_keyword(&name) || vocabulary.contains(&name) => hash(&name),
        Token::Name(_) => hash("a name"),
        Token::Sign(sign) => hash(sign.encode_utf8(&mut [0; 4])),
        Token::Literal => hash("a literal"),
    };
    flatten(source).into_iter().map(|(token, line)| HashedToken { hash: hash(token), line }).collect()
}

/// All names in a source, except those in comments.
pub(super) fn names(source: &str) -> BTreeSet<String> {
    let names = flatten(source).into_iter().filter_map(|(token, _)| match token {
        Token::Name(name) => Some(name),
        Token::Sign(_) | Token::Literal => None,
    });
    names.collect()
}

/// All tokens, each with its line, counted from 0.
fn flatten(source: &str) -> Vec<(Token, usize)> {
    let tokens = source.parse::<TokenStream>().map_or_else(|_| words(source), flatten_stream);
    // Else the texts of all sources would stay in memory.
    proc_macro2::extra::invalidate_current_thread_spans();
    tokens
}

/// The words of what is not Rust.
fn words(source: &str) -> Vec<(Token, usize)> {
    let of_line = |(line, text): (usize, &str)| {
        let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        let words = words.filter(|word| !word.is_empty());
        words.map(|word| (Token::Name(word.to_owned()), line)).collect::<Vec<_>>()
    };
    source.lines().enumerate().flat_map(of_line).collect()
}

fn flatten_stream(stream: TokenStream) -> Vec<(Token, usize)> {
    let line = |span: Span| span.start().line.saturating_sub(1);
    let mut tokens = Vec::new();
    // Not by recursion: brackets can be nested as deep as a file is long.
    let mut open = vec![(stream.into_iter(), None)];
    while let Some((stream, end)) = open.last_mut() {
        let Some(token) = stream.next() else {
            tokens.extend(end.take());
            open.pop();
            continue;
        };
        match token {
            TokenTree::Group(group) if is_documentation(&group.stream()) => {
                // `///` and `//!` come as attributes, whose signs are there already.
                while let Some((Token::Sign('#' | '!'), _)) = tokens.last() {
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
                tokens.extend(start.map(|sign| (Token::Sign(sign), line(group.span_open()))));
                let end = end.map(|sign| (Token::Sign(sign), line(group.span_close())));
                open.push((group.stream().into_iter(), end));
            }
            TokenTree::Ident(ident) => tokens.push((Token::Name(ident.to_string()), line(ident.span()))),
            TokenTree::Punct(punct) => tokens.push((Token::Sign(punct.as_char()), line(punct.span()))),
            TokenTree::Literal(literal) => tokens.push((Token::Literal, line(literal.span()))),
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
