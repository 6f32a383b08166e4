//! Finds the student of a folder: by number, login and name, which must not contradict each other.

use super::directory::Directory;
use super::identity::Identity;
use super::names::{Agreement, agreement};
use super::roster::Student;

/// Indices of the students whom a folder's name names: none, one, or the members of a team.
///
/// # Errors
/// If number, login and name are of different students, with a message. Nothing is guessed.
pub(super) fn find(roster: &Directory<'_>, identity: &Identity) -> Result<Vec<usize>, String> {
    if let Some(team) = &identity.team {
        return Ok(roster.team(team).to_vec());
    }
    let found = if identity.has_parts {
        with_parts(roster, identity)?
    } else {
        let label = identity.readings.first().map_or("", |reading| reading.login.as_str());
        match plain(roster, label)? {
            None => return Ok(roster.named_team(label).to_vec()),
            found => found,
        }
    };
    Ok(found.into_iter().collect())
}

/// The student of a folder that is named after a login, an address, a number or a name.
fn plain(roster: &Directory<'_>, label: &str) -> Result<Option<usize>, String> {
    let found = roster.by_login(label).or_else(|| roster.by_name(&label.replace('_', " ")));
    if found.is_some() {
        return Ok(found);
    }
    match roster.by_github(label)[..] {
        [] => Ok(None),
        [one] => Ok(Some(one)),
        [one, other, ..] => Err(format!(
            "`{label}` ends in the names on GitHub of {} and of {}: rename the folder to a login",
            roster.students[one].describe(),
            roster.students[other].describe()
        )),
    }
}

/// The student of a folder that a course system has named after number, login and name.
fn with_parts(roster: &Directory<'_>, identity: &Identity) -> Result<Option<usize>, String> {
    let number = identity.number.as_deref().unwrap_or_default();
    let by_number = roster.by_number(number);
    let by_login = of_logins(roster, identity)?;
    let names = || identity.readings.iter().map(|reading| reading.name.as_str());
    let by_name = names().find_map(|name| roster.by_name(name));
    let Some(found) = by_number.or(by_login).or(by_name) else { return Ok(None) };
    let student = &roster.students[found];
    let conflict = |what: &str, other: &str| {
        Err(format!(
            "its {what} is that of {}, but {other}: correct the roster, or rename the folder to the student's login",
            student.describe()
        ))
    };
    let what = if by_number.is_some() { format!("number {number}") } else { "login".to_owned() };
    for (other, part) in [(by_login, "login"), (by_name, "name")] {
        if let Some(other) = other.filter(|&other| other != found) {
            return conflict(&what, &format!("its {part} is that of {}", roster.students[other].describe()));
        }
    }
    let is_named = !student.full_name().is_empty() && names().any(|name| !name.is_empty());
    if by_name.is_none() && is_named && agreement_of(student, identity) == Agreement::None {
        let name = names().next_back().unwrap_or_default();
        return conflict(&what, &format!("it is named after {name}"));
    }
    Ok(Some(found))
}

/// The best agreement of a student's name with any reading.
fn agreement_of(student: &Student, identity: &Identity) -> Agreement {
    let with_team = format!("{} {}", student.team, student.full_name());
    let names = identity.readings.iter().map(|reading| &reading.name);
    let best = names.map(|name| agreement(&student.full_name(), name).max(agreement(&with_team, name)));
    best.max().unwrap_or(Agreement::None)
}

/// The student whose login is in the name, whichever way it is split; of several the one whose name is there as well.
fn of_logins(roster: &Directory<'_>, identity: &Identity) -> Result<Option<usize>, String> {
    let mut found: Vec<(usize, Agreement)> = Vec::new();
    for reading in identity.readings.iter().filter(|reading| !reading.login.is_empty()) {
        if let Some(index) = roster.by_login(&reading.login) {
            found.push((index, agreement(&roster.students[index].full_name(), &reading.name)));
        }
    }
    let named = found.iter().filter(|(_, agreement)| *agreement >= Agreement::Ascii).count();
    if named == 1 {
        found.retain(|(_, agreement)| *agreement >= Agreement::Ascii);
    }
    let mut best: Vec<usize> = found.into_iter().map(|(index, _)| index).collect();
    best.sort_unstable();
    best.dedup();
    match best.as_slice() {
        [] => Ok(None),
        [one] => Ok(Some(*one)),
        [one, other, ..] => Err(format!(
            "its login can be that of {} and of {}: rename the folder to one of the logins",
            roster.students[*one].describe(),
            roster.students[*other].describe()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn student(login: &str, name: &str, number: &str) -> Student {
        Student {
            login: login.into(),
            first_name: name.into(),
            identifiers: [number].iter().filter(|it| !it.is_empty()).map(|&it| it.to_owned()).collect(),
            ..Student::default()
        }
    }

    fn found(roster: &[Student], label: &str) -> Result<Vec<usize>, String> {
        find(&Directory::new(roster), &Identity::of(label))
    }

    #[test]
    fn students_are_found_by_number_login_address_and_name() {
        let roster = [
            Student { email: "al@x.org".into(), ..student("", "Ann Lee", "11") },
            Student { email: "jo@x.org".into(), ..student("", "Jürgen O'Neill", "12") },
        ];
        for (label, expected) in [
            ("Jürgen O'Neill_12_assignsubmission_file_", vec![1]),
            ("Participant_12_assignsubmission_file_", vec![1]),
            ("AL", vec![0]),
            // Decomposed, as macOS writes file names, and with the family name first.
            ("O_Neill Ju\u{308}rgen", vec![1]),
            ("Juergen O'Neill", vec![1]),
            ("Nobody", vec![]),
        ] {
            assert_eq!(found(&roster, label), Ok(expected), "{label}");
        }
        let mut namesakes = [student("al1", "Ann Lee", ""), student("al2", "Ann Lee", "")];
        namesakes[1].numbers.push("4712".into());
        assert_eq!(found(&namesakes, "Lee Ann"), Ok(vec![]), "there are two");
        assert_eq!(found(&namesakes, "4712"), Ok(vec![1]));
        assert_eq!(found(&namesakes, "Lee_Ann_al2_301"), Ok(vec![1]));
    }

    #[test]
    fn a_login_with_an_underscore_is_found_and_one_of_somebody_else_is_not() {
        let roster =
            [student("al_1", "Ann Lee", ""), student("1", "Bob Ray", ""), student("z_1", "Zoe Z", "")];
        assert_eq!(found(&roster, "Lee_Ann_al_1_301"), Ok(vec![0]));
        assert_eq!(found(&roster, "Ray_Bob_1_302"), Ok(vec![1]));
        let message = found(&roster, "Ray_Bob_al_1_303").expect_err("a login and another's name");
        assert!(message.contains("Bob Ray") || message.contains("Ann Lee"), "{message}");
    }

    #[test]
    fn what_disagrees_is_an_error_and_no_guess() {
        let roster = [student("al1", "Ann Lee", "11"), student("br2", "Bob Ray", "12")];
        for label in [
            "Lee_Ann_br2_99",
            "Lee_Ann_al1_12",
            "Poe_Dee_al1_99",
            "Bob Ray_11_assignsubmission_file_",
            "Dee Poe_11_assignsubmission_file_",
        ] {
            assert!(found(&roster, label).is_err(), "{label}");
        }
        assert_eq!(found(&roster, "Lee_Anna_al1_11"), Ok(vec![0]), "a part of the name is enough");
    }

    #[test]
    fn teams_are_found_by_number_and_name_and_folders_of_github_by_their_end() {
        let mut roster =
            [student("a", "Ann Lee", "3"), student("b", "Bob Ray", ""), student("c", "Cem Öz", "")];
        for (student, team) in roster.iter_mut().zip(["Team 3", "3", "Red Pandas"]) {
            student.team = team.into();
        }
        roster[2].github = "octo-cat".into();
        for (label, expected) in [
            ("Team 3", vec![0, 1]),
            ("Group_3_assignsubmission_file_", vec![0, 1]),
            ("Group_4_assignsubmission_file_", vec![]),
            ("red pandas", vec![2]),
            ("Red Pandas-Cem Öz_77_assignsubmission_file_", vec![2]),
            ("05-nee-mis-Octo-Cat", vec![2]),
        ] {
            assert_eq!(found(&roster, label), Ok(expected), "{label}");
        }
    }
}
