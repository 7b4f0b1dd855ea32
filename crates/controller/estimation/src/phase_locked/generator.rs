//! Quadrature signal generators: a slow oscillation and the same a quarter period later, without its offset.
//!
//! All are linear with every integrator running at the centre rate ω, so that a state x of an input u obeys
//!
//! ```text
//! ẋ = ω (A x + b u)        A, b constant and without dimension
//! second:    ẋ₁ = ω (k (u − x₁) − x₂)           ẋ₂ = ω x₁
//! extended:  ẋ₁ = ω (k (u − x₁ − x₃) − x₂)      ẋ₂ = ω x₁      ẋ₃ = ω κ (u − x₁ − x₃)
//! mixed:     ẋ₁ = ω (k (u − x₁) − x₂)           ẋ₂ = ω x₁      ẋ₃ = ω (k (u − x₁) − x₃)
//! ```
//!
//! with damping k and, in the extended one, dc gain κ. The in-phase signal is x₁; the quadrature signal, a
//! quarter period behind, is x₂, in the mixed one x₂ − x₃; the offset is x₃, in the mixed one x₃/k.
//! Source: van Veldhoven, "Closed-Loop Wake Meandering Control of Downstream Wind Turbines", TU Delft 2024,
//! Eqs. A-1, A-9.
//!
//! # Discretisation
//!
//! By the trapezoidal rule with 2 tan(φ/2) in place of φ = ω × interval. Three things follow. A sine at the
//! centre passes with gain one and without delay *exactly*, whatever the interval, and while the centre moves
//! too: what is left of the equations in lock is a rotation, and its Cayley transform with tan(φ/2) turns by
//! φ. The gains for a constant are exact as well. And however the centre moves, the filter stays stable: each
//! step multiplies the state by a rational function of the one matrix A, these functions commute, and each
//! maps the left half plane into the unit disk. (The exponential of φ A has the last property, not the first
//! two: with the input interpolated linearly its gain at the centre is φ²/12 short.)

use super::PhaseLockedError;
use serde::{Deserialize, Serialize};

/// Magnitude (any unit) from which a sample is unusable: beyond, squares overflow.
const TOO_LARGE: f64 = 1e150;

/// Whether `sample` (any unit) is a usable number.
pub(super) fn is_usable(sample: f64) -> bool {
    sample.abs() < TOO_LARGE
}

/// Structure of the generator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum GeneratorKind {
    /// Second-order generalised integrator (SOGI): does not estimate the offset, which disturbs its
    /// quadrature signal.
    Second,
    /// Extended by a third integrator that removes the offset from the input (ESOGI).
    Extended {
        /// Gain of the offset's integrator (–), see [`dc_gain`].
        dc_gain: f64,
    },
    /// Mixed second- and third-order (MSTOGI): a third-order branch removes the offset from the quadrature
    /// signal.
    Mixed,
}

impl GeneratorKind {
    /// The extended generator whose real pole decays `pole_ratio` (–) times as fast as its pair, see
    /// [`dc_gain`].
    ///
    /// # Errors
    /// Those of [`dc_gain`].
    pub fn extended(damping: f64, pole_ratio: f64) -> Result<Self, PhaseLockedError> {
        Ok(Self::Extended { dc_gain: dc_gain(damping, pole_ratio)? })
    }

    /// Lag of a slow change of phase, times the centre rate (rad).
    ///
    /// Group delay of the two signals at the centre, averaged: 2/k of all, and half a radian more where the
    /// quadrature signal passes an all-pass. It is the time constant τ of Eqs. 2-25 and 2-30.
    pub fn lag(self, damping: f64) -> f64 {
        2.0 / damping + if self == Self::Mixed { 0.5 } else { 0.0 }
    }
}

/// Gain κ (–) of the extended generator's offset that puts its real pole at −m α beside the pair −α ± jβ.
///
/// `damping` is k (–), `pole_ratio` is m (–): with 1 offset and oscillation settle alike, with less the
/// offset is slower. Source: van Veldhoven (2024), Eqs. 2-12 to 2-14: the positive root of
/// κ³ + 3 k κ² + (3 k² + ((m+2)/m)²) κ + k³ − (m+2)² k / (2 m) = 0, which rises with κ and so has one at
/// most.
///
/// # Errors
/// [`PhaseLockedError::Damping`] when k is not positive or too strong for a positive root, k² ≥ (m+2)²/(2 m);
/// [`PhaseLockedError::PoleRatio`] when m is not positive.
///
/// ```
/// // k = √2 and m = 1: all three poles decay alike
/// let gain = estimation::phase_locked::dc_gain(2.0_f64.sqrt(), 1.0)?;
/// assert!((gain - 0.221_15).abs() < 1e-5);
/// # Ok::<(), estimation::phase_locked::PhaseLockedError>(())
/// ```
pub fn dc_gain(damping: f64, pole_ratio: f64) -> Result<f64, PhaseLockedError> {
    if !(pole_ratio > 0.0 && pole_ratio.is_finite()) {
        return Err(PhaseLockedError::PoleRatio { pole_ratio });
    }
    let (k, m) = (damping, pole_ratio);
    let most = (m + 2.0) / (2.0 * m).sqrt();
    if !(k > 0.0 && k < most) {
        return Err(PhaseLockedError::Damping { damping, most });
    }
    let linear = 3.0 * k * k + ((m + 2.0) / m).powi(2);
    let constant = k.powi(3) - (m + 2.0).powi(2) * k / (2.0 * m);
    // Convex and rising: Newton's method from above the root comes down to it. It starts where the line alone
    // is zero.
    let mut gain = -constant / linear;
    for _ in 0..50 {
        let value = ((gain + 3.0 * k) * gain + linear) * gain + constant;
        let slope = (3.0 * gain + 6.0 * k) * gain + linear;
        gain -= value / slope;
    }
    Ok(gain)
}

/// A generator with its state; serialises whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Generator {
    kind: GeneratorKind,
    damping: f64,
    /// x₁, x₂, x₃ in the unit of the samples.
    state: [f64; 3],
    /// Previous sample; none before the first.
    last: Option<f64>,
}

impl Generator {
    /// A generator of `kind` with `damping` k (–), before the first sample.
    ///
    /// # Errors
    /// [`PhaseLockedError::Damping`] unless 0 < k < 2, beyond which a real pole slows it down;
    /// [`PhaseLockedError::DcGain`] unless that is positive.
    pub fn new(kind: GeneratorKind, damping: f64) -> Result<Self, PhaseLockedError> {
        if !(damping > 0.0 && damping < 2.0) {
            return Err(PhaseLockedError::Damping { damping, most: 2.0 });
        }
        if let GeneratorKind::Extended { dc_gain } = kind
            && !(dc_gain > 0.0 && dc_gain.is_finite())
        {
            return Err(PhaseLockedError::DcGain { dc_gain });
        }
        Ok(Self { kind, damping, state: [0.0; 3], last: None })
    }

    /// Takes in `sample` (any unit), the centre having turned by `turned` (rad, below π) since the sample
    /// before.
    ///
    /// The first sample is taken as the offset, so that a large one causes no transient. An unusable sample
    /// is replaced by the expected one: the generator turns on undisturbed, and the result is false.
    pub fn update(&mut self, turned: f64, sample: f64) -> bool {
        if !is_usable(sample) {
            self.coast(turned);
            return false;
        }
        let Some(last) = self.last.replace(sample) else {
            self.state = self.settled_on(sample);
            return true;
        };
        let [x1, x2, x3] = self.state;
        let (k, a, input) = (self.damping, (0.5 * turned).tan(), last + sample);
        self.state = match self.kind {
            GeneratorKind::Second | GeneratorKind::Mixed => {
                let new =
                    (x1 * (1.0 - a * (k + a)) + a * (k * input - 2.0 * x2)) / (1.0 + a * (k + a));
                let both = x1 + new;
                let third = if self.kind == GeneratorKind::Mixed {
                    (x3 * (1.0 - a) + a * k * (input - both)) / (1.0 + a)
                } else {
                    0.0
                };
                [new, x2 + a * both, third]
            }
            GeneratorKind::Extended { dc_gain } => {
                // Sums over the step's two ends: of x₁, then of the error u − x₁ − x₃.
                let loose = a * k / (1.0 + a * dc_gain);
                let both =
                    (2.0 * (x1 - a * x2) + loose * (input - 2.0 * x3)) / (1.0 + a * a + loose);
                let error = (input - both - 2.0 * x3) / (1.0 + a * dc_gain);
                [both - x1, x2 + a * both, x3 + a * dc_gain * error]
            }
        };
        true
    }

    /// Turns on by `turned` (rad) as if the sample had been the expected one.
    pub fn coast(&mut self, turned: f64) {
        let (sine, cosine) = turned.sin_cos();
        let [x1, x2, x3] = self.state;
        // The mixed generator's x₂ swings about k times the offset, which x₃ holds.
        let middle = if self.kind == GeneratorKind::Mixed { x3 } else { 0.0 };
        let swing = x2 - middle;
        self.state = [cosine * x1 - sine * swing, middle + sine * x1 + cosine * swing, x3];
        if self.last.is_some() {
            self.last = Some(self.state[0] + self.offset());
        }
    }

    /// The oscillation A sin θ without its offset (unit of the samples).
    pub fn in_phase(&self) -> f64 {
        self.state[0]
    }

    /// The same a quarter period later, −A cos θ (unit of the samples).
    pub fn quadrature(&self) -> f64 {
        match self.kind {
            GeneratorKind::Second | GeneratorKind::Extended { .. } => self.state[1],
            GeneratorKind::Mixed => self.state[1] - self.state[2],
        }
    }

    /// Offset b (unit of the samples); zero from the second-order generator, which does not estimate it.
    pub fn offset(&self) -> f64 {
        match self.kind {
            GeneratorKind::Second => 0.0,
            GeneratorKind::Extended { .. } => self.state[2],
            GeneratorKind::Mixed => self.state[2] / self.damping,
        }
    }

    /// Amplitude A (unit of the samples). van Veldhoven (2024), Eq. 2-37.
    pub fn amplitude(&self) -> f64 {
        self.in_phase().hypot(self.quadrature())
    }

    /// Residual: the last sample without oscillation and offset (unit of the samples).
    pub fn residual(&self) -> f64 {
        self.last.map_or(0.0, |last| last - self.in_phase() - self.offset())
    }

    fn settled_on(&self, constant: f64) -> [f64; 3] {
        match self.kind {
            GeneratorKind::Second => [0.0; 3],
            GeneratorKind::Extended { .. } => [0.0, 0.0, constant],
            GeneratorKind::Mixed => [0.0, self.damping * constant, self.damping * constant],
        }
    }
}
