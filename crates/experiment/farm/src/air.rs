//! The air of a farm: solved, or prescribed.

use basis::{PointForce, Vector3};
use flow::inflow::PrescribedWind;
use flow::lattice::Lattice;
use flow::{FlowError, FlowSolver, WindField};

/// One of the ways to have wind.
pub enum Air {
    /// Solved: it feels the rotors.
    Lattice(Box<Lattice>),
    /// Prescribed: it blows as it is told.
    Prescribed(Box<PrescribedWind>),
}

impl Air {
    /// The lattice, where the air is solved: planes and volumes come from it.
    pub fn lattice(&self) -> Option<&Lattice> {
        match self {
            Self::Lattice(lattice) => Some(lattice),
            Self::Prescribed(_) => None,
        }
    }
}

impl WindField for Air {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        match self {
            Self::Lattice(air) => air.sample(positions, velocities),
            Self::Prescribed(air) => air.sample(positions, velocities),
        }
    }
}

impl FlowSolver for Air {
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError> {
        match self {
            Self::Lattice(air) => air.advance(duration, forces),
            Self::Prescribed(air) => air.advance(duration, forces),
        }
    }

    fn resolves_induction(&self) -> bool {
        match self {
            Self::Lattice(air) => air.resolves_induction(),
            Self::Prescribed(air) => air.resolves_induction(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flow::inflow::MeanProfile;
    use flow::lattice::Settings;
    use std::sync::Arc;

    const SPEED: f64 = 8.0;
    const INTERVAL: f64 = 0.2;

    fn profile() -> Arc<MeanProfile> {
        Arc::new(MeanProfile::PowerLaw { hub_height: 100.0, speed: SPEED, exponent: 0.2 })
    }

    fn prescribed() -> Air {
        Air::Prescribed(Box::new(PrescribedWind::everywhere(profile())))
    }

    fn solved() -> Air {
        let settings = Settings::new(Vector3::ZERO, 20.0, [16, 12, 12], INTERVAL, SPEED);
        Air::Lattice(Box::new(Lattice::new(settings, profile()).expect("such air can be")))
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
    fn prescribed_wind_blows_as_it_is_told() {
        let mut air = prescribed();
        assert!(air.lattice().is_none() && !air.resolves_induction());
        for (wind, point) in wind(&air).iter().zip(points()) {
            let expected = SPEED * (point.z / 100.0).powf(0.2);
            assert!((*wind - Vector3::X * expected).length() < 1e-12, "{wind}");
        }
        let before = wind(&air);
        assert_eq!(wind_behind_a_pull(&mut air), before);
        let Air::Prescribed(wind) = &air else { panic!("it is prescribed") };
        assert!((wind.time() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn solved_air_feels_what_pulls_at_it() {
        let mut air = solved();
        assert!(air.lattice().is_some() && air.resolves_induction());
        let before = wind(&air);
        let mut direct = [Vector3::ZERO; 3];
        air.lattice().expect("it is solved").sample(&points(), &mut direct);
        assert_eq!(before, direct);
        let after = wind_behind_a_pull(&mut air);
        assert!(after[1].x < before[1].x - 0.1, "{} {}", after[1], before[1]);
        assert!((air.lattice().expect("it is solved").time() - 2.0).abs() < 1e-12);
    }
}
