//! Azimuth of the rotor and of its helix over time.

use super::refused;
use crate::PostprocessingError;
use analysis::phases::helix_azimuth;
use basis::angle::wrap_to_half_turn;
use basis::channels::{AZIMUTH, BLD_PITCH, TIME};
use basis::mbc::to_fixed_frame;
use basis::{PerBlade, Sense};
use formats::records::{RunFolder, read_series};
use formats::table::TableReader;
use std::f64::consts::TAU;
use std::path::Path;

/// Least amplitude of a pitch that makes a helix (rad): what is less is no excitation.
const LEAST_PITCH: f64 = 2e-3;
/// Greatest step of rotor azimuth from row to row, on the average (rad): of more the way round is not told.
const MOST_STEP: f64 = 0.26 * TAU;
/// Blades whose pitch makes tilt and yaw.
const N_BLADES: usize = 3;

/// Azimuths over time, neither of them wrapped.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Angles {
    times: Vec<f64>,
    rotor: Vec<f64>,
    /// Empty where there is no helix.
    helix: Vec<f64>,
    /// Blades whose pitch is told (–).
    n_blades: usize,
    /// Time beyond the first and the last row for which they hold, straight on (s).
    beyond: f64,
}

impl Angles {
    /// Those of the turbine called `turbine`, or of the first, in the run in `folder`.
    ///
    /// # Errors
    /// [`PostprocessingError`] for a series that cannot be read, or has no azimuth of it.
    pub(crate) fn of_run(
        folder: &RunFolder,
        turbine: Option<&str>,
    ) -> Result<Self, PostprocessingError> {
        let path = folder.series_path();
        let ends = format!(".{}", AZIMUTH.name);
        let is_wanted = |name: &str| {
            name == TIME.name || name.ends_with(&ends) || name.contains(BLD_PITCH.stem)
        };
        let series = read_series(&path, is_wanted)?;
        let first = series.names.iter().find_map(|name| name.strip_suffix(&ends));
        let turbine = turbine.or(first).unwrap_or("T1").to_owned();
        let column = |channel: &str| {
            let name = format!("{turbine}.{channel}");
            series.column(&name).ok_or(name)
        };
        let missing = |channel| {
            let path = Some(path.clone());
            PostprocessingError::MissingChannel { path, channel }
        };
        let rotor = column(&AZIMUTH.name).map_err(missing)?;
        let times = series.column(&TIME.name).unwrap_or_default();
        let pitch: Result<Vec<&[f64]>, String> =
            (1..=N_BLADES).map(|blade| column(&BLD_PITCH.of_blade(blade).name)).collect();
        let helix = pitch.map_or_else(|_| Vec::new(), |pitch| of_pitch(rotor, &pitch));
        let rotor = unwrapped(rotor);
        dense(&path, &rotor, "make the run again with a shorter output.interval")?;
        // Rows are of the beginnings of steps, instants of their ends: the last one lies a row beyond.
        let beyond = match times {
            [.., before, last] => 1.001 * (last - before),
            _ => 0.0,
        };
        let n_blades = (1..).take_while(|n| column(&BLD_PITCH.of_blade(*n).name).is_ok()).count();
        Ok(Self { times: times.to_vec(), rotor, helix, n_blades, beyond })
    }

    /// Those in the table at `path`: time, `Azimuth_deg` and, where there is one, `Helix_deg`.
    ///
    /// # Errors
    /// [`PostprocessingError::File`].
    pub(crate) fn of_table(path: &Path) -> Result<Self, PostprocessingError> {
        let mut table = TableReader::open(path)?;
        let has_helix = table.channels().any(|one| one.name.to_lowercase().starts_with("helix"));
        let names: &[&str] = if has_helix { &["Azimuth", "Helix"] } else { &["Azimuth"] };
        table.select(names)?;
        let units: Vec<f64> = table
            .selected()
            .map(|column| match (column.unit.as_str(), column.name.ends_with("_rad")) {
                ("" | "deg" | "°", false) => Ok(1.0_f64.to_radians()),
                ("" | "rad", _) => Ok(1.0),
                (other, _) => {
                    let problem = format!("has `{}` in {other}", column.name);
                    Err(refused(path, problem, "give azimuths in deg or rad"))
                }
            })
            .collect::<Result<_, _>>()?;
        let mut row = vec![0.0; names.len() + 1];
        let mut columns = vec![Vec::new(); row.len()];
        while table.read(&mut row)? {
            for (column, value) in columns.iter_mut().zip(&row) {
                column.push(*value);
            }
        }
        let times = columns.remove(0);
        if times.len() < 2 {
            let fix = "give a table that spans all instants of the fields";
            return Err(refused(path, "has fewer than two rows", fix));
        }
        let mut angles = columns.iter().zip(&units).map(|(column, unit)| {
            unwrapped(&column.iter().map(|angle| unit * angle).collect::<Vec<f64>>())
        });
        let (rotor, helix) = (angles.next().unwrap_or_default(), angles.next().unwrap_or_default());
        dense(path, &rotor, "give four rows a revolution at least")?;
        let beyond = 1e-6 * (times[times.len() - 1] - times[0]);
        Ok(Self { times, rotor, helix, n_blades: 0, beyond })
    }

    /// Azimuths of rotor and helix at `time` (rad), linear between rows; none beyond where they hold.
    pub(crate) fn at(&self, time: f64) -> Option<(f64, Option<f64>)> {
        let after = self.times.partition_point(|other| *other < time);
        let [first, .., last] = &self.times[..] else { return None };
        let rounding = 1e-9;
        if time < first - self.beyond - rounding || time > last + self.beyond + rounding {
            return None;
        }
        let after = after.clamp(1, self.times.len() - 1);
        let (a, b) = (self.times[after - 1], self.times[after]);
        let share = if b > a { (time - a) / (b - a) } else { 0.0 };
        let between = |values: &[f64]| {
            let (a, b) = (values[after - 1], values[after]);
            a + share * (b - a)
        };
        Some((between(&self.rotor), (!self.helix.is_empty()).then(|| between(&self.helix))))
    }

    /// Blades of the turbine (–); none where they are not told.
    pub(crate) fn n_blades(&self) -> Option<usize> {
        (self.n_blades > 0).then_some(self.n_blades)
    }

    /// Revolutions a second between `span` (s): of the rotor, and of the helix with its sense; none where it
    /// does not turn.
    pub(crate) fn rates(&self, span: [f64; 2]) -> Option<(f64, Option<(f64, Sense)>)> {
        let (start, end) = (self.at(span[0])?, self.at(span[1])?);
        let time = span[1] - span[0];
        let rotor = (end.0 - start.0) / (TAU * time);
        let helix = start.1.zip(end.1).map(|(a, b)| (b - a) / (TAU * time));
        let helix = helix.filter(|rate| rate.abs() > 1e-3 * rotor.abs()).map(|rate| {
            let sense = if rate > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
            (rate.abs(), sense)
        });
        (rotor > 0.0 && rotor.is_finite()).then_some((rotor, helix))
    }
}

/// That the rows of the table at `path` are so near that `rotor` (rad, not wrapped) is told between them.
fn dense(path: &Path, rotor: &[f64], fix: &str) -> Result<(), PostprocessingError> {
    let turned: f64 = rotor.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let step = turned / (rotor.len().max(2) - 1) as f64;
    if step <= MOST_STEP {
        return Ok(());
    }
    let step = step.to_degrees();
    let problem =
        format!("has a row each {step:.0}° of the rotor, between which its azimuth is not told");
    Err(refused(path, problem, fix))
}

/// Azimuth of the helix that `pitch` of the blades makes at the azimuths `rotor` (rad), not wrapped; empty
/// where it makes none.
fn of_pitch(rotor: &[f64], pitch: &[&[f64]]) -> Vec<f64> {
    let mut squares = 0.0;
    let fixed: Vec<f64> = rotor
        .iter()
        .enumerate()
        .map(|(row, azimuth)| {
            let blades = PerBlade::from_fn(N_BLADES, |blade| pitch[blade][row]);
            let fixed = to_fixed_frame(*azimuth, &blades);
            squares += fixed.tilt.powi(2) + fixed.yaw.powi(2);
            helix_azimuth(fixed.tilt, fixed.yaw)
        })
        .collect();
    let amplitude = (squares / rotor.len().max(1) as f64).sqrt();
    if amplitude < LEAST_PITCH { Vec::new() } else { unwrapped(&fixed) }
}

/// `angles` (rad) without the jumps of a turn.
fn unwrapped(angles: &[f64]) -> Vec<f64> {
    let mut last = angles.first().copied().unwrap_or(0.0);
    let step = |angle: &f64| {
        last += wrap_to_half_turn(angle - last);
        last
    };
    angles.iter().map(step).collect()
}
