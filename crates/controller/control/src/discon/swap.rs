//! The swap array of Bladed's interface: which record holds what.
//!
//! Record numbers, units and signs are those of the Bladed user manual's appendix A as OpenFAST's ServoDyn
//! fills them (`BladedInterface.f90`); record n is element n − 1. Speeds and torques cross on the high-speed
//! side of the gearbox. `docs/how-to/own-controller.md` has the table.

use crate::kind::Site;
use crate::library::Hosted;
use basis::{Commands, Measurements, PerBlade};

/// Records of the array (–): OpenFAST's extended array has 3300.
pub const N_RECORDS: usize = 4096;
/// Records that whoever calls fills with the lengths of the texts that go along: room for the message, the
/// name of the input file, that of outputs, and room for what comes back in it.
pub const TEXTS: [usize; 4] = [49, 50, 51, 64];
/// Blades that the interface knows (–).
pub(super) const MOST_BLADES: usize = 3;

/// Status of a call.
pub(super) const STATUS: usize = 1;
/// Generator contactor: 0 off, 1 on.
pub(super) const CONTACTOR: usize = 35;
/// Shaft brake; 0 is off.
pub(super) const BRAKE: usize = 36;
/// Yaw rate that is asked for, counter-clockwise seen from above as in OpenFAST (rad/s).
const YAW_RATE: usize = 48;
/// Not 0: the library leaves pitch, or torque, to a built-in controller.
pub(super) const OVERRIDES: [usize; 2] = [55, 56];
/// Start of a table of torque over speed, behind which logged values begin.
const TABLE: f32 = 165.0;
/// First of the records of individual pitch (rad), and that of collective pitch (rad).
const PITCH: [usize; 2] = [42, 45];
/// Torque that is asked for (N m).
const TORQUE: usize = 47;

/// Records that are sent and change from call to call.
pub(super) const SENT: [usize; 20] =
    [2, 4, 33, 34, 14, 15, 20, 21, 23, 24, 27, 30, 31, 32, 69, 70, 71, 53, 60, 37];
/// Records that come back and move the turbine.
pub(super) const RETURNED: [usize; 7] = [42, 43, 44, 45, 47, 35, YAW_RATE];

/// What the [`SENT`] records hold.
pub(super) type Sent = [f32; SENT.len()];
/// What the [`RETURNED`] records hold.
pub(super) type Returned = [f32; RETURNED.len()];

/// What is sent that time does not change, and how demands are read.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    fixed: Vec<(usize, f64)>,
    n_blades: usize,
    gear_ratio: f64,
    is_individual: bool,
    anemometer: Option<String>,
}

impl Layout {
    /// That of the turbine at `site` under the library of `hosted`.
    pub(super) fn new(hosted: &Hosted, site: &Site) -> Self {
        let (constants, machine) = (site.constants, site.rotor);
        let (ratio, actuator) = (machine.drive_train.gear_ratio, &machine.pitch_actuator);
        let rated_speed = ratio * constants.rated_rotor_speed;
        let fixed = vec![
            (3, site.interval),
            (5, constants.fine_pitch),
            (6, actuator.minimum_pitch),
            (7, actuator.maximum_pitch),
            (8, -actuator.maximum_rate),
            (9, actuator.maximum_rate),
            (13, constants.rated_power),
            (16, constants.torque_gain / ratio.powi(3)),
            (17, ratio * constants.minimum_rotor_speed),
            (18, rated_speed),
            (19, rated_speed),
            (22, constants.rated_torque / ratio),
            (28, if hosted.is_individual { 1.0 } else { 0.0 }),
            (61, machine.n_blades as f64),
            (63, f64::from(TABLE)),
            (95, site.air_density),
            (96, site.wind_speed),
        ];
        Self {
            fixed,
            n_blades: machine.n_blades,
            gear_ratio: ratio,
            is_individual: hosted.is_individual,
            anemometer: hosted.anemometer.clone(),
        }
    }

    /// The array before the first call.
    pub(super) fn blank(&self) -> Vec<f32> {
        let mut swap = vec![0.0; N_RECORDS];
        self.fixed.iter().for_each(|&(record, value)| put(&mut swap, record, value as f32));
        put(&mut swap, CONTACTOR, 1.0);
        swap
    }

    /// On return `swap` holds `sent`, and what time does not change as it was.
    pub(super) fn send(&self, swap: &mut [f32], sent: &Sent) {
        // A library may use what it is sent as it likes.
        self.fixed.iter().for_each(|&(record, value)| put(swap, record, value as f32));
        SENT.iter().zip(sent).for_each(|(&record, &value)| put(swap, record, value));
    }

    /// What is sent of `measurements`, in single precision as the interface has it.
    pub(super) fn sent(&self, measurements: &Measurements) -> Sent {
        let Measurements { pitch, flap_moments, edge_moments, .. } = measurements;
        let of = |values: &PerBlade<f64>, blade: usize| values.get(blade).copied().unwrap_or(0.0);
        let speed = measurements.generator_speed;
        let wind = self.anemometer.as_ref().and_then(|name| measurements.reading(name));
        let wind = |index: usize| wind.and_then(|wind| wind.get(index)).copied().unwrap_or(0.0);
        SENT.map(|record| {
            let value = match record {
                2 => measurements.time,
                4 => of(pitch, 0),
                33 | 34 => of(pitch, record - 32),
                14 => measurements.generator_torque * speed,
                15 => measurements.power,
                20 => self.gear_ratio * speed,
                21 => measurements.rotor_speed,
                23 => measurements.generator_torque / self.gear_ratio,
                24 => wind(1),
                27 => wind(0),
                30..=32 => of(flap_moments, record - 30),
                69..=71 => of(edge_moments, record - 69),
                53 => measurements.tower_top_acceleration,
                60 => measurements.azimuth,
                // Record 37, the nacelle's heading, is counted from the wind's x axis.
                _ => measurements.yaw,
            };
            value as f32
        })
    }

    /// What the [`RETURNED`] records ask of the turbine.
    pub(super) fn commands(&self, returned: &Returned) -> Commands {
        let of = |record: usize| {
            let place = RETURNED.iter().position(|own| *own == record);
            place.map_or(0.0, |place| f64::from(returned[place]))
        };
        let pitch = PerBlade::from_fn(self.n_blades, |blade| match self.is_individual {
            true => of(PITCH[0] + blade),
            false => of(PITCH[1]),
        });
        let is_on = of(CONTACTOR) != 0.0;
        let torque = if is_on { self.gear_ratio * of(TORQUE) } else { 0.0 };
        Commands { pitch, generator_torque: torque, yaw_rate: of(YAW_RATE) }
    }
}

/// What `record` of `swap` holds.
pub(super) fn get(swap: &[f32], record: usize) -> f32 {
    swap[record - 1]
}

/// Puts `value` into `record` of `swap`.
pub(super) fn put(swap: &mut [f32], record: usize, value: f32) {
    swap[record - 1] = value;
}

/// What the [`RETURNED`] records of `swap` hold.
pub(super) fn returned(swap: &[f32]) -> Returned {
    RETURNED.map(|record| get(swap, record))
}
