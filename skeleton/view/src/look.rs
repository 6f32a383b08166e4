//! From radiance to the colours on the screen.

use arty::math::Rgb;
use arty::srgb::{exposure_factor, linear_to_srgb_u8};

/// Exposure and tone map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Exposure in stops.
    pub exposure: f32,
    /// What becomes of values above 1.
    pub tone_map: ToneMap,
}

/// What becomes of values above 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// They are clamped, as in PNG files.
    #[default]
    Clamp,
    /// All values are compressed to x / (1 + x) (Reinhard et al., SIGGRAPH 2002).
    Reinhard,
}

impl ToneMap {
    /// The other one.
    pub fn next(self) -> Self {
        match self {
            Self::Clamp => Self::Reinhard,
            Self::Reinhard => Self::Clamp,
        }
    }

    /// The name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clamp => "clamped",
            Self::Reinhard => "x / (1 + x)",
        }
    }
}

impl Look {
    /// Linear values between 0 and 1 where they can be shown.
    pub fn apply(&self, radiance: Rgb) -> Rgb {
        let exposed = radiance * exposure_factor(self.exposure);
        match self.tone_map {
            ToneMap::Clamp => exposed,
            ToneMap::Reinhard => {
                exposed.map(|value| if value.is_infinite() { 1.0 } else { value / (1.0 + value) })
            }
        }
    }

    /// The colour on the screen, `0x00RRGGBB`.
    pub fn color(&self, radiance: Rgb) -> u32 {
        let [r, g, b] = self.apply(radiance).to_array().map(|value| u32::from(linear_to_srgb_u8(value)));
        r << 16 | g << 8 | b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_those_of_png_files() {
        let look = |exposure| Look { exposure, tone_map: ToneMap::Clamp };
        assert_eq!(look(0.0).color(Rgb::new(1.0, 0.18, 0.0)), 0xff7600);
        assert_eq!(look(2.0).color(Rgb::gray(0.045)), 0x767676);
    }

    #[test]
    fn the_tone_map_keeps_differences_above_one() {
        let look = Look { exposure: 0.0, tone_map: ToneMap::Reinhard };
        assert_eq!(look.apply(Rgb::new(1.0, 3.0, f32::INFINITY)), Rgb::new(0.5, 0.75, 1.0));
        assert_eq!(ToneMap::Clamp.next().next(), ToneMap::Clamp);
    }
}
