//! The series: one row a control instant or every few of them, all turbines, `series.csv`.

use super::lines::{self, WindLines};
use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::channels::{self, Row};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use basis::{Channel, Commands, Truth, Vector3};
use farm::case::Run;
use farm::{Air, Farm, Recorder};
use flow::WindField;
use formats::records::SeriesWriter;
use std::path::PathBuf;

/// Distance of the wind probe upstream of the first turbine (rotor diameters), or halfway to the inlet if
/// nearer.
const PROBE_DISTANCE: f64 = 2.0;
/// Bytes of a value in the file, its comma included: 16 or 17 digits, point and sign; small numbers have an
/// exponent, round ones fewer digits.
const VALUE_BYTES: u64 = 20;
/// Bytes of the name of a channel, about.
const NAME_BYTES: u64 = 28;

pub(super) static KIND: OutputKind = OutputKind {
    name: "series",
    keys: Keys::OfOutput(&["interval", "lines_at"]),
    fed_by: FedBy::AnyFlow,
    disk,
    begin,
};

/// The steps in which a row is due.
pub(crate) fn schedule(setup: &Prepared) -> Schedule {
    Schedule::steps(setup.plan.row_stride)
}

/// Rows in the series of a run (–).
pub(crate) fn n_rows(setup: &Prepared) -> u64 {
    schedule(setup).count(setup.plan.n_steps)
}

/// Channels in the series of `run` (–).
pub(crate) fn n_channels(setup: &Prepared, run: &Run) -> u64 {
    channels::count(setup, run, lines::count(setup, run))
}

/// Bytes that a row of the series of `run` takes.
pub(crate) fn row_bytes(setup: &Prepared, run: &Run) -> u64 {
    n_channels(setup, run) * VALUE_BYTES
}

fn disk(setup: &Prepared, run: &Run, _: &Values) -> u64 {
    n_rows(setup) * row_bytes(setup, run) + n_channels(setup, run) * NAME_BYTES
}

struct Series {
    schedule: Schedule,
    rows: Rows,
    writer: SeriesWriter,
}

/// Point at hub height where the realised wind is measured (m): upstream of the first turbine, and of those
/// in whose wakes it may stand; in prescribed wind at it.
fn probe(setup: &Prepared) -> Vector3 {
    let plan = &setup.plan;
    let foot = plan.positions[0];
    if !setup.case.flow.solver.resolves_induction {
        return Vector3::new(foot.x, foot.y, plan.hub_height);
    }
    // With another direction of the wind another turbine is the foremost.
    let beside = |other: &&Vector3| (other.y - foot.y).abs() < plan.diameter;
    let foremost = plan.positions.iter().filter(beside).map(|other| other.x).fold(foot.x, f64::min);
    let distance = (PROBE_DISTANCE * plan.diameter).min(0.5 * (foremost - plan.origin.x));
    Vector3::new(foremost - distance, foot.y, plan.hub_height)
}

/// The rows of a series, one at a time.
pub(crate) struct Rows {
    row: Row,
    /// Where the arriving wind is read (m).
    probe: Vector3,
    lines: Vec<WindLines>,
}

impl Rows {
    /// The rows of `run`, whose turbines are those of `farm`.
    pub(crate) fn new(setup: &Prepared, run: &Run, farm: &Farm<Air>) -> Self {
        let lines = lines::of(setup, run);
        let places: Vec<&str> = lines.iter().map(|lines| lines.name.as_str()).collect();
        let names = run.present().map(|index| setup.case.turbines[index].name.as_str());
        let row = Row::new(names.zip(farm.machines()), &places);
        Self { row, probe: probe(setup), lines }
    }

    /// The channels, in the order of the columns.
    pub(crate) fn channels(&self) -> &[Channel] {
        self.row.channels()
    }

    /// Starts the row of the step that `farm` is about to make.
    pub(crate) fn start(&mut self, farm: &Farm<Air>) {
        let mut wind = [Vector3::ZERO];
        farm.flow().sample(&[self.probe], &mut wind);
        self.row.start(farm.time(), wind[0]);
        for (index, machine) in farm.machines().iter().enumerate() {
            self.row.loads(index, &machine.turbine);
        }
        for (index, lines) in self.lines.iter_mut().enumerate() {
            self.row.lines(index, lines.wind(farm.flow()));
        }
    }

    /// The row in SI units, once `farm` has made the step.
    pub(crate) fn complete(&mut self, farm: &Farm<Air>) -> &[f64] {
        for (index, machine) in farm.machines().iter().enumerate() {
            self.row.signals(index, machine);
        }
        self.row.values()
    }
}

impl Recorder for Rows {
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        self.row.record(turbine, truth, commands);
    }
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, folder, farm, .. } = *scene;
    let rows = Rows::new(setup, run, farm);
    let writer = match stored {
        // So many bytes of it are sure.
        Some(stored) => {
            SeriesWriter::resume(&folder.series_path(), rows.channels(), stored.state()?)?
        }
        None => SeriesWriter::create(&folder.series_path(), rows.channels())?,
    };
    Ok(Some(Box::new(Series { schedule: schedule(setup), rows, writer })))
}

impl Output for Series {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn before_step(&mut self, scene: &Scene) {
        self.rows.start(scene.farm);
    }

    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        self.rows.record(turbine, truth, commands);
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        Ok(self.writer.write(self.rows.complete(scene.farm))?)
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let n_bytes: u64 = self.writer.flush()?;
        section.keep(&n_bytes)
    }

    fn salvage(&mut self) -> Option<PathBuf> {
        self.writer.flush().ok().map(|_| self.writer.part_path().to_owned())
    }

    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        Ok(self.writer.finish()?)
    }
}
