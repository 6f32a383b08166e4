//! Linear RGB values: radiance, intensity, reflectance, throughput.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::panic::Location;

use serde::{Deserialize, Serialize};

/// A linear RGB value with the primaries and white point of Rec. 709 (sRGB without its transfer curve).
///
/// The unit depends on the quantity: W·sr⁻¹·m⁻² for radiance, none for reflectance and throughput. Products are per
/// channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Rgb {
    /// Zero in each channel.
    pub const BLACK: Self = Self::gray(0.0);
    /// One in each channel.
    pub const WHITE: Self = Self::gray(1.0);

    /// A colour from its three channels.
    #[inline]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// The same value in each channel.
    #[inline]
    pub const fn gray(value: f32) -> Self {
        Self::new(value, value, value)
    }

    /// The largest of the three channels.
    #[inline]
    pub fn max_channel(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    /// The smallest of the three channels.
    #[inline]
    pub fn min_channel(self) -> f32 {
        self.r.min(self.g).min(self.b)
    }

    /// Relative luminance Y (ITU-R BT.709): 0.2126 R + 0.7152 G + 0.0722 B.
    #[inline]
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// True if all channels are zero.
    #[inline]
    pub fn is_black(self) -> bool {
        self.r == 0.0 && self.g == 0.0 && self.b == 0.0
    }

    /// True if no channel is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    /// Applies `f` to each channel.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }

    /// The channels in the order red, green, blue.
    #[inline]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }
}

impl From<[f32; 3]> for Rgb {
    #[inline]
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self::new(r, g, b)
    }
}

impl Add for Rgb {
    type Output = Self;
    #[inline]
    #[track_caller]
    fn add(self, other: Self) -> Self {
        let sum = Self::new(self.r + other.r, self.g + other.g, self.b + other.b);
        if !sum.is_finite() && self.is_finite() {
            super::non_finite::record(Location::caller());
        }
        sum
    }
}

impl Sub for Rgb {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.r - other.r, self.g - other.g, self.b - other.b)
    }
}

impl Neg for Rgb {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|channel| -channel)
    }
}

impl Mul for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(self.r * other.r, self.g * other.g, self.b * other.b)
    }
}

impl Mul<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f32) -> Self {
        self.map(|channel| channel * factor)
    }
}

impl Mul<Rgb> for f32 {
    type Output = Rgb;
    #[inline]
    fn mul(self, color: Rgb) -> Rgb {
        color * self
    }
}

impl Div<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn div(self, divisor: f32) -> Self {
        self.map(|channel| channel / divisor)
    }
}

impl AddAssign for Rgb {
    #[inline]
    #[track_caller]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Rgb {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Rgb {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl MulAssign<f32> for Rgb {
    #[inline]
    fn mul_assign(&mut self, factor: f32) {
        *self = *self * factor;
    }
}

impl DivAssign<f32> for Rgb {
    #[inline]
    fn div_assign(&mut self, divisor: f32) {
        *self = *self / divisor;
    }
}
