//! Vortices and sound across the boundary of a box, beside uniform grids.

use super::*;
use std::f64::consts::TAU;

/// Root of the mean square of `air` less `expected`, over that of `expected` less `mean`.
fn error(air: &Refined, mean: Vector3, expected: impl Fn(Vector3) -> Vector3) -> f64 {
    let (mut error, mut norm) = (0.0, 0.0);
    for (centre, velocity, volume) in all_cells(air) {
        error += volume * (velocity - expected(centre)).length_squared();
        norm += volume * (expected(centre) - mean).length_squared();
    }
    (error / norm).sqrt()
}

/// Error of a Taylor-Green vortex after one decay time on `n` cells a side, carried by `wind`.
fn taylor_green(n: usize, halved: bool, boxes: &[Refinement], wind: Vector3) -> f64 {
    let k = TAU / n as f64;
    let viscosity = 0.02;
    let speed = 0.04 * 16.0 / n as f64;
    let vortex = move |position: Vector3| {
        let (x, y) = (k * position.x, k * position.y);
        Vector3::new(x.cos() * y.sin(), -x.sin() * y.cos(), 0.0) * speed
    };
    let coarse = periodic_box([n, n, 1], viscosity);
    let settings = if halved { fine(&coarse) } else { coarse };
    let mut air = refined(settings, boxes, move |_, position| wind + vortex(position));
    let duration = (1.0 / (2.0 * viscosity * k * k)).round();
    air.advance(duration, &[]).expect("no divergence");
    let decay = (-2.0 * viscosity * k * k * duration).exp();
    error(&air, wind, |position| wind + vortex(position - wind * duration) * decay)
}

#[test]
fn taylor_green_across_a_box_is_better_than_without_it() {
    for wind in [Vector3::ZERO, Vector3::new(0.05, 0.02, 0.0)] {
        let refined = [16, 32].map(|n| {
            let place = [cells([n / 4, n / 4, 0], [n / 2, n / 2, 1])];
            let coarse = taylor_green(n, false, &[], wind);
            let refined = taylor_green(n, false, &place, wind);
            let fine = taylor_green(n, true, &[], wind);
            println!("{wind} {n}: coarse {coarse:.5}, refined {refined:.5}, fine {fine:.5}");
            assert!(refined < coarse, "{wind}, {n} cells: {refined} for {coarse} without the box");
            refined
        });
        // In a wind, errors of the speed over that of sound are of first order, without boxes as well.
        let order = (refined[0] / refined[1]).log2();
        assert!(order > if wind == Vector3::ZERO { 1.9 } else { 1.1 }, "order {order} in {wind}");
    }
}

/// Fastest wind of the vortex that is carried (m/s).
const VORTEX_SPEED: f64 = 0.02;

/// A vortex of radius `radius` around `centre`.
fn vortex(position: Vector3, centre: Vector3, radius: f64) -> Vector3 {
    let d = (position - centre) / radius;
    let swirl = VORTEX_SPEED * (0.5 - 0.5 * (d.x * d.x + d.y * d.y)).exp();
    Vector3::new(-swirl * d.y, swirl * d.x, 0.0)
}

/// The vortex on the base cells after `duration` (s), as the means over them.
fn carried(halved: bool, boxes: &[Refinement], radius: f64, duration: f64) -> Vec<Vector3> {
    let mut coarse = periodic_box([112, 48, 1], 1e-5);
    coarse.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    let wind = Vector3::new(0.1, 0.0, 0.0);
    let settings = if halved { fine(&coarse) } else { coarse.clone() };
    let mut air = refined(settings, boxes, move |_, x| {
        wind + vortex(x, Vector3::new(20.0, 24.0, 0.0), radius)
    });
    air.advance(duration, &[]).expect("no divergence");
    let mut sums = vec![Vector3::ZERO; coarse.cells()];
    for (centre, velocity, volume) in all_cells(&air) {
        let [x, y, _] = (coarse.scaling().to_lattice_position(centre)).round().to_array();
        sums[y as usize * 112 + x as usize] += velocity * volume - wind * volume;
    }
    sums
}

#[test]
fn a_vortex_is_carried_through_boxes() {
    let one = cells([40, 10, 0], [32, 28, 1]);
    let mut nested = one.clone();
    nested.within.push(cells([16, 8, 0], [32, 40, 2]));
    let norm = |values: &[Vector3]| values.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
    for radius in [3.0, 5.0] {
        let fine = carried(true, &[], radius, 640.0);
        let compare = |boxes: &[Refinement]| {
            let other = carried(false, boxes, radius, 640.0);
            let all: Vec<_> = other.iter().zip(&fine).map(|(a, b)| *a - *b).collect();
            // What is left where the vortex has been: in the box and before it.
            let left = all.iter().enumerate().filter(|(index, _)| index % 112 < 64);
            let left = left.map(|(_, v)| v.length()).fold(0.0, f64::max) / VORTEX_SPEED;
            (norm(&all) / norm(&fine), left)
        };
        let (coarse, coarse_left) = compare(&[]);
        let (refined, left) = compare(std::slice::from_ref(&one));
        let (twice, twice_left) = compare(std::slice::from_ref(&nested));
        println!(
            "radius {radius}: off by {coarse:.4} coarse, {refined:.4} in a box, {twice:.4} in two"
        );
        println!("left behind {coarse_left:.4}, {left:.4}, {twice_left:.4}");
        assert!(
            refined < 0.55 * coarse,
            "radius {radius}: off by {refined}, without a box {coarse}"
        );
        assert!(twice < 0.55 * coarse, "radius {radius}: off by {twice}, without a box {coarse}");
        assert!(left < 0.01 && twice_left < 0.01, "radius {radius}: {left}, {twice_left} is left");
    }
}

/// Strongest sound on its way back, and on its way through, over what came, 110 steps after a pulse began at
/// `start` (cells): it splits, and the half that goes downstream has passed the boundary 40 cells on.
fn sound(boxes: &[Refinement], n: [usize; 3], start: f64, wind: Vector3) -> [f64; 2] {
    let strength = 1e-3;
    let pulse = move |_: f64, x: Vector3| {
        wind + Vector3::X * (2.0 * strength * (-((x.x - start) / 5.0).powi(2)).exp())
    };
    let mut air = refined(periodic_box(n, 1e-3), boxes, pulse);
    air.advance(110.0, &[]).expect("no divergence");
    let all = all_cells(&air);
    let most = |from: f64, to: f64| {
        let there = |x: f64| start + from <= x && x <= start + to;
        let speeds = all.iter().filter(|(x, ..)| there(x.x));
        speeds.map(|(_, velocity, _)| (*velocity - wind).length()).fold(0.0, f64::max) / strength
    };
    [most(2.0, 33.0), most(50.0, 80.0)]
}

#[test]
fn sound_crosses_a_box_without_echo() {
    let through = cells([80, 0, 0], [80, 1, 1]);
    let finite = cells([80, 5, 0], [80, 10, 1]);
    for wind in [Vector3::ZERO, Vector3::new(0.05, 0.03, 0.0)] {
        for (what, start) in [("into", 40.0), ("out of", 120.0)] {
            for (place, n_y) in [(&through, 1), (&finite, 20)] {
                let place = std::slice::from_ref(place);
                let [_, free] = sound(&[], [240, n_y, 1], start, wind);
                let [back, on] = sound(place, [240, n_y, 1], start, wind);
                println!(
                    "sound {what} the box in {wind}: {back:.5} back, {on:.4} on, {free:.4} without"
                );
                assert!(back < 0.01, "{what} the box, in {wind}: {back} comes back");
                assert!(on > 0.99 * free, "{what} the box, in {wind}: {on} goes on of {free}");
            }
        }
    }
}
