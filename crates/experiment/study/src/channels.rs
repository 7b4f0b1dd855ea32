//! The channels of a run's series, one row a control instant.

use crate::prepared::Prepared;
use basis::{Commands, FixedFrame, Truth, Vector3};
use farm::case::Run;
use farm::farm::Recorder;
use farm::{Machine, assemble};
use std::ops::Range;
use turbine::Turbine;
use turbine::structure::channels_of;

/// Channels before the turbines' own.
const SHARED: [&str; 4] = ["time_s", "wind.u_m_s", "wind.v_m_s", "wind.w_m_s"];

/// Loads and motions that are kept of a turbine in resolved flow, under OpenFAST's names; in prescribed wind
/// all are.
pub(crate) const LOADS: [&str; 18] = [
    "RootMxc1",
    "RootMyc1",
    "RootMzc1",
    "RootMxb1",
    "RootMyb1",
    "RotTorq",
    "LSSTipMys",
    "LSSTipMzs",
    "YawBrMxp",
    "YawBrMyp",
    "YawBrMzp",
    "TwrBsMxt",
    "TwrBsMyt",
    "TwrBsMzt",
    "OoPDefl1",
    "IPDefl1",
    "TTDspFA",
    "TTDspSS",
];

/// Channels of the wind along lines at one place (–).
const LINES: [&str; 3] = ["average", "tilt", "yaw"];
/// Channels of a turbine beside its loads and signals: of the machine, and of each blade (–).
const N_SCALARS: usize = 8;
const N_PER_BLADE: usize = 3;

/// Loads that the series of a run of `setup` keeps of turbine number `index` (–).
pub(crate) fn n_loads(setup: &Prepared, index: usize) -> usize {
    let channels = channels_of(setup.models[index].definition.n_blades);
    let all = !setup.case.flow.solver.resolves_induction;
    channels.iter().filter(|channel| all || LOADS.contains(&channel.name.as_str())).count()
}

/// Channels in the series of `run` with lines at `n_lines` places (–), as [`Row`] has them.
pub(crate) fn count(setup: &Prepared, run: &Run, n_lines: u64) -> u64 {
    let of_turbine = |index: usize| {
        let n_blades = setup.models[index].definition.n_blades;
        let (plan, model) = (&setup.plan, setup.models[index].clone());
        // What is found before the runs, if there is to be anything, changes no name.
        let model = model.without_individual_pitch();
        let mut control = run.control[index].clone();
        control.response = control.response.or(control.kind().any_response());
        let signals = assemble::controller(&control, &model, &setup.case, plan)
            .map_or(0, |controller| controller.signals().len());
        let shown = assemble::sensing(&setup.case, plan, &model, index)
            .map_or(0, |sensing| sensing.channels().len());
        N_SCALARS + N_PER_BLADE * n_blades + n_loads(setup, index) + signals + shown
    };
    let turbines: usize = run.present().map(of_turbine).sum();
    (SHARED.len() + turbines) as u64 + LINES.len() as u64 * n_lines
}

/// Gathers one row of the series from the turbines' signals.
///
/// A row is: time, wind at the hub-height probe upstream of the first turbine, then for each
/// turbine its true state, whatever its instruments showed, its commands, its loads, the signals of its
/// controller and what its further sensors show; then the wind along radial lines at the places of turbines
/// that are not there.
pub(crate) struct Row {
    names: Vec<String>,
    values: Vec<f64>,
    offsets: Vec<usize>,
    /// Of each turbine: where its loads begin, and places among its channels with the factor to the unit in
    /// the name.
    loads: Vec<(usize, Vec<(usize, f64)>)>,
    /// Of each turbine: where the signals of its controller begin and end; behind them is what its further
    /// sensors show.
    signals: Vec<Range<usize>>,
    /// Where the winds along lines begin.
    lines: usize,
    /// All channels of one turbine.
    channels: Vec<f64>,
}

impl Row {
    /// The row for `machines`, each with its name, and for lines at the places `lines`; `all_loads` or a
    /// choice of them.
    pub(crate) fn new<'a>(
        machines: impl Iterator<Item = (&'a str, &'a Machine)>,
        lines: &[&str],
        all_loads: bool,
    ) -> Self {
        let mut names: Vec<String> = SHARED.iter().map(|&name| name.to_owned()).collect();
        let (mut offsets, mut loads, mut signals) = (Vec::new(), Vec::new(), Vec::new());
        let mut n_channels = 0;
        for (name, machine) in machines {
            let turbine = &machine.turbine;
            let n_blades = turbine.definition().n_blades;
            offsets.push(names.len());
            let scalars: [&str; N_SCALARS] = [
                "power_w",
                "thrust_n",
                "rotor_speed_rad_s",
                "azimuth_rad",
                "yaw_rad",
                "generator_torque_nm",
                "aerodynamic_torque_nm",
                "rotor_wind_speed_m_s",
            ];
            names.extend(scalars.iter().map(|channel| format!("{name}.{channel}")));
            let per_blade: [fn(usize) -> String; N_PER_BLADE] = [
                |blade| format!("pitch_{blade}_rad"),
                |blade| format!("pitch_command_{blade}_rad"),
                |blade| format!("flap_moment_{blade}_nm"),
            ];
            for channel in per_blade {
                names.extend((1..=n_blades).map(|blade| format!("{name}.{}", channel(blade))));
            }
            let channels = turbine.channels();
            n_channels = n_channels.max(channels.len());
            let kept: Vec<usize> = (0..channels.len())
                .filter(|&index| all_loads || LOADS.contains(&channels[index].name.as_str()))
                .collect();
            let first = names.len();
            names.extend(kept.iter().map(|&index| {
                let channel = &channels[index];
                format!("{name}.{}_{}", channel.name, channel.unit)
            }));
            loads.push((first, kept.iter().map(|&i| (i, channels[i].scale)).collect()));
            let first = names.len();
            let own = machine.controller.signals();
            names.extend(own.iter().map(|signal| format!("{name}.{signal}")));
            signals.push(first..names.len());
            let shown = machine.sensing.channels();
            names.extend(shown.iter().map(|channel| format!("{name}.{channel}")));
        }
        let first_line = names.len();
        for place in lines {
            names.extend(LINES.map(|channel| format!("{place}.lines_{channel}_m_s")));
        }
        let values = vec![0.0; names.len()];
        let channels = vec![0.0; n_channels];
        Self { names, values, offsets, loads, signals, lines: first_line, channels }
    }

    /// Takes the loads of turbine number `index` in, as they are before it moves on.
    pub(crate) fn loads(&mut self, index: usize, turbine: &Turbine) {
        let (first, kept) = &self.loads[index];
        let channels = &mut self.channels[..turbine.channels().len()];
        turbine.write_channels(channels);
        for (value, (channel, scale)) in self.values[*first..].iter_mut().zip(kept) {
            *value = channels[*channel] * scale;
        }
    }

    /// Takes in the signals of the controller of `machine` number `index` after its last decision, and what
    /// its further sensors showed it.
    pub(crate) fn signals(&mut self, index: usize, machine: &Machine) {
        let place = self.signals[index].clone();
        let mut next = place.end;
        machine.controller.write_signals(&mut self.values[place]);
        for reading in machine.sensing.readings() {
            let n_values = reading.values.len();
            self.values[next..next + n_values].copy_from_slice(&reading.values);
            next += n_values;
        }
    }

    /// Takes in the `wind` (m/s) along the lines at place number `index`.
    pub(crate) fn lines(&mut self, index: usize, wind: FixedFrame) {
        let first = self.lines + 3 * index;
        self.values[first..first + 3].copy_from_slice(&[wind.average, wind.tilt, wind.yaw]);
    }

    /// Names of the channels, in the order of [`Self::values`].
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The row as it stands.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Starts the row of `time` (s) with the probe's `wind` (m/s).
    pub(crate) fn start(&mut self, time: f64, wind: Vector3) {
        self.values[..SHARED.len()].copy_from_slice(&[time, wind.x, wind.y, wind.z]);
    }
}

impl Recorder for Row {
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        let scalars = [
            truth.power,
            truth.thrust,
            truth.rotor_speed,
            truth.azimuth,
            truth.yaw,
            truth.generator_torque,
            truth.aerodynamic_torque,
            truth.rotor_wind_speed,
        ];
        let mut next = self.offsets[turbine];
        for block in [&scalars[..], &truth.pitch, &commands.pitch, &truth.flap_moments] {
            self.values[next..next + block.len()].copy_from_slice(block);
            next += block.len();
        }
    }
}
