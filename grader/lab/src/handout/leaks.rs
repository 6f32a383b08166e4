//! Search for code of the solution.
//!
//! Code is compared token by token, so that whitespace does not hide it; comments are searched like code.

use std::collections::HashSet;

/// Number of consecutive tokens that count as code of the solution. Shorter runs occur in any similar program.
const RUN: usize = 8;

/// The runs of tokens that only the solution has.
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
    /// The runs of the solution's code where it differs from the starting file. `public` are phrases that reveal nothing,
    /// such as documented calls of the framework; a run that continues beyond one of them is found all the same.
    ///
    /// # Errors
    /// If there are no such runs.
    pub fn of(solution: &str, starter: &str, public: &[String]) -> Result<Self, String> {
        let (solution, starter) = (code(solution), code(starter));
        let mut runs = HashSet::new();
        for block in added(&solution, &starter) {
            runs.extend(tokens(&block).windows(RUN).map(words));
        }
        for text in public.iter().chain([&starter.join("\n")]) {
            for run in tokens(text).windows(RUN) {
                runs.remove(&words(run));
            }
        }
        if runs.is_empty() {
            return Err("its code does not differ from the starting file".to_owned());
        }
        Ok(Self { runs })
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

/// The lines of code of a Rust source, without comments and indentation.
fn code(source: &str) -> Vec<String> {
    let lines = source.lines().map(|line| line.split("//").next().unwrap_or_default().trim().to_owned());
    lines.filter(|line| !line.is_empty()).collect()
}

/// Groups of consecutive lines of `new` that are not in `old`, by a longest common subsequence.
fn added(new: &[String], old: &[String]) -> Vec<String> {
    let mut common = vec![vec![0_usize; old.len() + 1]; new.len() + 1];
    for (i, line) in new.iter().enumerate().rev() {
        for (j, other) in old.iter().enumerate().rev() {
            common[i][j] =
                if line == other { common[i + 1][j + 1] + 1 } else { common[i + 1][j].max(common[i][j + 1]) };
        }
    }
    let (mut j, mut group, mut groups) = (0, Vec::new(), Vec::new());
    for (i, line) in new.iter().enumerate() {
        while j < old.len() && *line != old[j] && common[i][j + 1] == common[i][j] {
            j += 1;
        }
        if old.get(j) == Some(line) && common[i][j] == common[i + 1][j + 1] + 1 {
            groups.push(std::mem::take(&mut group));
            j += 1;
        } else {
            group.push(line.as_str());
        }
    }
    groups.push(group);
    groups.into_iter().filter(|group| !group.is_empty()).map(|group| group.join("\n")).collect()
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

    const STARTER: &str = "fn f() {\n    // TASK 1: what?\n    0.0\n    // END 1\n}\n";
    const SOLUTION: &str = "fn f() {\n    // TASK 1: what?\n    // Why.\n    let p = q * 2.0 / (r + s.t); // So.\n    // END 1\n}\n";

    #[test]
    fn a_run_of_the_solution_is_found_however_it_is_laid_out() {
        let secrets = Secrets::of(SOLUTION, STARTER, &[]).expect("they differ");
        for text in [
            "x\nlet p = q * 2.0 / (r",
            "x\n\tlet\tp=q*2.0/(r",
            "x\n// let p = q *\n// 2.0 / (r",
            "x\np = q * 2.0 / (r +",
        ] {
            assert_eq!(secrets.find(text).map(|leak| leak.line), Some(2), "{text}");
        }
        for text in ["let p = q * 2.0 / x", "let p = q * 3.0 / (r - s.t)", "", STARTER] {
            assert_eq!(secrets.find(text), None, "{text}");
        }
    }

    #[test]
    fn a_public_phrase_is_no_secret_and_what_goes_on_from_it_is_one() {
        let public = ["let p = q * 2.0 / (".to_owned()];
        let secrets = Secrets::of(SOLUTION, STARTER, &public).expect("they differ");
        assert_eq!(secrets.find("let p = q * 2.0 / ("), None);
        assert!(secrets.find("let p = q * 2.0 / (r + s").is_some());
    }

    #[test]
    fn a_solution_without_marks_is_searched_for_where_it_differs() {
        let (starter, solution) = ("fn f() {\n0.0\n}\n", "fn f() {\nlet p = q * 2.0 / (r + s.t);\np\n}\n");
        let secrets = Secrets::of(solution, starter, &[]).expect("they differ");
        assert!(secrets.find("q * 2.0 / (r + s").is_some());
        for same in ["fn f() {}", starter] {
            assert!(Secrets::of(same, same, &[]).is_err(), "{same}");
        }
    }
}
