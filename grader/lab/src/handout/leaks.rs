//! Search for code of the solution.
//!
//! Code is compared token by token, so that whitespace does not hide it; comments are searched like code.

use std::collections::HashSet;

use proc_macro2::TokenStream;

/// Number of consecutive tokens that count as code of the solution. Shorter runs occur in any similar program.
const RUN: usize = 8;

/// Documented calls of the framework's interface, which reveal nothing. A run that continues beyond one of these is found
/// all the same.
const PHRASES: [&str; 7] = [
    "sampler: &mut Sampler) -> Rgb { let ",
    ") else { return Rgb::BLACK }; let (",
    ") { return Rgb::BLACK; }",
    "; let (wi, distance) = direction_and_distance(hit.point,",
    ".technique == Technique::Bsdf",
    "scene.lights().len() as f32",
    "); let f = bsdf.eval(wi)",
];

/// The runs of tokens that occur in the solution's task blocks and nowhere else in it.
#[derive(Clone, Debug)]
pub struct Secrets {
    runs: HashSet<Vec<String>>,
}

/// Code of the solution in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leak {
    /// The line, counted from 1.
    pub line: usize,
    /// The tokens.
    pub words: String,
}

impl Secrets {
    /// The runs of the blocks between `// TASK` and `// END` in the solution.
    ///
    /// # Errors
    /// If there are no blocks, or they are not Rust.
    pub fn of(solution: &str) -> Result<Self, String> {
        let (mut runs, mut outside) = (HashSet::new(), String::new());
        let mut block: Option<String> = None;
        for line in solution.lines() {
            let mark = line.trim_start();
            if mark.starts_with("// TASK") {
                block = Some(String::new());
            } else if mark.starts_with("// END") {
                let text = block.take().ok_or("an END without a TASK")?;
                let stream: TokenStream =
                    text.parse().map_err(|error| format!("a task block is no Rust: {error}"))?;
                // As Rust's tokens, the code is without its comments.
                let all = tokens(&stream.to_string());
                runs.extend(all.windows(RUN).map(words));
            } else if let Some(block) = &mut block {
                block.push_str(line);
                block.push('\n');
            } else {
                outside.push_str(line);
                outside.push('\n');
            }
        }
        // What stands outside of the blocks is the students' as well: it is the same in the starting file.
        for text in PHRASES.into_iter().chain([outside.as_str()]) {
            for run in tokens(text).windows(RUN) {
                runs.remove(&words(run));
            }
        }
        if runs.is_empty() { Err("there are no task blocks in it".to_owned()) } else { Ok(Self { runs }) }
    }

    /// The first place of a text that holds some of it.
    pub fn find(&self, text: &str) -> Option<Leak> {
        let all = tokens(text);
        all.windows(RUN).find_map(|run| {
            let words = words(run);
            self.runs.contains(&words).then(|| Leak { line: run[0].line, words: words.join(" ") })
        })
    }
}

struct Token {
    word: String,
    line: usize,
}

fn words(run: &[Token]) -> Vec<String> {
    run.iter().map(|token| token.word.clone()).collect()
}

/// Words, numbers and signs of a text. Marks of comments are none.
fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut line = 1;
    let mut rest = text.chars().peekable();
    while let Some(first) = rest.next() {
        line += usize::from(first == '\n');
        if first.is_whitespace() {
            continue;
        }
        let mut word = String::from(first);
        if first == '/' && rest.peek() == Some(&'/') {
            while rest.next_if(|&next| next == '/' || next == '!').is_some() {}
            continue;
        }
        if first.is_alphanumeric() || first == '_' {
            let number = first.is_ascii_digit();
            while let Some(next) =
                rest.next_if(|&next| next.is_alphanumeric() || next == '_' || (number && next == '.'))
            {
                word.push(next);
            }
        }
        tokens.push(Token { word, line });
    }
    tokens
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOLUTION: &str =
        "fn f() {\n    // TASK 1: what?\n    // Why.\n    let p = q * 2.0 / (r + s.t);\n    // END 1\n}\n";

    #[test]
    fn a_run_of_the_solution_is_found_however_it_is_laid_out() {
        let secrets = Secrets::of(SOLUTION).expect("it has a block");
        for text in [
            "x\nlet p = q * 2.0 / (r",
            "x\n\tlet\tp=q*2.0/(r",
            "x\n// let p = q *\n// 2.0 / (r",
            "x\np = q * 2.0 / (r +",
        ] {
            assert_eq!(secrets.find(text).map(|leak| leak.line), Some(2), "{text}");
        }
        for text in ["let p = q * 2.0 / x", "let p = q * 3.0 / (r - s.t)", ""] {
            assert_eq!(secrets.find(text), None, "{text}");
        }
    }

    #[test]
    fn a_file_without_blocks_is_no_solution() {
        for text in ["fn f() {}", "// TASK 1\n// END 1\n", "// END 1\n", "// TASK 1\n(\n// END 1\n"] {
            assert!(Secrets::of(text).is_err(), "{text}");
        }
    }
}
