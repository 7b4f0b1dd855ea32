//! A precursor that goes on beside its study, so that its air comes in while it moves.

use super::air_box::{AirBox, Drive};
use crate::air::{Air, FarmFlow};
use basis::records::Filaments;
use basis::{Answer, PointForce, Vector3};
use flow::fields::FieldSource;
use flow::lattice::Lattice;
use flow::{FlowError, FlowSolver, Inflow, WindField};
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

/// Places that are looked at together (–).
const AT_ONCE: usize = 64;

/// Air of a box as the wind that enters a study, whose origin lies in the middle of the box.
///
/// When the study asks for a time, the box goes on to the step that is next to it; what is left, half a step
/// at most, the mean wind carries. So times may only grow: a solver asks once for each, all its threads
/// before the next.
pub struct Companion {
    inner: RwLock<Inner>,
    /// Direction along which x of the study points, towards east and north (–).
    along: [f64; 2],
    /// Mean speed along it at hub height (m/s).
    speed: f64,
    /// Time of the box at which that of the study begins (s).
    begin: f64,
    /// Step of the box (s).
    step: f64,
}

struct Inner {
    air: AirBox,
    /// Why it could not go on.
    failed: Option<FlowError>,
}

impl Companion {
    /// The wind of `air`, as it stands now, along the direction `along` (towards east and north), where its
    /// mean is `speed` (m/s).
    pub fn new(air: AirBox, along: [f64; 2], speed: f64) -> Self {
        let lattice = air.air();
        let (begin, step) = (lattice.time(), lattice.scaling().interval());
        Self { inner: RwLock::new(Inner { air, failed: None }), along, speed, begin, step }
    }

    fn read(&self) -> RwLockReadGuard<'_, Inner> {
        self.inner.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn write(&self) -> RwLockWriteGuard<'_, Inner> {
        self.inner.write().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the box is to make a step before it is looked at for `time` (s) of the study.
    fn is_behind(&self, inner: &Inner, time: f64) -> bool {
        inner.failed.is_none() && inner.air.air().time() + 0.5 * self.step < self.begin + time
    }

    /// The box, at the step next to `time` (s) of the study, or where it could not go on.
    fn at(&self, time: f64) -> RwLockReadGuard<'_, Inner> {
        if self.is_behind(&self.read(), time) {
            let mut inner = self.write();
            // Another thread may have been here.
            while self.is_behind(&inner, time) {
                inner.failed = inner.air.step().err();
            }
        }
        self.read()
    }

    /// Hands `ask` the box at the step next to `time` (s) of the study, with places in it of some of
    /// `positions` and as many of `values`, until all were asked for.
    fn each<Value>(
        &self,
        time: f64,
        positions: &[Vector3],
        values: &mut [Value],
        mut ask: impl FnMut(&Lattice, &[Vector3], &mut [Value]),
    ) {
        let inner = self.at(time);
        let air = inner.air.air();
        let carried = self.speed * (self.begin + time - air.time());
        let [east, north] = self.along;
        let mut places = [Vector3::ZERO; AT_ONCE];
        for (positions, values) in positions.chunks(AT_ONCE).zip(values.chunks_mut(AT_ONCE)) {
            for (place, position) in places.iter_mut().zip(positions) {
                let (x, y) = (position.x - carried, position.y);
                *place = Vector3::new(x * east - y * north, x * north + y * east, position.z);
            }
            ask(air, &places[..positions.len()], values);
        }
    }

    /// Why the box could not go on, where it could not.
    fn failure(&self) -> Option<FlowError> {
        self.read().failed.clone()
    }

    fn write_state(&self, writer: &mut dyn Write) -> Result<()> {
        let mut inner = self.write();
        let drive = inner.air.drive();
        let control = drive.control.unwrap_or([f64::NAN; 2]);
        for value in drive.geostrophic.into_iter().chain(control) {
            writer.write_all(&value.to_le_bytes())?;
        }
        inner.air.air_mut().write_state(writer)
    }

    fn read_state(&self, reader: &mut dyn Read) -> Result<()> {
        let mut values = [0.0; 4];
        for value in &mut values {
            let mut bytes = [0; 8];
            reader.read_exact(&mut bytes)?;
            *value = f64::from_le_bytes(bytes);
        }
        let [east, north, control @ ..] = values;
        let mut inner = self.write();
        inner.air.air_mut().read_state(reader)?;
        let control = control[0].is_finite().then_some(control);
        inner.air.restore(Drive { geostrophic: [east, north], control });
        inner.failed = None;
        Ok(())
    }
}

impl Inflow for Companion {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let [east, north] = self.along;
        self.each(time, positions, velocities, |air, places, velocities| {
            air.sample(places, velocities);
            for wind in velocities {
                let Vector3 { x, y, z } = *wind;
                *wind = Vector3::new(x * east + y * north, y * east - x * north, z);
            }
        });
    }

    fn sample_temperature(
        &self,
        time: f64,
        positions: &[Vector3],
        temperatures: &mut [f64],
    ) -> bool {
        let mut is_told = true;
        self.each(time, positions, temperatures, |air, places, temperatures| {
            is_told &= air.sample_temperature(places, temperatures);
        });
        is_told
    }
}

/// Air that the wind of a [`Companion`] enters, which goes on and is kept with it.
pub struct Accompanied {
    air: Air,
    companion: Arc<Companion>,
}

impl Accompanied {
    /// `air`, into which the wind of `companion` blows.
    pub fn new(air: Air, companion: Arc<Companion>) -> Self {
        Self { air, companion }
    }
}

impl WindField for Accompanied {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.air.sample(positions, velocities);
    }
}

impl FlowSolver for Accompanied {
    fn advance(
        &mut self,
        duration: f64,
        forces: &[PointForce],
    ) -> std::result::Result<(), FlowError> {
        self.air.advance(duration, forces)?;
        self.companion.failure().map_or(Ok(()), Err)
    }

    fn resolves_induction(&self) -> bool {
        self.air.resolves_induction()
    }

    fn answer(&self, turbine: usize) -> Option<Answer<'_>> {
        self.air.answer(turbine)
    }
}

impl FarmFlow for Accompanied {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        if let Some(error) = self.companion.failure() {
            return Err(Error::new(ErrorKind::InvalidData, error));
        }
        self.companion.write_state(writer)?;
        self.air.write_state(writer)
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        self.companion.read_state(reader)?;
        self.air.read_state(reader)
    }

    fn check(&mut self) -> std::result::Result<(), FlowError> {
        self.companion.write().air.air_mut().check()?;
        self.air.check()
    }

    fn fields(&self) -> Option<&dyn FieldSource> {
        self.air.fields()
    }

    fn filaments(&self) -> Option<Filaments> {
        self.air.filaments()
    }

    fn elements_in_cores(&self, machine: usize) -> [u64; 2] {
        self.air.elements_in_cores(machine)
    }

    fn reach_full_cost(&mut self) {
        self.air.reach_full_cost();
    }

    fn backend(&self) -> &'static str {
        self.air.backend()
    }

    fn n_threads(&self) -> usize {
        self.air.n_threads()
    }

    fn memory(&self) -> u64 {
        self.air.memory() + self.companion.read().air.air().memory()
    }
}
