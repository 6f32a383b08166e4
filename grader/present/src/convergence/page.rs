//! The measurements as a page of their own: plot, sentences, and crops after equal time.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};

use verdict::convergence::{Convergence, Crop, Crops};

use super::{Axis, not_measured, sentences, svg};
use crate::page::document;
use crate::pictures::png;

/// The page of a measurement.
pub fn page(convergence: &Convergence, crops: &[Crops]) -> String {
    let body = html! {
        header { h1 { "Error against run time" } }
        main {
            p.soft { "The error of an unbiased program falls with slope −1; a curve that flattens indicates a bias (dashed line). \
                Bars are 95 % confidence intervals." }
            @if let Some(plot) = svg(convergence, Axis::Seconds) { div.scroll { (PreEscaped(plot)) } }
            @for (axis, title) in [(Axis::Samples, "Error against samples"), (Axis::Rays, "Error against rays")] {
                @if let Some(plot) = svg(convergence, axis) {
                    details { summary { (title) } div.scroll { (PreEscaped(plot)) } }
                }
            }
            ul { @for sentence in convergence.panels.iter().flat_map(sentences) { li { (sentence) } } }
            @if !crops.is_empty() {
                h2 { "Equal time" }
                p.soft { "The part of each image in which the solution has the largest error, at the number of samples nearest to "
                    (crops[0].seconds) " seconds of processor time." }
                @for crops in crops {
                    h3 { (crops.scene) ", " (crops.technique) }
                    div.crops { @for crop in &crops.list { (figure(crop)) } }
                }
            }
            @for entry in &convergence.left_out { p { (not_measured(entry)) } }
        }
    };
    format!("{}{}{}", document::begin("Error against run time", ""), body.into_string(), document::end(""))
}

fn figure(crop: &Crop) -> Markup {
    let source = format!(
        "data:image/png;base64,{}",
        STANDARD.encode(png(&crop.pixels, crop.width, crop.height).unwrap_or_default())
    );
    html! {
        figure {
            img src=(source) alt={ "part of a picture by " (crop.name) };
            figcaption {
                (crop.name)
                @if let Some(samples) = crop.samples { " " span.soft { (samples) " samples" } }
                @if let Some(error) = crop.relative_mse { " " span.soft { "relMSE " (format!("{error:.3}")) } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arty::integrator::Technique;

    #[test]
    fn names_of_submissions_are_no_markup() {
        let crop = Crop {
            name: "<b>&".to_owned(),
            samples: Some(3),
            relative_mse: Some(0.5),
            pixels: vec![[0.5; 3]],
            width: 1,
            height: 1,
        };
        let crops =
            Crops { scene: "box".to_owned(), technique: Technique::Mis, seconds: 0.25, list: vec![crop] };
        let text = page(&Convergence::default(), &[crops]);
        assert!(
            text.contains("&lt;b&gt;&amp;") && !text.contains("<b>") && text.contains("base64,iVBORw0KGgo")
        );
        assert!(text.contains("3 samples") && text.contains("relMSE 0.500"));
    }
}
