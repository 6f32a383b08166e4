//! The report as one self-contained page: no network, no other files.
//!
//! Everything that comes from the report is escaped by the template; style, script, plots and numbers of pictures are
//! our own. A content security policy forbids the page to load anything, and to run any script but its own.

mod causes;
pub mod document;
mod files;
mod findings;
pub mod plots;
mod viewer;

pub use files::{Readers, pages_beside, pictures_beside, remove_pages, write_pages};

use maud::{Markup, PreEscaped, html};

use crate::convergence::{sentences, svg};
use verdict::edition::Edition;
use verdict::pictures::Picture;
use verdict::report::{CheckResult, Report};

const SCRIPT: &str = include_str!("viewer.js");

/// The page of a report, as HTML. A student's page is made of the report that [`for_student`](verdict::edition::for_student) gives.
pub fn page(report: &Report, pictures: &[Picture], edition: Edition) -> String {
    let points = &report.points;
    let body = html! {
        header {
            h1 { (report.submission.path) }
            p.soft { "assignment " (report.assignment) @if edition == Edition::Tutor { " · tutor's edition" } }
            p.sum { (points.earned) " of " (points.automatic_max) " points "
                small { "graded automatically; " @match points.marked {
                    Some(marked) => { (marked) " of " (points.manual_max) " given by a person" }
                    None => { (points.manual_max) " more are marked by a person" }
                } } }
        }
        main {
            (findings::tasks(report))
            @if let Some(failure) = &report.submission.build_failure {
                h2 { "It does not compile" }
                pre tabindex="0" { (failure.messages) }
            }
            (causes::section(report))
            (findings::explanations(report))
            (findings::checks(report, edition))
            @let shown = pictures.iter().filter(|picture| edition == Edition::Tutor || !verdict::edition::is_hidden_name(&picture.scene));
            (viewer::section(report, &shown.collect::<Vec<_>>()))
            (convergence(report))
            (weights(report))
            (furnaces(report))
            (p_values(report))
            (findings::left_out(report))
            (findings::provenance(report))
        }
    };
    let title = format!("{}: {} of {}", report.submission.path, points.earned, points.automatic_max);
    format!("{}{}{}", document::begin(&title, SCRIPT), body.into_string(), document::end(SCRIPT))
}

fn convergence(report: &Report) -> Markup {
    let Some(convergence) = &report.convergence else { return html! {} };
    html! {
        h2 { "Error against run time" }
        p.soft { "For no points. An unbiased program follows the slope −1; one that flattens has a bias, whose size the dashed \
            line shows. Bars are 95 % intervals." }
        @if let Some(plot) = svg(convergence) { div.scroll { (PreEscaped(plot)) } }
        ul { @for sentence in convergence.panels.iter().flat_map(sentences) { li { (sentence) } } }
        @for left_out in &convergence.left_out { p { "Left out: " (left_out.check) " " (left_out.scene) ": " (left_out.why) } }
    }
}

/// The weights that were measured, where they were.
fn weights(report: &Report) -> Markup {
    let measured =
        report.checks.iter().filter_map(|check| Some((check, plots::weights(check.weights.as_ref()?)?)));
    html! {
        @for (check, plot) in measured {
            h2 { "Weights of multiple importance sampling" }
            div.beside {
                div.scroll { (PreEscaped(plot)) }
                div {
                    p { "Dots are the weights that the hand-in gives a light sample, rings those that it gives a BSDF sample, \
                        over the ratio of the two densities for the same direction. The lines are those of the balance heuristic." }
                    p { (check.explanation) }
                    p.soft { "Other weights are right too, if both sum to one and that of the light sample rises with p_L / p_B." }
                }
            }
        }
    }
}

/// How often light counts, by how many times it was scattered.
fn furnaces(report: &Report) -> Markup {
    let plots: Vec<(&CheckResult, String)> =
        report.checks.iter().filter_map(|check| Some((check, plots::furnace(check)?))).collect();
    html! {
        @if !plots.is_empty() {
            h2 { "Furnaces, bounce by bounce" }
            p { "Inside of a closed surface that emits the same everywhere, light that is scattered k times must count once, \
                for every k: the dashed line. Bars are 99 % intervals. The first k that is off tells which bounce is wrong: twice is \
                light that both techniques count, nothing is light that neither finds." }
            div.plots {
                @for (check, plot) in plots {
                    figure { figcaption { b { (check.scene) ", " (check.technique) } } div.scroll { (PreEscaped(plot)) } }
                }
            }
        }
    }
}

/// Whether what passed looks like what is right.
fn p_values(report: &Report) -> Markup {
    let plots = [
        (
            true,
            "In checks that passed",
            "Were every tile right, each bar would be as high as the line, but for chance: nineteen \
            of twenty bars end between the dashed lines. A high bar on the left is tiles that are off by more than chance. \
            Low bars there are caution: noise that is not well known is taken to be larger.",
        ),
        (
            false,
            "In the other checks",
            "A high bar on the left is expected here: tiles that are off by more than chance.",
        ),
    ];
    let plots: Vec<_> = plots
        .into_iter()
        .filter_map(|(passed, title, words)| Some((title, words, plots::p_values(&report.checks, passed)?)))
        .collect();
    html! {
        @if !plots.is_empty() {
            h2 { "Is it chance?" }
            p { "Pictures are compared with the reference in tiles. A p-value says how likely a difference of at least this size \
                would be if only chance were at work." }
            div.plots {
                @for (title, words, values) in plots {
                    figure {
                        figcaption { b { (title) } " " span.soft { (values.tiles) " tiles of " (values.pictures) " pictures; "
                            (format!("{:.0} %", 100.0 * values.unlikely)) " below 0.05" } }
                        div.scroll { (PreEscaped(values.plot)) }
                        p.soft { (words) }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
