//! A large turbine for trials, and a world that is what the estimator's model says it is.

#![allow(dead_code)]

use basis::angle::wrap_to_turn;
use basis::mbc::to_blades;
use basis::{FixedFrame, Measurements, Sense};
use estimation::helix::{HelixOptions, HelixSettings, Measurement, MeasurementModel};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use turbine::definition::*;
use turbine::{Definition, sample};

/// Period of the helix (s).
pub(crate) const PERIOD: f64 = 91.4;
/// Control interval (s).
pub(crate) const INTERVAL: f64 = 0.2;
/// Rotor speed (rad/s).
pub(crate) const ROTOR_SPEED: f64 = 0.68;

/// A rotor of 120 m with soft blades.
pub(crate) fn definition() -> Arc<Definition> {
    let mode = Mode { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], damping_ratio: 0.005 };
    let section = |k: usize| {
        let share = k as f64 / 20.0;
        BladeSection {
            span: 117.0 * share,
            twist: 0.0,
            mass: 2800.0 - 2700.0 * share,
            flap_stiffness: 2e11 * (1.0 - share).powi(3) + 1e7,
            edge_stiffness: 2e11,
        }
    };
    let station = |k: usize| {
        let radius = 3.0 + 117.0 * k as f64 / 39.0;
        let inflow = 2.0 / 3.0 * (120.0 / (9.0 * radius)).atan();
        let chord = (16.0 * PI * radius / (3.0 * 4.5) * (1.0 - inflow.cos())).clamp(1.0, 6.0);
        BladeStation {
            span: radius - 3.0,
            chord,
            twist: (inflow - 0.09).min(0.25),
            prebend: 0.0,
            sweep: 0.0,
            polar: usize::from(k > 5),
        }
    };
    let base = sample::definition();
    Arc::new(Definition {
        rotor: RotorGeometry {
            hub_radius: 3.0,
            tip_radius: 120.0,
            precone: 0.0,
            shaft_tilt: 0.0,
            overhang: 10.0,
            hub_height: 150.0,
        },
        blade: (0..40).map(station).collect(),
        blade_structure: BladeStructure {
            sections: (0..=20).map(section).collect(),
            flap_modes: [mode, mode],
            edge_mode: mode,
        },
        tower: Tower {
            top_height: 145.0,
            top_to_shaft: 5.0,
            fore_aft_modes: [mode, mode],
            side_to_side_modes: [mode, mode],
            ..base.tower.clone()
        },
        hub: Hub { mass: 1e5, inertia: 1e6 },
        nacelle: Nacelle { mass: 5e5, yaw_inertia: 1e7, ..base.nacelle },
        drive_train: DriveTrain {
            gear_ratio: 1.0,
            generator_inertia: 1e6,
            gearbox_efficiency: 1.0,
            generator_efficiency: 0.95,
            stiffness: 1e10,
            damping: 1e8,
        },
        operation: None,
        rated_power: 15e6,
        rated_rotor_speed: 0.8,
        ..base
    })
}

/// Settings of the estimator.
pub(crate) fn setting(sense: Sense) -> HelixSettings {
    let (rate, interval) = (TAU / PERIOD, INTERVAL);
    HelixSettings {
        sense,
        rate,
        interval,
        air_density: 1.225,
        n_elements: HelixSettings::N_ELEMENTS,
    }
}

/// Random numbers.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * self.uniform().ln()).sqrt(), self.uniform());
        radius * (TAU * angle).cos()
    }
}

/// Wind and pitch at one instant.
#[derive(Clone, Copy)]
pub(crate) struct World {
    pub(crate) sense: Sense,
    pub(crate) rate: f64,
    pub(crate) mean_wind: f64,
    /// Amplitudes (m/s) and phases (rad) of tilt and yaw.
    pub(crate) amplitudes: [f64; 2],
    pub(crate) phases: [f64; 2],
    /// Tilt and yaw besides (m/s).
    pub(crate) other: [f64; 2],
    /// Amplitude (rad) of the rotor's own pitch and its phase (rad).
    pub(crate) own: (f64, f64),
    /// Noise of the moments over their mean (–).
    pub(crate) noise: f64,
}

impl World {
    pub(crate) fn new(sense: Sense, phase: f64) -> Self {
        Self {
            sense,
            rate: TAU / PERIOD,
            mean_wind: 9.0,
            amplitudes: [1.0; 2],
            phases: [phase; 2],
            other: [0.0; 2],
            own: (0.0, 0.0),
            noise: 0.05,
        }
    }

    fn wind(&self, time: f64) -> FixedFrame {
        let angle = self.rate * time;
        let [tilt, yaw] = self.amplitudes;
        FixedFrame {
            average: self.mean_wind,
            tilt: self.other[0] + tilt * (angle + self.phases[0]).sin(),
            yaw: self.other[1] + yaw * (angle + self.sense.yaw_lead() + self.phases[1]).sin(),
        }
    }

    /// What a rotor like `model` reads at `step`.
    pub(crate) fn read(
        &self,
        step: usize,
        model: &mut MeasurementModel,
        dice: &mut Dice,
    ) -> Measurements<'static> {
        self.read_every(INTERVAL, step, model, dice)
    }

    /// The same where readings are an `interval` (s) apart.
    pub(crate) fn read_every(
        &self,
        interval: f64,
        step: usize,
        model: &mut MeasurementModel,
        dice: &mut Dice,
    ) -> Measurements<'static> {
        let time = step as f64 * interval;
        let azimuth = ROTOR_SPEED * time;
        let angle = self.rate * time + self.own.1;
        let own = FixedFrame {
            average: 0.0,
            tilt: self.own.0 * angle.sin(),
            yaw: self.own.0 * (angle + self.sense.yaw_lead()).sin(),
        };
        let pitch = to_blades(azimuth, own, 3);
        let moments = model.moments(interval, self.wind(time), azimuth, ROTOR_SPEED, &pitch);
        let scale = self.noise * moments.mean();
        Measurements {
            time,
            interval,
            azimuth: wrap_to_turn(azimuth),
            rotor_speed: ROTOR_SPEED,
            generator_speed: ROTOR_SPEED,
            pitch,
            flap_moments: moments.map(|moment| moment + scale * dice.normal()),
            ..Measurements::at_rest(3)
        }
    }
}

/// Noise of 5 % of the mean in readings at every [`INTERVAL`].
pub(crate) fn noise_of_readings() -> Measurement {
    Measurement::Share(0.05 * INTERVAL.sqrt())
}

/// The model of an estimator with `options`, with finer blades.
pub(crate) fn model(
    definition: &Arc<Definition>,
    sense: Sense,
    options: &HelixOptions,
) -> MeasurementModel {
    let setting = HelixSettings { n_elements: 24, ..setting(sense) };
    MeasurementModel::new(definition, &setting, options).unwrap()
}
