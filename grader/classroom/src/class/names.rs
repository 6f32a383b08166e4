//! Comparison of people's names.

use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::is_combining_mark;

/// A text for comparison: composed (NFKC), in lower case.
pub(super) fn fold(text: &str) -> String {
    text.nfkc().flat_map(char::to_lowercase).collect()
}

/// True if two texts are the same to a reader, and not empty.
pub(super) fn same(one: &str, other: &str) -> bool {
    let (one, other) = (one.trim(), other.trim());
    if one.is_ascii() && other.is_ascii() {
        return !one.is_empty() && one.eq_ignore_ascii_case(other);
    }
    !one.is_empty() && fold(one) == fold(other)
}

/// The words of a name in the ways that systems write them in ASCII: Müller as muller and as mueller.
fn ascii_words(folded: &str) -> [Vec<String>; 2] {
    let without_marks = |text: &str| -> String {
        text.nfkd()
            .filter(|&c| !is_combining_mark(c))
            .flat_map(|c| letters(c).chars().collect::<Vec<_>>())
            .collect()
    };
    let german: String = folded
        .chars()
        .map(|c| match c {
            'ä' => "ae".to_owned(),
            'ö' => "oe".to_owned(),
            'ü' => "ue".to_owned(),
            'å' => "aa".to_owned(),
            'ø' => "oe".to_owned(),
            other => other.to_string(),
        })
        .collect();
    [sorted_words(&without_marks(folded)), sorted_words(&without_marks(&german))]
}

/// Letters that Unicode does not decompose, in ASCII.
fn letters(c: char) -> String {
    match c {
        'ß' => "ss".to_owned(),
        'æ' => "ae".to_owned(),
        'œ' => "oe".to_owned(),
        'ø' => "o".to_owned(),
        'ł' => "l".to_owned(),
        'đ' | 'ð' => "d".to_owned(),
        'þ' => "th".to_owned(),
        'ı' => "i".to_owned(),
        other => other.to_string(),
    }
}

/// The words of a text, sorted, since some systems put the family name first.
fn sorted_words(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let mut words: Vec<String> = words.map(str::to_owned).collect();
    words.sort();
    words
}

/// Agreement of two names, from none to full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Agreement {
    /// No word in common.
    None,
    /// Some words in common.
    Part,
    /// The same words, where letters beyond ASCII are written in ASCII.
    Ascii,
    /// Both names consist of the same words.
    Full,
}

/// A name, taken apart once to be compared with many.
#[derive(Clone, Debug)]
pub(super) struct Name {
    /// Words as they are written, then in the two ways of ASCII.
    forms: [Vec<String>; 3],
}

impl Name {
    /// Takes a name apart.
    pub(super) fn new(name: &str) -> Self {
        let folded = fold(name);
        let plain = sorted_words(&folded);
        if folded.is_ascii() {
            return Self { forms: [plain.clone(), plain.clone(), plain] };
        }
        let [one, other] = ascii_words(&folded);
        Self { forms: [plain, one, other] }
    }

    /// Its words as they are written; empty if it has none.
    pub(super) fn plain(&self) -> String {
        self.forms[0].join(" ")
    }

    /// Its words in all ways to write them.
    pub(super) fn forms(&self) -> [String; 3] {
        self.forms.each_ref().map(|words| words.join(" "))
    }

    /// Compares it with another.
    pub(super) fn agreement(&self, other: &Self) -> Agreement {
        let (ones, others) = (&self.forms, &other.forms);
        if ones[0].is_empty() || others[0].is_empty() {
            return Agreement::None;
        }
        if ones[0] == others[0] {
            return Agreement::Full;
        }
        if ones.iter().any(|form| others.contains(form)) {
            return Agreement::Ascii;
        }
        let common = |one: &[String], other: &[String]| one.iter().any(|word| other.contains(word));
        let shares = ones.iter().any(|one| others.iter().any(|other| common(one, other)));
        if shares { Agreement::Part } else { Agreement::None }
    }
}

/// Compares two names.
pub(super) fn agreement(one: &str, other: &str) -> Agreement {
    Name::new(one).agreement(&Name::new(other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_ascii_are_those_of_the_roster() {
        for (one, other, expected) in [
            ("Müller Jürgen", "Jürgen Müller", Agreement::Full),
            ("O_Neill Ju\u{308}rgen", "Jürgen O'Neill", Agreement::Full),
            ("Muller Jurgen", "Jürgen Müller", Agreement::Ascii),
            ("Mueller Juergen", "Jürgen Müller", Agreement::Ascii),
            ("Lukasz Strauss", "Łukasz Strauß", Agreement::Ascii),
            ("Jose Nunez", "José Núñez", Agreement::Ascii),
            ("Mueller Juergen", "Jurgen Muller", Agreement::None),
            ("Lee Anna", "Ann Lee", Agreement::Part),
            ("Lee Ann", "Bob Ray", Agreement::None),
            ("", "Bob Ray", Agreement::None),
        ] {
            assert_eq!(agreement(one, other), expected, "{one} {other}");
        }
    }
}
