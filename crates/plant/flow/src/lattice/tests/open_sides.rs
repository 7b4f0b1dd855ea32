//! Wind that blows through the sides of a box.

use super::*;
use crate::FlowSolver;
use crate::WindField;
use crate::lattice::atmosphere::{AirRow, Atmosphere, Heating};
use std::f64::consts::TAU;

const SPEED: f64 = 0.1;

/// A box of `n_cells` with open sides between inlet and outlet, in lattice units.
fn settings(n_cells: [usize; 3]) -> LatticeSettings {
    let mut settings = periodic_box(n_cells, 1e-6);
    (settings.ends, settings.sides) = (Ends::InletOutlet, Sides::Open);
    settings.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    settings
}

/// Wind of `SPEED` at `angle` (°) to the x axis.
fn aslant(angle: f64) -> Vector3 {
    let (sine, cosine) = angle.to_radians().sin_cos();
    SPEED * Vector3::new(cosine, sine, 0.0)
}

/// Largest departure of `air` from `wind` in the cells from `low` to before `high`.
fn departure(
    air: &Lattice,
    low: [usize; 3],
    high: [usize; 3],
    wind: impl Fn(Vector3) -> Vector3,
) -> f64 {
    let mut worst: f64 = 0.0;
    for z in low[2]..high[2] {
        for y in low[1]..high[1] {
            let positions: Vec<Vector3> =
                (low[0]..high[0]).map(|x| Vector3::new(x as f64, y as f64, z as f64)).collect();
            let mut velocities = vec![Vector3::ZERO; positions.len()];
            air.sample(&positions, &mut velocities);
            for (position, velocity) in positions.iter().zip(velocities) {
                worst = worst.max((velocity - wind(*position)).length());
            }
        }
    }
    worst
}

#[test]
fn a_wind_aslant_stays_one() {
    for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
        for angle in [15.0, -15.0, 0.0] {
            let n_cells = [40, 14, 5];
            let mut settings = settings(n_cells);
            (settings.ground, settings.stencil) = (Ground::Slip, stencil);
            let mut air = lattice(settings, move |_, _| aslant(angle));
            // Five times through the box.
            air.advance(2000.0, &[]).unwrap();
            let worst = departure(&air, [0; 3], n_cells, |_| aslant(angle));
            assert!(worst < 1e-5 * SPEED, "{stencil:?} {angle}: off by {worst}");
        }
    }
}

/// Wind that turns from −6° at the ground to 6° at the top of 20 levels.
fn veering(z: f64) -> Vector3 {
    aslant(-6.0 + 12.0 * z / 19.0)
}

#[test]
fn a_wind_that_veers_keeps_its_directions_up_to_the_sides() {
    let n_cells = [48, 16, 20];
    let mut settings = settings(n_cells);
    settings.ground = Ground::Slip;
    let mut air = lattice(settings, |_, x| veering(x.z));
    air.advance(2000.0, &[]).unwrap();
    let worst = departure(&air, [0; 3], n_cells, |x| veering(x.z));
    // The outlet has to stop what friction between the layers changes: less than of the wind's shear in a
    // cell.
    assert!(worst < 0.01 * SPEED, "off by {worst}");
}

#[test]
fn mass_stays_where_wind_veers_and_gusts() {
    let mut settings = settings([24, 12, 10]);
    settings.ground = Ground::Slip;
    let mut air = lattice(settings, |time, x| {
        let phase = 0.3 * (x.x - SPEED * time);
        veering(1.9 * x.z) + 0.003 * Vector3::new(0.0, phase.sin(), phase.cos())
    });
    let start = air.mass();
    air.advance(2000.0, &[]).unwrap();
    // The gusts come round every 209 steps.
    let mut mean = || {
        let steps = 209;
        let sum: f64 = (0..steps)
            .map(|_| {
                air.advance(1.0, &[]).unwrap();
                air.mass()
            })
            .sum();
        let mean = sum / f64::from(steps) / start - 1.0;
        air.advance(10_000.0, &[]).unwrap();
        mean
    };
    let [early, late] = [mean(), mean()];
    // A hundredth of what the wind's own pressure head would add: 4.7e-5.
    assert!(early.abs() < 0.01 * 1.5 * SPEED.powi(2), "{early}");
    assert!((late - early).abs() < 1e-6, "mass drifts from {early} to {late}");
}

/// Speed of the vortex `swirl` at `place` from its middle.
fn swirl([x, y]: [f64; 2]) -> Vector3 {
    const RADIUS: f64 = 6.0;
    let size = 0.01 * (-(x * x + y * y) / RADIUS.powi(2)).exp() / RADIUS;
    Vector3::new(-size * y, size * x, 0.0)
}

/// Wind at 15° with a vortex that was at (`x`, `y`) at first.
fn vortex(x: f64, y: f64) -> impl Fn(f64, Vector3) -> Vector3 {
    move |time, place| {
        let wind = aslant(15.0);
        let middle = [x + wind.x * time, y + wind.y * time];
        wind + swirl([place.x - middle[0], place.y - middle[1]])
    }
}

#[test]
fn a_vortex_leaves_through_a_side() {
    // It passes the side at x = 110.
    let start = [40.0, 28.0];
    let mut boxes = [48, 96].map(|n_y| {
        let all = vortex(start[0], start[1]);
        // Only the air that is there at first has it.
        let wind = move |time, x| if time > 0.0 { aslant(15.0) } else { all(time, x) };
        lattice(settings([200, n_y, 1]), wind)
    });
    let sum = |air: &Lattice, wind: &dyn Fn(Vector3) -> Vector3| {
        let mut sum = 0.0;
        for y in 0..48 {
            let at = |x| Vector3::new(f64::from(x), f64::from(y), 0.0);
            let positions: Vec<Vector3> = (0..180).map(at).collect();
            let mut velocities = vec![Vector3::ZERO; positions.len()];
            air.sample(&positions, &mut velocities);
            let departures = positions.iter().zip(velocities).map(|(x, v)| v - wind(*x));
            sum += departures.map(Vector3::length_squared).sum::<f64>();
        }
        sum
    };
    let before = sum(&boxes[0], &|_| aslant(15.0));
    let [mut there, mut wrong] = [0.0_f64; 2];
    for _ in 0..16 {
        for air in &mut boxes {
            air.advance(100.0, &[]).unwrap();
        }
        let [air, wide] = &boxes;
        let differs = |x: Vector3| {
            let mut velocity = [Vector3::ZERO];
            wide.sample(&[x], &mut velocity);
            velocity[0]
        };
        let now = sum(air, &differs) / before;
        wrong = wrong.max(now);
        there = sum(air, &|_| aslant(15.0)) / before;
    }
    assert!(there < 1e-3, "{there} is left");
    // 27 % of its energy while its middle passes, for the inflow's wind is held a little, and the wind along
    // the side has no slope there: a side whose speed has no slope, as a wall, has more than half
    // of it wrong.
    assert!(wrong < 0.35, "{wrong} is wrong at the worst");
}

#[test]
fn a_vortex_enters_through_a_side() {
    // It passes the side at x = 34 and is in the middle of the box in the end.
    let wind = vortex(-45.0, -21.0);
    let mut air = lattice(settings([160, 56, 1]), vortex(-45.0, -21.0));
    air.advance(1500.0, &[]).unwrap();
    let worst = departure(&air, [60, 0, 0], [140, 56, 1], |x| wind(1500.0, x));
    let peak = 0.01 / (2.0 * std::f64::consts::E).sqrt();
    // The same in a box so wide that it comes in through the inlet.
    let mut wide = settings([160, 56 + 2 * 120, 1]);
    wide.origin.y -= 120.0;
    let mut wide = lattice(wide, vortex(-45.0, -21.0));
    wide.advance(1500.0, &[]).unwrap();
    let inlet = departure(&wide, [60, 0, 0], [140, 56, 1], |x| wind(1500.0, x));
    // 12 % by the side, 18 % by the inlet, most of it what the vortex loses on the way.
    assert!(worst < inlet && inlet < 0.2 * peak, "off by {worst} and {inlet} of {peak}");
}

#[test]
fn sound_leaves_through_sides() {
    // Two halves of a velocity pulse go to either side. Sound from the ends is not in the middle yet.
    let n = [240, 100, 1];
    let wind = aslant(10.0);
    let pulse = move |time: f64, x: Vector3| {
        let bump = if time > 0.0 { 0.0 } else { (-((x.y - 50.0) / 6.0).powi(2)).exp() };
        wind + Vector3::new(0.0, 0.004 * bump, 0.0)
    };
    let mut air = lattice(settings(n), pulse);
    let wrong = |air: &Lattice, low, high| departure(air, [110, low, 0], [130, high, 1], |_| wind);
    air.advance(50.0, &[]).unwrap();
    let [first, last] = [wrong(&air, 10, 40), wrong(&air, 60, 90)];
    // What comes back is half-way to the middle.
    air.advance(80.0, &[]).unwrap();
    let [entered, left] = [wrong(&air, 10, 40), wrong(&air, 60, 90)];
    assert!(first > 1.5e-3 && last > 1.5e-3);
    // Half of the amplitude, a quarter of the energy.
    assert!(left < 0.6 * last, "{left} of {last} came back");
    // The side where wind enters holds the wind, as an inlet does: nearly all comes back.
    assert!(entered > 0.7 * first, "{entered} of {first} came back");
    // Half comes back from one side and nearly all from the other: 0.43 in each way to and fro, of which 930
    // steps are 2.7, so that a tenth is left of each half, and a fifth
    // where they meet.
    air.advance(800.0, &[]).unwrap();
    // Ahead of the eddy that the pulse has left where it met the inlet, which the wind has carried to 92.
    let rest = departure(&air, [170, 0, 0], [190, n[1], 1], |_| wind);
    assert!(rest < 0.25 * last, "{rest} of {last} is left");
}

/// Wind aslant whose temperature is given by time and position, about 300 K.
struct Warm<F>(F, f64);

impl<F: Fn(f64, Vector3) -> f64 + Send + Sync> Inflow for Warm<F> {
    fn sample(&self, _: f64, _: &[Vector3], velocities: &mut [Vector3]) {
        velocities.fill(aslant(self.1));
    }

    fn sample_temperature(
        &self,
        time: f64,
        positions: &[Vector3],
        temperatures: &mut [f64],
    ) -> bool {
        for (position, temperature) in positions.iter().zip(temperatures) {
            *temperature = 300.0 + self.0(time, *position);
        }
        true
    }
}

fn warm(
    n_cells: [usize; 3],
    angle: f64,
    temperature: impl Fn(f64, Vector3) -> f64 + Send + Sync + 'static,
) -> Lattice {
    let mut settings = settings(n_cells);
    settings.kinematic_viscosity = 1e-4;
    settings.atmosphere =
        Some(Atmosphere { gravity: 0.0, heating: Heating::None, ..Atmosphere::new(300.0) });
    Lattice::new(settings, Arc::new(Warm(temperature, angle))).unwrap()
}

/// Departures from 300 K in the cells of `air`, which is one level high.
fn temperatures(air: &Lattice) -> Vec<Vec<f32>> {
    let [n, n_y, _] = air.n_cells();
    let mut row = AirRow::new(n);
    (0..n_y)
        .map(|y| {
            assert!(air.engine.read_air(y, &mut row));
            row.temperature[..n].to_vec()
        })
        .collect()
}

#[test]
fn temperature_that_enters_through_a_side_is_carried_along() {
    for angle in [30.0, -30.0] {
        let swing = move |time: f64, x: Vector3| {
            (TAU / 600.0 * (time - x.dot(aslant(angle)) / SPEED.powi(2))).sin()
        };
        let mut air = warm([80, 40, 1], angle, swing);
        air.advance(1500.0, &[]).unwrap();
        let mut worst: f64 = 0.0;
        for (y, row) in temperatures(&air).into_iter().enumerate() {
            for (x, found) in row.into_iter().enumerate().take(72) {
                let expected = swing(1500.0, Vector3::new(x as f64, y as f64, 0.0));
                worst = worst.max((f64::from(found) - expected).abs());
            }
        }
        // A quarter of a cell late, as behind the inlet: 0.026 K.
        assert!(worst < 0.04, "{angle}: off by {worst}");
    }
}

#[test]
fn a_warm_blob_leaves_through_a_side_and_none_comes_back() {
    let blob = |x: f64, y: f64| (-(x * x + y * y) / 64.0).exp();
    let mut air =
        warm(
            [160, 40, 1],
            15.0,
            move |time, x| {
                if time > 0.0 { 0.0 } else { blob(x.x - 30.0, x.y - 20.0) }
            },
        );
    let most = |air: &Lattice| {
        temperatures(air).concat().into_iter().fold(0.0_f32, |most, t| most.max(t.abs()))
    };
    let mut left = Vec::new();
    for _ in 0..4 {
        air.advance(300.0, &[]).unwrap();
        left.push(most(&air));
    }
    // Its middle passes the side after 770 steps, at x = 105, and is 12 cells beyond the last cell in the
    // end, where a tenth of it is left.
    let beyond = 20.0 + 1200.0 * aslant(15.0).y - 39.0;
    assert!(left[0] > 0.95, "{left:?}");
    assert!(
        (f64::from(left[3]) - blob(0.0, beyond)).abs() < 0.03,
        "{left:?}, {}",
        blob(0.0, beyond)
    );
}

#[test]
fn threads_and_resuming_change_no_bit() {
    let begin = |threads: usize| {
        let swing = |time: f64, x: Vector3| (0.01 * time + 0.1 * x.x + 0.2 * x.y).sin();
        let mut settings = settings([24, 8, 4]);
        (settings.ground, settings.threads) = (Ground::Slip, Some(threads));
        settings.kinematic_viscosity = 1e-4;
        settings.atmosphere =
            Some(Atmosphere { gravity: 0.0, heating: Heating::None, ..Atmosphere::new(300.0) });
        Lattice::new(settings, Arc::new(Warm(swing, 20.0))).unwrap()
    };
    let bits = |air: &mut Lattice| {
        let mut bytes = Vec::new();
        air.write_state(&mut bytes).unwrap();
        bytes
    };
    let [mut one, mut three] = [1, 3].map(begin);
    // Not a whole number of the times at which the inflow is asked.
    one.advance(130.0, &[]).unwrap();
    three.advance(130.0, &[]).unwrap();
    let kept = bits(&mut one);
    let mut resumed = begin(2);
    resumed.read_state(&mut kept.as_slice()).unwrap();
    for air in [&mut one, &mut three, &mut resumed] {
        air.advance(57.0, &[]).unwrap();
    }
    let one = bits(&mut one);
    assert!(one == bits(&mut three) && one == bits(&mut resumed) && one != kept);
}

/// A wind that was asked for ever later times alone.
struct Onward(std::sync::Mutex<f64>);

impl Inflow for Onward {
    fn sample(&self, time: f64, _: &[Vector3], velocities: &mut [Vector3]) {
        let mut latest = self.0.lock().unwrap();
        assert!(time >= *latest, "asked for {time} after {latest}");
        *latest = time;
        velocities.fill(aslant(10.0));
    }
}

#[test]
fn the_inflow_is_never_asked_for_what_is_over() {
    let begin = || {
        let mut settings = settings([12, 6, 3]);
        settings.threads = Some(3);
        Lattice::new(settings, Arc::new(Onward(std::sync::Mutex::new(0.0)))).unwrap()
    };
    let mut air = begin();
    air.advance(13.0, &[]).unwrap();
    let mut kept = Vec::new();
    air.write_state(&mut kept).unwrap();
    let mut resumed = begin();
    resumed.read_state(&mut kept.as_slice()).unwrap();
    resumed.advance(9.0, &[]).unwrap();
    air.advance(9.0, &[]).unwrap();
}
