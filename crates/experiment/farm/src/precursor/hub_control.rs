//! The control that holds the mean wind at hub height by the pressure gradient.

use std::array;

/// Rate at which a departure dies, over |f| (–).
const RATE: f64 = 1.5;

/// Proportional-integral control of the geostrophic wind.
///
/// With winds as complex numbers, east + i north, a layer that is driven by the geostrophic wind G moves as
/// dU/dt = −i f (U − G) − r U: left to itself it swings about its balance with the inertial period 2π/f, and
/// only friction, r ≈ f/10, stills it. Of G = I + i k σ e with the departure e = U − U₀ from the wind that is
/// asked for and σ the sign of f, the second part pushes all heights alike against the departure, with the
/// force −k |f| e; a real gain would only change the period. With dI/dt = −q |f| e the departure obeys
///
/// s² + (iσ + k) |f| s + iσ q f² = 0
///
/// without friction, which makes one of them faster and the other slower, by 2 % where r = f/10. k = 2a and
/// q = a (1 − iσ a) put the roots at −a |f| and −(a + iσ) |f|: what was wrong with the pressure gradient
/// and the inertial oscillation die alike, by e in 1/(a |f|). Here a is 1.5: 1.6 h at 52°. A stronger hold
/// would take what the largest eddies do to the mean of the box for a departure, and the air above the
/// layer, which nothing but the pressure gradient moves, keeps the swing of every sudden change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubControl {
    /// U₀ towards east and north (m/s).
    wanted: [f64; 2],
    /// f (1/s).
    coriolis: f64,
    /// I towards east and north (m/s).
    integral: [f64; 2],
}

impl HubControl {
    /// A control that holds the wind `wanted` under the Coriolis parameter `coriolis` (1/s), and begins with
    /// the geostrophic wind `geostrophic`; winds towards east and north (m/s).
    pub fn new(wanted: [f64; 2], coriolis: f64, geostrophic: [f64; 2]) -> Self {
        Self { wanted, coriolis, integral: geostrophic }
    }

    /// The geostrophic wind (m/s) that drives the air next, after `duration` (s) in which the mean wind at
    /// hub height was about `wind` (m/s).
    pub fn update(&mut self, wind: [f64; 2], duration: f64) -> [f64; 2] {
        let [east, north]: [f64; 2] = array::from_fn(|axis| wind[axis] - self.wanted[axis]);
        let sign = self.coriolis.signum();
        let share = RATE * self.coriolis.abs() * duration;
        self.integral[0] -= share * (east + sign * RATE * north);
        self.integral[1] -= share * (north - sign * RATE * east);
        let gain = 2.0 * RATE * sign;
        [self.integral[0] - gain * north, self.integral[1] + gain * east]
    }

    /// Its state: I towards east and north (m/s).
    pub fn state(&self) -> [f64; 2] {
        self.integral
    }

    /// Goes on from a `state`.
    pub fn set_state(&mut self, state: [f64; 2]) {
        self.integral = state;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::Vector3;
    use flow::lattice::atmosphere::{Atmosphere, Driving};
    use flow::lattice::{Ends, Ground, Lattice, LatticeSettings};
    use flow::{FlowSolver, Inflow};
    use std::sync::Arc;

    /// The same wind everywhere.
    struct Even([f64; 2]);

    impl Inflow for Even {
        fn sample(&self, _: f64, _: &[Vector3], velocities: &mut [Vector3]) {
            velocities.fill(Vector3::new(self.0[0], self.0[1], 0.0));
        }
    }

    /// a b of complex numbers.
    fn times([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
        [a * c - b * d, a * d + b * c]
    }

    /// The departure of a layer without friction at `time`, that began `e` from the wind asked for, with a
    /// geostrophic wind off by `g`: A exp(−a|f|t) + B exp(−(a + iσ)|f|t) with A + B = e and its first change.
    fn departure(e: [f64; 2], g: [f64; 2], coriolis: f64, time: f64) -> [f64; 2] {
        let (sign, scaled) = (coriolis.signum(), coriolis.abs() * time);
        // e' = −(iσ + 2a) e + iσ g = −a A − (a + iσ) B, so that iσ A = −a e + iσ g.
        let a: [f64; 2] = array::from_fn(|axis| g[axis] + RATE * sign * [-e[1], e[0]][axis]);
        let b = [e[0] - a[0], e[1] - a[1]];
        let (s, c) = (-sign * scaled).sin_cos();
        let turned = times(b, [c, s]);
        array::from_fn(|axis| (-RATE * scaled).exp() * (a[axis] + turned[axis]))
    }

    #[test]
    fn air_settles_at_the_wind_that_is_asked_for_as_two_decays_without_a_swing() {
        // A day is seven minutes long; the ground slips, so that all heights move alike.
        for coriolis in [0.03, -0.03] {
            let (wanted, start, driven) = ([8.0, 1.0], [7.0, 0.0], [8.5, 3.0]);
            let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [6, 5, 4], 0.1, 8.0);
            settings.ends = Ends::Periodic;
            settings.ground = Ground::Slip;
            settings.threads = Some(1);
            let driving = Driving::Geostrophic(driven);
            settings.atmosphere = Some(Atmosphere { coriolis, driving, ..Atmosphere::new(290.0) });
            let mut air = Lattice::new(settings, Arc::new(Even(start))).unwrap();
            let mut control = HubControl::new(wanted, coriolis, driven);
            let minus = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
            let wind = |air: &Lattice| {
                let [east, north, _] = air.statistics_of(1..2)[0].velocity;
                [east, north]
            };
            for second in 1..=200 {
                let geostrophic = control.update(wind(&air), 1.0);
                assert!(air.drive(geostrophic));
                air.advance(1.0, &[]).unwrap();
                let found = minus(wind(&air), wanted);
                let time = f64::from(second);
                let expected =
                    departure(minus(start, wanted), minus(driven, wanted), coriolis, time);
                // A second is 0.03/f: the first order of its steps.
                let off = minus(found, expected);
                assert!(off[0].hypot(off[1]) < 0.08, "{time} s: {found:?}, not {expected:?}");
            }
            let left = minus(wind(&air), wanted);
            assert!(left[0].hypot(left[1]) < 0.01 * 8.0, "{left:?}");
        }
    }

    /// A column of air of 1280 m over a rough sea, mixed by a mixing length up to an inversion at 700 m.
    struct Column {
        winds: Vec<[f64; 2]>,
        coriolis: f64,
    }

    /// Height of a level, roughness length, height of the inversion, longest mixing length (m); step (s).
    const LEVEL: f64 = 20.0;
    const ROUGHNESS: f64 = 1e-3;
    const INVERSION: f64 = 700.0;
    const LONGEST: f64 = 40.0;
    const STEP: f64 = 10.0;

    impl Column {
        /// The wind `wind` (m/s) at 170 m, logarithmic below it, and `geostrophic` from the inversion on.
        fn new(wind: [f64; 2], geostrophic: [f64; 2], coriolis: f64) -> Self {
            let at = |index: u32| {
                let height = (f64::from(index) + 0.5) * LEVEL;
                let share = ((height - 170.0) / (INVERSION - 170.0)).clamp(0.0, 1.0);
                let below = ((height / ROUGHNESS).ln() / (170.0 / ROUGHNESS).ln()).min(1.0);
                array::from_fn(|axis| below * wind[axis] + share * (geostrophic[axis] - wind[axis]))
            };
            Self { winds: (0..64).map(at).collect(), coriolis }
        }

        fn at_hub(&self) -> [f64; 2] {
            array::from_fn(|axis| self.winds[8][axis])
        }

        fn step(&mut self, geostrophic: [f64; 2]) {
            let (s, c) = (self.coriolis * STEP).sin_cos();
            let at_ground = (0.4 / (0.5 * LEVEL / ROUGHNESS).ln()).powi(2);
            let lowest = self.winds[0];
            let mut flux = lowest.map(|wind| at_ground * lowest[0].hypot(lowest[1]) * wind);
            for index in 0..self.winds.len() {
                let height = (index + 1) as f64 * LEVEL;
                let length = 0.4 * height / (1.0 + 0.4 * height / LONGEST);
                let share = (1.0 - height / INVERSION).max(0.0).sqrt();
                let wind = self.winds[index];
                let above = self.winds.get(index + 1).copied().unwrap_or(wind);
                let shear: [f64; 2] = array::from_fn(|axis| (above[axis] - wind[axis]) / LEVEL);
                let mixing = share * length * length * shear[0].hypot(shear[1]);
                let next = shear.map(|shear| mixing * shear);
                let [x, y] = array::from_fn(|axis| wind[axis] - geostrophic[axis]);
                let turned = [c * x + s * y, c * y - s * x];
                self.winds[index] = array::from_fn(|axis| {
                    geostrophic[axis] + turned[axis] + STEP / LEVEL * (next[axis] - flux[axis])
                });
                flux = next;
            }
        }
    }

    #[test]
    fn a_column_settles_where_it_would_swing() {
        // The geostrophic wind is off by a tenth and by some degrees at first.
        let (coriolis, wanted, first) = (1.1586e-4, [10.0, 0.0], [11.1, -2.9]);
        let speeds = |held: bool| -> Vec<f64> {
            let mut column = Column::new(wanted, first, coriolis);
            let mut control = HubControl::new(wanted, coriolis, first);
            let hour = |_: u32| {
                for _ in 0..360 {
                    let found = control.update(column.at_hub(), STEP);
                    column.step(if held { found } else { first });
                }
                let [east, north] = column.at_hub();
                if held { east.hypot(north) } else { east }
            };
            (1..=16).map(hour).collect()
        };
        let held = speeds(true);
        let off = |hours: &[f64]| -> f64 {
            hours.iter().map(|speed| (speed / 10.0 - 1.0).abs()).fold(0.0, f64::max)
        };
        assert!(off(&held) < 0.03 && off(&held[5..]) < 0.01 && off(&held[9..]) < 1e-3, "{held:?}");
        let free = speeds(false);
        let (low, high) = free.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), speed| {
            (low.min(*speed), high.max(*speed))
        });
        assert!(high - low > 0.8, "{free:?}");
    }

    #[test]
    fn a_control_goes_on_from_its_state() {
        let mut control = HubControl::new([9.0, 0.0], 1.2e-4, [10.0, -1.0]);
        // At the wind that is asked for nothing changes.
        assert_eq!(control.update([9.0, 0.0], 10.0), [10.0, -1.0]);
        control.update([9.5, 0.2], 10.0);
        let mut other = HubControl::new([9.0, 0.0], 1.2e-4, [3.0, 3.0]);
        other.set_state(control.state());
        assert_eq!(other.update([8.0, 0.0], 10.0), control.update([8.0, 0.0], 10.0));
    }
}
