//! Vectors of `f32`: one small trait, one back-end per instruction set, chosen at run time.

#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Avx512};

use std::ops::{Add, Mul, Sub};

/// Instruction set that a solver runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// x86-64 with AVX-512F: sixteen values at once.
    Avx512,
    /// x86-64 with AVX2 and FMA: eight values at once.
    Avx2,
    /// Any machine: four values at once, as far as the compiler sees them.
    Portable,
}

impl Backend {
    /// All back-ends, fastest first.
    pub const ALL: [Self; 3] = [Self::Avx512, Self::Avx2, Self::Portable];

    /// The fastest back-end that this machine has.
    pub fn detect() -> Self {
        Self::ALL.into_iter().find(|backend| backend.is_available()).unwrap_or(Self::Portable)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Portable => "portable",
        }
    }

    /// Whether this machine has the instructions.
    pub fn is_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx512 | Self::Avx2 => false,
            Self::Portable => true,
        }
    }
}

/// A vector of `f32`, one lane per cell or element.
///
/// Every implementation is `#[inline(always)]`, so that a kernel generic over it compiles into the
/// instructions of whichever `#[target_feature]` function it is inlined into; a closure in between would not
/// be.
///
/// # Safety of use
/// Values may only be made on a machine that has the back-end's instructions.
pub(crate) trait Simd:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// Values in a vector (–).
    const LANES: usize;

    /// # Safety
    /// `LANES` values can be read from `source`, on a machine with the back-end's instructions.
    unsafe fn load(source: *const f32) -> Self;

    /// Asks for the cache line of `address`, which need not be readable, ahead of its use. Advice only.
    fn prefetch(address: *const f32);

    /// # Safety
    /// `LANES` values can be written to `target`, on a machine with the back-end's instructions.
    unsafe fn store(self, target: *mut f32);

    /// The same value in all lanes.
    fn splat(value: f32) -> Self;

    /// `self · factor + addend`, rounded once where the machine can.
    fn mul_add(self, factor: Self, addend: Self) -> Self;

    /// `minuend − self · factor`, rounded once where the machine can.
    fn sub_from(self, factor: Self, minuend: Self) -> Self;

    /// Quotient, correctly rounded.
    fn divide(self, divisor: Self) -> Self;

    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// 1/√ of a positive number, to some units of the last place.
    fn inverse_sqrt(self) -> Self;

    /// 1/√ of a positive number, to four digits at the least.
    fn rough_inverse_sqrt(self) -> Self;

    /// The greater of two numbers.
    fn maximum(self, other: Self) -> Self;

    /// `negative` in lanes below zero, `other` in all others.
    fn where_negative(self, negative: Self, other: Self) -> Self;
}

/// Widest vector of any back-end (–).
pub(crate) const MAXIMUM_LANES: usize = 16;

/// Four lanes in plain Rust.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub(crate) struct Portable([f32; 4]);

/// One fused operation where that is a single instruction of the target, else two roundings.
#[inline(always)]
fn fused(a: f32, b: f32, c: f32) -> f32 {
    if cfg!(any(target_arch = "aarch64", target_feature = "fma")) {
        a.mul_add(b, c)
    } else {
        a * b + c
    }
}

impl Simd for Portable {
    const LANES: usize = 4;

    #[inline(always)]
    unsafe fn load(source: *const f32) -> Self {
        // SAFETY: the caller promises four readable values.
        Self(unsafe { source.cast::<[f32; 4]>().read_unaligned() })
    }

    #[inline(always)]
    fn prefetch(_: *const f32) {
        // Its arithmetic is slower than any memory.
    }

    #[inline(always)]
    unsafe fn store(self, target: *mut f32) {
        // SAFETY: the caller promises four writable values.
        unsafe { target.cast::<[f32; 4]>().write_unaligned(self.0) }
    }

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 4])
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let (a, b, c) = (self.0, factor.0, addend.0);
        Self([
            fused(a[0], b[0], c[0]),
            fused(a[1], b[1], c[1]),
            fused(a[2], b[2], c[2]),
            fused(a[3], b[3], c[3]),
        ])
    }

    #[inline(always)]
    fn sub_from(self, factor: Self, minuend: Self) -> Self {
        let (a, b, c) = (self.0, factor.0, minuend.0);
        Self([
            fused(-a[0], b[0], c[0]),
            fused(-a[1], b[1], c[1]),
            fused(-a[2], b[2], c[2]),
            fused(-a[3], b[3], c[3]),
        ])
    }

    #[inline(always)]
    fn divide(self, divisor: Self) -> Self {
        let (a, b) = (self.0, divisor.0);
        Self([a[0] / b[0], a[1] / b[1], a[2] / b[2], a[3] / b[3]])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let a = self.0;
        Self([a[0].sqrt(), a[1].sqrt(), a[2].sqrt(), a[3].sqrt()])
    }

    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        Self::splat(1.0).divide(self.sqrt())
    }

    #[inline(always)]
    fn rough_inverse_sqrt(self) -> Self {
        self.inverse_sqrt()
    }

    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0].max(b[0]), a[1].max(b[1]), a[2].max(b[2]), a[3].max(b[3])])
    }

    #[inline(always)]
    fn where_negative(self, negative: Self, other: Self) -> Self {
        let lane = |i: usize| if self.0[i] < 0.0 { negative.0[i] } else { other.0[i] };
        Self([lane(0), lane(1), lane(2), lane(3)])
    }
}

impl Add for Portable {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]])
    }
}

impl Sub for Portable {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]])
    }
}

impl Mul for Portable {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]])
    }
}
