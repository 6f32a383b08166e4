//! What the name of a folder or file tells about its student.

/// What the name of a folder or file tells about its student.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// Number of the student in the course system.
    pub number: Option<String>,
    /// The ways to read login and name, the most likely one first: ILIAS joins both with `_`, which a login may hold.
    pub readings: Vec<Reading>,
    /// [`team_key`] if the name is that of a team.
    pub team: Option<String>,
    /// True if login and name are separate parts, which must be of the same student.
    pub has_parts: bool,
}

/// One way to read login and name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// The login; empty if there is none.
    pub login: String,
    /// First and last name in any order; empty if there is none.
    pub name: String,
}

/// Words for a group of students, in the languages of course systems.
const TEAM: [&str; 4] = ["team", "group", "gruppe", "mannschaft"];

/// What Moodle writes instead of names where submissions are anonymous.
const ANONYMOUS: [&str; 5] = ["participant", "teilnehmer", "teilnehmerin", "teilnehmer in", "teilnehmende"];

impl Identity {
    /// Reads the name of a folder, or of a file without its extension.
    pub fn of(label: &str) -> Self {
        // Moodle: `Full Name_1234567_assignsubmission_file…`, `Group_1234_assignsubmission_file…`
        if let Some((who, _)) = label.split_once("_assignsubmission_")
            && let Some((name, number)) = who.rsplit_once('_')
            && is_number(number)
        {
            return if TEAM.contains(&name.to_lowercase().as_str()) {
                Self::of_team(label, number)
            } else {
                Self::of_participant(name, number)
            };
        }
        // ILIAS: `Team 3`
        if let Some((word, number)) = label.split_once([' ', '_'])
            && TEAM.contains(&word.to_lowercase().as_str())
            && is_number(number)
        {
            return Self::of_team(label, number);
        }
        // ILIAS: `Last_First_login_1234`
        let parts: Vec<&str> = label.split('_').collect();
        if let [parts @ .., number] = parts.as_slice()
            && parts.len() >= 3
            && is_number(number)
        {
            let split = |at: usize| Reading { login: parts[at..].join("_"), name: parts[..at].join(" ") };
            return Self {
                number: Some((*number).to_owned()),
                readings: (2..parts.len()).rev().map(split).collect(),
                team: None,
                has_parts: true,
            };
        }
        let reading = Reading { login: label.to_owned(), name: label.replace('_', " ") };
        Self { readings: vec![reading], ..Self::default() }
    }

    fn of_team(label: &str, number: &str) -> Self {
        let reading = Reading { login: String::new(), name: label.to_owned() };
        Self { readings: vec![reading], team: Some(number.to_owned()), ..Self::default() }
    }

    fn of_participant(name: &str, number: &str) -> Self {
        let is_anonymous = ANONYMOUS.contains(&name.replace(['/', '_'], " ").to_lowercase().as_str());
        let name = if is_anonymous { String::new() } else { name.to_owned() };
        let reading = Reading { login: String::new(), name };
        Self { number: Some(number.to_owned()), readings: vec![reading], team: None, has_parts: true }
    }

    /// True if only a course system writes such names.
    pub fn is_of_course_system(&self) -> bool {
        self.number.is_some() || self.team.is_some()
    }

    /// Login, name or number for a table where no roster says more.
    pub fn key(&self) -> String {
        let first = self.readings.first();
        let texts = first.into_iter().flat_map(|reading| [&reading.login, &reading.name]);
        let named = texts.into_iter().find(|text| !text.is_empty()).cloned();
        named.or_else(|| self.number.clone()).unwrap_or_default()
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// A team's name for comparison: the number of "Team 3" or "Group_3", or else the name in lower case.
pub(crate) fn team_key(name: &str) -> String {
    let lower = name.trim().to_lowercase();
    let rest = TEAM.iter().find_map(|word| lower.strip_prefix(word));
    let number = rest.unwrap_or(&lower).trim_start_matches([' ', '_', '-', '.']);
    if is_number(number) { number.to_owned() } else { lower }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(label: &str) -> Vec<(String, String)> {
        Identity::of(label).readings.into_iter().map(|it| (it.login, it.name)).collect()
    }

    fn pair(login: &str, name: &str) -> (String, String) {
        (login.to_owned(), name.to_owned())
    }

    #[test]
    fn a_login_with_underscores_is_split_off_every_way() {
        assert_eq!(readings("Lee_Ann_al_1_301"), [pair("1", "Lee Ann al"), pair("al_1", "Lee Ann")]);
        assert_eq!(readings("Ann Lee_11_assignsubmission_file_"), [pair("", "Ann Lee")]);
        assert_eq!(readings("Teilnehmer_in_11_assignsubmission_file_"), [pair("", "")]);
        assert_eq!(readings("ann_lee"), [pair("ann_lee", "ann lee")]);
    }

    #[test]
    fn a_number_of_a_team_is_no_number_of_a_student() {
        for (label, team) in [
            ("Group_123457_assignsubmission_file_", "123457"),
            ("Gruppe_7_assignsubmission_onlinetext_", "7"),
            ("Team 3", "3"),
        ] {
            let identity = Identity::of(label);
            assert_eq!((identity.team.as_deref(), identity.number), (Some(team), None), "{label}");
        }
        for name in ["3", "Team 3", "team_3", "Gruppe 3"] {
            assert_eq!(team_key(name), "3", "{name}");
        }
        assert_eq!(team_key("Red Pandas"), "red pandas");
    }
}
