//! A vortex in a plane: place, circulation and core, by a fit of its velocity.

use super::Section;
use crate::small::solved;
use std::f64::consts::{PI, TAU};

/// Radius of the greatest speed of a Lamb-Oseen vortex over the length in its exponent (–): the root of
/// (1 + 2 s²) e^{−s²} = 1.
pub const PEAK_OVER_LENGTH: f64 = 1.120_906_422_778_534;
/// Radius about the vortex whose points are fitted, over its length (–).
const REACH: f64 = 2.5;
/// Fewest points of a fit (–), of two numbers each: about twice the unknowns.
const FEWEST: usize = 10;
/// Unknowns that are solved for: circulation, drift, two rates of strain, a jet.
const N_LINEAR: usize = 7;
/// Steps of a fit at most, and how little it must move to be done (lengths).
const MOST_STEPS: usize = 60;
const DONE: f64 = 1e-9;

/// A vortex in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vortex {
    /// Its middle, along both axes of the plane (m).
    pub position: [f64; 2],
    /// Circulation, positive from the first axis to the second (m²/s).
    pub circulation: f64,
    /// Radius of its greatest speed (m).
    pub core_radius: f64,
    /// Velocity of the air about it, without its own and without what flows along it, at its middle (m/s).
    pub drift: [f64; 2],
    /// Root mean square of what the fit leaves, over the greatest speed of the vortex (–).
    pub misfit: f64,
    /// Γ₁ and Γ₂ at the point nearest to its middle, of a window that reaches as far as its core (–), which
    /// know nothing of the fit; see [`Section::turning`]. None next to an edge or a hole.
    pub turning: Option<[f64; 2]>,
}

impl Vortex {
    /// Vorticity in its middle (1/s).
    pub fn peak_vorticity(&self) -> f64 {
        self.circulation / (PI * (self.core_radius / PEAK_OVER_LENGTH).powi(2))
    }

    /// Its greatest speed (m/s): the peak of Γ/(2πr) (1 − e^{−r²/a²}).
    pub fn peak_speed(&self) -> f64 {
        let share = 1.0 - (-PEAK_OVER_LENGTH.powi(2)).exp();
        self.circulation.abs() * share / (TAU * self.core_radius)
    }
}

/// What is looked for: place and length of the exponent.
#[derive(Clone, Copy)]
struct Guess {
    place: [f64; 2],
    length: f64,
}

/// The best linear unknowns for a guess: circulation, drift, two rates of strain, a jet; and what is left.
struct Linear {
    circulation: f64,
    drift: [f64; 2],
    residuals: Vec<f64>,
}

/// The vortex next to `start` (m), whose length of the exponent is about `length` (m), in `section`.
///
/// Fitted is a Lamb-Oseen vortex in uniform air that is strained, with a jet as wide as its core: what of a
/// Batchelor vortex's axial velocity shows in a plane that stands askew to it. Least squares of both
/// velocities at all points within 2.5 lengths, Levenberg and Marquardt for place and length, the rest solved
/// for. None where fewer than ten points are there, where the fit does not settle, or ends more than three
/// lengths from where it began.
///
/// Source of the profile: Lamb, "Hydrodynamics", 1932, §334a; Batchelor (1964), J. Fluid Mech. 20.
pub fn fit_vortex(section: &Section, start: [f64; 2], length: f64) -> Option<Vortex> {
    let least = 0.5 * section.spacing[0].min(section.spacing[1]);
    let mut guess = Guess { place: start, length: length.max(2.0 * least) };
    // The points follow the core: a second time about what the first has found.
    for _ in 0..3 {
        let points = points_about(section, guess);
        guess = settled(section, &points, guess)?;
        let moved = (guess.place[0] - start[0]).hypot(guess.place[1] - start[1]);
        if guess.length < least || moved.is_nan() || moved > 3.0 * length.max(2.0 * least) {
            return None;
        }
    }
    let points = points_about(section, guess);
    let linear = solve(section, &points, guess)?;
    let mut vortex = Vortex {
        position: guess.place,
        circulation: linear.circulation,
        core_radius: PEAK_OVER_LENGTH * guess.length,
        drift: linear.drift,
        misfit: 0.0,
        turning: None,
    };
    vortex.turning = turning(section, &vortex);
    vortex.misfit = (squares(&linear) / linear.residuals.len() as f64).sqrt() / vortex.peak_speed();
    vortex.misfit.is_finite().then_some(vortex)
}

/// Γ₁ and Γ₂ in the middle of `vortex`, of a window as large as its core; none next to an edge or a hole.
fn turning(section: &Section, vortex: &Vortex) -> Option<[f64; 2]> {
    let place = [0, 1].map(|axis| {
        let step = (vortex.position[axis] - section.origin[axis]) / section.spacing[axis];
        (step.round().max(0.0) as usize).min(section.n_points[axis] - 1)
    });
    let far = section.spacing[0].max(section.spacing[1]);
    let reach = (vortex.core_radius / far).round().max(1.0) as usize;
    let (first, second) = section.turning_at(place[1] * section.n_points[0] + place[0], reach);
    (first.is_finite() && second.is_finite()).then_some([first, second])
}

fn squares(linear: &Linear) -> f64 {
    linear.residuals.iter().map(|r| r * r).sum()
}

fn points_about(section: &Section, guess: Guess) -> Vec<usize> {
    let far = section.spacing[0].max(section.spacing[1]);
    let reach = (REACH * guess.length).max(2.1 * far);
    let is_near = |index: &usize| {
        let at = section.position(*index);
        let is_sound = section.velocity.iter().all(|values| values[*index].is_finite());
        is_sound && (at[0] - guess.place[0]).hypot(at[1] - guess.place[1]) <= reach
    };
    // Those in the square about the circle, and one more to either side.
    let [first, second] = [0, 1].map(|axis| {
        let step = |at: f64| (at - section.origin[axis]) / section.spacing[axis];
        let start = (step(guess.place[axis] - reach) - 1.0).max(0.0) as usize;
        let end = (step(guess.place[axis] + reach) + 2.0).max(0.0) as usize;
        start..end.min(section.n_points[axis])
    });
    let row = |row: usize| first.clone().map(move |column| row * section.n_points[0] + column);
    second.flat_map(row).filter(is_near).collect()
}

/// Place and length with the least squares, from `guess` on.
fn settled(section: &Section, points: &[usize], mut guess: Guess) -> Option<Guess> {
    if points.len() < FEWEST {
        return None;
    }
    let mut damping = 1e-3;
    let mut now = solve(section, points, guess)?;
    for _ in 0..MOST_STEPS {
        let slopes = derivatives(section, points, guess, &now)?;
        let mut normal = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        for i in 0..3 {
            for j in 0..3 {
                normal[i][j] = slopes[i].iter().zip(&slopes[j]).map(|(a, b)| a * b).sum();
            }
            right[i] = -slopes[i].iter().zip(&now.residuals).map(|(a, r)| a * r).sum::<f64>();
        }
        for (i, row) in normal.iter_mut().enumerate() {
            row[i] *= 1.0 + damping;
        }
        let step = solved(normal, right)?;
        let next = Guess {
            place: [
                guess.place[0] + guess.length * step[0],
                guess.place[1] + guess.length * step[1],
            ],
            length: guess.length * step[2].clamp(-1.0, 1.0).exp(),
        };
        let there = solve(section, points, next)?;
        if squares(&there) <= squares(&now) {
            (guess, now, damping) = (next, there, (0.3 * damping).max(1e-12));
            if step.iter().all(|part| part.abs() < DONE) {
                return Some(guess);
            }
        } else {
            damping *= 10.0;
            if damping > 1e8 {
                // Nothing near is better: this is the least, as far as numbers tell.
                return Some(guess);
            }
        }
    }
    None
}

/// Slopes of what is left along place (in lengths) and the logarithm of the length.
fn derivatives(
    section: &Section,
    points: &[usize],
    guess: Guess,
    now: &Linear,
) -> Option<[Vec<f64>; 3]> {
    const STEP: f64 = 1e-6;
    let by = STEP * guess.length;
    let moved = [
        Guess { place: [guess.place[0] + by, guess.place[1]], ..guess },
        Guess { place: [guess.place[0], guess.place[1] + by], ..guess },
        Guess { length: guess.length * STEP.exp(), ..guess },
    ];
    let mut slopes = [const { Vec::new() }; 3];
    for (slope, guess) in slopes.iter_mut().zip(moved) {
        let there = solve(section, points, guess)?;
        *slope = there.residuals.iter().zip(&now.residuals).map(|(a, b)| (a - b) / STEP).collect();
    }
    Some(slopes)
}

/// The linear unknowns of `guess` with the least squares.
fn solve(section: &Section, points: &[usize], guess: Guess) -> Option<Linear> {
    let mut normal = [[0.0; N_LINEAR]; N_LINEAR];
    let mut right = [0.0; N_LINEAR];
    let rows = |index: usize| {
        let at = section.position(index);
        let [x, y] = [0, 1].map(|axis| (at[axis] - guess.place[axis]) / guess.length);
        let square = x * x + y * y;
        // (1 − e^{−s²})/s², which is 1 − s²/2 near the middle.
        let share = if square < 1e-8 { 1.0 - 0.5 * square } else { -(-square).exp_m1() / square };
        let turn = share / (TAU * guess.length);
        let jet = (-square).exp();
        [
            ([-y * turn, 1.0, 0.0, x, y, jet, 0.0], section.velocity[0][index]),
            ([x * turn, 0.0, 1.0, -y, x, 0.0, jet], section.velocity[1][index]),
        ]
    };
    let rows: Vec<_> = points.iter().flat_map(|index| rows(*index)).collect();
    for (row, value) in &rows {
        for i in 0..N_LINEAR {
            right[i] += row[i] * value;
            for j in 0..N_LINEAR {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    let found = solved(normal, right)?;
    let left = |(row, value): &([f64; N_LINEAR], f64)| {
        value - row.iter().zip(&found).map(|(a, b)| a * b).sum::<f64>()
    };
    let residuals = rows.iter().map(left).collect();
    Some(Linear { circulation: found[0], drift: [found[1], found[2]], residuals })
}
