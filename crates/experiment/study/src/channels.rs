//! The channels of a run's series, one row a control instant.

use basis::{Commands, FixedFrame, Measurements, Vector3};
use control::{Excitation, Meandering, PhaseSync};
use farm::Machine;
use farm::farm::Recorder;
use turbine::Turbine;

/// Channels before the turbines' own.
const SHARED: [&str; 4] = ["time_s", "wind.u_m_s", "wind.v_m_s", "wind.w_m_s"];

/// Loads and motions that are kept of a turbine in solved air, under OpenFAST's names; in prescribed wind all are.
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

/// What a turbine that seeks a helix believes, behind its measurements.
const ESTIMATES: [&str; 9] = [
    "estimated_wind_m_s",
    "estimated_tilt_wind_m_s",
    "estimated_yaw_wind_m_s",
    "estimated_tilt_amplitude_m_s",
    "estimated_yaw_amplitude_m_s",
    "estimated_tilt_phase_rad",
    "estimated_yaw_phase_rad",
    "estimate_trust",
    "sync_share",
];

/// What a turbine that follows meandering believes and asks for, behind its measurements.
const MEANDERING: [&str; 14] = [
    "meandering_rate_rad_s",
    "meandering_phase_rad",
    "meandering_tilt_amplitude_nm",
    "meandering_yaw_amplitude_nm",
    "meandering_tilt_phase_rad",
    "meandering_yaw_phase_rad",
    "meandering_tilt_offset_nm",
    "meandering_yaw_offset_nm",
    "meandering_tilt_reference_nm",
    "meandering_yaw_reference_nm",
    "meandering_lock",
    "meandering_share",
    "meandering_tilt_pitch_rad",
    "meandering_yaw_pitch_rad",
];

/// What the controller of a machine believes.
enum Belief<'a> {
    /// Of a helix from upstream.
    Helix(&'a PhaseSync),
    /// Of its loads' slow oscillation.
    Meandering(&'a Meandering),
}

impl Belief<'_> {
    fn names(&self) -> &'static [&'static str] {
        match self {
            Self::Helix(_) => &ESTIMATES,
            Self::Meandering(_) => &MEANDERING,
        }
    }
}

/// Gathers one row of the series from the turbines' signals.
///
/// A row is: time, wind at the hub-height probe upstream of the first turbine, then for each
/// turbine how it truly fared, whatever its instruments showed, what it was told, its loads, and what it believes where it seeks a helix or meandering; then the wind along
/// radial lines at the places of turbines that are not there.
pub(crate) struct Row {
    names: Vec<String>,
    values: Vec<f64>,
    offsets: Vec<usize>,
    /// Of each turbine: where its loads begin, and places among its channels with the factor to the unit in the name.
    loads: Vec<(usize, Vec<(usize, f64)>)>,
    /// Of each turbine that seeks a helix or meandering: where its beliefs begin.
    estimates: Vec<Option<usize>>,
    /// Where the winds along lines begin.
    lines: usize,
    /// All channels of one turbine.
    channels: Vec<f64>,
}

impl Row {
    /// The row for `machines`, each with its name, and for lines at the places `lines`; `all_loads` or a choice of them.
    pub(crate) fn new<'a>(
        machines: impl Iterator<Item = (&'a str, &'a Machine)>,
        lines: &[&str],
        all_loads: bool,
    ) -> Self {
        let mut names: Vec<String> = SHARED.iter().map(|&name| name.to_owned()).collect();
        let (mut offsets, mut loads, mut estimates) = (Vec::new(), Vec::new(), Vec::new());
        let mut n_channels = 0;
        for (name, machine) in machines {
            let turbine = &machine.turbine;
            let n_blades = turbine.definition().n_blades;
            offsets.push(names.len());
            let scalars = [
                "power_w",
                "thrust_n",
                "rotor_speed_rad_s",
                "azimuth_rad",
                "generator_torque_nm",
                "aerodynamic_torque_nm",
                "rotor_wind_speed_m_s",
            ];
            names.extend(scalars.iter().map(|channel| format!("{name}.{channel}")));
            let per_blade: [fn(usize) -> String; 3] = [
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
            let belief = belief(machine);
            estimates.push(belief.as_ref().map(|_| names.len()));
            if let Some(belief) = belief {
                names.extend(belief.names().iter().map(|channel| format!("{name}.{channel}")));
            }
        }
        let first_line = names.len();
        for place in lines {
            let channels = ["average", "tilt", "yaw"];
            names.extend(channels.map(|channel| format!("{place}.lines_{channel}_m_s")));
        }
        let values = vec![0.0; names.len()];
        let channels = vec![0.0; n_channels];
        Self { names, values, offsets, loads, estimates, lines: first_line, channels }
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

    /// Takes in what `machine` number `index` believes after its last decision.
    pub(crate) fn beliefs(&mut self, index: usize, machine: &Machine) {
        let Some(first) = self.estimates[index] else { return };
        match belief(machine) {
            Some(Belief::Helix(sync)) => self.helix(first, sync),
            Some(Belief::Meandering(meandering)) => self.meandering(first, meandering),
            None => {}
        }
    }

    fn helix(&mut self, first: usize, sync: &PhaseSync) {
        let Some(belief) = sync.estimate() else { return };
        self.values[first..first + ESTIMATES.len()].copy_from_slice(&[
            belief.mean_wind,
            belief.helix.tilt,
            belief.helix.yaw,
            belief.tilt.amplitude,
            belief.yaw.amplitude,
            belief.tilt.phase,
            belief.yaw.phase,
            belief.trust.overall(),
            sync.share(),
        ]);
    }

    fn meandering(&mut self, first: usize, meandering: &Meandering) {
        let belief = meandering.estimate();
        // Zero while it is not known yet.
        let [tilt_reference, yaw_reference] = meandering.baseline().unwrap_or_default();
        let commands = meandering.commands();
        self.values[first..first + MEANDERING.len()].copy_from_slice(&[
            belief.rate,
            belief.phase,
            belief.tilt.amplitude,
            belief.yaw.amplitude,
            belief.tilt.phase,
            belief.yaw.phase,
            belief.tilt.offset,
            belief.yaw.offset,
            tilt_reference,
            yaw_reference,
            f64::from(u8::from(belief.locked)),
            meandering.authority(),
            commands.tilt,
            commands.yaw,
        ]);
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

/// What the controller of `machine` believes, if it seeks anything.
fn belief(machine: &Machine) -> Option<Belief<'_>> {
    match &machine.controller.excitation {
        Excitation::PhaseSync(sync) => Some(Belief::Helix(sync)),
        Excitation::Meandering(meandering) => Some(Belief::Meandering(meandering)),
        Excitation::None | Excitation::Helix(_) | Excitation::Pulse(_) => None,
    }
}

impl Recorder for Row {
    fn record(&mut self, turbine: usize, measurements: &Measurements, commands: &Commands) {
        let scalars = [
            measurements.power,
            measurements.thrust,
            measurements.rotor_speed,
            measurements.azimuth,
            measurements.generator_torque,
            measurements.aerodynamic_torque,
            measurements.rotor_wind_speed,
        ];
        let mut next = self.offsets[turbine];
        for block in
            [&scalars[..], &measurements.pitch, &commands.pitch, &measurements.flap_moments]
        {
            self.values[next..next + block.len()].copy_from_slice(block);
            next += block.len();
        }
    }
}
