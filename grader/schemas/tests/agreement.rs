//! Parser and schema accept and refuse the same, on shipped files and on files with every key, changed at random.

use std::path::{Path, PathBuf};

use schemas::{all, files};
use serde_json::Value as Json;
use serde_yaml::Value as Yaml;

/// Number of changed files per schema.
const CHANGES: usize = 1500;

/// Reads a file as its owner does; returns its message.
type Parse = fn(&Path) -> Result<(), String>;

/// How a format is read, and what its schema does not say: beginnings and parts of messages about several values, or about
/// names.
fn parser(schema: &str) -> (Parse, &'static [&'static str]) {
    match schema {
        "scenes/scene.schema.json" => (
            |file| arty::scene::file::check(file).map_err(|error| error.to_string()),
            &[
                // Tags.
                "unknown variant `",
                "a YAML tag starting with",
                "must not be the same point",
                "must not be parallel",
                "must not be zero",
                "the transform is singular",
                "the transform exceeds",
                "the last row of a matrix",
                "they must satisfy 0 <= inner <= outer",
                "the triangle has no area",
            ],
        ),
        "assignments/rubric.schema.json" => (
            |file| verdict::rubric::Rubric::load(file).map(drop).map_err(|error| error.to_string()),
            &[
                "not one of `techniques`",
                "either `manual: true` or a list of `checks`",
                "mark a check with `required: true`",
                "`requires` names",
                "is listed twice",
                "needs the contract",
                "needs a `scene`",
                "takes no `scene`",
                "or 0 for a required check",
                "unknown time zone",
                "must be a path below the checkout",
                "cannot be the name of a module",
            ],
        ),
        "assignments/causes.schema.json" => (
            |file| judge::diagnosis::CausesFile::load(file).map(drop).map_err(|error| error.to_string()),
            &[],
        ),
        "assignments/course.schema.json" => {
            (|file| classroom::policy::Course::load(file).map(drop).map_err(|error| error.to_string()), &[])
        }
        other => panic!("{other} has no parser here"),
    }
}

/// Random numbers from a fixed seed.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }
}

/// A YAML value as an editor sees it: without tags.
fn json(value: &Yaml) -> Json {
    match value {
        Yaml::Null => Json::Null,
        Yaml::Bool(value) => (*value).into(),
        Yaml::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => whole.into(),
            (None, number) => serde_json::json!(number),
        },
        Yaml::String(text) => text.clone().into(),
        Yaml::Sequence(list) => list.iter().map(json).collect(),
        Yaml::Mapping(entries) => {
            let key = |key: &Yaml| key.as_str().expect("keys are texts").to_owned();
            Json::Object(entries.iter().map(|(name, value)| (key(name), json(value))).collect())
        }
        Yaml::Tagged(tagged) => json(&tagged.value),
    }
}

/// Number of values in a value, itself included.
fn size(value: &Yaml) -> usize {
    1 + match value {
        Yaml::Sequence(list) => list.iter().map(size).sum(),
        Yaml::Mapping(entries) => entries.values().map(size).sum(),
        Yaml::Tagged(tagged) => size(&tagged.value) - 1,
        _ => 0,
    }
}

/// Changes the value with this number, counted depth first. True if a tag says what it must be, which a schema does not know.
fn change(value: &mut Yaml, number: &mut usize, random: &mut Random) -> bool {
    if let Yaml::Tagged(tagged) = value {
        let is_here = *number == 0;
        return change(&mut tagged.value, number, random) || is_here;
    }
    if *number == 0 {
        *number = usize::MAX;
        replace(value, random);
        return false;
    }
    *number -= 1;
    let items: &mut dyn Iterator<Item = &mut Yaml> = match value {
        Yaml::Sequence(list) => &mut list.iter_mut(),
        Yaml::Mapping(entries) => &mut entries.values_mut(),
        _ => return false,
    };
    let mut is_tagged = false;
    for item in items {
        if *number != usize::MAX {
            is_tagged = change(item, number, random);
        }
    }
    is_tagged
}

fn replace(value: &mut Yaml, random: &mut Random) {
    match value {
        Yaml::Sequence(list) if random.below(2) == 0 && !list.is_empty() => {
            let index = random.below(list.len());
            if random.below(2) == 0 {
                list.remove(index);
            } else {
                list.push(list[index].clone());
            }
        }
        Yaml::Mapping(entries) if random.below(4) != 0 && !entries.is_empty() => {
            let index = random.below(entries.len());
            let key = entries.keys().nth(index).expect("it is there").clone();
            match random.below(3) {
                0 => drop(entries.remove(&key)),
                1 => drop(entries.insert("unknown".into(), 1.into())),
                _ => {
                    let value = entries.remove(&key).expect("it is there");
                    entries.insert(format!("{}s", key.as_str().unwrap_or_default()).into(), value);
                }
            }
        }
        Yaml::Number(number) if random.below(4) != 0 => {
            let old = number.as_f64().unwrap_or_default();
            let new = [-old - 1.0, 0.0, 0.5, 179.5, 180.0, 70_000.0, 1e30, 1e39];
            *value = match new[random.below(new.len())] {
                // What is read as a whole number must be written as one.
                whole if whole.fract() == 0.0 && whole.abs() < 1e9 => (whole as i64).into(),
                other => other.into(),
            };
        }
        _ => {
            let others: [Yaml; 7] = [
                Yaml::Null,
                "word".into(),
                true.into(),
                7.into(),
                (-0.25).into(),
                Yaml::Sequence(vec![1.into(), 2.into()]),
                Yaml::Mapping(Default::default()),
            ];
            *value = others[random.below(others.len())].clone();
        }
    }
}

#[test]
fn parser_and_schema_agree() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for schema in all() {
        let mut corpus = files(&here.join("../.."), &schema).expect("they can be listed");
        let every_key: &[&str] = match schema.path {
            "scenes/scene.schema.json" => &["scene.yml", "environment.yml"],
            "assignments/rubric.schema.json" => &["rubric.yml"],
            _ => &[],
        };
        // As often as all shipped files together.
        let own = every_key.iter().map(|name| here.join("tests/every_key").join(name));
        corpus.extend(std::iter::repeat_n(own, corpus.len()).flatten().collect::<Vec<_>>());
        agree(&schema.schema, &corpus, parser(schema.path));
    }
}

fn agree(schema: &Json, files: &[PathBuf], (parse, not_said): (Parse, &[&str])) {
    let validator = jsonschema::validator_for(schema).expect("it is a schema");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("changed.yml");
    let mut random = Random(3);
    let (mut accepted, mut refused) = (0, 0);
    for file in files {
        let text = std::fs::read_to_string(file).expect("it can be read");
        let whole: Yaml = serde_yaml::from_str(&text).expect("it is YAML");
        assert_eq!(parse(file), Ok(()));
        assert!(validator.is_valid(&json(&whole)), "{}", file.display());
        for _ in 0..CHANGES.div_ceil(files.len()) {
            let mut changed = whole.clone();
            let mut number = random.below(size(&whole));
            let is_tagged = change(&mut changed, &mut number, &mut random);
            let text = serde_yaml::to_string(&changed).expect("it can be written");
            std::fs::write(&path, &text).expect("it can be written");
            let instance = json(&changed);
            match (parse(&path), validator.is_valid(&instance)) {
                (Ok(()), true) => accepted += 1,
                (Err(_), false) => refused += 1,
                (Err(message), true) if is_tagged || not_said.iter().any(|part| message.contains(part)) => {}
                (says, true) => {
                    panic!("{}: the schema accepts, the parser: {says:?}:\n{text}", file.display())
                }
                (says, false) => {
                    let why: Vec<_> =
                        validator.iter_errors(&instance).map(|error| error.to_string()).collect();
                    panic!("{}: the parser says {says:?}, the schema {why:#?}:\n{text}", file.display());
                }
            }
        }
    }
    assert!(accepted > 100 && refused > 100, "{accepted} accepted, {refused} refused");
}
