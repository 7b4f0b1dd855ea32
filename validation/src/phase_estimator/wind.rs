//! Wind that carries a helix: as a swinging gradient, or as a wake whose middle goes round.

use basis::mbc::blade_azimuth;
use basis::{FixedFrame, PerBlade, Sense, Vector3};
use flow::Inflow;
use flow::inflow::{MeanProfile, TurbulenceBox, TurbulentInflow, kaimal};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Lines of the ground truth (van Vondelen et al. 2025, Eq. 23), and points on each.
const N_LINES: usize = 36;
const N_POINTS: usize = 20;

/// What swings.
#[derive(Clone, Copy, Debug)]
pub(super) enum Swing {
    /// Tilt and yaw of this amplitude (m/s) averaged over a blade, linear in the distance from the shaft.
    Gradient(f64),
    /// A Gaussian deficit of `depth` (m/s) and standard deviation `width` (m) whose middle goes round at
    /// `offset` (m) from a point `aside` (m along y) of the shaft.
    Wake { depth: f64, width: f64, offset: f64, aside: f64 },
}

/// Helix, shear and turbulence together.
#[derive(Clone)]
pub(super) struct HelixWind {
    pub(super) swing: Swing,
    pub(super) sense: Sense,
    /// Excitation rate (rad/s) and phase (rad).
    pub(super) rate: f64,
    pub(super) phase: f64,
    /// Hub (m) and rotor radius (m).
    pub(super) hub: Vector3,
    pub(super) radius: f64,
    pub(super) mean: Arc<dyn Inflow>,
    /// Interval (s) in which the helix does not blow.
    pub(super) absent: [f64; 2],
    /// Speed that is added from `gust`.0 (s) on (m/s).
    pub(super) gust: (f64, f64),
}

impl HelixWind {
    /// What the helix alone adds to the wind along x (m/s) at `time` (s) at `y` and `z` (m).
    fn added(&self, time: f64, y: f64, z: f64) -> f64 {
        let angle = self.rate * time + self.phase;
        let (tilt, yaw) = (angle.sin(), (angle + self.sense.yaw_lead()).sin());
        let (up, right) = (z - self.hub.z, self.hub.y - y);
        match self.swing {
            // The mean of the distance over a blade is half its length.
            Swing::Gradient(amplitude) => 2.0 * amplitude / self.radius * (tilt * up + yaw * right),
            // More wind above is a wake that hangs low.
            Swing::Wake { depth, width, offset, aside } => {
                let (up, right) = (up + offset * tilt, right + aside + offset * yaw);
                -depth * (-(up * up + right * right) / (2.0 * width * width)).exp()
            }
        }
    }

    /// Phases of tilt and yaw of the helix alone (rad), from lines over the rotor and one period: Eq. 23,
    /// first harmonic.
    pub(super) fn truth(&self) -> [f64; 2] {
        let n_steps = 72;
        let mut sums = [[0.0; 2]; 2];
        for step in 0..n_steps {
            let time = TAU / self.rate * f64::from(step) / f64::from(n_steps);
            let fixed = self.lines(|y, z| self.added(time, y, z));
            let (sine, cosine) = (self.rate * time).sin_cos();
            for (sum, value) in sums.iter_mut().zip([fixed.tilt, fixed.yaw]) {
                sum[0] += value * sine;
                sum[1] += value * cosine;
            }
        }
        let phase = |sum: [f64; 2]| sum[1].atan2(sum[0]);
        [phase(sums[0]), phase(sums[1]) - self.sense.yaw_lead()]
    }

    fn lines(&self, wind: impl Fn(f64, f64) -> f64) -> FixedFrame {
        let mut fixed = FixedFrame::default();
        for line in 0..N_LINES {
            let (sine, cosine) = blade_azimuth(0.0, line, N_LINES).sin_cos();
            let mean = (0..N_POINTS)
                .map(|point| {
                    let distance = self.radius * (point as f64 + 0.5) / N_POINTS as f64;
                    wind(self.hub.y - distance * sine, self.hub.z + distance * cosine)
                })
                .sum::<f64>()
                / N_POINTS as f64;
            let share = 2.0 / N_LINES as f64;
            fixed.average += 0.5 * share * mean;
            fixed.tilt += share * mean * cosine;
            fixed.yaw += share * mean * sine;
        }
        fixed
    }
}

impl Inflow for HelixWind {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.mean.sample(time, positions, velocities);
        let absent = (self.absent[0]..self.absent[1]).contains(&time);
        let gust = if time >= self.gust.0 { self.gust.1 } else { 0.0 };
        for (position, velocity) in positions.iter().zip(velocities) {
            velocity.x += gust;
            if !absent {
                velocity.x += self.added(time, position.y, position.z);
            }
        }
    }
}

/// Turbulence of `intensity` (–) in `speed` (m/s) around a hub, on a power law of `exponent` (–).
pub(super) fn turbulent(
    speed: f64,
    exponent: f64,
    intensity: f64,
    hub: Vector3,
    seed: u64,
) -> Arc<dyn Inflow> {
    let profile = MeanProfile::PowerLaw { hub_height: hub.z, speed, exponent };
    if intensity == 0.0 {
        return Arc::new(profile);
    }
    let turbulence: TurbulenceBox = kaimal::generate(
        &kaimal::KaimalSettings {
            n_points: [4096, 16, 16],
            spacing: [0.35 * speed, 20.0, 20.0],
            hub_speed: speed,
            hub_height: hub.z,
            lowest_height: hub.z - 150.0,
            standard_deviation: intensity * speed,
            scaling: kaimal::Scaling::Hub,
            seed,
            threads: Some(1),
        },
        |_| {},
    )
    .expect("the settings are the validation's own");
    let origin = Vector3::new(0.0, hub.y - 150.0, hub.z - 150.0);
    let inflow = TurbulentInflow::new(Arc::new(turbulence), profile, origin);
    Arc::new(inflow.expect("the speed is positive"))
}

/// Pitch that swings with the fixed frame's `amplitude` (rad), `ahead` (rad) of the wave of `wind`.
pub(super) fn pitch(
    wind: &HelixWind,
    time: f64,
    azimuth: f64,
    amplitude: f64,
    ahead: f64,
    n_blades: usize,
) -> PerBlade<f64> {
    let angle = wind.rate * time + wind.phase + ahead;
    let fixed = FixedFrame {
        average: 0.0,
        tilt: amplitude * angle.sin(),
        yaw: amplitude * (angle + wind.sense.yaw_lead()).sin(),
    };
    basis::mbc::to_blades(azimuth, fixed, n_blades)
}

/// The same angle in degrees, −180 to 180.
pub(super) fn degrees(angle: f64) -> f64 {
    basis::angle::wrap_to_half_turn(angle) * 180.0 / PI
}
