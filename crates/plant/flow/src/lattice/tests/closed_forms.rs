//! Flows whose decay is known.

use super::*;
use crate::{FlowSolver, WindField};
use std::f64::consts::TAU;

/// Viscosity (lattice units) that a wave of wave vector `wave` (rad per cell) decays with, from its
/// amplitudes at two times.
///
/// The wave lies in the component along `along`, is carried by the uniform wind `mean`, and decays as exp(−ν
/// k² t).
fn measured_viscosity(
    settings: LatticeSettings,
    wave: Vector3,
    along: Vector3,
    mean: Vector3,
    duration: f64,
) -> f64 {
    let n = settings.n_cells;
    let amplitude = 1e-3;
    let mut air = lattice(settings, move |_, x| mean + along * (amplitude * wave.dot(x).sin()));
    // The stress needs a few steps to follow the strain.
    let settling = 0.2 * duration;
    let mut amplitudes = [0.0; 2];
    for (amplitude, duration) in
        amplitudes.iter_mut().zip([settling.round(), (duration - settling).round()])
    {
        air.advance(duration, &[]).expect("no divergence");
        let time = air.time();
        let positions: Vec<Vector3> = (0..n[2])
            .flat_map(|z| {
                (0..n[1]).flat_map(move |y| {
                    (0..n[0]).map(move |x| Vector3::new(x as f64, y as f64, z as f64))
                })
            })
            .collect();
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        air.sample(&positions, &mut velocities);
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (position, velocity) in positions.iter().zip(&velocities) {
            let (s, c) = wave.dot(*position - mean * time).sin_cos();
            sine += (*velocity - mean).dot(along) * s;
            cosine += (*velocity - mean).dot(along) * c;
        }
        *amplitude = sine.hypot(cosine);
    }
    (amplitudes[0] / amplitudes[1]).ln() / (wave.length_squared() * (duration - settling).round())
}

#[test]
fn shear_waves_decay_alike_whatever_the_wind_carries_them() {
    let n = 32;
    let k = TAU / n as f64;
    let viscosity = 0.02;
    let root = 0.5_f64.sqrt();
    // Wave vector, its velocity's direction, and the largest error at rest: 32, 23 and 18 cells a wave.
    let waves = [
        (Vector3::new(0.0, k, 0.0), Vector3::X, 0.01),
        (Vector3::new(k, k, 0.0), Vector3::new(root, -root, 0.0), 0.01),
        (Vector3::new(k, k, k), Vector3::new(root, -root, 0.0), 0.02),
    ];
    let winds = [
        Vector3::new(0.1, 0.0, 0.0),
        Vector3::new(0.07, 0.07, 0.0),
        Vector3::new(0.06, 0.03, -0.09),
    ];
    for (wave, along, tolerance) in waves {
        let depth = if wave.z == 0.0 { 1 } else { n };
        let viscosity_in = |stencil, wind| {
            let settings = LatticeSettings { stencil, ..periodic_box([n, n, depth], viscosity) };
            measured_viscosity(settings, wave, along, wind, 400.0)
        };
        for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
            let at_rest = viscosity_in(stencil, Vector3::ZERO);
            let error = at_rest / viscosity - 1.0;
            assert!(error.abs() < tolerance, "{stencil:?}, wave {wave}: viscosity {at_rest}");
            for wind in winds {
                let change = viscosity_in(stencil, wind) / at_rest - 1.0;
                println!("{stencil:?} {wave:.3} {wind:.2} {error:+.5} {change:+.5}");
                assert!(
                    change.abs() < 2e-3,
                    "{stencil:?}, wave {wave}: the wind {wind} changes the viscosity by {:.3} %",
                    100.0 * change
                );
            }
        }
    }
}

#[test]
fn taylor_green_converges_at_second_order() {
    let errors: Vec<f64> = [16, 32, 64].map(taylor_green_error).to_vec();
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 1.8, "errors {errors:?}");
    }
    assert!(errors[1] < 0.01, "errors {errors:?}");
}

/// Relative error of the velocity on `n` cells a side after one decay time, all else scaled with diffusion.
fn taylor_green_error(n: usize) -> f64 {
    let k = TAU / n as f64;
    let viscosity = 0.02;
    let speed = 0.04 * 16.0 / n as f64;
    let vortex = move |position: Vector3| {
        let (x, y) = (k * position.x, k * position.y);
        Vector3::new(x.cos() * y.sin(), -x.sin() * y.cos(), 0.0)
    };
    let mut air =
        lattice(periodic_box([n, n, 1], viscosity), move |_, position| vortex(position) * speed);
    let duration = (1.0 / (2.0 * viscosity * k * k)).round();
    air.advance(duration, &[]).expect("no divergence");
    let positions: Vec<Vector3> =
        (0..n * n).map(|index| Vector3::new((index % n) as f64, (index / n) as f64, 0.0)).collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut velocities);
    let decay = (-2.0 * viscosity * k * k * duration).exp();
    let (mut error, mut norm) = (0.0, 0.0);
    for (position, velocity) in positions.iter().zip(&velocities) {
        let exact = vortex(*position) * (speed * decay);
        error += (*velocity - exact).length_squared();
        norm += exact.length_squared();
    }
    (error / norm).sqrt()
}
