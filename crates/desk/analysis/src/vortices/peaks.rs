//! All vortices of a plane: peaks of vorticity, each fitted.

use super::{Section, Vortex, fit_vortex};
use std::f64::consts::PI;

/// What counts as a vortex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Least vorticity of a peak (1/s), of either sign.
    pub least_vorticity: f64,
    /// Two peaks of one sign are at least so far apart (m); of nearer ones the stronger counts.
    pub separation: f64,
    /// Part of the plane in which peaks are looked for: least and greatest coordinates (m).
    pub within: [[f64; 2]; 2],
    /// Greatest misfit of a vortex (–).
    pub most_misfit: f64,
}

/// The vortices of `section`, the strongest peak of vorticity first, and how many peaks made no vortex: whose
/// fit did not settle, turned the other way, or left more than `search` allows.
pub fn vortices(section: &Section, search: &Search) -> (Vec<Vortex>, usize) {
    let vorticity = section.vorticity();
    let mut places = peaks(section, &vorticity, search);
    places.sort_by(|a, b| vorticity[*b].abs().total_cmp(&vorticity[*a].abs()).then(a.cmp(b)));
    let mut kept: Vec<usize> = Vec::new();
    for place in places {
        let at = section.position(place);
        let is_near = |other: &usize| {
            let there = section.position(*other);
            let is_alike = vorticity[*other] * vorticity[place] > 0.0;
            is_alike && (at[0] - there[0]).hypot(at[1] - there[1]) < search.separation
        };
        if !kept.iter().any(is_near) {
            kept.push(place);
        }
    }
    let n_peaks = kept.len();
    let mut found: Vec<Vortex> = Vec::new();
    for place in kept {
        let (start, length) = refined(section, &vorticity, place);
        let Some(vortex) = fit_vortex(section, start, length) else { continue };
        let turns = vortex.circulation * vorticity[place] > 0.0;
        let is_new = found.iter().all(|other| {
            let away = [0, 1].map(|axis| vortex.position[axis] - other.position[axis]);
            away[0].hypot(away[1]) > 0.25 * vortex.core_radius
        });
        if turns && is_new && vortex.misfit <= search.most_misfit {
            found.push(vortex);
        }
    }
    let n_lost = n_peaks - found.len();
    (found, n_lost)
}

/// Points whose vorticity is stronger than that of their eight neighbours, and strong enough.
fn peaks(section: &Section, vorticity: &[f64], search: &Search) -> Vec<usize> {
    let [n_first, n_second] = section.n_points;
    let is_peak = |index: &usize| {
        let (column, row) = (index % n_first, index / n_first);
        if column == 0 || row == 0 || column + 1 >= n_first || row + 1 >= n_second {
            return false;
        }
        let at = section.position(*index);
        let is_within = (0..2)
            .all(|axis| (search.within[axis][0]..=search.within[axis][1]).contains(&at[axis]));
        let own = vorticity[*index];
        let beats = |other: usize| {
            let there = own.signum() * vorticity[other];
            // Of equal neighbours the first is the peak.
            own.abs() > there || own.abs() == there && other > *index
        };
        let around = (row - 1..=row + 1)
            .flat_map(|row| (column - 1..=column + 1).map(move |column| row * n_first + column));
        is_within
            && own.abs() >= search.least_vorticity
            && around.filter(|other| other != index).all(beats)
    };
    (0..section.len()).filter(is_peak).collect()
}

/// Place and length of the vortex that peaks at point number `index`, by a Gaussian through it and its four
/// neighbours.
fn refined(section: &Section, vorticity: &[f64], index: usize) -> ([f64; 2], f64) {
    let mut place = section.position(index);
    let strides = [1, section.n_points[0]];
    let mut inverse_squares = Vec::new();
    for axis in 0..2 {
        let values = [index - strides[axis], index, index + strides[axis]];
        let [before, own, after] = values.map(|at| vorticity[at] / vorticity[index]);
        if before > 0.0 && after > 0.0 {
            // ln ω is a parabola, of curvature −2/a².
            let [before, own, after] = [before, own, after].map(f64::ln);
            let curvature = before - 2.0 * own + after;
            if curvature < 0.0 {
                let spacing = section.spacing[axis];
                place[axis] += (0.5 * (before - after) / curvature).clamp(-0.5, 0.5) * spacing;
                inverse_squares.push(-0.5 * curvature / spacing.powi(2));
            }
        }
    }
    let fallback = section.spacing[0].max(section.spacing[1]) * 2.0 / PI.sqrt();
    let mean = inverse_squares.iter().sum::<f64>() / inverse_squares.len().max(1) as f64;
    (place, if mean > 0.0 { mean.powf(-0.5) } else { fallback })
}
