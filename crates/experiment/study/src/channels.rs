//! The channels of a run's series, one row a control instant.

use crate::prepared::Prepared;
use basis::channels::{Channel, LINES, OPERATION, OPERATION_OF_BLADES, TIME, WIND, loads_of};
use basis::{Commands, FixedFrame, Truth, Vector3};
use farm::Machine;
use farm::case::Run;
use farm::farm::Recorder;
use std::ops::Range;
use turbine::{Definition, Turbine};

/// Channels before the turbines' own: time and wind.
const N_SHARED: usize = 4;

/// Channels that a turbine of `n_blades` blades has under any controller (–).
fn n_own(n_blades: usize) -> usize {
    OPERATION.len() + OPERATION_OF_BLADES.len() * n_blades + loads_of(n_blades).len()
}

/// Channels of each turbine in the series of `run` (–).
pub(crate) fn of_turbines(setup: &Prepared, run: &Run) -> Vec<u64> {
    let n_blades = |index: usize| setup.models[index].definition.n_blades;
    let own = |index| (n_own(n_blades(index)) + setup.n_told(run, index)) as u64;
    run.present().map(own).collect()
}

/// Channels in the series of `run` with lines at `n_lines` places (–), as [`Row`] has them.
pub(crate) fn count(setup: &Prepared, run: &Run, n_lines: u64) -> u64 {
    let turbines: u64 = of_turbines(setup, run).into_iter().sum();
    N_SHARED as u64 + turbines + LINES.len() as u64 * n_lines
}

/// Gathers one row of the series from the turbines' signals, in SI units.
///
/// A row is: time, wind at the hub-height probe upstream of the first turbine, then for each
/// turbine its true state, whatever its instruments showed, its commands, its loads, the signals of its
/// controller and what its further sensors show; then the wind along radial lines at the places of turbines
/// that are not there.
pub(crate) struct Row {
    channels: Vec<Channel>,
    values: Vec<f64>,
    turbines: Vec<Place>,
    /// Where the winds along lines begin.
    lines: usize,
    /// All that the structure of one turbine tells.
    told: Vec<f64>,
}

/// Where a turbine's channels are in the row.
struct Place {
    /// Where its state begins.
    first: usize,
    /// Generator speed over rotor speed (–): the channels of the generator are of its own, the fast side.
    gear_ratio: f64,
    /// Where its loads begin, and their places among what its structure tells.
    loads: (usize, Vec<usize>),
    /// Where the signals of its controller begin and end; behind them is what its further sensors show.
    signals: Range<usize>,
}

impl Row {
    /// The row for `machines`, each with its name, and for lines at the places `lines`.
    pub(crate) fn new<'a>(
        machines: impl Iterator<Item = (&'a str, &'a Machine)>,
        lines: &[&str],
    ) -> Self {
        let mut channels: Vec<Channel> = std::iter::once(TIME).chain(WIND).collect();
        let (mut turbines, mut n_told) = (Vec::new(), 0);
        for (name, machine) in machines {
            let turbine = &machine.turbine;
            let Definition { n_blades, drive_train, .. } = turbine.definition();
            let mut add = |own: &mut dyn Iterator<Item = Channel>| {
                let first = channels.len();
                channels.extend(own.map(|channel| channel.of(name)));
                first..channels.len()
            };
            let first = add(&mut OPERATION.into_iter()).start;
            for channel in OPERATION_OF_BLADES {
                add(&mut (1..=*n_blades).map(|blade| channel.of_blade(blade)));
            }
            // Its state is that of the instant; the structure tells of the middle of the step before, too.
            let told = turbine.channels();
            n_told = n_told.max(told.len());
            let loads = loads_of(*n_blades);
            let place = |load: &Channel| told.iter().position(|channel| channel == load);
            let places = loads.iter().filter_map(place).collect();
            let first_load = add(&mut loads.into_iter()).start;
            let signals = add(&mut machine.controller.signals().into_iter());
            add(&mut machine.sensing.channels().into_iter());
            turbines.push(Place {
                first,
                gear_ratio: drive_train.gear_ratio,
                loads: (first_load, places),
                signals,
            });
        }
        let first_line = channels.len();
        for place in lines {
            channels.extend(LINES.map(|channel| channel.of(place)));
        }
        let (values, told) = (vec![0.0; channels.len()], vec![0.0; n_told]);
        Self { channels, values, turbines, lines: first_line, told }
    }

    /// Takes the loads of turbine number `index` in, as they are before it moves on.
    pub(crate) fn loads(&mut self, index: usize, turbine: &Turbine) {
        let (first, places) = &self.turbines[index].loads;
        let told = &mut self.told[..turbine.channels().len()];
        turbine.write_channels(told);
        for (value, place) in self.values[*first..].iter_mut().zip(places) {
            *value = told[*place];
        }
    }

    /// Takes in the signals of the controller of `machine` number `index` after its last decision, and what
    /// its further sensors showed it.
    pub(crate) fn signals(&mut self, index: usize, machine: &Machine) {
        let place = self.turbines[index].signals.clone();
        let mut next = place.end;
        machine.controller.write_signals(&mut self.values[place]);
        for shown in machine.sensing.recorded() {
            self.values[next..next + shown.len()].copy_from_slice(shown);
            next += shown.len();
        }
    }

    /// Takes in the `wind` (m/s) along the lines at place number `index`.
    pub(crate) fn lines(&mut self, index: usize, wind: FixedFrame) {
        let first = self.lines + LINES.len() * index;
        let values = &mut self.values[first..first + LINES.len()];
        values.copy_from_slice(&[wind.average, wind.tilt, wind.yaw]);
    }

    /// The channels, in the order of [`Self::values`].
    pub(crate) fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The row as it stands, in SI units.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Starts the row of `time` (s) with the probe's `wind` (m/s).
    pub(crate) fn start(&mut self, time: f64, wind: Vector3) {
        self.values[..N_SHARED].copy_from_slice(&[time, wind.x, wind.y, wind.z]);
    }
}

impl Recorder for Row {
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        let Place { first, gear_ratio, .. } = self.turbines[turbine];
        let operation: [f64; 9] = [
            truth.power,
            truth.generator_torque / gear_ratio,
            truth.generator_speed * gear_ratio,
            truth.rotor_speed,
            truth.azimuth,
            truth.yaw,
            truth.thrust,
            truth.aerodynamic_torque,
            truth.rotor_wind_speed,
        ];
        let mut next = first;
        for block in [&operation[..], &truth.pitch, &commands.pitch] {
            self.values[next..next + block.len()].copy_from_slice(block);
            next += block.len();
        }
    }
}
