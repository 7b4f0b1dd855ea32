//! The first flapwise mode of a blade, which delays the effect of aerodynamic loads on its root.
//!
//! Symbols: q deflection of the tip downwind, φ mode shape, s span from the root, r distance from the shaft,
//! μ mass per length, Ω rotor speed, M aerodynamic moment on a rigid blade, U its wind, g chord × r, to which
//! the derivative of the force by the wind is proportional, ω rate of the excitation in the blade.
//!
//! ```text
//! m q̈ + d q̇ + k q = a M               m = ∫ μ φ² ds,   a = ∫ g φ ds / ∫ g s ds,
//!                         k = ∫ EI φ″² ds + Ω² ∫ φ′² ∫ₛ μ r ds′ ds,   d = ∂M/∂U ∫ g φ² ds / ∫ g s ds
//! root moment = M − ∂M/∂U b q̇ − i q̈ − Ω² c q
//!                                       b = ∫ g φ s ds / ∫ g s ds,   i = ∫ μ φ s ds,   c = ∫ μ r φ ds
//! ```
//!
//! Tilt and yaw excite the blade at the sum of the rotor's and the helix's rate; the response at that rate is
//! a gain and a lag, which rotate tilt and yaw into each other. The steady-state response is used, so that
//! noise in the estimate does not excite the model's blades.

use basis::PerBlade;
use basis::mbc::{blade_azimuth, to_fixed_frame};
use turbine::Definition;

/// Points of the integrals over a blade (–).
const N_POINTS: usize = 200;

/// Integrals of a blade.
#[derive(Clone, Debug)]
pub(super) struct Flap {
    mass: f64,
    stiffness: f64,
    /// Centrifugal stiffness over the square of the rotor speed (kg).
    centrifugal: f64,
    /// a (1/m), d over ∂M/∂U (1/m), b (–).
    drive: f64,
    damping: f64,
    relief: f64,
    /// i, c (kg m).
    inertia: f64,
    tension: f64,
}

/// Effect of blade bending on root moments: a gain of the average, a complex gain of tilt and yaw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    azimuth: f64,
    average: f64,
    /// Gain and lead of tilt − i yaw: real and imaginary part.
    swing: [f64; 2],
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

    /// Effect of bending on moments that oscillate at `rate` (rad/s) in the blade, with blade 1 at `azimuth`
    /// (rad); their derivative by the wind is `slope` (N m/(m/s)).
    pub(super) fn bend(&self, rate: f64, rotor_speed: f64, azimuth: f64, slope: f64) -> Bend {
        let (held, square) = (self.held(rotor_speed), rotor_speed * rotor_speed);
        let slope = slope.max(0.0);
        // Deflection per moment is drive over this; with what it takes from the root on top.
        let below = [held - rate * rate * self.mass, rate * self.damping * slope];
        let above =
            [rate * rate * self.inertia - square * self.tension, -rate * self.relief * slope];
        let scale = self.drive / (below[0] * below[0] + below[1] * below[1]);
        Bend {
            azimuth,
            average: 1.0 - square * self.tension * self.drive / held,
            swing: [
                1.0 + scale * (above[0] * below[0] + above[1] * below[1]),
                scale * (above[1] * below[0] - above[0] * below[1]),
            ],
        }
    }

    fn held(&self, rotor_speed: f64) -> f64 {
        self.stiffness + rotor_speed * rotor_speed * self.centrifugal
    }
}

impl Bend {
    /// Rigid blades.
    pub(super) fn none(azimuth: f64) -> Self {
        Self { azimuth, average: 1.0, swing: [1.0, 0.0] }
    }

    /// Root moments from the `moments` on rigid blades.
    pub(super) fn apply(&self, moments: &PerBlade<f64>) -> PerBlade<f64> {
        self.times(moments, self.average, self.swing)
    }

    /// Moments on rigid blades that give the root `moments`.
    pub(super) fn undo(&self, moments: &PerBlade<f64>) -> PerBlade<f64> {
        let [real, imaginary] = self.swing;
        let square = real * real + imaginary * imaginary;
        self.times(moments, 1.0 / self.average, [real / square, -imaginary / square])
    }

    fn times(&self, moments: &PerBlade<f64>, average: f64, swing: [f64; 2]) -> PerBlade<f64> {
        if average == 1.0 && swing == [1.0, 0.0] {
            return *moments;
        }
        let fixed = to_fixed_frame(self.azimuth, moments);
        let more = (average - 1.0) * fixed.average;
        let [real, imaginary] = [swing[0] - 1.0, swing[1]];
        let tilt = real * fixed.tilt + imaginary * fixed.yaw;
        let yaw = real * fixed.yaw - imaginary * fixed.tilt;
        PerBlade::from_fn(moments.len(), |blade| {
            let azimuth = blade_azimuth(self.azimuth, blade, moments.len());
            let (sine, cosine) = azimuth.sin_cos();
            moments[blade] + more + tilt * cosine + yaw * sine
        })
    }
}

/// Linear interpolation at `span` (m) in `rows` of span (m) and value.
pub(super) fn between(rows: impl Iterator<Item = (f64, f64)>, span: f64) -> f64 {
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

pub(super) fn mass_at(definition: &Definition, span: f64) -> f64 {
    between(definition.blade_structure.sections.iter().map(|row| (row.span, row.mass)), span)
}

fn stiffness_at(definition: &Definition, span: f64) -> f64 {
    let sections = definition.blade_structure.sections.iter();
    between(sections.map(|row| (row.span, row.flap_stiffness)), span)
}

fn chord_at(definition: &Definition, span: f64) -> f64 {
    between(definition.blade.iter().map(|row| (row.span, row.chord)), span)
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::FixedFrame;
    use basis::mbc::to_blades;

    fn flap() -> Flap {
        Flap {
            mass: 1.3e4,
            stiffness: 9e4,
            centrifugal: 2e4,
            drive: 0.013,
            damping: 0.009,
            relief: 0.7,
            inertia: 1.2e6,
            tension: 1.2e6,
        }
    }

    /// The gain is that of the equations, stepped through time.
    #[test]
    fn the_bend_is_the_response_of_the_equations() {
        let (flap, rotor_speed, rate, slope) = (flap(), 0.7, 0.77, 7e6);
        let (mut q, mut velocity, step) = (0.0, 0.0, 1e-3);
        let (mut cosine, mut sine, n) = (0.0, 0.0, 400_000);
        let turns = |k: usize| rate * step * k as f64;
        let last_turn = n - (std::f64::consts::TAU / rate / step).round() as usize;
        for k in 0..n {
            let moment = turns(k).cos();
            let free = flap.drive * moment - flap.damping * slope * velocity;
            let acceleration = (free - flap.held(rotor_speed) * q) / flap.mass;
            let root = moment
                - slope * flap.relief * velocity
                - flap.inertia * acceleration
                - rotor_speed * rotor_speed * flap.tension * q;
            velocity += step * acceleration;
            q += step * velocity;
            if k >= last_turn {
                cosine += 2.0 * root * turns(k).cos() / (n - last_turn) as f64;
                sine += 2.0 * root * turns(k).sin() / (n - last_turn) as f64;
            }
        }
        let bend = flap.bend(rate, rotor_speed, 0.0, slope);
        // The real part of (gain e^(i ω t)) is gain's real part × cosine − its imaginary part × sine.
        assert!((bend.swing[0] - cosine).abs() < 2e-3, "{bend:?} {cosine}");
        assert!((bend.swing[1] + sine).abs() < 2e-3, "{bend:?} {sine}");
        assert!(bend.swing[1] < 0.0, "a blade lags");
    }

    #[test]
    fn undone_it_is_as_before_and_a_lag_turns_tilt_towards_yaw() {
        let bend = flap().bend(0.75, 0.7, 2.2, 7e6);
        let moments = PerBlade::from_fn(3, |blade| 5.0 + blade as f64 * blade as f64);
        let back = bend.undo(&bend.apply(&moments));
        for (back, moment) in back.iter().zip(moments.iter()) {
            assert!((back - moment).abs() < 1e-12);
        }
        let tilt = to_blades(2.2, FixedFrame { tilt: 1.0, ..FixedFrame::default() }, 3);
        let after = to_fixed_frame(2.2, &bend.apply(&tilt));
        // A blade that lags shows most after it has passed the top, at azimuths above zero.
        assert!(after.yaw > 0.05 && after.average.abs() < 1e-12, "{after:?}");
    }
}
