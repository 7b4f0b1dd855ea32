//! The air of a farm, whatever moves it.

use basis::records::Filaments;
use flow::fields::FieldSource;
use flow::inflow::PrescribedWind;
use flow::inflow::prescribed::Clock;
use flow::lattice::Lattice;
use flow::lattice::refinement::Refined;
use flow::vortex::FreeWake;
use flow::{FlowError, FlowSolver};
use std::io::{Error, ErrorKind, Read, Result, Write};

/// A flow in which a farm can stand: it goes on from a checkpoint, and may be looked at.
pub trait FarmFlow: FlowSolver + Send + Sync {
    /// Writes everything that time has changed; a flow made alike that [reads](Self::read_state) it goes on
    /// with the same bits.
    ///
    /// # Errors
    /// Those of `writer`, and [`ErrorKind::InvalidData`] when the flow is no longer valid.
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()>;

    /// Goes on from what [`write_state`](Self::write_state) wrote.
    ///
    /// # Errors
    /// Those of `reader`, and [`ErrorKind::InvalidData`] when it is no state of such a flow.
    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()>;

    /// Looks at all of it.
    ///
    /// # Errors
    /// [`FlowError`] when it cannot go on.
    fn check(&mut self) -> std::result::Result<(), FlowError> {
        Ok(())
    }

    /// The flow as a source of planes and volumes; none where it has none to give.
    fn fields(&self) -> Option<&dyn FieldSource> {
        None
    }

    /// The vortices of its wakes; none where it has none to give.
    fn filaments(&self) -> Option<Filaments> {
        None
    }

    /// Blade elements of machine number `machine` that stand in the cores of other turbines' vortices, and
    /// all of its elements (–); none of none where there are no such things.
    fn elements_in_cores(&self, _machine: usize) -> [u64; 2] {
        [0; 2]
    }

    /// On return a step costs as much as one does once wakes have their length. What blows is then no wind
    /// of the case: this is for timing alone. Air whose steps cost all the same stays as it is.
    fn reach_full_cost(&mut self) {}

    /// What of the machine decides its bits beside [`flow::numerics`], such as `avx512`; empty where nothing
    /// does.
    fn backend(&self) -> &'static str {
        ""
    }

    /// Threads that it runs on (–).
    fn n_threads(&self) -> usize {
        1
    }

    /// Memory of its field (bytes).
    fn memory(&self) -> u64 {
        0
    }
}

/// What moves the air of a farm.
pub type Air = Box<dyn FarmFlow>;

impl FarmFlow for Lattice {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        Self::write_state(self, writer)
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        Self::read_state(self, reader)
    }

    fn check(&mut self) -> std::result::Result<(), FlowError> {
        Self::check(self)
    }

    fn fields(&self) -> Option<&dyn FieldSource> {
        Some(self)
    }

    fn backend(&self) -> &'static str {
        Lattice::backend(self)
    }

    fn n_threads(&self) -> usize {
        Self::n_threads(self)
    }

    fn memory(&self) -> u64 {
        Self::memory(self)
    }
}

impl FarmFlow for Refined {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        Self::write_state(self, writer)
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        Self::read_state(self, reader)
    }

    fn check(&mut self) -> std::result::Result<(), FlowError> {
        Self::check(self)
    }

    fn fields(&self) -> Option<&dyn FieldSource> {
        Some(self)
    }

    fn backend(&self) -> &'static str {
        self.base().backend()
    }

    fn n_threads(&self) -> usize {
        self.base().n_threads()
    }

    fn memory(&self) -> u64 {
        Self::memory(self)
    }
}

impl FarmFlow for FreeWake {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        Self::write_state(self, writer)
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        Self::read_state(self, reader)
    }

    fn fields(&self) -> Option<&dyn FieldSource> {
        Some(self)
    }

    fn filaments(&self) -> Option<Filaments> {
        Some(Self::filaments(self))
    }

    fn elements_in_cores(&self, machine: usize) -> [u64; 2] {
        Self::elements_in_cores(self, machine)
    }

    fn reach_full_cost(&mut self) {
        self.reach_full_length();
    }

    fn backend(&self) -> &'static str {
        Self::backend(self)
    }

    fn n_threads(&self) -> usize {
        Self::n_threads(self)
    }

    fn memory(&self) -> u64 {
        Self::memory(self)
    }
}

impl FarmFlow for PrescribedWind {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        writer.write_all(&self.state().to_bytes())
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut bytes = [0; 24];
        reader.read_exact(&mut bytes)?;
        self.restore(Clock::from_bytes(bytes))
            .map_err(|error| Error::new(ErrorKind::InvalidData, error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::PlaneAxes;
    use basis::{PointForce, Vector3};
    use flow::WindField;
    use flow::inflow::MeanProfile;
    use flow::lattice::LatticeSettings;
    use std::sync::Arc;

    const SPEED: f64 = 8.0;
    const INTERVAL: f64 = 0.2;

    fn profile() -> Arc<MeanProfile> {
        Arc::new(MeanProfile::PowerLaw { hub_height: 100.0, speed: SPEED, exponent: 0.2 })
    }

    fn prescribed() -> Air {
        Box::new(PrescribedWind::everywhere(profile()))
    }

    fn resolved() -> Air {
        let settings = LatticeSettings::new(Vector3::ZERO, 20.0, [16, 12, 12], INTERVAL, SPEED);
        Box::new(Lattice::new(settings, profile()).expect("such air can be"))
    }

    fn points() -> [Vector3; 3] {
        [70.0, 100.0, 130.0].map(|height| Vector3::new(160.0, 110.0, height))
    }

    fn wind(air: &Air) -> [Vector3; 3] {
        let mut wind = [Vector3::ZERO; 3];
        air.sample(&points(), &mut wind);
        wind
    }

    /// Winds after two seconds in which something pulls at the air upstream of the points.
    fn wind_behind_a_pull(air: &mut Air) -> [Vector3; 3] {
        let position = Vector3::new(140.0, 110.0, 100.0);
        let force = PointForce::of_body(position, Vector3::X * -4e5, 40.0);
        for _ in 0..10 {
            air.advance(INTERVAL, &[force]).expect("it stays finite");
        }
        wind(air)
    }

    #[test]
    fn prescribed_wind_blows_whatever_pulls_at_it() {
        let mut air = prescribed();
        assert!(air.fields().is_none() && !air.resolves_induction());
        for (wind, point) in wind(&air).iter().zip(points()) {
            let expected = SPEED * (point.z / 100.0).powf(0.2);
            assert!((*wind - Vector3::X * expected).length() < 1e-12, "{wind}");
        }
        let before = wind(&air);
        assert_eq!(wind_behind_a_pull(&mut air), before);
    }

    #[test]
    fn resolved_flow_feels_what_pulls_at_it() {
        let mut air = resolved();
        assert!(air.resolves_induction());
        let before = wind(&air);
        let after = wind_behind_a_pull(&mut air);
        assert!(after[1].x < before[1].x - 0.1, "{} {}", after[1], before[1]);
        // Its planes are those of the same instant: the point lies half-way between two rows of cells.
        let fields = air.fields().expect("it has fields");
        let mut plane = fields.plane("here", PlaneAxes::Horizontal, 100.0);
        assert!((plane.time - 2.0).abs() < 1e-12);
        let at = |plane: &basis::records::Plane| plane.velocity[0][5 * 16 + 7..][..2].to_vec();
        let mean = 0.5 * (at(&plane)[0] + at(&plane)[1]);
        assert!((f64::from(mean) - after[1].x).abs() < 1e-5, "{mean} {}", after[1]);
        let then = plane.clone();
        plane.velocity[0].fill(0.0);
        fields.refresh(&mut plane);
        assert_eq!(plane, then);
    }

    #[test]
    fn a_flow_goes_on_from_what_it_wrote() {
        for make in [prescribed, resolved] {
            let mut air = make();
            wind_behind_a_pull(&mut air);
            let mut bytes = Vec::new();
            air.write_state(&mut bytes).expect("a sound state");
            let mut other = make();
            other.read_state(&mut bytes.as_slice()).expect("what was written");
            assert_eq!(wind_behind_a_pull(&mut other), wind_behind_a_pull(&mut air));
            let mut again = [Vec::new(), Vec::new()];
            air.write_state(&mut again[0]).expect("a sound state");
            other.write_state(&mut again[1]).expect("a sound state");
            assert!(again[0] == again[1] && again[0] != bytes);
            assert!(other.read_state(&mut &bytes[..bytes.len() - 1]).is_err());
        }
    }
}
