//! The first flapwise mode of a blade, which delays and shares out what the air does to its root.
//!
//! Symbols: q deflection of the tip downwind, φ mode shape, s span from the root, r distance from the shaft, μ mass per
//! length, Ω rotor speed, M moment of the air on a blade that does not move, U its wind, g chord × r, which the force's
//! slope over the wind goes with.
//!
//! ```text
//! m q̈ + d q̇ + k q = a M               m = ∫ μ φ² ds,   a = ∫ g φ ds / ∫ g s ds,
//!                                       k = ∫ EI φ″² ds + Ω² ∫ φ′² ∫ₛ μ r ds′ ds,   d = ∂M/∂U ∫ g φ² ds / ∫ g s ds
//! root moment = M − ∂M/∂U b q̇ − i q̈ − Ω² c q
//!                                       b = ∫ g φ s ds / ∫ g s ds,   i = ∫ μ φ s ds,   c = ∫ μ r φ ds
//! ```

use serde::{Deserialize, Serialize};
use turbine::Definition;

/// Points of the integrals over a blade.
const N_POINTS: usize = 200;

/// Integrals of a blade.
#[derive(Clone, Debug)]
pub(super) struct Flap {
    mass: f64,
    stiffness: f64,
    /// Stiffness by rotation over the square of the rotor speed (kg).
    centrifugal: f64,
    /// a (1/m), d over ∂M/∂U (1/m), b (–).
    drive: f64,
    damping: f64,
    relief: f64,
    /// i, c (kg m).
    inertia: f64,
    tension: f64,
}

/// Tip of one blade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Tip {
    /// Deflection downwind (m), its rate (m/s) and acceleration (m/s²).
    deflection: f64,
    rate: f64,
    acceleration: f64,
}

impl Flap {
    pub(super) fn new(definition: &Definition) -> Self {
        let length = definition.blade_length();
        let mode = &definition.blade_structure.flap_modes[0];
        let width = length / N_POINTS as f64;
        let curvature = |x: f64| -> f64 {
            let terms = mode.coefficients.iter().enumerate();
            terms.map(|(k, c)| c * ((k + 2) * (k + 1)) as f64 * x.powi(k as i32)).sum::<f64>()
                / (length * length)
        };
        let slope = |x: f64| -> f64 {
            let terms = mode.coefficients.iter().enumerate();
            terms.map(|(k, c)| c * (k + 2) as f64 * x.powi(k as i32 + 1)).sum::<f64>() / length
        };
        let mut flap = Self {
            mass: 0.0,
            stiffness: 0.0,
            centrifugal: 0.0,
            drive: 0.0,
            damping: 0.0,
            relief: 0.0,
            inertia: 0.0,
            tension: 0.0,
        };
        let (mut lever, mut outside) = (0.0, 0.0);
        // From the tip inwards, so that the tension of what lies outside is at hand.
        for point in (0..N_POINTS).rev() {
            let share = (point as f64 + 0.5) / N_POINTS as f64;
            let span = share * length;
            let radius = definition.distance_from_shaft(definition.rotor.hub_radius + span, 0.0);
            let (shape, mass) = (mode.shape(share), width * mass_at(definition, span));
            let strength = width * chord_at(definition, span) * radius;
            outside += mass * radius;
            flap.mass += mass * shape * shape;
            flap.inertia += mass * shape * span;
            flap.tension += mass * shape * radius;
            flap.stiffness += width * stiffness_at(definition, span) * curvature(share).powi(2);
            flap.centrifugal += width * outside * slope(share).powi(2);
            flap.drive += strength * shape;
            flap.damping += strength * shape * shape;
            flap.relief += strength * shape * span;
            lever += strength * span;
        }
        flap.drive /= lever;
        flap.damping /= lever;
        flap.relief /= lever;
        flap
    }

    /// The tip where the air has always made `moment` (N m).
    pub(super) fn settled(&self, rotor_speed: f64, moment: f64) -> Tip {
        Tip { deflection: self.drive * moment / self.held(rotor_speed), ..Tip::default() }
    }

    /// Moves `tip` on by `interval` (s) to the instant at which the air makes `moment` (N m) on a still blade, growing with
    /// the wind by `slope` (N m/(m/s)); gives the moment at the root (N m). Average acceleration: any interval will do.
    pub(super) fn advance(
        &self,
        interval: f64,
        rotor_speed: f64,
        moment: f64,
        slope: f64,
        tip: &mut Tip,
    ) -> f64 {
        let (stiffness, damping) = (self.held(rotor_speed), self.damping * slope.max(0.0));
        let half = 0.5 * interval;
        let rate = tip.rate + half * tip.acceleration;
        let deflection = tip.deflection + interval * tip.rate + half * half * tip.acceleration;
        let free = self.drive * moment - damping * rate - stiffness * deflection;
        tip.acceleration = free / (self.mass + half * damping + half * half * stiffness);
        tip.rate = rate + half * tip.acceleration;
        tip.deflection = deflection + half * half * tip.acceleration;
        moment
            - slope * self.relief * tip.rate
            - self.inertia * tip.acceleration
            - rotor_speed * rotor_speed * self.tension * tip.deflection
    }

    /// Share of the air's moment that reaches the root when it lasts (–).
    pub(super) fn lasting_share(&self, rotor_speed: f64) -> f64 {
        1.0 - rotor_speed * rotor_speed * self.tension * self.drive / self.held(rotor_speed)
    }

    fn held(&self, rotor_speed: f64) -> f64 {
        self.stiffness + rotor_speed * rotor_speed * self.centrifugal
    }
}

/// Straight line through `rows` of span (m) and value at `span`.
fn between(rows: impl Iterator<Item = (f64, f64)>, span: f64) -> f64 {
    let mut before: Option<(f64, f64)> = None;
    for (place, value) in rows {
        match before {
            Some((from, start)) if span <= place => {
                let share = ((span - from) / (place - from)).clamp(0.0, 1.0);
                return start + share * (value - start);
            }
            _ => before = Some((place, value)),
        }
    }
    before.map_or(0.0, |(_, value)| value)
}

fn mass_at(definition: &Definition, span: f64) -> f64 {
    between(definition.blade_structure.sections.iter().map(|row| (row.span, row.mass)), span)
}

fn stiffness_at(definition: &Definition, span: f64) -> f64 {
    let sections = definition.blade_structure.sections.iter();
    between(sections.map(|row| (row.span, row.flap_stiffness)), span)
}

fn chord_at(definition: &Definition, span: f64) -> f64 {
    between(definition.blade.iter().map(|row| (row.span, row.chord)), span)
}
