//! A disc in a box, and its wake through the box and out of it.

use super::*;
use std::f64::consts::TAU;

/// Wind on the base cells, as the means over them, behind a disc that pushes against the wind.
fn disc(halved: bool, boxes: &[Refinement]) -> Vec<Vector3> {
    let n = [40, 16, 16];
    let mut coarse = periodic_box(n, 1e-5);
    coarse.ends = Ends::InletOutlet;
    coarse.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    let settings = if halved { fine(&coarse) } else { coarse.clone() };
    let wind = Vector3::new(0.1, 0.0, 0.0);
    let mut air = refined(settings, boxes, move |_, _| wind);
    // Thrust coefficient 0.8 of a disc of radius 3 cells.
    let thrust = 0.8 * 0.5 * 0.01 * TAU / 2.0 * 9.0;
    let points: Vec<PointForce> = (0..36)
        .map(|k| {
            let (sine, cosine) = (TAU * f64::from(k % 18) / 18.0).sin_cos();
            let radius = if k < 18 { 1.3 } else { 2.5 };
            let share = if k < 18 { 0.35 } else { 0.65 } / 18.0;
            let position = Vector3::new(10.0, 7.5 + radius * cosine, 7.5 + radius * sine);
            PointForce::of_body(position, Vector3::new(-thrust * share, 0.0, 0.0), 0.9)
        })
        .collect();
    air.advance(500.0, &points).expect("no divergence");
    let mut means = vec![Vector3::ZERO; coarse.cells()];
    for (centre, velocity, volume) in all_cells(&air) {
        let [x, y, z] = coarse.scaling().to_lattice_position(centre).round().to_array();
        means[((z * 16.0 + y) * 40.0 + x) as usize] += (velocity - wind) * volume;
    }
    means
}

#[test]
fn a_wake_is_that_of_the_fine_grid() {
    let fine = disc(true, &[]);
    let off = |boxes: &[Refinement]| {
        let other = disc(false, boxes);
        // As far as the box reaches, and behind it up to the outlet's sponge.
        [5..30, 30..36].map(|range| {
            let (mut error, mut norm) = (0.0, 0.0);
            for (index, (other, fine)) in other.iter().zip(&fine).enumerate() {
                if range.contains(&(index % 40)) {
                    error += (*other - *fine).length_squared();
                    norm += fine.length_squared();
                }
            }
            (error / norm).sqrt()
        })
    };
    let (coarse, refined) = (off(&[]), off(&[cells([5, 3, 3], [25, 10, 10])]));
    println!("wake off by {coarse:.4?} on coarse cells, {refined:.4?} with a box");
    assert!(refined[0] < 0.25 * coarse[0], "{} with a box, {} without", refined[0], coarse[0]);
    // Behind the box cells and outlet are the coarse ones.
    assert!(refined[1] < coarse[1], "{} behind the box, {} without it", refined[1], coarse[1]);
}
