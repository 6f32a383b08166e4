//! The report as one self-contained page: no network, no other files.
//!
//! Everything that comes from the report is escaped by the template; style, script, plots and numbers of pictures are
//! our own. A content security policy forbids the page to load anything, and to run any script but its own.

mod audit;
mod causes;
pub mod document;
mod files;
mod findings;
mod next;
mod paths;
pub mod plots;
mod prose;
mod viewer;

pub use files::{Readers, pages_beside, pictures_beside, remove_pages, write_pages, write_watched_pages};

use maud::{Markup, PreEscaped, html};

use prose::prose;

use crate::convergence::{Axis, not_measured, sentences, svg};
use crate::words;
use verdict::check::{CheckId, CheckResult, Evidence, Visibility};
use verdict::edition::Edition;
use verdict::pictures::Picture;
use verdict::report::Report;

const SCRIPT: &str = include_str!("viewer.js");

/// The script of a page that is written again on every save: it loads itself anew.
const RELOAD: &str = include_str!("reload.js");

/// The page of a report, as HTML. A student's page is made of the report that [`for_student`](verdict::edition::for_student) gives.
pub fn page(report: &Report, pictures: &[Picture], edition: Edition) -> String {
    page_with(report, pictures, edition, SCRIPT)
}

/// The page of a report that will be replaced on the next save.
fn watched_page(report: &Report, edition: Edition) -> String {
    page_with(report, &[], edition, &format!("{SCRIPT}{RELOAD}"))
}

fn page_with(report: &Report, pictures: &[Picture], edition: Edition, script: &str) -> String {
    let points = &report.points;
    let body = html! {
        header {
            h1 { "Assignment " (report.assignment) }
            p.soft { (report.submission.path) @if edition == Edition::Tutor { " · tutor's edition" } }
            @let rest = words::not_covered(points);
            p.sum { (points.earned) " of " (words::number_of_points(points.automatic_max)) " "
                small { "graded automatically" @if !rest.is_empty() { "; " (rest) } } }
            (hand_in(report))
        }
        main {
            @if let Some(failure) = &report.submission.build_failure {
                h2 { "The submission does not compile" }
                pre tabindex="0" { (failure.messages) }
            }
            (next::section(report))
            (findings::tasks(report))
            (audit::section(report))
            @let is_public = |picture: &&Picture| Visibility::of_scene(&picture.scene) == Visibility::Public;
            @let shown = pictures.iter().filter(|picture| edition == Edition::Tutor || is_public(picture));
            (viewer::section(report, &shown.collect::<Vec<_>>()))
            (causes::section(report))
            (findings::explanations(report))
            (findings::checks(report, edition))
            (weights(report))
            (furnaces(report))
            (statistics(report, edition))
            (findings::skipped(report))
            (findings::provenance(report))
        }
    };
    let title = format!("{}: {} of {}", report.assignment, points.earned, points.automatic_max);
    format!("{}{}{}", document::begin(&title, script), body.into_string(), document::end(script))
}

/// What changes no points: error against run time, and for tutors whether the differences of tiles look like noise.
fn statistics(report: &Report, edition: Edition) -> Markup {
    let parts = [Some(convergence(report)), (edition == Edition::Tutor).then(|| p_values(report))];
    let parts: Vec<String> =
        parts.into_iter().flatten().map(Markup::into_string).filter(|part| !part.is_empty()).collect();
    html! {
        @if !parts.is_empty() {
            h2 { "Statistics" }
            details { summary { "error against run time" @if parts.len() > 1 { ", bias and noise" } }
                @for part in parts { (PreEscaped(part)) } }
        }
    }
}

/// Who handed it in, when, and the points that count.
fn hand_in(report: &Report) -> Markup {
    let Some(hand_in) = &report.hand_in else { return html! {} };
    html! {
        p { b { (hand_in.student) }
            @if let Some(time) = &hand_in.received_at { " · received " (time) }
            @if let Some(late_by) = hand_in.late_by {
                " · " (words::duration(late_by)) " late"
                @if hand_in.factor > 0.0 { ": points × " (hand_in.factor) } @else { ": no longer accepted" }
            }
            " · " b { (words::number_of_points(hand_in.points)) } " so far"
        }
    }
}

fn convergence(report: &Report) -> Markup {
    let Some(convergence) = &report.convergence else { return html! {} };
    html! {
        h3 { "Error against run time" }
        p.soft { "This changes no points. The error of an unbiased program falls with slope −1; a curve that flattens indicates a bias \
            (dashed line). Bars are 95 % confidence intervals." }
        @if let Some(plot) = svg(convergence, Axis::Seconds) { div.scroll { (PreEscaped(plot)) } }
        ul { @for sentence in convergence.panels.iter().flat_map(sentences) { li { (sentence) } } }
        @for entry in &convergence.left_out { p { (not_measured(entry)) } }
    }
}

/// The weights that were measured, where they were.
fn weights(report: &Report) -> Markup {
    let measured = report.checks.iter().filter_map(|check| match &check.evidence {
        Some(Evidence::MisWeights(test)) => Some((check, plots::weights(test.measured.as_ref()?)?)),
        _ => None,
    });
    html! {
        @for (check, plot) in measured {
            h2 { "MIS weights" }
            div.beside {
                div.scroll { (PreEscaped(plot)) }
                div {
                    p { "Weights of light samples (dots) and BSDF samples (rings), plotted against the ratio of the two densities for \
                        the same direction. The lines show the balance heuristic." }
                    p { (prose(&words::explanation(check))) }
                    p.soft { "Other weights are correct, too, if the two sum to one and that of the light sample rises with p_L / p_B." }
                }
            }
        }
    }
}

/// Energy per bounce.
fn furnaces(report: &Report) -> Markup {
    let plot = |check: &CheckResult| match &check.evidence {
        Some(Evidence::WhiteFurnace(test)) => plots::furnace(test),
        _ => None,
    };
    let plots: Vec<(&CheckId, String)> =
        report.checks.iter().filter_map(|check| Some((&check.id, plot(check)?))).collect();
    html! {
        @if !plots.is_empty() {
            h2 { "White furnace: energy per bounce" }
            p { "Inside a closed surface that emits uniformly, the energy of each bounce is known. The plots show your energy \
                relative to it; the dashed line, 1, is correct. Bars are 99 % confidence intervals. Start with the first bounce that is \
                off: 2 means that both techniques count the light, 0 that neither finds it." }
            div.plots {
                @for (id, plot) in plots {
                    figure { figcaption { b { (id.scene) ", " (id.technique) } } div.scroll { (PreEscaped(plot)) } }
                }
            }
        }
    }
}

/// Whether the differences of tiles look like noise.
fn p_values(report: &Report) -> Markup {
    let plots = [
        (
            true,
            "Checks that passed",
            "Without bias, all bars have the same height up to noise: 19 of 20 end between the dashed lines. A high bar on \
            the left means that tiles differ by more than noise. Low bars on the left are no problem: where the noise is not \
            known well, the test assumes more of it.",
        ),
        (
            false,
            "Other checks",
            "A high bar on the left is expected here: these tiles differ by more than noise.",
        ),
    ];
    let plots: Vec<_> = plots
        .into_iter()
        .filter_map(|(passed, title, words)| Some((title, words, plots::p_values(&report.checks, passed)?)))
        .collect();
    html! {
        @if !plots.is_empty() {
            h3 { "Bias or noise?" }
            p { "Images are compared with the reference tile by tile. The p-value of a tile is the probability that noise alone causes a \
                difference at least this large." }
            div.plots {
                @for (title, words, values) in plots {
                    figure {
                        figcaption { b { (title) } " " span.soft { (words::count(values.tiles, "tile")) " of " (words::count(values.pictures, "image")) "; "
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
