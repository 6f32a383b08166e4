//! Values of a scene file, validated during deserialization so that errors carry the line of the value.

use std::fmt;
use std::marker::PhantomData;

use glam::{DVec3, Vec3};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Unexpected, Visitor};

use crate::math::Rgb;

/// Reads a number that must satisfy `accept`; `expected` describes it in the error.
fn number<'de, D: Deserializer<'de>>(
    deserializer: D,
    expected: &'static str,
    accept: fn(f64) -> bool,
) -> Result<f64, D::Error> {
    struct NumberVisitor {
        expected: &'static str,
        accept: fn(f64) -> bool,
    }
    impl Visitor<'_> for NumberVisitor {
        type Value = f64;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str(self.expected)
        }
        fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
            if (self.accept)(value) {
                Ok(value)
            } else {
                Err(E::invalid_value(Unexpected::Float(value), &self))
            }
        }
        fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
            self.visit_f64(value as f64)
        }
        fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
            self.visit_f64(value as f64)
        }
    }
    deserializer.deserialize_f64(NumberVisitor { expected, accept })
}

/// True if the number is finite in single precision.
fn fits_f32(value: f64) -> bool {
    (value as f32).is_finite()
}

/// Any finite number.
#[derive(Clone, Copy)]
pub(super) struct Number(f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number(deserializer, "a finite number", fits_f32).map(Self)
    }
}

impl Number {
    /// The number in double precision.
    pub(super) fn get(self) -> f64 {
        self.0
    }
}

/// Three finite numbers: a point or a direction.
#[derive(Clone, Copy, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Vector([Number; 3]);

impl Vector {
    /// In double precision.
    pub(super) fn double(self) -> DVec3 {
        DVec3::from_array(self.0.map(Number::get))
    }

    /// In single precision.
    pub(super) fn single(self) -> Vec3 {
        self.double().as_vec3()
    }
}

/// A non-negative number.
#[derive(Clone, Copy)]
pub(super) struct NonNegative(f32);

impl<'de> Deserialize<'de> for NonNegative {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let accept = |value| value >= 0.0 && fits_f32(value);
        number(deserializer, "a finite, non-negative number", accept).map(|value| Self(value as f32))
    }
}

/// Three non-negative numbers.
#[derive(Clone, Copy, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Colour([NonNegative; 3]);

impl From<Colour> for Rgb {
    fn from(Colour(channels): Colour) -> Self {
        Self::from(channels.map(|channel| channel.0))
    }
}

/// A field of view in degrees, in (0, 180).
pub(super) fn field_of_view<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    // Compared in single precision, so that 179.999999999 is not rounded to 180 afterwards.
    let accept = |value| 0.0 < value as f32 && (value as f32) < 180.0;
    number(deserializer, "a field of view in degrees, between 0 and 180", accept).map(|value| value as f32)
}

/// A number of pixels, in 1..=65536.
pub(super) fn pixels<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    let accept = |value: f64| (1.0..=65536.0).contains(&value) && value.fract() == 0.0;
    number(deserializer, "a whole number of pixels from 1 to 65536", accept).map(|value| Some(value as u32))
}

/// A number of bounces, in 0..=u32::MAX.
pub(super) fn bounces<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    let accept = |value: f64| (0.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0;
    number(deserializer, "a whole number of bounces, 0 or more", accept).map(|value| Some(value as u32))
}

/// Reads a mapping with the keys of `Keys` and converts it to a `T`, which validates the combination of values.
///
/// Errors carry the line in which the mapping starts.
pub(super) fn mapping<'de, D, Keys, T>(deserializer: D, expected: &'static str) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    Keys: Deserialize<'de>,
    T: TryFrom<Keys, Error = String>,
{
    struct MappingVisitor<Keys, T> {
        expected: &'static str,
        types: PhantomData<(Keys, T)>,
    }
    impl<'de, Keys, T> Visitor<'de> for MappingVisitor<Keys, T>
    where
        Keys: Deserialize<'de>,
        T: TryFrom<Keys, Error = String>,
    {
        type Value = T;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str(self.expected)
        }
        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
            let keys = Keys::deserialize(MapAccessDeserializer::new(map))?;
            T::try_from(keys).map_err(A::Error::custom)
        }
    }
    deserializer.deserialize_map(MappingVisitor { expected, types: PhantomData })
}
