//! Paths of a pixel as SVG over a picture. The script of the page shows those of the chosen technique and sample.

use maud::{Markup, html};

use verdict::pictures::{DrawnPath, PathLine, Picture, RayKind, Rendered};

/// Kinds of rays, with their classes, in the order in which they are drawn.
const KINDS: [(RayKind, &str); 4] = [
    (RayKind::Bounce, "bounce"),
    (RayKind::Untested, "untested"),
    (RayKind::Blocked, "blocked"),
    (RayKind::Arrives, "arrives"),
];

/// The paths of all techniques; nothing where there are none. `picture` decides what their coordinates mean.
pub(super) fn overlays(picture: &Picture) -> Markup {
    html! {
        @for Rendered { technique, paths, .. } in &picture.rendered {
            @if let Some(paths) = paths {
                svg.paths data-technique=(technique) data-pixel={ (paths.pixel[0]) "," (paths.pixel[1]) }
                    viewBox={ "0 0 " (picture.width) " " (picture.height) } preserveAspectRatio="none" aria-hidden="true" {
                    @for path in &paths.samples { (drawn(path)) }
                }
            }
        }
    }
}

/// True if there is something to show.
pub(super) fn are_there(picture: &Picture) -> bool {
    picture.rendered.iter().any(|rendered| rendered.paths.is_some())
}

fn drawn(DrawnPath { radiance, lines }: &DrawnPath) -> Markup {
    html! {
        g data-radiance=(radiance.map(|value| value.to_string()).join(" ")) {
            @for (kind, class) in KINDS {
                @let of_kind: Vec<&PathLine> = lines.iter().filter(|line| line.kind == kind).collect();
                @if !of_kind.is_empty() { path class=(class) d=(data(&of_kind)) {} }
            }
        }
    }
}

/// Lines as the data of an SVG path.
fn data(lines: &[&PathLine]) -> String {
    lines.iter().map(|PathLine { from, to, .. }| format!("M{}L{}", place(*from), place(*to))).collect()
}

/// A position, to a tenth of a pixel.
fn place([x, y]: [f32; 2]) -> String {
    format!("{x:.1} {y:.1}")
}
