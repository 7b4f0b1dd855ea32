//! A velocity set's moments and their inverse.

use super::super::stencil::{D3Q19, Moments, Stencil as Set, opposite};
use super::super::stencil27::D3Q27;
use crate::simd::{Portable, Simd};

fn first_lane(value: Portable) -> f64 {
    let mut lanes = [0.0; 4];
    // SAFETY: four lanes.
    unsafe { value.store(lanes.as_mut_ptr()) };
    f64::from(lanes[0])
}

fn state() -> Moments<Portable> {
    let velocity = [0.11, -0.04, 0.07].map(Portable::splat);
    let stress = [2e-3, -1e-3, 5e-4, -7e-4, 3e-4, 9e-4].map(Portable::splat);
    Moments::new(Portable::splat(0.013), velocity, stress)
}

fn moments_come_back<L: Set<Q>, const Q: usize>() {
    let given = state();
    let found = L::moments(&L::populations(&given));
    let pairs = [(given.density_excess, found.density_excess)]
        .into_iter()
        .chain(given.momentum.into_iter().zip(found.momentum))
        .chain(given.velocity.into_iter().zip(found.velocity))
        .chain(given.stress.into_iter().zip(found.stress));
    for (given, found) in pairs {
        let difference = first_lane(found) - first_lane(given);
        assert!(difference.abs() < 1e-7, "{} for {}", first_lane(found), first_lane(given));
    }
}

fn directions_are_paired_and_isotropic<L: Set<Q>, const Q: usize>() {
    for (q, direction) in L::DIRECTIONS.iter().enumerate() {
        assert_eq!(direction.map(|c| -c), L::DIRECTIONS[opposite(q)]);
    }
    // Air at rest is all zeros; a small excess shows the weights, whose second moments are a third of it.
    let zero = Portable::splat(0.0);
    let excess = Moments::new(Portable::splat(0.01), [zero; 3], [zero; 6]);
    let populations = L::populations(&excess).map(first_lane);
    for a in 0..3 {
        for b in 0..3 {
            let moment: f64 = L::DIRECTIONS
                .iter()
                .zip(populations)
                .map(|(e, f)| f64::from(e[a]) * f64::from(e[b]) * f)
                .sum();
            let expected = if a == b { 0.01 / 3.0 } else { 0.0 };
            assert!((moment - expected).abs() < 1e-8);
        }
    }
}

#[test]
fn nineteen_directions() {
    moments_come_back::<D3Q19, 19>();
    directions_are_paired_and_isotropic::<D3Q19, 19>();
}

#[test]
fn twenty_seven_directions() {
    moments_come_back::<D3Q27, 27>();
    directions_are_paired_and_isotropic::<D3Q27, 27>();
}

#[test]
fn twenty_seven_directions_hold_a_gaussian() {
    // Sixth central moment of the populations against Isserlis' theorem, with the background of air at rest
    // added.
    let given = state();
    let populations = D3Q27::populations(&given).map(first_lane);
    let weight = |e: [i8; 3]| [8.0, 2.0, 0.5, 0.125][e.iter().filter(|c| **c != 0).count()] / 27.0;
    let velocity = given.velocity.map(first_lane);
    let rho = 1.0 + first_lane(given.density_excess);
    let central = |powers: [i32; 3]| -> f64 {
        D3Q27::DIRECTIONS
            .iter()
            .zip(populations)
            .map(|(e, f)| {
                let shape: f64 =
                    (0..3).map(|a| (f64::from(e[a]) - velocity[a]).powi(powers[a])).product();
                (f + weight(*e)) * shape
            })
            .sum()
    };
    let [xx, yy, zz, xy, xz, yz] = given.stress.map(first_lane);
    let (xx, yy, zz) = (xx + rho / 3.0, yy + rho / 3.0, zz + rho / 3.0);
    let gaussian =
        (xx * yy * zz + 2.0 * (xx * yz * yz + yy * xz * xz + zz * xy * xy) + 8.0 * xy * xz * yz)
            / (rho * rho);
    assert!((central([2, 2, 2]) - gaussian).abs() < 1e-7);
    assert!((central([2, 1, 1]) - (xx * yz + 2.0 * xy * xz) / rho).abs() < 1e-7);
    assert!((central([2, 2, 0]) - (xx * yy + 2.0 * xy * xy) / rho).abs() < 1e-7);
    for odd in [[1, 1, 1], [2, 1, 0], [2, 2, 1], [0, 1, 2]] {
        assert!(central(odd).abs() < 1e-7, "{odd:?}: {}", central(odd));
    }
}
