//! The channels of a run's series, one row a control instant.

use basis::{Commands, Measurements, Vector3};
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

/// Gathers one row of the series from the turbines' signals.
///
/// A row is: time, wind at the hub-height probe upstream of the first turbine, then for each
/// turbine what it measured, what it was told, and its loads.
pub(crate) struct Row {
    names: Vec<String>,
    values: Vec<f64>,
    offsets: Vec<usize>,
    /// Of each turbine: where its loads begin, and places among its channels with the factor to the unit in the name.
    loads: Vec<(usize, Vec<(usize, f64)>)>,
    /// All channels of one turbine.
    channels: Vec<f64>,
}

impl Row {
    /// The row for `turbines`, each with its name; `all_loads` or a choice of them.
    pub(crate) fn new<'a>(
        turbines: impl Iterator<Item = (&'a str, &'a Turbine)>,
        all_loads: bool,
    ) -> Self {
        let mut names: Vec<String> = SHARED.iter().map(|&name| name.to_owned()).collect();
        let (mut offsets, mut loads) = (Vec::new(), Vec::new());
        let mut n_channels = 0;
        for (name, turbine) in turbines {
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
        }
        let values = vec![0.0; names.len()];
        Self { names, values, offsets, loads, channels: vec![0.0; n_channels] }
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
