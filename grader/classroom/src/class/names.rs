//! Comparison of people's names.

use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::is_combining_mark;

/// A text for comparison: composed (NFKC), in lower case.
pub(super) fn fold(text: &str) -> String {
    text.nfkc().flat_map(char::to_lowercase).collect()
}

/// True if two texts are the same to a reader, and not empty.
pub(super) fn same(one: &str, other: &str) -> bool {
    !one.trim().is_empty() && fold(one.trim()) == fold(other.trim())
}

/// The words of a name, sorted, since some systems put the family name first.
pub(super) fn words(name: &str) -> Vec<String> {
    sorted_words(&fold(name))
}

/// [`words`] in the ways that systems write them in ASCII: Müller as muller and as mueller.
pub(super) fn ascii_words(name: &str) -> [Vec<String>; 2] {
    let folded = fold(name);
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
    [sorted_words(&without_marks(&folded)), sorted_words(&without_marks(&german))]
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

/// Compares two names.
pub(super) fn agreement(one: &str, other: &str) -> Agreement {
    let (plain_one, plain_other) = (words(one), words(other));
    if plain_one.is_empty() || plain_other.is_empty() {
        return Agreement::None;
    }
    if plain_one == plain_other {
        return Agreement::Full;
    }
    let forms = |plain: Vec<String>, name: &str| [vec![plain], ascii_words(name).to_vec()].concat();
    let (ones, others) = (forms(plain_one, one), forms(plain_other, other));
    if ones.iter().any(|form| others.contains(form)) {
        return Agreement::Ascii;
    }
    let common = |one: &[String], other: &[String]| one.iter().any(|word| other.contains(word));
    let shares = ones.iter().any(|one| others.iter().any(|other| common(one, other)));
    if shares { Agreement::Part } else { Agreement::None }
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
