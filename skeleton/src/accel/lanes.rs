//! SIMD with eight lanes.
//!
//! The traversal is generic over the trait [`Lanes`] and compiled twice: for AVX2, and with arrays for all other machines.
//! Each operation is one IEEE operation per lane, and operations are never fused, so both give the same bits.

use std::ops::{Add, Mul, Sub};

/// Eight numbers, one per lane.
pub(super) trait Lanes: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same number in every lane.
    fn splat(value: f32) -> Self;
    /// Eight numbers from memory.
    fn load(values: &Row) -> Self;
    /// Stores the numbers to memory.
    fn store(self) -> Row;
    /// Quotients.
    fn div(self, divisor: Self) -> Self;
    /// The minimum; `other` if one of them is NaN.
    fn min(self, other: Self) -> Self;
    /// The maximum; `other` if one of them is NaN.
    fn max(self, other: Self) -> Self;
    /// Absolute values.
    fn abs(self) -> Self;
    /// A mask of the lanes where `self <= other`, lane 0 in the lowest bit; false for NaN.
    fn le(self, other: Self) -> u32;
    /// A mask of the lanes where `self < other`, lane 0 in the lowest bit; false for NaN.
    fn lt(self, other: Self) -> u32;
    /// Prefetches an address, which need not be valid.
    fn fetch<T>(address: *const T);
    /// A mask of the indices equal to the given one, the first in the lowest bit.
    fn equal(indices: &Indices, index: u32) -> u32;
}

/// Clears the lowest bit of a mask and returns its lane.
#[inline(always)]
pub(super) fn take_lowest(bits: &mut u32) -> usize {
    let lane = bits.trailing_zeros() as usize;
    *bits &= *bits - 1;
    lane
}

/// Eight indices in memory.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Indices(pub(super) [u32; 8]);

/// Eight numbers in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Row(pub(super) [f32; 8]);

/// For all machines: an array.
#[derive(Clone, Copy)]
pub(super) struct Portable([f32; 8]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut result = self.0;
        for (a, b) in result.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        Self(result)
    }

    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        let mut bits = 0;
        for lane in 0..8 {
            bits |= u32::from(f(self.0[lane], other.0[lane])) << lane;
        }
        bits
    }
}

impl Add for Portable {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Portable {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Portable {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 8])
    }
    #[inline(always)]
    fn load(values: &Row) -> Self {
        Self(values.0)
    }
    #[inline(always)]
    fn store(self) -> Row {
        Row(self.0)
    }
    #[inline(always)]
    fn div(self, divisor: Self) -> Self {
        self.zip(divisor, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.compare(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn fetch<T>(_: *const T) {}
    #[inline(always)]
    fn equal(indices: &Indices, index: u32) -> u32 {
        (0..8).fold(0, |bits, lane| bits | u32::from(indices.0[lane] == index) << lane)
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx::Avx;

#[cfg(target_arch = "x86_64")]
mod avx {
    use std::arch::x86_64::*;
    use std::ops::{Add, Mul, Sub};

    use super::{Indices, Lanes, Row};

    /// For machines with AVX2: a register.
    ///
    /// May be constructed only after a check for AVX2. All code is inlined into functions compiled for AVX2, so that the
    /// intrinsics below become single instructions.
    #[derive(Clone, Copy)]
    pub(in crate::accel) struct Avx(__m256);

    /// Operators that map to one intrinsic.
    macro_rules! operators {
        ($($operator:ident :: $function:ident = $intrinsic:ident),*) => {$(
            impl $operator for Avx {
                type Output = Self;
                #[inline(always)]
                fn $function(self, other: Self) -> Self {
                    // SAFETY: an `Avx` exists, so the machine has AVX2.
                    Self(unsafe { $intrinsic(self.0, other.0) })
                }
            }
        )*};
    }

    operators!(Add::add = _mm256_add_ps, Sub::sub = _mm256_sub_ps, Mul::mul = _mm256_mul_ps);

    impl Lanes for Avx {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            // SAFETY: only called on machines with AVX2, see `Avx`.
            Self(unsafe { _mm256_set1_ps(value) })
        }
        #[inline(always)]
        fn load(values: &Row) -> Self {
            // SAFETY: only called on machines with AVX2, see `Avx`; a `Row` is 32 readable bytes, aligned to 32.
            Self(unsafe { _mm256_load_ps(values.0.as_ptr()) })
        }
        #[inline(always)]
        fn store(self) -> Row {
            let mut row = Row([0.0; 8]);
            // SAFETY: an `Avx` exists, so the machine has AVX2; a `Row` is 32 bytes, aligned to 32.
            unsafe { _mm256_store_ps(row.0.as_mut_ptr(), self.0) };
            row
        }
        #[inline(always)]
        fn div(self, divisor: Self) -> Self {
            // SAFETY: an `Avx` exists, so the machine has AVX2.
            Self(unsafe { _mm256_div_ps(self.0, divisor.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            // SAFETY: as above. The instruction returns its second operand if one is NaN.
            Self(unsafe { _mm256_min_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            // SAFETY: as above. The instruction returns its second operand if one is NaN.
            Self(unsafe { _mm256_max_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn abs(self) -> Self {
            // SAFETY: as above. Clears the sign bits.
            Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
        }
        #[inline(always)]
        fn le(self, other: Self) -> u32 {
            // SAFETY: as above.
            (unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) }) as u32
        }
        #[inline(always)]
        fn lt(self, other: Self) -> u32 {
            // SAFETY: as above.
            (unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) }) as u32
        }
        #[inline(always)]
        fn fetch<T>(address: *const T) {
            for line in 0..size_of::<T>() / 64 {
                // SAFETY: every machine with AVX2 supports it; it has no effect on memory, and invalid addresses do not fault.
                unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast::<i8>().wrapping_add(64 * line)) };
            }
        }
        #[inline(always)]
        fn equal(indices: &Indices, index: u32) -> u32 {
            // SAFETY: only called on machines with AVX2, see `Avx`; `Indices` are 32 readable bytes, aligned to 32.
            unsafe {
                let indices = _mm256_load_si256((&raw const indices.0).cast());
                let equal = _mm256_cmpeq_epi32(indices, _mm256_set1_epi32(index.cast_signed()));
                _mm256_movemask_ps(_mm256_castsi256_ps(equal)) as u32
            }
        }
    }
}
