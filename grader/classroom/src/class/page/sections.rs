//! The sections of the class's page besides its table.

use maud::{Markup, PreEscaped, html};

use super::ClassPage;
use super::digest::{Digests, Rate};
use super::table::{link, name};
use crate::class::gradebook::{Row, State};
use present::page::plots::{Bars, bars};
use present::words;

/// Length of the lists of the slowest and of the most efficient submissions.
const LISTED: usize = 5;

/// Number of bars in the distribution of points.
const BARS: usize = 14;

pub(super) fn header(page: &ClassPage<'_>) -> Markup {
    let count = |state: State| page.rows.iter().filter(|row| row.state == state).count();
    let parts = [
        (State::Graded, "graded"),
        (State::Refused, "could not be graded"),
        (State::Missing, "handed in nothing"),
        (State::Harness, "the grader failed with"),
    ];
    html! {
        header {
            h1 { (page.rubric.title) }
            p.soft { "assignment " (page.rubric.assignment) " · for staff only" }
            p { @for (index, (state, words)) in parts.into_iter().filter(|(state, _)| count(*state) > 0).enumerate() {
                @if index > 0 { ", " } b { (count(state)) } " " (words)
            } }
            @if page.similar > 0 { p { "Submissions that are the same or nearly so: " (words::count(page.similar, "group")) ", in "
                a href="similar.txt" { "similar.txt" } "." } }
        }
    }
}

/// Average points of each task, and the distribution of points.
pub(super) fn points(page: &ClassPage<'_>) -> Markup {
    let automatic = |row: &Row| -> Option<f64> {
        let tasks = page.rubric.tasks.iter().filter(|task| !task.manual);
        tasks.map(|task| row.tasks.get(&task.id).copied().flatten()).sum()
    };
    let max: f64 = page.rubric.tasks.iter().filter(|task| !task.manual).map(|task| task.points).sum();
    let points: Vec<f64> = page.rows.iter().filter_map(automatic).collect();
    let mut counts = [0; BARS];
    for value in &points {
        counts[((value / max * BARS as f64) as usize).min(BARS - 1)] += 1;
    }
    let plot = bars(&Bars {
        label: "distribution of points",
        axis: "points of tasks that are graded automatically",
        range: (0.0, max),
        counts: &counts,
        expected: None,
    });
    html! {
        h2 { "Points" }
        div.beside {
            @if let Some(plot) = plot { div.scroll { (PreEscaped(plot)) } }
            div { div.scroll { table {
                thead { tr { th { "task" } th { "title" } th.number { "mean" } th { "share" } th.number { "all" } th.number { "none" } } }
                tbody { @for task in &page.rubric.tasks {
                    @let given: Vec<f64> = page.rows.iter().filter_map(|row| row.tasks.get(&task.id).copied().flatten()).collect();
                    @let mean = given.iter().sum::<f64>() / given.len().max(1) as f64;
                    tr {
                        td { (task.id) } td { (task.title) }
                        @if given.is_empty() { td.number { "–" } td { "" } td { "" } td { "" } } @else {
                            td.number { (format!("{mean:.1}")) " / " (task.points) }
                            td { meter min="0" max=(task.points) value=(format!("{mean:.3}")) { } }
                            td.number { (given.iter().filter(|points| **points >= task.points).count()) }
                            td.number { (given.iter().filter(|points| **points <= 0.0).count()) }
                        }
                    }
                } }
            } } p.soft { "Of " (words::count(points.len(), "submission")) " with points; raw, before any penalty for being late." } }
        }
    }
}

/// Checks with the lowest pass rates.
pub(super) fn hard(page: &ClassPage<'_>, digests: &Digests) -> Markup {
    let mut checks: Vec<(&str, Rate)> =
        digests.checks.iter().map(|(check, rate)| (check.as_str(), *rate)).collect();
    let share = |rate: &Rate| rate.passed as f64 / rate.run.max(1) as f64;
    checks.sort_by(|a, b| share(&a.1).total_cmp(&share(&b.1)));
    let titles =
        |task: &str| page.rubric.tasks.iter().find(|other| other.id == task).map(|task| task.title.as_str());
    html! {
        @if !checks.is_empty() {
            h2 { "Checks with the lowest pass rates" }
            details open {
                summary { "pass rates of " (words::count(checks.len(), "check")) }
                div.scroll { table.sortable {
                    thead { tr {
                        th scope="col" aria-sort="none" { button type="button" { "task" } }
                        th scope="col" aria-sort="none" { button type="button" { "check" } }
                        th.number scope="col" aria-sort="none" { button type="button" { "passed" } }
                        th { "share" }
                    } }
                    tbody { @for (check, rate) in checks {
                        @let (task, id) = check.split_once(' ').unwrap_or(("", check));
                        tr {
                            td title=[titles(task)] { (task) } td.name { (id) }
                            td.number data-value=(share(&rate)) { (rate.passed) " of " (rate.run) }
                            td { meter min="0" max="1" value=(format!("{:.3}", share(&rate))) { } }
                        }
                    } }
                } }
            }
        }
    }
}

/// Groups of submissions with the same mistake.
pub(super) fn alike(page: &ClassPage<'_>, digests: &Digests) -> Markup {
    html! {
        @if !digests.alike.is_empty() {
            h2 { "The same mistake" }
            p.soft { "By the most likely cause; if none is known, by the failed checks." }
            div.scroll { table {
                thead { tr { th.number { "submissions" } th { "what they share" } th { "who" } } }
                tbody { @for group in &digests.alike { tr {
                    td.number { (group.rows.len()) }
                    td.name { @if group.is_cause { b { (group.what) } } @else { (long(&group.what)) } }
                    td { @for (index, row) in group.rows.iter().enumerate() {
                        @if index > 0 { ", " }
                        (who(&page.rows[*row], digests.of_rows[*row].pages))
                    } }
                } } }
            } }
        }
    }
}

/// A list of checks, folded if it is long.
fn long(what: &str) -> Markup {
    let parts: Vec<&str> = what.split(", ").collect();
    html! {
        @if parts.len() <= 3 { (what) } @else {
            details.again { summary { (parts[..2].join(", ")) " and " (parts.len() - 2) " more" } (what) }
        }
    }
}

fn who(row: &Row, pages: bool) -> Markup {
    html! { @if pages { a href=(link(row, "report-tutor.html")) { (row.key) } } @else { (row.key) } }
}

/// The slowest submissions, and the most efficient ones.
pub(super) fn speed(page: &ClassPage<'_>, digests: &Digests) -> Markup {
    let sorted = |value: &dyn Fn(usize) -> Option<f64>| {
        let mut list: Vec<(usize, f64)> =
            (0..page.rows.len()).filter_map(|index| Some((index, value(index)?))).collect();
        list.sort_by(|a, b| a.1.total_cmp(&b.1));
        list
    };
    let slowest = sorted(&|index| digests.of_rows[index].seconds);
    let work = sorted(&|index| digests.of_rows[index].work);
    let median = work.get(work.len() / 2).map_or(1.0, |(_, work)| *work);
    let list = |title: &str, entries: Vec<(usize, String)>| {
        html! { @if !entries.is_empty() { div { h3 { (title) } ol { @for (index, text) in entries {
            li { (who(&page.rows[index], digests.of_rows[index].pages)) " " span.soft { (text) } }
        } } } } }
    };
    html! {
        @if !slowest.is_empty() {
            h2 { "Time" }
            div.beside {
                (list("The slowest grades", slowest.iter().rev().take(LISTED).map(|&(index, seconds)| (index, format!("{seconds:.1} s"))).collect()))
                (list("The most efficient", work.iter().take(LISTED).map(|&(index, work)| (index, format!("{:.2} times the median", median / work))).collect()))
            }
            @if !work.is_empty() { p.soft { "Efficiency is 1 / (variance × time) of multiple importance sampling, in the scenes of the check "
                code { "efficiency" } ". Several submissions were graded at once, so times are approximate: "
                code { "cargo grader converge" } " measures accurately." } }
        }
    }
}

/// Submissions that still need a mark.
pub(super) fn to_mark(page: &ClassPage<'_>) -> Markup {
    html! {
        @for task in page.rubric.tasks.iter().filter(|task| task.manual) {
            @let missing: Vec<&Row> = page.rows.iter()
                .filter(|row| row.state == State::Graded || !row.explanations.is_empty())
                .filter(|row| row.tasks.get(&task.id).copied().flatten().is_none()).collect();
            h2 { "To be marked: " (task.id) " " (task.title) }
            @if missing.is_empty() { p { "all done" } } @else {
                p { (words::count(missing.len(), "submission")) " without a mark. "
                    code { "cargo grader mark STUDENT " (task.id) " POINTS --comment=\"…\" --out=" (page.out.display()) }
                    ", then " code { "--resume" } "." }
                details {
                    summary { "who" }
                    ul { @for row in missing { li {
                        (row.key) " " (name(row)) " " span.soft {
                            @if row.explanations.is_empty() { "no explanation came with it" } @else { (row.explanations.join(", ")) }
                        }
                    } } }
                }
            }
        }
    }
}

/// Changes of scores since the last run.
pub(super) fn changes(page: &ClassPage<'_>) -> Markup {
    html! {
        @if !page.changes.is_empty() {
            h2 { "Changed since the last run" }
            p { (page.changes.len()) " of " (page.rows.len()) " scores" }
            ul { @for change in page.changes { li { (change) } } }
        }
    }
}
