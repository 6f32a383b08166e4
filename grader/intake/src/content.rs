//! Whether a file is a source, by its content.

use proc_macro2::{TokenStream, TokenTree};

use super::text::decode;

/// True for a text that may define the type of a submission. A text that the lexer cannot read is judged by its words:
/// a missing bracket must not hide a source from its student.
pub(super) fn may_be_source(bytes: &[u8], type_name: &str) -> bool {
    text(bytes, type_name).is_some_and(|text| match text.parse::<TokenStream>() {
        Ok(tokens) => defines_type(tokens, type_name),
        Err(_) => text.contains(&format!("struct {type_name}")),
    })
}

/// True for a text that is Rust and defines the type of a submission. Prose that quotes a definition is not Rust: Rust
/// begins with an item or an attribute.
pub(super) fn is_source(bytes: &[u8], type_name: &str) -> bool {
    let tokens = text(bytes, type_name).and_then(|text| text.parse::<TokenStream>().ok());
    tokens.is_some_and(|tokens| begins_with_item(&tokens) && defines_type(tokens, type_name))
}

fn text(bytes: &[u8], type_name: &str) -> Option<String> {
    decode(bytes, &mut Vec::new()).ok().filter(|text| text.contains(type_name))
}

fn defines_type(tokens: TokenStream, type_name: &str) -> bool {
    let mut defines = false;
    for token in tokens {
        match token {
            TokenTree::Ident(word) if defines && word == type_name => return true,
            TokenTree::Ident(word) => defines = word == "struct" || word == "enum" || word == "type",
            _ => defines = false,
        }
    }
    false
}

fn begins_with_item(tokens: &TokenStream) -> bool {
    const ITEMS: [&str; 11] =
        ["use", "pub", "struct", "enum", "impl", "fn", "mod", "const", "static", "type", "trait"];
    match tokens.clone().into_iter().next() {
        Some(TokenTree::Punct(first)) => first.as_char() == '#',
        Some(TokenTree::Ident(first)) => ITEMS.iter().any(|item| first == item),
        _ => false,
    }
}
