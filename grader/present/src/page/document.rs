//! What all pages have in common: the head, the policy of what they may load, and the style.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, PreEscaped, html};
use sha2::{Digest, Sha256};

const STYLE: &str = include_str!("style.css");

/// The beginning of a page, up to and with `<body>`. `script` is what [`end`] is given, too: no other one may run, and
/// nothing may be loaded.
pub fn begin(title: &str, script: &str) -> String {
    let hash = STANDARD.encode(Sha256::digest(script));
    let policy = format!(
        "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{hash}'"
    );
    let head = html! {
        (DOCTYPE)
        (PreEscaped("<html lang=\"en\">"))
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta http-equiv="Content-Security-Policy" content=(policy);
            title { (title) }
            style { (PreEscaped(STYLE)) }
        }
        (PreEscaped("<body>"))
    };
    head.into_string()
}

/// The end of a page, with its script.
pub fn end(script: &str) -> String {
    html! { script { (PreEscaped(script)) } (PreEscaped("</body></html>")) }.into_string()
}
