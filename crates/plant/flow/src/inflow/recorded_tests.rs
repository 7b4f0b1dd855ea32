//! Recorded wind at an inlet: the record's own on its grid, and what was chosen beyond it.

use super::*;

const GRID: PlaneGrid = PlaneGrid {
    n_y: 5,
    n_z: 4,
    spacing: [20.0, 25.0],
    first: [-40.0, 40.0],
    interval: 0.5,
    speed: 10.0,
    n_steps: 24,
    repeats: true,
};
const PROFILE: MeanProfile = MeanProfile::PowerLaw { hub_height: 90.0, speed: 10.0, exponent: 0.2 };
const ENTRY: Entry = Entry { origin_x: 0.0, extent: [-60.0, 100.0], duration: 8.0 };

struct Given(PlaneGrid);

impl Given {
    /// A wind that tells its place.
    fn wind(step: usize, y: usize, z: usize) -> [f32; 3] {
        let phase = (7 * step + 3 * y + 5 * z) as f32;
        [9.0 + 0.5 * z as f32 + phase.sin(), 0.7 * phase.cos(), 0.3 * (2.0 * phase).sin()]
    }
}

impl Planes for Given {
    fn grid(&self) -> PlaneGrid {
        self.0
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        let n_y = self.0.n_y;
        for (point, value) in values.iter_mut().enumerate() {
            *value = Self::wind(step, point % n_y, point / n_y);
        }
        Ok(())
    }
}

fn entering(grid: PlaneGrid, entry: Entry, beyond: Beyond) -> RecordedInflow {
    RecordedInflow::read(Box::new(Given(grid)), entry, PROFILE, beyond, &|_| true).unwrap()
}

fn at(inflow: &RecordedInflow, time: f64, x: f64, y: f64, z: f64) -> Vector3 {
    let mut wind = [Vector3::ZERO];
    inflow.sample(time, &[Vector3::new(x, y, z)], &mut wind);
    wind[0]
}

#[track_caller]
fn assert_near(found: Vector3, [u, v, w]: [f32; 3]) {
    let expected = Vector3::new(f64::from(u), f64::from(v), f64::from(w));
    assert!((found - expected).length() < 2e-5, "{found}, expected {expected}");
}

fn place(y: usize, z: usize) -> (f64, f64) {
    (-40.0 + 20.0 * y as f64, 40.0 + 25.0 * z as f64)
}

/// Mean of row `z` over time and width.
fn mean(z: usize) -> [f32; 3] {
    let mut sum = [0.0_f64; 3];
    for step in 0..24 {
        for y in 0..5 {
            (0..3).for_each(|axis| sum[axis] += f64::from(Given::wind(step, y, z)[axis]));
        }
    }
    sum.map(|sum| (sum / 120.0) as f32)
}

#[test]
fn it_is_the_record_on_its_grid_and_arrives_by_its_speed() {
    for beyond in [Beyond::Repeat, Beyond::Hold, Beyond::Mean] {
        let inflow = entering(GRID, ENTRY, beyond);
        for (step, y, z) in [(0, 0, 0), (3, 4, 3), (11, 2, 1), (23, 3, 2)] {
            let (left, height) = place(y, z);
            let time = 0.5 * step as f64;
            assert_near(at(&inflow, time, 0.0, left, height), Given::wind(step, y, z));
            // 50 m upstream it was 5 s earlier, and the record comes round.
            assert_near(
                at(&inflow, time, -50.0, left, height),
                Given::wind((step + 10) % 24, y, z),
            );
            assert_near(at(&inflow, time + 12.0, 0.0, left, height), Given::wind(step, y, z));
        }
        // Linear between points and in time.
        let [a, b] = [Given::wind(4, 1, 1), Given::wind(5, 1, 1)];
        let half = std::array::from_fn(|axis| 0.25 * a[axis] + 0.75 * b[axis]);
        assert_near(at(&inflow, 2.375, 0.0, -20.0, 65.0), half);
    }
}

#[test]
fn below_the_grid_all_goes_with_the_profile() {
    let inflow = entering(GRID, ENTRY, Beyond::Hold);
    let factor = (10.0_f64 / 40.0).powf(0.2) as f32;
    let expected = Given::wind(6, 2, 0).map(|wind| factor * wind);
    assert_near(at(&inflow, 3.0, 0.0, 0.0, 10.0), expected);
}

#[test]
fn beyond_the_grid_blows_what_was_chosen() {
    let (step, time) = (9, 4.5);
    let growth = ((115.0_f64 + 25.0) / 115.0).powf(0.2) as f32;
    let fluctuation = |y: usize, z: usize| -> [f32; 3] {
        std::array::from_fn(|axis| Given::wind(step, y, z)[axis] - mean(z)[axis])
    };
    let above = |about: [f32; 3]| -> [f32; 3] {
        std::array::from_fn(|axis| growth * mean(3)[axis] + about[axis])
    };
    let repeated = entering(GRID, ENTRY, Beyond::Repeat);
    // One point beyond the left end is the right end, one above the top the lowest row.
    assert_near(at(&repeated, time, 0.0, 60.0, 65.0), Given::wind(step, 0, 1));
    assert_near(at(&repeated, time, 0.0, -60.0, 65.0), Given::wind(step, 4, 1));
    assert_near(at(&repeated, time, 0.0, 0.0, 140.0), above(fluctuation(2, 0)));
    let held = entering(GRID, ENTRY, Beyond::Hold);
    assert_near(at(&held, time, 0.0, 300.0, 65.0), Given::wind(step, 4, 1));
    assert_near(at(&held, time, 0.0, 0.0, 140.0), above(fluctuation(2, 3)));
    let mean_wind = entering(GRID, ENTRY, Beyond::Mean);
    assert_near(at(&mean_wind, time, 0.0, 60.0, 65.0), mean(1));
    assert_near(at(&mean_wind, time, 0.0, 0.0, 140.0), above([0.0; 3]));
    // Half of it is left in the middle of the fading.
    let half = std::array::from_fn(|axis| mean(1)[axis] + 0.5 * fluctuation(4, 1)[axis]);
    assert_near(at(&mean_wind, time, 0.0, 50.0, 65.0), half);
}

#[test]
fn a_share_of_the_mean_leaves_the_fluctuations() {
    let inflow = entering(GRID, ENTRY, Beyond::Hold).with_share_of_mean(0.9);
    let (wind, mean) = (Given::wind(2, 1, 2), mean(2));
    let expected = std::array::from_fn(|axis| wind[axis] - 0.1 * mean[axis]);
    assert_near(at(&inflow, 1.0, 0.0, -20.0, 90.0), expected);
}

#[test]
fn a_record_that_ends_is_refused_or_stands_still_at_its_ends() {
    let grid = PlaneGrid { repeats: false, ..GRID };
    // 23 intervals of 0.5 s are there; the inlet is 6 s upstream.
    let too_long = Entry { duration: 5.6, ..ENTRY };
    assert!(matches!(too_long.planes(&grid), Err(InflowError::Ended { .. })));
    let entry = Entry { duration: 5.5, ..ENTRY };
    let inflow = entering(grid, entry, Beyond::Hold);
    assert_near(at(&inflow, 0.0, 80.0, 0.0, 65.0), Given::wind(0, 2, 1));
    assert_near(at(&inflow, 5.5, -60.0, 0.0, 65.0), Given::wind(23, 2, 1));
    // What a lattice asks for a few steps after the end.
    assert_near(at(&inflow, 5.7, -60.0, 0.0, 65.0), Given::wind(23, 2, 1));
    // A part of a record is the same wind, in less memory.
    let entry = Entry { origin_x: 150.0, extent: [100.0, 140.0], duration: 1.5 };
    assert_eq!(entry.planes(&grid).unwrap(), [2, 14]);
    assert_eq!(entry.memory(&grid).unwrap(), 13 * 20 * 12);
    let part = entering(grid, entry, Beyond::Hold);
    let whole = entering(grid, Entry { extent: [100.0, 150.0], ..entry }, Beyond::Hold);
    assert_eq!(at(&part, 1.0, 120.0, 10.0, 70.0), at(&whole, 1.0, 120.0, 10.0, 70.0));
}

#[test]
fn the_first_plane_of_a_record_that_ends_stands_downwind_until_it_is_blown_out() {
    let grid = PlaneGrid { repeats: false, ..GRID };
    let entry = Entry { origin_x: 20.0, extent: [60.0, 100.0], duration: 12.0 };
    let inflow = entering(grid, entry, Beyond::Hold);
    let (first, next) = (Given::wind(0, 2, 1), Given::wind(1, 2, 1));
    let at_outlet = |time| at(&inflow, time, 100.0, 0.0, 65.0);
    assert_eq!(entry.blown_out(&grid), 8.0);
    [0.0, 4.0, 8.0].iter().for_each(|&time| assert_near(at_outlet(time), first));
    assert_near(at_outlet(8.5), next);
    assert_eq!(Entry { origin_x: 120.0, ..entry }.blown_out(&grid), 0.0);
    assert_eq!(entry.blown_out(&GRID), 0.0);
}

#[test]
fn reading_can_be_broken_off() {
    let broken =
        RecordedInflow::read(Box::new(Given(GRID)), ENTRY, PROFILE, Beyond::Hold, &|share| {
            share < 0.5
        });
    assert!(matches!(broken, Err(InflowError::BrokenOff)));
}

/// Planes of [`Given`] with a temperature that tells its place.
struct Warm(Given);

impl Warm {
    fn temperature(step: usize, y: usize, z: usize) -> f32 {
        288.0 + 0.3 * z as f32 + (5.0 * step as f32 + 2.0 * y as f32 + z as f32).sin()
    }

    /// Mean of row `z` over time and width.
    fn mean(z: usize) -> f64 {
        let all = (0..24).flat_map(|step| (0..5).map(move |y| (step, y)));
        all.map(|(step, y)| f64::from(Self::temperature(step, y, z))).sum::<f64>() / 120.0
    }
}

impl Planes for Warm {
    fn grid(&self) -> PlaneGrid {
        self.0.grid()
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        self.0.read(step, values)
    }

    fn read_temperature(&mut self, step: usize, values: &mut [f32]) -> Result<bool, InflowError> {
        for (point, value) in values.iter_mut().enumerate() {
            *value = Self::temperature(step, point % 5, point / 5);
        }
        Ok(true)
    }
}

fn column() -> MeanColumn {
    let level = |height: f64| crate::inflow::ColumnLevel {
        height,
        wind: [9.0 + 0.01 * height, -0.004 * height],
        temperature: 280.0 + 0.02 * height,
    };
    MeanColumn::new((0..20).map(|number| level(20.0 * f64::from(number))).collect()).unwrap()
}

#[test]
fn temperature_comes_in_with_its_wind() {
    let planes = Box::new(Warm(Given(GRID)));
    let inflow = RecordedInflow::read(planes, ENTRY, PROFILE, Beyond::Mean, &|_| true).unwrap();
    assert!(inflow.has_temperature() && !entering(GRID, ENTRY, Beyond::Mean).has_temperature());
    let inflow = inflow.with_column_aloft(column());
    let at = |time: f64, x: f64, y: f64, z: f64| {
        let mut found = [0.0];
        assert!(inflow.sample_temperature(time, &[Vector3::new(x, y, z)], &mut found));
        found[0]
    };
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-4, "{found}, expected {expected}");
    };
    for (step, y, z) in [(0, 0, 0), (3, 4, 3), (11, 2, 1), (23, 3, 2)] {
        let (left, height) = place(y, z);
        let time = 0.5 * step as f64;
        near(at(time, 0.0, left, height), f64::from(Warm::temperature(step, y, z)));
        let earlier = f64::from(Warm::temperature((step + 10) % 24, y, z));
        near(at(time, -50.0, left, height), earlier);
    }
    // Below the lowest row the same as there, and to the side the mean of the row.
    near(at(1.5, 0.0, 0.0, 5.0), f64::from(Warm::temperature(3, 2, 0)));
    near(at(1.5, 0.0, 400.0, 65.0), Warm::mean(1));
    // Far above as much warmer than the highest row's mean as the column has it.
    near(at(1.5, 0.0, 0.0, 215.0), Warm::mean(3) + 0.02 * 100.0);
}

#[test]
fn above_the_grid_the_mean_goes_on_as_its_atmosphere_does() {
    let inflow = entering(GRID, ENTRY, Beyond::Mean).with_column_aloft(column());
    let [u, v, w] = mean(3);
    assert_near(at(&inflow, 4.5, 0.0, 0.0, 215.0), [u + 1.0, v - 0.4, w]);
    // On the grid it is the record's own.
    assert_near(at(&inflow, 4.5, 0.0, 0.0, 65.0), Given::wind(9, 2, 1));
}
