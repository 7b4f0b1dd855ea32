//! Blade-element momentum theory in one annulus: the inflow angle at which blade force and change of momentum
//! balance.
//!
//! Source: Ning, "A simple solution method for the blade element momentum equations with guaranteed
//! convergence", Wind Energy 17, 2014: one residual in the inflow angle φ, bracketed, never diverging.
//! Tip and hub loss after Prandtl; heavily loaded discs after Buhl, NREL/TP-500-36834, 2005.

mod warm_start;

use super::SectionCoefficients;
use std::f64::consts::{FRAC_PI_2, PI};
pub use warm_start::{Factors, WarmStart, solve_near};

/// Smallest inflow angle of the search (rad): there the drag of any section that has some outweighs the
/// momentum.
const SMALLEST_ANGLE: f64 = 1e-15;
/// Tolerance of the inflow angle (rad).
const ANGLE_TOLERANCE: f64 = 1e-13;
/// Bisection alone needs 44 halvings from a right angle to the tolerance; Brent's method falls back on it.
const MAXIMUM_ITERATIONS: usize = 200;
/// Least share of either wind in the relative wind (–); induction factors need both.
const LEAST_SHARE: f64 = 1e-9;

/// Exponent of Prandtl's formula (–) from which the loss is less than the rounding of one.
const NO_LOSS: f64 = 38.0;

/// Which parts of the theory are active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theory {
    /// Prandtl's tip loss.
    pub tip_loss: bool,
    /// Prandtl's loss at the hub.
    pub hub_loss: bool,
    /// Drag contributes to the induction, axial and tangential; it acts on the blade in any case.
    pub drag_in_induction: bool,
}

impl Default for Theory {
    fn default() -> Self {
        Self { tip_loss: true, hub_loss: true, drag_in_induction: true }
    }
}

/// A ring of air and the blade sections in it; radii are distances from the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Annulus {
    /// Blades (–).
    pub n_blades: usize,
    /// Radius of the ring (m).
    pub radius: f64,
    /// Radius at which blades begin (m).
    pub hub_radius: f64,
    /// Radius at which blades end (m).
    pub tip_radius: f64,
    /// Chord (m).
    pub chord: f64,
    /// Twist plus pitch, positive to feather (rad).
    pub section_pitch: f64,
    /// Local cone angle (rad) in the momentum balance: angle of the blade's line out of the plane across the
    /// shaft.
    ///
    /// It enters by its squared cosine: one cosine for the component of the blade force along the shaft, one
    /// for the component of the induced velocity normal to the blade. Zero balances momentum normal to the
    /// blade instead, as most programs do.
    pub cone_angle: f64,
}

impl Annulus {
    /// Share of a coned blade's normal force that enters the momentum balance (–).
    pub(super) fn momentum_share(&self) -> f64 {
        if self.cone_angle == 0.0 { 1.0 } else { self.cone_angle.cos().powi(2) }
    }
}

/// Inflow that satisfies blade-element momentum theory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inflow {
    /// Angle of the relative wind to the plane of rotation φ (rad).
    pub inflow_angle: f64,
    /// Angle of attack α (rad).
    pub angle_of_attack: f64,
    /// Axial induction factor at the blade a (–): axial wind × (1 − a) passes it.
    pub axial_induction: f64,
    /// Tangential induction factor at the blade a′ (–): tangential wind × (1 + a′) passes it.
    pub tangential_induction: f64,
    /// Prandtl's loss factor F (–).
    pub loss_factor: f64,
    /// Relative wind at the blade (m/s).
    pub relative_speed: f64,
    /// Section coefficients there.
    pub section: SectionCoefficients,
    /// Force coefficient across the plane of rotation, downwind, on relative speed and chord (–).
    pub normal_coefficient: f64,
    /// Force coefficient along the rotation, on relative speed and chord (–).
    pub tangential_coefficient: f64,
}

impl Inflow {
    /// Force per metre of blade (N/m) in air of `air_density` (kg/m³) on `chord` (m): downwind, and along the
    /// rotation.
    pub fn forces(&self, air_density: f64, chord: f64) -> [f64; 2] {
        let scale = 0.5 * air_density * self.relative_speed * self.relative_speed * chord;
        [scale * self.normal_coefficient, scale * self.tangential_coefficient]
    }
}

/// Inflow of one annulus in `axial` wind (m/s, downwind) and `tangential` wind (m/s, against the
/// rotation, ωr of a turning blade), both without induction; `section` gives coefficients at an angle of
/// attack (rad).
///
/// Always returns a state in which the residual vanishes, for any sign of either wind, as long as the
/// section has some drag: then the residual runs from −∞ at φ → 0 to ∞ at φ → 180°. Where momentum theory
/// has no solution (κ ≤ −1) it takes the sign of its own limit at that border: negative below 90°, positive
/// above; so a change of sign from negative to positive is always a solution.
/// Without drag in the induction a state with reversed flow through the disc may be returned instead.
pub fn solve(
    annulus: &Annulus,
    axial: f64,
    tangential: f64,
    section: impl Fn(f64) -> SectionCoefficients,
    theory: Theory,
) -> Inflow {
    match Ring::new(annulus, axial, tangential, section, theory) {
        Some(ring) => ring.inflow(ring.root()),
        None => Inflow { loss_factor: 1.0, ..Inflow::default() },
    }
}

/// Prandtl's loss factor (–) where the relative wind meets the plane of rotation at an angle of that `sine`
/// (–, positive).
pub fn loss_factor(annulus: &Annulus, theory: Theory, sine: f64) -> f64 {
    let Annulus { radius, hub_radius, tip_radius, .. } = *annulus;
    let half_blades = 0.5 * annulus.n_blades as f64;
    let prandtl = |exponent: f64| {
        if exponent > NO_LOSS { 1.0 } else { 2.0 / PI * (-exponent).exp().min(1.0).acos() }
    };
    let mut loss = 1.0;
    if theory.tip_loss {
        loss *= prandtl(half_blades * (tip_radius - radius) / (radius * sine));
    }
    if theory.hub_loss {
        loss *= prandtl(half_blades * (radius - hub_radius) / (hub_radius * sine));
    }
    // Exactly at tip or hub no finite load is possible; a small number keeps the division defined.
    loss.max(1e-9)
}

struct Ring<'a, Section> {
    annulus: &'a Annulus,
    axial: f64,
    tangential: f64,
    section: Section,
    theory: Theory,
}

/// One trial of the inflow angle.
struct Trial {
    residual: f64,
    /// Sine and cosine of the angle.
    direction: (f64, f64),
    axial_induction: f64,
    tangential_induction: f64,
    loss_factor: f64,
    section: SectionCoefficients,
}

impl<'a, Section: Fn(f64) -> SectionCoefficients> Ring<'a, Section> {
    /// None where there is no wind at all.
    fn new(
        annulus: &'a Annulus,
        axial: f64,
        tangential: f64,
        section: Section,
        theory: Theory,
    ) -> Option<Self> {
        let speed = (axial * axial + tangential * tangential).sqrt();
        let at_least = |wind: f64| wind.abs().max(LEAST_SHARE * speed).copysign(wind);
        let (axial, tangential) = (at_least(axial), at_least(tangential));
        (speed != 0.0).then_some(Self { annulus, axial, tangential, section, theory })
    }

    /// Inflow angle (rad) at which the residual vanishes, in the frame in which both winds are positive.
    fn root(&self) -> f64 {
        let residual = |angle: f64| self.state(angle).residual;
        let low = residual(SMALLEST_ANGLE);
        if low < 0.0 {
            let middle = residual(FRAC_PI_2);
            if middle >= 0.0 {
                bracketed_root(residual, SMALLEST_ANGLE, low, FRAC_PI_2, middle)
            } else {
                // Propeller state: the swirl is faster than the blades.
                let highest = PI - SMALLEST_ANGLE;
                bracketed_root(residual, FRAC_PI_2, middle, highest, residual(highest))
            }
        } else {
            // Only without drag: the disc may be loaded beyond what passes it, then the flow turns back.
            reversed_angle(residual).unwrap_or(SMALLEST_ANGLE)
        }
    }

    /// Inflow angle (rad) in the true frame, of one in the frame in which both winds are positive.
    fn true_angle(&self, angle: f64) -> f64 {
        if self.axial > 0.0 && self.tangential > 0.0 {
            return angle;
        }
        let (sine, cosine) = angle.sin_cos();
        (sine * self.axial.signum()).atan2(cosine * self.tangential.signum())
    }

    fn state(&self, angle: f64) -> Trial {
        // Symbols of Ning 2014: phi inflow angle, sigma local solidity, F loss factor, cn and ct force
        // coefficients, k and kp the two loadings κ and κ′, a and ap the two induction factors.
        // A wind of the other sign is the mirror image: lift changes its sign, drag does not.
        let mirror = self.axial.signum() * self.tangential.signum();
        let coefficients = (self.section)(self.true_angle(angle) - self.annulus.section_pitch);
        let cl = mirror * coefficients.lift;
        let cd = if self.theory.drag_in_induction { coefficients.drag } else { 0.0 };
        let (sphi, cphi) = angle.sin_cos();
        let cn = cl * cphi + cd * sphi;
        let ct = cl * sphi - cd * cphi;
        let loss = loss_factor(self.annulus, self.theory, sphi.abs());
        let sigma =
            self.annulus.n_blades as f64 * self.annulus.chord / (2.0 * PI * self.annulus.radius);
        let k = sigma * cn * self.annulus.momentum_share() / (4.0 * loss * sphi * sphi);
        // Times cos φ, so that it stays finite at a right angle.
        let kp_cphi = sigma * ct / (4.0 * loss * sphi);
        let ratio = (self.axial / self.tangential).abs();
        let (a, momentum) = if angle > 0.0 {
            let a = axial_induction(k, loss);
            (a, if k > -1.0 { sphi / (1.0 - a) } else { f64::NEG_INFINITY })
        } else {
            // Flow through the disc from behind: κ > 1.
            (if k > 1.0 { k / (k - 1.0) } else { 0.0 }, sphi * (1.0 - k))
        };
        let residual = momentum - ratio * (cphi - kp_cphi);
        let kp = kp_cphi / cphi;
        Trial {
            residual: if residual.is_finite() { residual } else { -cphi },
            direction: (sphi, cphi),
            axial_induction: a,
            tangential_induction: kp / (1.0 - kp),
            loss_factor: loss,
            section: coefficients,
        }
    }

    fn inflow(&self, angle: f64) -> Inflow {
        let trial = self.state(angle);
        let inflow_angle = self.true_angle(angle);
        let (sine, cosine) = inflow_angle.sin_cos();
        let Trial { axial_induction, tangential_induction, loss_factor, section, .. } = trial;
        Inflow {
            inflow_angle,
            angle_of_attack: inflow_angle - self.annulus.section_pitch,
            axial_induction,
            tangential_induction,
            loss_factor,
            relative_speed: (self.axial * (1.0 - axial_induction))
                .hypot(self.tangential * (1.0 + tangential_induction)),
            section,
            normal_coefficient: section.lift * cosine + section.drag * sine,
            tangential_coefficient: section.lift * sine - section.drag * cosine,
        }
    }
}

/// Axial induction (–) from the loading κ = a/(1 − a) of momentum theory; above a = 0.4 from Buhl's parabola,
/// which meets it smoothly.
pub(super) fn axial_induction(k: f64, loss: f64) -> f64 {
    if k <= 2.0 / 3.0 {
        return k / (1.0 + k);
    }
    let g1 = 2.0 * loss * k - (10.0 / 9.0 - loss);
    let g2 = 2.0 * loss * k - loss * (4.0 / 3.0 - loss);
    let g3 = 2.0 * loss * k - (25.0 / 9.0 - 2.0 * loss);
    if g3.abs() < 1e-6 { 1.0 - 0.5 / g2.sqrt() } else { (g1 - g2.sqrt()) / g3 }
}

/// Inflow angle (rad) below zero or beyond a right angle at which `residual` vanishes.
fn reversed_angle(residual: impl Fn(f64) -> f64) -> Option<f64> {
    let brackets = [(-FRAC_PI_2, -SMALLEST_ANGLE), (FRAC_PI_2, PI - SMALLEST_ANGLE)];
    brackets.into_iter().find_map(|(low, high)| {
        let (at_low, at_high) = (residual(low), residual(high));
        (at_low * at_high <= 0.0).then(|| bracketed_root(&residual, low, at_low, high, at_high))
    })
}

/// Root of `function` between `a` and `b`, where its values `fa` and `fb` differ in sign: Brent's method.
///
/// Source: Brent, "Algorithms for minimization without derivatives", 1973, ch. 4.
fn bracketed_root(
    function: impl Fn(f64) -> f64,
    mut a: f64,
    mut fa: f64,
    mut b: f64,
    mut fb: f64,
) -> f64 {
    let (mut c, mut fc) = (a, fa);
    let (mut step, mut last_step) = (b - a, b - a);
    for _ in 0..MAXIMUM_ITERATIONS {
        if (fb > 0.0) == (fc > 0.0) {
            (c, fc) = (a, fa);
            step = b - a;
            last_step = step;
        }
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let tolerance = 2.0 * f64::EPSILON * b.abs() + 0.5 * ANGLE_TOLERANCE;
        let half = 0.5 * (c - b);
        if half.abs() <= tolerance || fb == 0.0 {
            break;
        }
        if last_step.abs() >= tolerance && fa.abs() > fb.abs() {
            let s = fb / fa;
            let (mut p, mut q) = if a == c {
                (2.0 * half * s, 1.0 - s)
            } else {
                let (q, r) = (fa / fc, fb / fc);
                (
                    s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)),
                    (q - 1.0) * (r - 1.0) * (s - 1.0),
                )
            };
            if p > 0.0 {
                q = -q;
            }
            p = p.abs();
            if 2.0 * p < (3.0 * half * q - (tolerance * q).abs()).min((last_step * q).abs()) {
                last_step = step;
                step = p / q;
            } else {
                step = half;
                last_step = half;
            }
        } else {
            step = half;
            last_step = half;
        }
        (a, fa) = (b, fb);
        b += if step.abs() > tolerance { step } else { tolerance.copysign(half) };
        fb = function(b);
    }
    b
}

#[cfg(test)]
mod tests;
