//! What OpenFAST's users expect of a turbine: one `.outb` file, with the channels of its series.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::Stored;
use super::series;
use crate::channels;
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::channels::WIND;
use basis::keys::Values;
use farm::case::Run;
use formats::FileError;
use formats::openfast_output::{Encoding, Layout, OutbWriter};
use formats::records::{RunFolder, SeriesFile};
use formats::table::Column;
use std::collections::BTreeSet;

/// What OpenFAST calls the wind at a point; the series have it of no turbine.
const WIND_NAMES: [&str; 3] = ["Wind1VelX", "Wind1VelY", "Wind1VelZ"];

/// Bytes of a value in the file, and in the rows that gather beside the file of one turbine at a time.
const VALUE_BYTES: u64 = size_of::<i16>() as u64;
const GATHERED_BYTES: u64 = size_of::<f64>() as u64;
/// Bytes of a channel above the rows: name, unit, range.
const HEADER_BYTES: u64 = 56;

pub(super) static KIND: OutputKind =
    OutputKind { name: "outb", keys: Keys::OfOutput(&[]), fed_by: FedBy::AnyFlow, disk, begin };

fn disk(setup: &Prepared, run: &Run, _: &Values) -> u64 {
    let n_rows = series::n_rows(setup);
    let n_wind = WIND.len() as u64;
    let of_turbines = channels::of_turbines(setup, run);
    let n_channels: u64 = of_turbines.iter().map(|own| own + n_wind).sum();
    let most = of_turbines.iter().map(|own| own + n_wind).max().unwrap_or(0);
    n_rows * row_bytes(setup, run) + n_channels * HEADER_BYTES + most * n_rows * GATHERED_BYTES
}

/// Bytes that a row of the series takes in the files of all turbines of `run`.
pub(crate) fn row_bytes(setup: &Prepared, run: &Run) -> u64 {
    let own = channels::of_turbines(setup, run).into_iter();
    own.map(|own| (own + WIND.len() as u64) * VALUE_BYTES).sum()
}

struct Outb;

fn begin(_scene: &Scene, _stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    Ok(Some(Box::new(Outb)))
}

impl Output for Outb {
    fn schedule(&self) -> Schedule {
        Schedule::at_the_end()
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let turbines = &mut scene.run.present();
        turbines.try_for_each(|index| write(scene.setup, scene.run, scene.folder, index))
    }
}

/// Writes `TURBINE.outb` into `folder`, from the run's complete series, for turbine number `index` of the
/// case.
///
/// The format has finite numbers alone: a channel that was anything else at any time is left out.
fn write(setup: &Prepared, run: &Run, folder: &RunFolder, index: usize) -> Result<(), StudyError> {
    let turbine = setup.case.turbines[index].name.as_str();
    let series = SeriesFile::open(&folder.series_path())?;
    let mut left_out = BTreeSet::new();
    loop {
        let is_in = |name: &str| name_of(name, turbine).is_some() && !left_out.contains(name);
        let chosen: Vec<(&str, Column)> = series
            .names()
            .iter()
            .zip(series.units())
            .filter(|(name, _)| is_in(name))
            .filter_map(|(ours, unit)| {
                let name = name_of(ours, turbine)?.to_owned();
                Some((ours.as_str(), Column { name, unit: unit.symbol().to_owned() }))
            })
            .collect();
        let layout = Layout {
            description: format!("wakemix, case {}, run {}", setup.case.name, run.name),
            channels: chosen.iter().map(|(_, column)| column.clone()).collect(),
            start: 0.0,
            interval: setup.plan.row_interval(),
        };
        let path = folder.path().join(format!("{turbine}.outb"));
        let mut writer = OutbWriter::create(&path, layout, Encoding::Compressed)?;
        let written = series.each_row(is_in, |row| {
            match row.iter().position(|value| !OutbWriter::holds(*value)) {
                Some(place) => Err(Stop::NotFinite(chosen[place].0.to_owned())),
                None => Ok(writer.write(row)?),
            }
        });
        match written {
            Ok(()) => return Ok(writer.finish()?),
            Err(Stop::NotFinite(name)) => left_out.insert(name),
            Err(Stop::File(error)) => return Err(error.into()),
        };
    }
}

/// The name in the file of `turbine` of what the series calls `name`; none of what is another's.
fn name_of<'a>(name: &'a str, turbine: &str) -> Option<&'a str> {
    let wind = WIND.iter().position(|wind| wind.name == name);
    let own = || name.strip_prefix(turbine)?.strip_prefix('.');
    wind.map(|place| WIND_NAMES[place]).or_else(own)
}

/// Why rows end before the last.
enum Stop {
    /// The channel of this name was not a finite number.
    NotFinite(String),
    File(FileError),
}

impl From<FileError> for Stop {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}
