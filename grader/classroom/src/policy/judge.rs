//! Lateness of a submission, and the points that count.

use std::collections::BTreeMap;

use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};
use serde::{Deserialize, Serialize};

use super::time::{Repeated, parse};
use super::zone;
use super::{Course, Receipt, Rules};

/// The late policy of an assignment in one course.
#[derive(Clone, Debug)]
pub struct Policy {
    rules: Rules,
    zone: TimeZone,
    deadline: Option<Timestamp>,
    /// Deadline and reason by student, in lower case.
    extensions: BTreeMap<String, (Timestamp, String)>,
    leaderboard: bool,
}

/// Standing of a submission relative to deadline, grace period and extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// In time, or there is no deadline.
    InTime,
    /// Late, and accepted.
    Late,
    /// There is a deadline but no receipt time. It counts in full, and a tutor should look.
    Unknown,
    /// Too late: it has no points.
    NotAccepted,
}

/// Lateness of a submission, and its consequences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lateness {
    /// In time, late, not accepted, or unknown.
    pub standing: Standing,
    /// Seconds after the deadline; none if it was in time or the receipt time is unknown.
    pub late_by: Option<i64>,
    /// Factor for raw points.
    pub factor: f64,
    /// What else decided, as a text: an extension, a checksum.
    pub why: String,
}

impl Policy {
    /// Combines the rules of a rubric with the dates of a course.
    ///
    /// # Errors
    /// The first rule or date that is not valid.
    pub fn new(rules: &Rules, course: &Course) -> Result<Self, String> {
        let zone = zone(&rules.time_zone)?;
        // Deadlines are read in favour of the student, too.
        let deadline = |text: &String| parse(text, &zone, Repeated::Later);
        let mut extensions = BTreeMap::new();
        for extension in &course.extensions {
            let until =
                deadline(&extension.until).map_err(|error| format!("{}: {error}", extension.student))?;
            if extension.reason.trim().is_empty() {
                return Err(format!("the extension of {} needs a reason", extension.student));
            }
            if extensions.insert(key(&extension.student), (until, extension.reason.clone())).is_some() {
                return Err(format!("there are two extensions of {}", extension.student));
            }
        }
        let deadline = course.deadline.as_ref().map(deadline).transpose()?;
        Ok(Self { rules: rules.clone(), deadline, extensions, zone, leaderboard: course.leaderboard })
    }

    /// True if the course wants a leaderboard.
    pub fn has_leaderboard(&self) -> bool {
        self.leaderboard
    }

    /// Time zone of times without an offset.
    pub fn zone(&self) -> &TimeZone {
        &self.zone
    }

    /// Deadline of a student who goes by these names, with the reason if it is an extension; `None` if there is none.
    pub fn deadline(&self, student: &[&str]) -> Option<(Timestamp, Option<&str>)> {
        let extension = student.iter().find_map(|name| self.extensions.get(&key(name)));
        match extension {
            Some((until, reason)) => Some((*until, Some(reason))),
            None => self.deadline.map(|deadline| (deadline, None)),
        }
    }

    /// Names of students with an extension, as in the course's file.
    pub fn extended(&self) -> impl Iterator<Item = &str> {
        self.extensions.keys().map(String::as_str)
    }

    /// Lateness of a submission. `checksums` are the MD5 sums of the files that were received.
    pub fn judge(&self, student: &[&str], receipt: Option<&Receipt>, checksums: &[String]) -> Lateness {
        let in_time = |why: String| Lateness { standing: Standing::InTime, late_by: None, factor: 1.0, why };
        let Some((deadline, extension)) = self.deadline(student) else { return in_time(String::new()) };
        let mut why: Vec<String> =
            extension.map(|reason| format!("extension: {reason}")).into_iter().collect();
        let Some(receipt) = receipt.filter(|receipt| receipt.received_at.is_some()) else {
            why.push("no receipt time".to_owned());
            return Lateness { standing: Standing::Unknown, late_by: None, factor: 1.0, why: why.join("; ") };
        };
        let received = receipt.received_at.unwrap_or(deadline);
        let late_by = received.duration_since(deadline);
        let matches =
            receipt.md5.as_ref().map(|md5| checksums.iter().any(|sum| sum.eq_ignore_ascii_case(md5)));
        if matches == Some(false) {
            why.push("md5-wrong: no file has the checksum that was sent".to_owned());
        }
        if !late_by.is_positive() {
            return in_time(why.join("; "));
        }
        if let (Some(rule), Some(true)) = (self.rules.md5, matches) {
            let checksum_in_time = receipt.md5_received_at.is_some_and(|time| time <= deadline);
            if checksum_in_time && late_by <= hours(rule.within_hours) {
                why.push("md5: its checksum was received in time".to_owned());
                return in_time(why.join("; "));
            }
            why.push(if checksum_in_time {
                format!("md5: the file was received more than {} hours after the deadline", rule.within_hours)
            } else {
                "md5: its checksum was not received in time either".to_owned()
            });
        }
        let accepted = self.rules.late.filter(|rule| late_by < hours(rule.less_than_hours));
        Lateness {
            standing: if accepted.is_some() { Standing::Late } else { Standing::NotAccepted },
            // A second that has begun is a second late.
            late_by: Some(late_by.as_secs() + i64::from(late_by.subsec_nanos() > 0)),
            factor: accepted.map_or(0.0, |rule| rule.factor),
            why: why.join("; "),
        }
    }

    /// Points that count, rounded as the rules say.
    pub fn points(&self, raw: f64, lateness: &Lateness) -> f64 {
        points_after(&self.rules, raw, lateness)
    }

    /// Rules of the rubric.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }
}

/// Points that count of so many raw points, rounded as the rules say.
pub(crate) fn points_after(rules: &Rules, raw: f64, lateness: &Lateness) -> f64 {
    if lateness.factor == 1.0 {
        return raw;
    }
    let step = rules.round_to;
    // 0.8 is no binary number: what is meant to lie in the middle must not fall below it.
    ((raw * lateness.factor / step + 0.5 + 1e-9).floor() * step).min(raw)
}

fn hours(hours: u32) -> SignedDuration {
    SignedDuration::from_hours(i64::from(hours))
}

fn key(student: &str) -> String {
    student.trim().to_lowercase()
}

impl Lateness {
    /// How late it is, as in "1 h 05 min 00 s"; empty if it is not.
    pub fn late_by_text(&self) -> String {
        self.late_by.map_or_else(String::new, present::words::duration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHEET: Rules = Rules {
        time_zone: String::new(),
        late: Some(super::super::LateRule { less_than_hours: 2, factor: 0.8 }),
        md5: Some(super::super::Md5Rule { within_hours: 12 }),
        round_to: 0.5,
    };
    const SUM: &str = "5eb63bbbe01eeed093cb22bb8f5acdc3";

    fn policy(deadline: &str) -> Policy {
        let rules = Rules { time_zone: "Europe/Berlin".into(), ..SHEET };
        let extension = Extension {
            student: "Ill".into(),
            until: "2026-05-23 23:59".into(),
            reason: "certificate".into(),
        };
        let course =
            Course { deadline: Some(deadline.into()), extensions: vec![extension], ..Course::default() };
        Policy::new(&rules, &course).expect("it is sound")
    }

    use super::super::{Extension, parse_received};

    fn at(policy: &Policy, received: &str) -> Receipt {
        let received = parse_received(received, policy.zone()).expect("it is a time");
        Receipt { received_at: Some(received), ..Receipt::default() }
    }

    fn standing(deadline: &str, received: &str) -> (Standing, Option<i64>, f64) {
        let policy = policy(deadline);
        let lateness = policy.judge(&["somebody"], Some(&at(&policy, received)), &[]);
        (lateness.standing, lateness.late_by, lateness.factor)
    }

    #[test]
    fn the_deadline_itself_is_in_time_and_two_hours_later_is_too_late() {
        use Standing::{InTime, Late, NotAccepted};
        for (received, expected) in [
            ("2026-05-21 12:00", (InTime, None, 1.0)),
            ("2026-05-21 23:59:00", (InTime, None, 1.0)),
            ("2026-05-21T21:59:00Z", (InTime, None, 1.0)),
            ("2026-05-21 23:59:00.001", (Late, Some(1), 0.8)),
            ("2026-05-21 23:59:01", (Late, Some(1), 0.8)),
            ("2026-05-22 01:58:59", (Late, Some(7199), 0.8)),
            ("2026-05-22 01:58:59.999", (Late, Some(7200), 0.8)),
            ("2026-05-22 01:59:00", (NotAccepted, Some(7200), 0.0)),
            ("2026-05-23 00:00", (NotAccepted, Some(86_460), 0.0)),
        ] {
            assert_eq!(standing("2026-05-21 23:59", received), expected, "{received}");
        }
    }

    #[test]
    fn the_nights_in_which_the_clocks_change_have_hours_of_sixty_minutes() {
        use Standing::{InTime, Late, NotAccepted};
        for (deadline, received, expected) in [
            // Forward, 29 March 2026, 2:00 → 3:00: one hour and a half by the sun, though the clocks say 2:30.
            ("2026-03-29 01:30", "2026-03-29 04:00", (Late, Some(5400), 0.8)),
            ("2026-03-29 01:30", "2026-03-29 04:30", (NotAccepted, Some(7200), 0.0)),
            // Back, 25 October 2026, 3:00 → 2:00.
            ("2026-10-24 23:59", "2026-10-25T02:10:00+02:00", (NotAccepted, Some(7860), 0.0)),
            ("2026-10-25 01:59", "2026-10-25T02:30:00+01:00", (Late, Some(5460), 0.8)),
            // Without an offset, in favour of the student: the first 2:30, and the second deadline.
            ("2026-10-25 01:59", "2026-10-25 02:30", (Late, Some(1860), 0.8)),
            ("2026-10-25 02:30", "2026-10-25T02:30:00+01:00", (InTime, None, 1.0)),
        ] {
            assert_eq!(standing(deadline, received), expected, "{deadline} {received}");
        }
        let zone = zone("Europe/Berlin").expect("it is known");
        let message = parse_received("2026-03-29 02:30", &zone).expect_err("there was no such time");
        assert!(message.contains("did not exist"), "{message}");
    }

    #[test]
    fn points_after_a_penalty_are_rounded_to_the_nearest_half() {
        let policy = policy("2026-05-21 23:59");
        let late = policy.judge(&["x"], Some(&at(&policy, "2026-05-22 00:30")), &[]);
        for (raw, expected) in [
            (0.0, 0.0),
            (0.5, 0.5),
            (1.0, 1.0),
            (10.0, 8.0),
            (17.5, 14.0),
            (33.5, 27.0),
            (34.0, 27.0),
            (68.5, 55.0),
            (69.5, 55.5),
            (70.0, 56.0),
        ] {
            assert_eq!(policy.points(raw, &late), expected, "{raw}");
        }
        // Exactly in the middle, but for 0.8 in binary: upwards.
        let quarters = Policy { rules: Rules { round_to: 2.0, ..policy.rules.clone() }, ..policy };
        assert_eq!(quarters.points(8.75, &late), 8.0);
    }

    #[test]
    fn an_extension_moves_the_deadline_of_one_student() {
        let policy = policy("2026-05-21 23:59");
        let receipt = at(&policy, "2026-05-23 23:59");
        for names in [["ill", ""], ["x", "ILL"]] {
            let lateness = policy.judge(&names, Some(&receipt), &[]);
            assert_eq!(
                (lateness.standing, lateness.why.as_str()),
                (Standing::InTime, "extension: certificate")
            );
        }
        assert_eq!(policy.judge(&["well"], Some(&receipt), &[]).standing, Standing::NotAccepted);
        let late = at(&policy, "2026-05-24 01:00");
        assert_eq!(policy.judge(&["ill"], Some(&late), &[]).standing, Standing::Late);
    }

    #[test]
    fn a_checksum_in_time_saves_a_file_that_comes_within_twelve_hours() {
        use Standing::{InTime, Late, NotAccepted};
        let policy = policy("2026-05-21 23:59");
        let wrong = "00000000000000000000000000000000";
        for (md5, md5_at, received, expected) in [
            (Some(SUM), Some("2026-05-21 23:59"), "2026-05-22 11:59", InTime),
            (Some(SUM), Some("2026-05-21 23:59"), "2026-05-22 11:59:01", NotAccepted),
            (Some(SUM), Some("2026-05-21 23:59:01"), "2026-05-22 11:00", NotAccepted),
            (Some(SUM), Some("2026-05-21 23:59:01"), "2026-05-22 00:30", Late),
            (Some(wrong), Some("2026-05-21 20:00"), "2026-05-22 11:00", NotAccepted),
            (Some(wrong), Some("2026-05-21 20:00"), "2026-05-22 00:30", Late),
            (Some(wrong), Some("2026-05-21 20:00"), "2026-05-21 21:00", InTime),
            (Some(SUM), None, "2026-05-22 11:00", NotAccepted),
            (None, None, "2026-05-22 11:00", NotAccepted),
        ] {
            let receipt = Receipt {
                md5: md5.map(str::to_owned),
                md5_received_at: md5_at
                    .map(|time| parse_received(time, policy.zone()).expect("it is a time")),
                ..at(&policy, received)
            };
            let lateness = policy.judge(&["x"], Some(&receipt), &[SUM.to_uppercase()]);
            assert_eq!(lateness.standing, expected, "{receipt:?}");
            assert_eq!(lateness.why.contains("md5-wrong"), md5 == Some(wrong), "{lateness:?}");
        }
    }

    #[test]
    fn without_a_deadline_nothing_is_late_and_without_a_time_somebody_should_look() {
        let rules = Rules { time_zone: "Europe/Berlin".into(), ..SHEET };
        let open = Policy::new(&rules, &Course::default()).expect("it is sound");
        assert_eq!(open.judge(&["x"], None, &[]).standing, Standing::InTime);
        let closed = policy("2026-05-21 23:59");
        let lateness = closed.judge(&["x"], None, &[]);
        assert_eq!((lateness.standing, lateness.factor), (Standing::Unknown, 1.0));
    }

    #[test]
    fn what_cannot_be_understood_is_an_error() {
        let rules = |zone: &str| Rules { time_zone: zone.into(), ..SHEET };
        let until = |deadline: &str| Course { deadline: Some(deadline.into()), ..Course::default() };
        for (zone, deadline, expected) in [
            ("Berlin", "2026-05-21 23:59", "unknown time zone"),
            ("Europe/Berlin", "21.5.2026", "is no time"),
            ("Europe/Berlin", "2026-05-21", "no time of day"),
            ("Europe/Berlin", "2026-03-29 02:30", "did not exist"),
        ] {
            let message = Policy::new(&rules(zone), &until(deadline)).expect_err(expected);
            assert!(message.contains(expected), "{message}");
        }
    }
}
