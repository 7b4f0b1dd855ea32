//! The channels of a run's series, one row a control instant.

use basis::{Commands, Measurements, Vector3};
use farm::farm::Recorder;

/// Channels before the turbines' own.
const SHARED: [&str; 4] = ["time_s", "wind.u_m_s", "wind.v_m_s", "wind.w_m_s"];

/// Gathers one row of the series from the turbines' signals.
///
/// A row is: time, wind at the hub-height probe upstream of the first turbine, then for each
/// turbine what it measured and what it was told.
pub(crate) struct Row {
    names: Vec<String>,
    values: Vec<f64>,
    offsets: Vec<usize>,
}

impl Row {
    /// The row for `turbines`: name and number of blades of each.
    pub(crate) fn new(turbines: &[(String, usize)]) -> Self {
        let mut names: Vec<String> = SHARED.iter().map(|&name| name.to_owned()).collect();
        let mut offsets = Vec::with_capacity(turbines.len());
        for (name, n_blades) in turbines {
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
                names.extend((1..=*n_blades).map(|blade| format!("{name}.{}", channel(blade))));
            }
        }
        let values = vec![0.0; names.len()];
        Self { names, values, offsets }
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
