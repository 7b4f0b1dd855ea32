//! What is cut out of winds that are known everywhere.

use super::*;
use std::f64::consts::TAU;

/// Slices as a wake is recorded in: 1120 × 330 m on points 10 m apart, one a second for 100 s.
const GRID: PlaneGrid = PlaneGrid {
    n_y: 113,
    n_z: 34,
    spacing: [10.0, 10.0],
    first: [-560.0, 5.0],
    interval: 1.0,
    speed: 8.0,
    n_steps: 101,
    repeats: false,
};
const HUB: f64 = 170.0;
/// The rectangle of a turbine, 340 × 330 m.
const CUT: Cut = Cut {
    from: 0.0,
    duration: Some(33.0),
    block: 1,
    width: Some(340.0),
    height: Some(330.0),
    spacing: Some(10.0),
    shift: 0.0,
};

/// A wind that is known at all places and times, on the points of a grid.
struct Known {
    grid: PlaneGrid,
    wind: fn(f64, f64, f64) -> [f64; 3],
}

impl Planes for Known {
    fn grid(&self) -> PlaneGrid {
        self.grid
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        let PlaneGrid { n_y, first, spacing, interval, .. } = self.grid;
        for (point, value) in values.iter_mut().enumerate() {
            let y = first[0] + (point % n_y) as f64 * spacing[0];
            let z = first[1] + (point / n_y) as f64 * spacing[1];
            *value = (self.wind)(step as f64 * interval, y, z).map(|value| value as f32);
        }
        Ok(())
    }
}

fn sheared(_: f64, y: f64, z: f64) -> [f64; 3] {
    [8.0 + 0.02 * (z - HUB) - 0.004 * y, 0.01 * y, -0.005 * z]
}

/// Waves that run to the left and upwards.
fn moving(time: f64, y: f64, z: f64) -> [f64; 3] {
    let wave = (TAU * (y / 200.0 + z / 150.0 - time / 30.0)).sin();
    [8.0 + 2.0 * wave, wave, -wave]
}

fn cut_of(wind: fn(f64, f64, f64) -> [f64; 3], cut: Cut) -> Result<CutPlanes, CutError> {
    CutPlanes::new(Box::new(Known { grid: GRID, wind }), &cut, HUB)
}

/// Greatest distance of the planes of `cut` from `wind`, at which they stand `begin` (s) into the record and
/// `shift` (m) to its left.
fn farthest(
    mut cut: CutPlanes,
    wind: fn(f64, f64, f64) -> [f64; 3],
    [begin, shift]: [f64; 2],
) -> f64 {
    let grid = cut.grid();
    let mut values = vec![[0.0; 3]; grid.n_y * grid.n_z];
    let mut farthest = 0.0_f64;
    for step in 0..grid.n_steps {
        cut.read(step, &mut values).unwrap();
        for (point, value) in values.iter().enumerate() {
            let y = grid.first[0] + (point % grid.n_y) as f64 * grid.spacing[0] + shift;
            let z = grid.first[1] + (point / grid.n_y) as f64 * grid.spacing[1];
            let expected = wind(begin + step as f64 * grid.interval, y, z);
            for (value, expected) in value.iter().zip(expected) {
                farthest = farthest.max((f64::from(*value) - expected).abs());
            }
        }
    }
    farthest
}

#[test]
fn on_points_of_the_record_a_moving_pattern_is_the_record_bit_for_bit() {
    for (block, shift) in [(1, 0.0), (2, 390.0), (3, -390.0), (2, 130.0)] {
        let cut = cut_of(moving, Cut { block, shift, ..CUT }).unwrap();
        let grid = cut.grid();
        assert_eq!([grid.n_y, grid.n_z, grid.n_steps], [35, 34, 34]);
        assert_eq!((grid.first, grid.spacing), ([-170.0, 5.0], [10.0, 10.0]));
        let begin = 33.0 * (block - 1) as f64;
        // As far from the wind as single precision is.
        assert!(farthest(cut, moving, [begin, shift]) < 1e-6);
    }
}

/// A wake, slower in its middle: what meets a rotor there is carried by its mean, not by its slowest wind.
#[test]
fn planes_are_carried_with_the_mean_over_the_width() {
    let wake = |_: f64, y: f64, _: f64| [8.0 - 1e-4 * (170.0_f64.powi(2) - y * y), 0.0, 0.0];
    let square = (-17..=17).map(|column| f64::from(100 * column * column)).sum::<f64>() / 35.0;
    let expected = 8.0 - 1e-4 * (170.0_f64.powi(2) - square);
    let found = cut_of(wake, CUT).unwrap().grid().speed;
    assert!((found - expected).abs() < 1e-5, "{found} {expected}");
}

#[test]
fn a_linear_shear_is_kept_on_any_points() {
    for (spacing, width, height, shift) in
        [(10.0, 340.0, 330.0, 123.4), (17.0, 340.0, 306.0, -71.7), (12.5, 300.0, 250.0, 3.0)]
    {
        let [spacing, width, height] = [spacing, width, height].map(Some);
        let cut = cut_of(sheared, Cut { spacing, width, height, shift, ..CUT }).unwrap();
        let speed = 8.0 - 0.004 * shift;
        assert!((cut.grid().speed - speed).abs() < 1e-5, "{}", cut.grid().speed);
        assert!(farthest(cut, sheared, [0.0, shift]) < 1e-5);
    }
}

#[test]
fn between_points_a_pattern_is_as_near_as_bilinear_interpolation_comes() {
    let cut = cut_of(moving, Cut { spacing: Some(11.0), width: Some(330.0), shift: 44.4, ..CUT })
        .unwrap();
    // An eighth of the squared spacing times the second derivatives along y and z, of amplitude 2 m/s.
    let curvature = 2.0 * ((TAU / 200.0).powi(2) + (TAU / 150.0).powi(2));
    let bound = 100.0 / 8.0 * curvature;
    let found = farthest(cut, moving, [0.0, 44.4]);
    assert!(found < bound && found > 0.5 * bound, "{found} of {bound}");
}

#[test]
fn blocks_follow_one_another_and_meet_in_a_plane() {
    let last = |block| {
        let mut cut = cut_of(moving, Cut { block, ..CUT }).unwrap();
        let mut values = vec![[0.0; 3]; 35 * 34];
        cut.read(33, &mut values).unwrap();
        values
    };
    let mut second = cut_of(moving, Cut { block: 2, ..CUT }).unwrap();
    let mut values = vec![[0.0; 3]; 35 * 34];
    second.read(0, &mut values).unwrap();
    assert_eq!(values, last(1));
    // Planes that are no whole part of the window: those within it, from the first on.
    let grid = PlaneGrid { interval: 0.96, ..GRID };
    let cut = Cut { from: 1.0, duration: Some(20.0), ..CUT };
    let planes = CutPlanes::new(Box::new(Known { grid, wind: moving }), &cut, HUB).unwrap();
    assert_eq!((planes.grid().n_steps, planes.first), (21, 2));
    assert!(farthest(planes, moving, [2.0 * 0.96, 0.0]) < 1e-6);
}

#[test]
fn without_a_word_it_is_the_whole_record() {
    let cut = cut_of(sheared, Cut::default()).unwrap();
    assert_eq!(cut.grid(), PlaneGrid { speed: cut.grid().speed, ..GRID });
    assert!(farthest(cut, sheared, [0.0, 0.0]) < 1e-6);
    // A repeating record does so no more, and below the lowest row is its wind.
    let grid = PlaneGrid { repeats: true, first: [-560.0, 25.0], ..GRID };
    let record = Known { grid, wind: sheared };
    let mut cut = CutPlanes::new(Box::new(record), &CUT, HUB).unwrap();
    let mut values = vec![[0.0; 3]; 35 * 34];
    cut.read(0, &mut values).unwrap();
    assert!(
        !cut.grid().repeats && values[..35] == values[70..105] && values[..35] != values[105..140]
    );
}

#[test]
fn what_does_not_fit_is_told_with_what_would() {
    let refused = |cut: Cut| {
        let error = cut_of(sheared, cut).err().expect("it is refused");
        (error.key().unwrap_or("none"), error.to_string())
    };
    let cases = [
        (
            Cut { block: 4, ..CUT },
            "block",
            "block 4 goes from 99.0 to 132.0 s, and the record ends at 100.0 s: blocks 1 to 3 fit",
        ),
        (Cut { duration: Some(660.0), ..CUT }, "duration", "take a shorter duration"),
        (Cut { block: 2, duration: None, ..CUT }, "block", "give a duration"),
        (
            Cut { duration: Some(0.5), ..CUT },
            "duration",
            "less than the 1.000 s between two planes",
        ),
        (Cut { from: 100.0, duration: None, ..CUT }, "from", "or an earlier begin"),
        (
            Cut { spacing: Some(5.0), ..CUT },
            "spacing",
            "finer than those of the record, 10.000 m along y",
        ),
        (Cut { width: Some(345.0), ..CUT }, "width", "take 340.000 or 350.000 m"),
        (Cut { height: Some(333.0), ..CUT }, "height", "take 330.000 or 340.000 m"),
        (
            Cut { shift: 400.0, ..CUT },
            "shift",
            "y 230.0 to 570.0 m of the record, which holds -560.0 to 560.0 m: with this width take a shift from -390.0 to 390.0 m",
        ),
        (
            Cut { width: None, shift: 90.0, ..CUT },
            "width",
            "with this shift take a width of 940.0 m at most",
        ),
        (Cut { width: Some(1130.0), ..CUT }, "width", "1120.0 m at most"),
        (Cut { height: Some(340.0), ..CUT }, "height", "at or below the ground"),
    ];
    for (cut, key, text) in cases {
        let (found_key, found) = refused(cut);
        assert!(found_key == key && found.contains(text), "{found_key}: {found}");
    }
    let low = PlaneGrid { n_z: 30, ..GRID };
    let error =
        CutPlanes::new(Box::new(Known { grid: low, wind: sheared }), &CUT, HUB).err().unwrap();
    assert!(error.to_string().contains("take a height of 250.0 m at most"), "{error}");
    let backwards: fn(f64, f64, f64) -> [f64; 3] = |_, _, _| [-1.0, 0.0, 0.0];
    assert_eq!(cut_of(backwards, CUT).err(), Some(CutError::Calm { speed: -1.0 }));
}
