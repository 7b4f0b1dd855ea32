//! Vortices of known place, circulation and core, and a helical pair that leapfrogs at a set place.

use crate::Row;
use crate::folds::{larger, worst};
use crate::row::Tolerance::{AtMost, Within};
use analysis::vortices::{
    PEAK_OVER_LENGTH, Pairs, Search, Section, Tracking, Vortex, follow, leapfrogs, sine_fit,
    vortices,
};
use std::f64::consts::{PI, TAU};

const LAMB: &str = "Lamb, Hydrodynamics, 1932, §334a";
const BATCHELOR: &str = "Batchelor (1964), J. Fluid Mech. 20, 645";
const SET: &str = "as the field was made";

/// Diameter and wind of the tunnel (m, m/s): those of van der Hoek et al. (2024).
const DIAMETER: f64 = 0.58;
const WIND: f64 = 5.0;
/// Spacing of the published grid (m).
const SPACING: f64 = 0.01;

/// A vortex: place (m), circulation (m²/s), length of its exponent (m).
#[derive(Clone, Copy)]
struct Given {
    place: [f64; 2],
    circulation: f64,
    length: f64,
}

impl Given {
    fn velocity(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = [at[0] - self.place[0], at[1] - self.place[1]];
        let square = x * x + y * y;
        if square == 0.0 {
            return [0.0; 2];
        }
        let turn = -self.circulation * (-square / self.length.powi(2)).exp_m1() / (TAU * square);
        [-y * turn, x * turn]
    }
}

/// A plane of the tunnel, x from 0.4 to 2.5 m and z from −0.45 to 0.45 m, with `velocity`.
fn plane(velocity: impl Fn([f64; 2]) -> [f64; 2]) -> Section {
    let mut section = Section {
        origin: [0.4, -0.45],
        spacing: [SPACING; 2],
        n_points: [211, 91],
        velocity: [Vec::new(), Vec::new()],
    };
    for index in 0..211 * 91 {
        let [u, w] = velocity(section.position(index));
        section.velocity[0].push(u);
        section.velocity[1].push(w);
    }
    section
}

fn search(least_vorticity: f64) -> Search {
    Search {
        least_vorticity,
        separation: 0.05 * DIAMETER,
        within: [[0.42, 2.48], [-0.44, 0.44]],
        most_misfit: 0.5,
    }
}

/// Greatest errors over places between the points: of place over the core, of circulation and core (–).
fn errors(field: impl Fn(Given, [f64; 2]) -> [f64; 2]) -> [f64; 3] {
    let mut greatest = [0.0_f64; 3];
    for step in 0..64_u32 {
        // Places, circulations and lengths that fill their ranges evenly.
        let share = |by: f64| (f64::from(step) * by).fract();
        let given = Given {
            place: [1.0 + 0.5 * share(0.618_034), -0.1 + 0.2 * share(0.754_878)],
            circulation: if step % 2 == 0 { 0.3 } else { -0.3 },
            length: 0.02 + 0.03 * share(0.569_840),
        };
        let section = plane(|at| field(given, at));
        let peak = 0.3 / (PI * given.length.powi(2));
        let (found, _) = vortices(&section, &search(0.5 * peak));
        let core = PEAK_OVER_LENGTH * given.length;
        let away = |vortex: &Vortex| {
            (vortex.position[0] - given.place[0]).hypot(vortex.position[1] - given.place[1])
        };
        let nearest = found.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        let own = nearest.map_or([f64::INFINITY; 3], |vortex| {
            [
                away(vortex) / core,
                (vortex.circulation / given.circulation - 1.0).abs(),
                (vortex.core_radius / core - 1.0).abs(),
            ]
        });
        for (greatest, own) in greatest.iter_mut().zip(own) {
            *greatest = larger(*greatest, own);
        }
    }
    greatest
}

/// Velocity at `at` in a plane whose normal is `angle` (rad) off the axis of a Batchelor vortex: its swirl is
/// stretched along x, and its axial velocity shows.
fn batchelor(given: Given, at: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    let [x, z] = [at[0] - given.place[0], at[1] - given.place[1]];
    let [swirl, w] = given.velocity([given.place[0] + x * cosine, at[1]]);
    let radius = (x * cosine).hypot(z);
    let axial = -0.4 * given.circulation.abs() / (TAU * given.length)
        * (-(radius / given.length).powi(2)).exp();
    [WIND + swirl * cosine + axial * sine, w]
}

pub(super) fn rows() -> Vec<Row> {
    let lone = errors(|given, at| {
        let [u, w] = given.velocity(at);
        [u + WIND, w]
    });
    let square = errors(|given, at| batchelor(given, at, 0.0));
    let askew = errors(|given, at| batchelor(given, at, PI / 6.0));
    let mut rows = Vec::new();
    let limits = [("place, of a core", 2.0), ("circulation", 1.0), ("core radius", 2.0)];
    for (kind, found, source) in [
        ("Lamb-Oseen vortices that drift", lone, LAMB),
        ("Batchelor vortices cut square", square, BATCHELOR),
        ("Batchelor vortices cut 30° askew", askew, BATCHELOR),
    ] {
        for ((what, limit), error) in limits.into_iter().zip(found) {
            rows.push(Row {
                what: format!("{kind}, 64 of 2 to 5 points of length: largest error of {what}"),
                measured: 100.0 * error,
                expected: limit,
                tolerance: AtMost,
                unit: "%",
                source,
            });
        }
    }
    rows.extend(leapfrogging());
    rows
}

/// Bins of a turn, turns of the cycle, and helix cycles in it: the published ccw case.
const BINS: usize = 204;
const TURNS: usize = 17;
const CYCLES: usize = 3;

/// Where pairs leapfrog at the azimuth `helix` (rad) of their passing, from the rotor (m).
fn set_place(helix: f64) -> f64 {
    DIAMETER * (1.5 + 0.2 * (helix + 0.8).sin())
}

/// Helix azimuth at `step` bins (rad).
fn helix_at(step: f64) -> f64 {
    TAU * CYCLES as f64 * step / BINS as f64
}

/// Bins between the births of the two of a pair.
const APART: usize = 4;

/// Those that are there of the pair whose second vortex is born at bin `birth`, `age` bins after that. They
/// go on at one speed about a middle, turn by 90° until the set place, then on.
fn pair(birth: usize, age: f64) -> Vec<Given> {
    // Three quarters of the wind, at 8 Hz and 12 bins a turn.
    let step = 0.75 * WIND / (8.0 * 12.0);
    let start = 0.43;
    let gap = APART as f64 * step;
    let given = |place| Given { place, circulation: -0.1, length: 0.012 };
    if age < 0.0 {
        return vec![given([start + step * (age + APART as f64), 0.5 * DIAMETER])];
    }
    let middle = start + step * age + 0.5 * gap;
    // Where it happens depends on when, and when on where: settled in a few rounds.
    let mut place = 1.5 * DIAMETER;
    for _ in 0..60 {
        let when = birth as f64 + (place - start - 0.5 * gap) / step;
        place = set_place(helix_at(when));
    }
    let share = (middle - start - 0.5 * gap) / (place - start - 0.5 * gap);
    if share > 1.5 || middle > 2.2 {
        return Vec::new();
    }
    let (sine, cosine) = (share * TAU / 4.0).sin_cos();
    let one = |sign: f64| {
        given([middle + sign * 0.5 * gap * cosine, 0.5 * DIAMETER - sign * 0.5 * gap * sine])
    };
    vec![one(1.0), one(-1.0)]
}

/// A pair born each revolution, with the wind: found bin by bin, followed, and its sine beside the set one.
fn leapfrogging() -> Vec<Row> {
    let n_each = BINS / TURNS;
    let mut frames = Vec::with_capacity(BINS);
    for bin in 0..BINS {
        let mut given = Vec::new();
        for turn in 0..TURNS {
            // In the middle of a turn, so that no pair is born across the end of the cycle.
            let birth = turn * n_each + n_each / 2;
            for lap in 0..2 {
                let age = (bin + lap * BINS) as f64 - birth as f64;
                if age >= -(APART as f64) {
                    given.extend(pair(birth, age));
                }
            }
        }
        let section = plane(|at| {
            let near = given.iter().filter(|one| (one.place[0] - at[0]).abs() < 0.5);
            near.fold([WIND, 0.0], |sum, one| {
                let own = one.velocity(at);
                [sum[0] + own[0], sum[1] + own[1]]
            })
        });
        frames.push(vortices(&section, &search(60.0)).0);
    }
    let tracking = Tracking {
        interval: 1.0 / (8.0 * 12.0),
        gate: 0.04 * DIAMETER,
        n_rounds: 2,
        birth: 0.43 + 0.15 * DIAMETER,
        most_missed: 1,
    };
    let tracks = follow(&frames, &tracking);
    let found = leapfrogs(&tracks, Pairs::All);
    let azimuths: Vec<f64> = found.iter().map(|one| helix_at(one.step)).collect();
    let off = found
        .iter()
        .zip(&azimuths)
        .map(|(one, azimuth)| (one.place / set_place(*azimuth) - 1.0).abs());
    let greatest = worst(off);
    let places: Vec<f64> = found.iter().map(|one| one.place / DIAMETER).collect();
    let fit = sine_fit(&azimuths, &places, 0.0).ok();
    let of = |part: fn(&analysis::vortices::SineFit) -> f64| fit.as_ref().map_or(f64::NAN, part);
    let what = "pairs that leapfrog over a helix of 204 bins";
    let row = |text: &str, measured, expected, tolerance, unit| Row {
        what: format!("{what}: {text}"),
        measured,
        expected,
        tolerance,
        unit,
        source: SET,
    };
    vec![
        row("pairs found of 17", found.len() as f64, 17.0, Within(0.0), "–"),
        row("largest error of a place", 100.0 * greatest, 1.0, AtMost, "%"),
        row("mean of the sine", of(|fit| fit.mean), 1.5, Within(0.015), "D"),
        row("amplitude of the sine", of(|fit| fit.amplitude), 0.2, Within(0.01), "D"),
        row("phase of the sine", of(|fit| fit.phase), 0.8, Within(0.05), "rad"),
    ]
}
