//! Sentences about the check `sampling`.

use verdict::check::{SampledMap, SamplingFlaw, SamplingTest};

use super::number::{percent, trimmed};

/// One sentence without a full stop.
pub(super) fn sampling(test: &SamplingTest) -> String {
    let Some(flaw) = test.flaw else {
        return format!("samples and density agree with each other and with the sheet in {} maps", test.maps);
    };
    let [columns, rows] = test.size;
    format!("{}: in {} ({columns} × {rows} texels)", what_is_wrong(flaw, test), name(test.map))
}

/// A map, as named in a sentence.
fn name(map: SampledMap) -> &'static str {
    match map {
        SampledMap::Constant => "a constant map",
        SampledMap::OneTexel => "a map of one texel",
        SampledMap::Rough => "a map of very different texels",
        SampledMap::OneRow => "a map of one row",
        SampledMap::OneColumn => "a map of one column",
        SampledMap::Poles => "a map with light at the poles only",
        SampledMap::Seam => "a map with light at its left and right edge only",
        SampledMap::Colours => "a map of red, green and blue texels",
        SampledMap::Rotated => "a rotated map",
        SampledMap::BrightTexel => "a map with one bright texel among a million",
        SampledMap::Black => "a black map",
    }
}

fn what_is_wrong(flaw: SamplingFlaw, test: &SamplingTest) -> String {
    match flaw {
        SamplingFlaw::NoDirection => "a sampled direction is not a unit vector".to_owned(),
        SamplingFlaw::NoDensity => {
            "a density is NaN, infinite or negative, or that of a sampled direction is 0".to_owned()
        }
        SamplingFlaw::InTheDark => {
            "no light arrives, but `sample` returns directions or `pdf` is not 0".to_owned()
        }
        SamplingFlaw::NoSample { returned } => {
            format!("`sample` returns a direction in {} of its calls only", percent(returned, 1))
        }
        SamplingFlaw::Disagree { share, ratio } => format!(
            "for {} of the sampled directions, `sample` and `pdf` return different densities: half of these differ by a factor \
             of {} or more",
            percent(share, 1),
            trimmed(ratio, 3)
        ),
        SamplingFlaw::Integral => match test.integral {
            Some(integral) => {
                format!("the integral of `pdf` over all directions is {}, not 1", trimmed(integral, 4))
            }
            None => "the integral of `pdf` over all directions is not finite".to_owned(),
        },
        SamplingFlaw::Density { column, row, ratio } => format!(
            "`pdf` in the texel of column {column} and row {row} is {} times that of the sheet",
            trimmed(ratio, 3)
        ),
        SamplingFlaw::Frequency { column, row, ratio } => format!(
            "`sample` selects the texel of column {column} and row {row} {} times as often as `pdf` says",
            trimmed(ratio, 3)
        ),
        SamplingFlaw::WithinTexels => {
            "within texels, `sample` does not distribute directions as `pdf` says".to_owned()
        }
        SamplingFlaw::Noise => {
            "luminance divided by `pdf` is hardly less noisy than with uniform directions".to_owned()
        }
    }
}
