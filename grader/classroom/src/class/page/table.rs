//! The table of the class's page.

use maud::{Markup, html};

use super::ClassPage;
use super::digest::{Digest, Digests};
use crate::class::gradebook::{Row, State};
use crate::policy::Lateness;

/// One row per member, with buttons in the header that sort. Empty columns are left out.
pub(super) fn table(page: &ClassPage<'_>, digests: &Digests) -> Markup {
    let tasks = &page.rubric.tasks;
    let columns = Columns {
        names: page.rows.iter().any(|row| !name(row).is_empty()),
        late: page.rows.iter().any(|row| late_by(row).is_some()),
        roster: page.rows.iter().any(|row| row.on_roster),
    };
    html! {
        h2 { "Everybody" }
        p.controls { label { "only rows with " input type="search" id="filter"; } " " span.soft id="shown" role="status" {} }
        div.scroll { table.sortable {
            thead { tr {
                (head("student", false))
                @if columns.names { (head("name", false)) }
                (head("points", true))
                @for task in tasks { (head(&task.id, true)) }
                (head("why", false))
                @if columns.late { (head("late", true)) }
                (head("seconds", true)) th { "report" }
            } }
            tbody { @for (row, digest) in page.rows.iter().zip(&digests.of_rows) { (line(page, columns, row, digests, digest)) } }
        } }
    }
}

/// Columns that may be empty: true if they are shown.
#[derive(Clone, Copy)]
struct Columns {
    names: bool,
    late: bool,
    roster: bool,
}

fn head(text: &str, is_number: bool) -> Markup {
    let class = if is_number { "number" } else { "text" };
    html! { th scope="col" class=(class) aria-sort="none" { button type="button" { (text) } } }
}

fn line(page: &ClassPage<'_>, columns: Columns, row: &Row, digests: &Digests, digest: &Digest) -> Markup {
    let cause = digest.group.map(|group| &digests.alike[group]).filter(|group| group.is_cause);
    html! {
        tr {
            td { (row.key) @if columns.roster && !row.on_roster { " " span.soft { "not on the roster" } } }
            @if columns.names { td.words { (name(row)) } }
            (number(row.points, points_of(row)))
            @for task in &page.rubric.tasks {
                @let points = row.tasks.get(&task.id).copied().flatten();
                (number(points, shown(points)))
            }
            td.words { (why(row)) @if let Some(cause) = cause { div { (cause.what) } } }
            @if columns.late {
                (number(late_by(row), row.lateness.as_ref().map_or_else(String::new, Lateness::late_by_text)))
            }
            (number(digest.seconds, digest.seconds.map_or_else(String::new, |seconds| format!("{seconds:.1}"))))
            td.links { @if digest.pages {
                a href=(link(row, "report-tutor.html")) aria-label={ "report of " (row.key) } { "report" } " "
                a.soft href=(link(row, "report.html")) aria-label={ "the student's edition of " (row.key) } { "student's" }
            } }
        }
    }
}

/// Seconds after the deadline; none if it was in time.
fn late_by(row: &Row) -> Option<f64> {
    row.lateness.as_ref()?.late_by.map(|seconds| seconds as f64)
}

fn number(value: Option<f64>, text: String) -> Markup {
    html! { td.number data-value=[value] { (text) } }
}

/// Points, or a dash.
fn shown(points: Option<f64>) -> String {
    points.map_or_else(|| "–".to_owned(), |points| points.to_string())
}

/// Points that count.
pub(super) fn points_of(row: &Row) -> String {
    shown(row.points)
}

/// First and last name; empty if unknown.
pub(super) fn name(row: &Row) -> String {
    format!("{} {}", row.first_name, row.last_name).trim().to_owned()
}

/// Main reason why points are missing, and notes.
fn why(row: &Row) -> Markup {
    html! {
        @match (&row.reason, row.state) {
            (Some(reason), _) => { b { (reason.code) } ": " (reason.message) }
            (None, State::Harness) => "the grader failed",
            _ => "",
        }
        @if row.kept { " " span.fail { "earlier result kept" } }
        @for note in &row.notes { " " span.soft title=(note.message) { (note.code) } }
    }
}

/// Link to a file of a row's results, relative to the page.
pub(super) fn link(row: &Row, file: &str) -> String {
    format!("submissions/{}/{file}", row.key)
}
