//! AVX-512 and AVX2 vectors. Made only inside functions that a run-time check of the machine guards.

use super::Simd;
use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

/// # Safety
/// On a machine with AVX-512F.
#[inline(always)]
unsafe fn select512(sign: __m512, negative: __m512, other: __m512) -> __m512 {
    // SAFETY: the caller promises the instructions.
    unsafe {
        let mask = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(sign, _mm512_setzero_ps());
        _mm512_mask_blend_ps(mask, other, negative)
    }
}

/// # Safety
/// On a machine with AVX.
#[inline(always)]
unsafe fn select256(sign: __m256, negative: __m256, other: __m256) -> __m256 {
    // SAFETY: the caller promises the instructions.
    unsafe {
        let mask = _mm256_cmp_ps::<_CMP_LT_OQ>(sign, _mm256_setzero_ps());
        _mm256_blendv_ps(other, negative, mask)
    }
}

/// 1/√`value`: one of Newton's steps from fourteen bits.
///
/// # Safety
/// On a machine with AVX-512F.
#[inline(always)]
unsafe fn inverse_sqrt512(value: __m512) -> __m512 {
    // SAFETY: the caller promises the instructions.
    unsafe {
        let half = _mm512_set1_ps(0.5);
        let guess = _mm512_rsqrt14_ps(value);
        let product = _mm512_mul_ps(half, _mm512_mul_ps(value, guess));
        _mm512_fmadd_ps(guess, _mm512_fnmadd_ps(product, guess, half), guess)
    }
}

/// 1/√`value`: guesses of AVX differ from machine to machine, so it is worked out.
///
/// # Safety
/// On a machine with AVX.
#[inline(always)]
unsafe fn inverse_sqrt256(value: __m256) -> __m256 {
    // SAFETY: the caller promises the instructions.
    unsafe { _mm256_div_ps(_mm256_set1_ps(1.0), _mm256_sqrt_ps(value)) }
}

macro_rules! vector {
    ($(#[$doc:meta])* $name:ident, $register:ty, $lanes:expr, $load:ident, $store:ident, $splat:ident,
     $add:ident,
     $sub:ident, $mul:ident, $fmadd:ident, $fnmadd:ident, $div:ident, $sqrt:ident, $max:ident,
     $select:expr, $inverse_sqrt:expr, $rough:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub(crate) struct $name($register);

        impl Simd for $name {
            const LANES: usize = $lanes;

            #[inline(always)]
            unsafe fn load(source: *const f32) -> Self {
                // SAFETY: the caller promises readable values and the instructions.
                Self(unsafe { $load(source) })
            }

            #[inline(always)]
            fn prefetch(address: *const f32) {
                // SAFETY: reads nothing, whatever the address.
                unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
            }

            #[inline(always)]
            unsafe fn store(self, target: *mut f32) {
                // SAFETY: the caller promises writable values and the instructions.
                unsafe { $store(target, self.0) }
            }

            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: vectors are made only where the instructions were found.
                Self(unsafe { $splat(value) })
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                // SAFETY: as above; the operands exist.
                Self(unsafe { $fmadd(self.0, factor.0, addend.0) })
            }

            #[inline(always)]
            fn sub_from(self, factor: Self, minuend: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $fnmadd(self.0, factor.0, minuend.0) })
            }

            #[inline(always)]
            fn divide(self, divisor: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $div(self.0, divisor.0) })
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $sqrt(self.0) })
            }

            #[inline(always)]
            fn inverse_sqrt(self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $inverse_sqrt(self.0) })
            }

            #[inline(always)]
            fn rough_inverse_sqrt(self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $rough(self.0) })
            }

            #[inline(always)]
            fn maximum(self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $max(self.0, other.0) })
            }

            #[inline(always)]
            fn where_negative(self, negative: Self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $select(self.0, negative.0, other.0) })
            }
        }

        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $add(self.0, other.0) })
            }
        }

        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $sub(self.0, other.0) })
            }
        }

        impl Mul for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $mul(self.0, other.0) })
            }
        }
    };
}

vector!(
    /// Sixteen lanes.
    Avx512, __m512, 16, _mm512_loadu_ps, _mm512_storeu_ps, _mm512_set1_ps, _mm512_add_ps, _mm512_sub_ps,
    _mm512_mul_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps, _mm512_div_ps, _mm512_sqrt_ps, _mm512_max_ps,
    select512, inverse_sqrt512, _mm512_rsqrt14_ps
);
vector!(
    /// Eight lanes.
    Avx2, __m256, 8, _mm256_loadu_ps, _mm256_storeu_ps, _mm256_set1_ps, _mm256_add_ps, _mm256_sub_ps,
    _mm256_mul_ps, _mm256_fmadd_ps, _mm256_fnmadd_ps, _mm256_div_ps, _mm256_sqrt_ps, _mm256_max_ps,
    select256, inverse_sqrt256, inverse_sqrt256
);
