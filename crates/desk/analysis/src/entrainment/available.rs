//! The share of the free stream's power that a rotor in the wake would find.

use crate::grids::value_at;
use basis::records::Grid;
use std::f64::consts::TAU;
use thiserror::Error;

/// Rings and points a ring of the quadrature; every point stands for the same area.
const N_RINGS: usize = 32;
const N_AROUND: usize = 72;
/// Share of a disc that must have numbers (–).
const LEAST_COVERED: f64 = 0.98;

/// Why a disc tells nothing.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum DiscError {
    /// The grid has no extent across the wind.
    #[error("the points span no area across the wind; a volume, or a plane across it, is needed")]
    NoArea,
    /// Too much of the disc has no numbers.
    #[error(
        "{:.1} % of the disc at x = {x:.3} m has velocities; 98 % are needed: fields must reach half a diameter from the hub to each side",
        100.0 * covered
    )]
    Uncovered {
        /// Distance (m).
        x: f64,
        /// Share that has numbers (–).
        covered: f64,
    },
}

/// The power in a disc over that of the free stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Available {
    /// ∫ u³ dA over that of the free stream (–).
    pub fraction: f64,
    /// Share of the disc that has numbers (–); the fraction is that of this part.
    pub covered: f64,
}

/// Fraction of available power f_AP at `x` (m) of a disc of `radius` (m) about y and z of `axis` (m): the
/// mean over the disc of (u / `speed`)³, of the velocity `u` (m/s) on `grid`.
///
/// Midpoint rule over rings of equal area. Source: van der Hoek et al. (2024), Eq. 8, over the area, so that
/// the free stream has 1; Vollmer et al. (2016).
///
/// # Errors
/// [`DiscError`].
pub fn available_power(
    grid: &Grid,
    u: &[f64],
    (x, axis): (f64, [f64; 2]),
    radius: f64,
    speed: f64,
) -> Result<Available, DiscError> {
    if grid.n_points[1] < 2 || grid.n_points[2] < 2 {
        return Err(DiscError::NoArea);
    }
    let (mut sum, mut n) = (0.0, 0_usize);
    for ring in 0..N_RINGS {
        let distance = radius * ((ring as f64 + 0.5) / N_RINGS as f64).sqrt();
        for step in 0..N_AROUND {
            let (sine, cosine) = (TAU * (step as f64 + 0.5) / N_AROUND as f64).sin_cos();
            let place = [x, axis[0] + distance * cosine, axis[1] + distance * sine];
            if let Some(u) = value_at(grid, u, place) {
                sum += (u / speed).powi(3);
                n += 1;
            }
        }
    }
    let covered = n as f64 / (N_RINGS * N_AROUND) as f64;
    if covered < LEAST_COVERED {
        return Err(DiscError::Uncovered { x, covered });
    }
    Ok(Available { fraction: sum / n as f64, covered })
}
