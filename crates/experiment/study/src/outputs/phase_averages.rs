//! Planes and volumes averaged by rotor and helix azimuth while the run goes on: `averages-NAME-PLACE.nc`.
//!
//! A case asks for it by a name, `output.further.NAME = { kind = "phase-averages", … }`, as often as it
//! likes. Instants are taken in at the end of steps of the analysed time, at the azimuth of a turbine and,
//! where one has a helix, at the azimuth of the pitch that its blades delivered (van der Hoek et al. 2024,
//! Eq. 6).

mod keys;
mod places;
mod pressure;

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::error::StudyError;
use crate::prepared::Prepared;
use analysis::phases::{Bins, PhaseAverager, PhaseError, helix_azimuth};
use basis::keys::Values;
use basis::mbc::to_fixed_frame;
use basis::records::{FieldSetting, Warning, WarningKind};
use basis::{FixedFrame, Truth};
use farm::case::Run;
use formats::records::{phase_averages_bytes, write_phase_averages};
use keys::{OWN, Wanted};
use places::{Place, Taken};
use pressure::MeanPressure;

pub(super) static KIND: OutputKind = OutputKind {
    name: "phase-averages",
    keys: Keys::Own(&OWN),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

/// Bins are filled evenly enough to be told of as they are when none has fewer instants than this (–).
const FEWEST_INSTANTS: u64 = 10;

/// All places and bins that `values` ask for in `run`; none where bins cannot be made.
fn sizes(setup: &Prepared, run: &Run, values: &Values) -> Option<(Vec<Place>, Bins)> {
    let wanted = Wanted::of(setup, run, values)?;
    Some((places::of(&setup.plan, values), wanted.bins.ok()?))
}

/// Memory of the sums at `n_points` points in `bins`, those of pressure included (bytes).
fn sums_of(n_points: u64, bins: &Bins) -> u64 {
    PhaseAverager::memory(n_points, bins) + MeanPressure::memory(n_points)
}

/// Memory (bytes) that the phase averages of a run of `setup` take, at most: sums, once more where they are
/// read from a checkpoint, and the wind of now.
pub(crate) fn memory(setup: &Prepared) -> u64 {
    let of_run = |run: &Run| {
        let further = setup.case.output.further.iter().filter(|one| one.kind.name() == KIND.name);
        let sizes = further.filter_map(|one| sizes(setup, run, &one.values));
        let of_one = |(places, bins): (Vec<Place>, Bins)| {
            let of_place = |place: &Place| 2 * sums_of(place.n_points(), &bins) + place.buffers();
            places.iter().map(of_place).sum::<u64>()
        };
        sizes.map(of_one).sum()
    };
    setup.case.runs.iter().map(of_run).max().unwrap_or(0)
}

/// Files, and the sums in two checkpoints.
fn disk(setup: &Prepared, run: &Run, values: &Values) -> u64 {
    let Some((places, bins)) = sizes(setup, run, values) else { return 0 };
    let of_place = |place: &Place| {
        let n = place.n_points();
        phase_averages_bytes(n, bins.len() as u64) + 2 * sums_of(n, &bins)
    };
    places.iter().map(of_place).sum()
}

struct PhaseAverages {
    schedule: Schedule,
    /// Machine whose azimuths count.
    machine: usize,
    places: Vec<Averaged>,
}

/// A plane or a volume, and its sums.
struct Averaged {
    taken: Taken,
    velocity: PhaseAverager,
    /// Of volumes whose pressure the flow knows: budgets ask for it.
    pressure: Option<MeanPressure>,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, values, .. } = *scene;
    let Some(fields) = scene.farm.flow().fields() else { return Ok(None) };
    let Some(wanted) = Wanted::of(setup, run, values) else { return Ok(None) };
    let bins = wanted.bins?;
    let mut sums: Option<std::vec::IntoIter<(PhaseAverager, Option<MeanPressure>)>> =
        stored.map(|stored| stored.state::<Vec<_>>()).transpose()?.map(Vec::into_iter);
    let mut places = Vec::new();
    for place in places::of(&setup.plan, values) {
        let taken = Taken::begin(place, fields);
        let new = || taken.has_pressure().then(|| MeanPressure::new(taken.grid().len()));
        let (velocity, pressure) = match &mut sums {
            None => (PhaseAverager::new(*taken.grid(), bins), new()),
            Some(sums) => sums
                .next()
                .filter(|(sums, _)| sums.grid() == taken.grid() && sums.bins() == &bins)
                .filter(|(_, pressure)| pressure.is_some() == taken.has_pressure())
                .ok_or(StudyError::OtherAverages)?,
        };
        places.push(Averaged { taken, velocity, pressure });
    }
    let schedule = Schedule::analysed(&setup.plan, wanted.interval);
    Ok(Some(Box::new(PhaseAverages { schedule, machine: wanted.machine, places })))
}

/// Azimuth of the rotor and, where its blades pitch cyclically, of their helix (rad).
fn azimuths(truth: &Truth) -> (f64, f64) {
    let FixedFrame { tilt, yaw, .. } = to_fixed_frame(truth.azimuth, &truth.pitch);
    (truth.azimuth, helix_azimuth(tilt, yaw))
}

impl Output for PhaseAverages {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let machine = scene.farm.machines().get(self.machine);
        let Some((fields, machine)) = scene.farm.flow().fields().zip(machine) else {
            return Ok(());
        };
        let time = scene.farm.time();
        let truth = machine.turbine.truth(time, scene.setup.plan.interval);
        let (rotor, helix) = azimuths(&truth);
        for place in &mut self.places {
            let (velocity, pressure) = place.taken.now(fields);
            place.velocity.add(time, rotor, Some(helix), velocity)?;
            if let (Some(sums), Some(pressure)) = (&mut place.pressure, pressure) {
                sums.add(pressure);
            }
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let sums = self.places.iter().map(|place| (&place.velocity, &place.pressure));
        section.keep(&sums.collect::<Vec<_>>())
    }

    fn warnings(&self, scene: &Scene) -> Vec<Warning> {
        let Some(place) = self.places.first() else { return Vec::new() };
        let bins = place.velocity.phase_bins();
        let few = bins.iter().filter(|bin| bin.n_instants < FEWEST_INSTANTS).count();
        let empty = bins.iter().filter(|bin| bin.n_instants == 0).count();
        let message = format!(
            "{}: {few} of {} bins of the phase averages {} hold fewer than {FEWEST_INSTANTS} instants, {empty} none; raise time.duration, lower interval, or widen helix_width_deg",
            scene.run.name,
            bins.len(),
            scene.name
        );
        let warning = Warning { kind: WarningKind::Setup, turbine: None, message };
        Vec::from_iter((few > 0).then_some(warning))
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let setting = setting(scene, self.machine);
        for Averaged { taken, velocity, pressure } in &self.places {
            let path =
                scene.folder.phase_averages_path(&format!("{}-{}", scene.name, taken.name()));
            let mut head = velocity.head();
            head.pressure = pressure.as_ref().map(MeanPressure::mean);
            write_phase_averages(&path, &setting, &head, |bin| velocity.bin(bin))?;
        }
        Ok(())
    }
}

/// What the averages are taken of: lengths count in diameters of the turbine whose azimuths count.
fn setting(scene: &Scene, machine: usize) -> FieldSetting {
    let Scene { setup, run, .. } = *scene;
    let index = run.present().nth(machine).unwrap_or(0);
    let definition = &setup.models[index].definition;
    let [x, y, z] = setup.plan.positions[index].to_array();
    FieldSetting {
        name: format!("{}, {}", setup.case.name, run.name),
        wind_speed: setup.case.wind.speed,
        turbulence_intensity: Some(setup.case.wind.turbulence_intensity),
        diameter: definition.rotor_diameter(),
        hub: [x, y, z + definition.rotor.hub_height],
    }
}

/// What is wrong with bins, at the door of a study.
impl From<PhaseError> for StudyError {
    fn from(error: PhaseError) -> Self {
        Self::Phases(error)
    }
}

#[cfg(test)]
mod tests;
