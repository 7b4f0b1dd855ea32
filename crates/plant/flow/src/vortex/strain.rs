//! What becomes of a filament's length, which its core's area follows.

use super::segment::{Cores, LAMB};
use basis::Vector3;

/// Least length over that at birth that still widens a core (–): a filament that has been folded up would be
/// as wide as the wake.
const SHORTEST: f64 = 0.25;

/// Length of a piece of filament since its birth.
///
/// A core that is stretched becomes thinner: its volume stays, and only viscosity adds to it. With r² l the
/// volume over π, d(r² l)/dt = 4 α δ ν l, so that r² l = r₀² l₀ + 4 α δ ν ∫ l dt.
/// Source: Ananthan and Leishman (2004), r²(t + Δt) l(t + Δt) = r² l, who let cores grow by the strain's
/// inverse. Limits: a filament counts as a quarter of its first length at the least.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Life {
    /// Length at birth (m).
    pub(super) at_birth: f64,
    /// Integral of the length over the time since (m s).
    pub(super) swept: f64,
}

impl Life {
    /// That of a piece of `length` (m) which comes into being at the mean `age` (s) of its ends.
    pub(super) fn new(length: f64, age: f64) -> Self {
        Self { at_birth: length, swept: length * age }
    }

    /// It lives on for `duration` (s) with `length` (m).
    pub(super) fn live(&mut self, length: f64, duration: f64) {
        self.swept += length * duration;
    }

    /// That of one piece of `length` (m) in the place of many of `lengths` (m) in all, whose lives sum up to
    /// this one; cores stay as they are.
    pub(super) fn joined(self, lengths: f64, length: f64) -> Self {
        let share = if lengths > 0.0 { length / lengths } else { 1.0 };
        Self { at_birth: share * self.at_birth, swept: share * self.swept }
    }

    /// Square of the core's radius (m²) that was `born` with such a square (m²), now that the piece has
    /// `length` (m) and `circulation` (m²/s).
    pub(super) fn core_squared(
        &self,
        cores: &Cores,
        born: f64,
        length: f64,
        circulation: f64,
    ) -> f64 {
        let viscosity = cores.kinematic_viscosity + cores.eddy_constant * circulation.abs();
        let volume = born * self.at_birth + 4.0 * LAMB * viscosity * self.swept;
        let length = length.max(SHORTEST * self.at_birth);
        if length > 0.0 { volume / length } else { born }
    }
}

impl Cores {
    /// Square of the radius (m²) of a core that was `born` with such a square (m²), now of `age` (s), on a
    /// piece of `length` (m) and `circulation` (m²/s) with such a `life`.
    pub(super) fn of(
        &self,
        born: f64,
        age: f64,
        length: f64,
        circulation: f64,
        life: &Life,
    ) -> f64 {
        if self.strain {
            life.core_squared(self, born, length, circulation)
        } else {
            self.squared(born, age, circulation)
        }
    }
}

impl std::ops::AddAssign for Life {
    fn add_assign(&mut self, other: Self) {
        self.at_birth += other.at_birth;
        self.swept += other.swept;
    }
}

/// Length of the closed line through `nodes` (m).
pub(super) fn around(nodes: &[Vector3]) -> f64 {
    let sides = nodes.windows(2).map(|ends| (ends[1] - ends[0]).length()).sum::<f64>();
    match nodes {
        [first, .., last] => sides + (*first - *last).length(),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORES: Cores = Cores {
        initial_widths: 0.25,
        kinematic_viscosity: 1.5e-5,
        eddy_constant: 1e-4,
        strain: true,
    };

    /// Core of a piece of unit length that is born with 0.04 m² after `time` (s) of stretching at `rate`
    /// (1/s), with a circulation of 20 m²/s.
    fn stretched(rate: f64, time: f64, cores: &Cores) -> f64 {
        let n = 2000;
        let interval = time / f64::from(n);
        let length = |step: i32| (rate * interval * f64::from(step)).exp();
        let mut life = Life::new(1.0, 0.0);
        for step in 0..n {
            life.live(length(step), 0.5 * interval);
            life.live(length(step + 1), 0.5 * interval);
        }
        life.core_squared(cores, 0.04, length(n), 20.0)
    }

    #[test]
    fn a_stretched_core_keeps_its_volume_and_grows_by_viscosity() {
        // Without viscosity r² l stays; with it d(r²)/dt = 4αδν − r² s under a steady strain s, whose end is
        // Burgers' vortex, r² = 4αδν/s.
        let inviscid = Cores { kinematic_viscosity: 0.0, eddy_constant: 0.0, ..CORES };
        let found = stretched(0.2, 5.0, &inviscid);
        assert!((found - 0.04 * (-1.0_f64).exp()).abs() < 1e-15, "{found}");
        let growth = 4.0 * LAMB * (1.5e-5 + 20.0 * 1e-4);
        for (rate, time) in [(0.2_f64, 5.0), (-0.2, 5.0), (0.5, 20.0)] {
            let decay = (-rate * time).exp();
            let expected = 0.04 * decay + growth / rate * (1.0 - decay);
            let found = stretched(rate, time, &CORES);
            // The trapezium's error: (rate × interval)²/12.
            assert!((found / expected - 1.0).abs() < 1e-5, "{rate} {found} {expected}");
        }
        assert!((stretched(0.5, 20.0, &CORES) / (growth / 0.5) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_filament_that_keeps_its_length_is_as_without_strain() {
        let mut life = Life::new(3.0, 0.05);
        life.live(3.0, 4.0);
        let found = life.core_squared(&CORES, 0.09, 3.0, -12.0);
        assert!((found - CORES.squared(0.09, 4.05, -12.0)).abs() < 1e-15);
    }

    #[test]
    fn joined_filaments_keep_their_cores_and_folded_ones_have_an_end() {
        let mut life = Life::new(2.0, 0.1);
        life.live(2.5, 3.0);
        let mut twice = life;
        twice += life;
        // Two pieces of 2.5 m become a chord of 4 m.
        let found = twice.joined(5.0, 4.0).core_squared(&CORES, 0.09, 4.0, 9.0);
        assert!((found - life.core_squared(&CORES, 0.09, 2.5, 9.0)).abs() < 1e-14);
        assert_eq!(
            life.core_squared(&CORES, 0.09, 0.0, 9.0),
            life.core_squared(&CORES, 0.09, 0.5, 9.0)
        );
    }
}
