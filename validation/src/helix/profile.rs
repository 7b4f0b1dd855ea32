//! The mean wind across a wake at hub height, beside a published large-eddy simulation.

use crate::Row;
use crate::row::Tolerance::{AtMost, Within};
use crate::studies::{Carried, failure, summaries};
use basis::records::{Plane, PlaneAxes, Summary};
use std::path::Path;

/// Where the expected values come from.
pub(super) const SOURCE: &str =
    "van der Hoek's large-eddy simulation, github.com/matteobaricchi/msr";
/// The same study's power and thrust of the turbine without a helix, file power_curves_TI2p.csv (W, N).
pub(super) const POWER: f64 = 16.924e6;
const THRUST: f64 = 3.0727e6;
/// Winds that are averaged over.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Distances behind the turbine (diameters), in the order of the published columns.
const DISTANCES: [f64; 6] = [3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
/// Distance at which gains are told: where a second turbine would stand.
const SECOND: usize = 2;
/// Half-widths (diameters) over which the mean speed, its cube, and the shape are compared.
pub(super) const CORE: f64 = 0.4;
pub(super) const ROTOR: f64 = 0.5;
const WAKE: f64 = 0.95;

/// A profile across a wake: places (diameters) with speeds (m/s).
pub(super) type Profile = Vec<(f64, f64)>;

/// `validation/cases/wake-profile.toml`: mean hub-height wind across the wake, baseline first, then the
/// helix, then what the helix gains.
pub fn wake_profile() -> Vec<Row> {
    let mut found = [vec![Profile::new(); DISTANCES.len()], vec![Profile::new(); DISTANCES.len()]];
    let mut turbine = [0.0; 2];
    for seed in SEEDS {
        let case = Carried::Own(include_str!("../../cases/wake-profile.toml"));
        let name = format!("wake-profile-{seed}");
        let made = summaries(case, &name, vec![format!("wind.seed={seed}")]);
        let read = made.and_then(|(summaries, folder)| {
            Ok((summaries, [profiles(&folder, BASELINE)?, profiles(&folder, HELIX)?]))
        });
        let (summaries, of_seed) = match read {
            Ok(read) => read,
            Err(problem) => return failure(problem),
        };
        for (found, of_seed) in found.iter_mut().zip(&of_seed) {
            for (profile, other) in found.iter_mut().zip(of_seed) {
                add(profile, other);
            }
        }
        let baseline = summaries.iter().find(|summary| summary.run == RUNS[0]);
        let [power, thrust] = baseline.map_or([f64::NAN; 2], first_turbine);
        turbine[0] += power / SEEDS.len() as f64;
        turbine[1] += thrust / SEEDS.len() as f64;
    }
    let mut rows = of_turbine(turbine);
    for (run, found) in RUNS.iter().zip(&found) {
        rows.extend(of_wake(run, found));
    }
    rows.extend(gains(&found));
    rows
}

/// The runs, as case and published file name them.
pub(super) const BASELINE: &str = "baseline";
pub(super) const HELIX: &str = "ccw-4";
const RUNS: [&str; 2] = [BASELINE, HELIX];

/// The mean hub-height wind across the wake of `run` at each of [`DISTANCES`], from the records in `folder`.
pub(super) fn profiles(folder: &Path, run: &str) -> Result<Vec<Profile>, String> {
    let study = formats::records::read_study(folder).map_err(|error| error.to_string())?;
    let records = study.runs.iter().find(|records| records.summary.run == run);
    let records = records.ok_or_else(|| format!("there is no run {run}"))?;
    let level = |plane: &&Plane| plane.axes == PlaneAxes::Horizontal;
    let plane = records.mean_planes.iter().find(level);
    let plane = plane.ok_or_else(|| format!("the run {run} has no mean plane at hub height"))?;
    let diameter = records.summary.conditions.rotor_diameter;
    Ok(DISTANCES.map(|distance| across(plane, distance * diameter, diameter)).to_vec())
}

fn first_turbine(summary: &Summary) -> [f64; 2] {
    [summary.turbines[0].power.mean, summary.turbines[0].thrust.mean]
}

/// Power and thrust of the turbine without a helix.
fn of_turbine([power, thrust]: [f64; 2]) -> Vec<Row> {
    let row = |what: &str, measured: f64, expected: f64, tolerance, unit| Row {
        what: format!("{what} of the turbine, baseline, 10 m/s"),
        measured: 1e-6 * measured,
        expected: 1e-6 * expected,
        tolerance: Within(tolerance),
        unit,
        source: SOURCE,
    };
    vec![row("power", power, POWER, 0.5, "MW"), row("thrust", thrust, THRUST, 0.06, "MN")]
}

/// Mean speed and shape of the wake of `run` at every distance.
fn of_wake(run: &str, found: &[Profile]) -> Vec<Row> {
    let mut rows = Vec::new();
    for ((index, distance), profile) in DISTANCES.iter().enumerate().zip(found) {
        let published = published(run, index);
        rows.push(Row {
            what: format!("mean speed over |y| < {CORE} D, {run}, {distance} D"),
            measured: mean(profile, CORE, 1),
            expected: mean(&published, CORE, 1),
            tolerance: Within(0.2),
            unit: "m/s",
            source: SOURCE,
        });
        rows.push(Row {
            what: format!("difference of the profile over |y| < {WAKE} D, root mean square, {run}, {distance} D"),
            measured: difference(profile, &published),
            expected: 0.3,
            tolerance: AtMost,
            unit: "m/s",
            source: SOURCE,
        });
    }
    rows
}

/// What the helix gives the wind where a second turbine would stand.
fn gains(found: &[Vec<Profile>; 2]) -> Vec<Row> {
    let published = RUNS.map(|run| published(run, SECOND));
    let published = [&published[0], &published[1]];
    let ours = [&found[0][SECOND], &found[1][SECOND]];
    let row = |what: String, half_width, power, tolerance| Row {
        what,
        measured: gain(ours, half_width, power),
        expected: gain(published, half_width, power),
        tolerance: Within(tolerance),
        unit: "%",
        source: SOURCE,
    };
    vec![
        row(format!("gain of the mean speed over |y| < {CORE} D at 5 D, ccw 4°"), CORE, 1, 3.0),
        row(format!("gain of the mean cube over |y| < {ROTOR} D at 5 D, ccw 4°"), ROTOR, 3, 8.0),
    ]
}

/// By how much (%) the mean of the speed to the `power` over the disc of `half_width` (diameters) is greater
/// in the second profile than in the first.
pub(super) fn gain(profiles: [&Profile; 2], half_width: f64, power: i32) -> f64 {
    let [baseline, helix] = profiles.map(|profile| mean(profile, half_width, power));
    100.0 * (helix / baseline - 1.0)
}

/// Adds a seed's share of `other` to `profile`.
fn add(profile: &mut Profile, other: &Profile) {
    let share = 1.0 / SEEDS.len() as f64;
    if profile.is_empty() {
        profile.extend(other.iter().map(|(y, u)| (*y, share * u)));
    } else {
        for (sum, (_, u)) in profile.iter_mut().zip(other) {
            sum.1 += share * u;
        }
    }
}

/// Streamwise speed across `plane` at x (m), linear between its points.
fn across(plane: &Plane, x: f64, diameter: f64) -> Profile {
    let place = (x - plane.origin[0]) / plane.spacing[0];
    let low = place.floor().clamp(0.0, plane.n_points[0] as f64 - 2.0);
    let (i, weight) = (low as usize, place - low);
    let at = |j: usize, i: usize| f64::from(plane.velocity[0][j * plane.n_points[0] + i]);
    (0..plane.n_points[1])
        .map(|j| {
            let y = (plane.origin[1] + j as f64 * plane.spacing[1]) / diameter;
            (y, (1.0 - weight) * at(j, i) + weight * at(j, i + 1))
        })
        .collect()
}

/// The published profile of `run` at distance number `index`.
pub(super) fn published(run: &str, index: usize) -> Profile {
    let table = include_str!("../../data/wake-iea-22mw-10-m-s.csv");
    let rows = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    rows.filter(|row| row[0] == run)
        .filter_map(|row| Some((row.get(1)?.parse().ok()?, row.get(2 + index)?.parse().ok()?)))
        .collect()
}

/// `profile` at `y`, linear between its places and constant beyond them.
fn at(profile: &Profile, y: f64) -> f64 {
    let next = profile.partition_point(|(place, _)| *place < y).clamp(1, profile.len() - 1);
    let [(y_0, u_0), (y_1, u_1)] = [profile[next - 1], profile[next]];
    u_0 + (u_1 - u_0) * ((y - y_0) / (y_1 - y_0)).clamp(0.0, 1.0)
}

/// Places between which a mean is summed (–).
const N_PLACES: i32 = 400;

/// Mean of the speed to the `power` over the disc of `half_width` (diameters), were the wake round: each
/// place counts as the ring that it lies on.
pub(super) fn mean(profile: &Profile, half_width: f64, power: i32) -> f64 {
    let places = (-N_PLACES..=N_PLACES).map(|n| half_width * f64::from(n) / f64::from(N_PLACES));
    let (sum, weight) = places.fold((0.0, 0.0), |(sum, weight), y| {
        (sum + y.abs() * at(profile, y).powi(power), weight + y.abs())
    });
    sum / weight
}

/// Root mean square of the difference of `profile` from the `published` one, at the places of the latter.
fn difference(profile: &Profile, published: &Profile) -> f64 {
    let inside: Vec<f64> = published
        .iter()
        .filter(|(y, _)| y.abs() < WAKE)
        .map(|(y, u)| (at(profile, *y) - u).powi(2))
        .collect();
    (inside.iter().sum::<f64>() / inside.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_profiles_are_read_whole() {
        for run in RUNS {
            for index in 0..DISTANCES.len() {
                let profile = published(run, index);
                assert_eq!(profile.len(), 19);
                assert!(profile.windows(2).all(|pair| pair[0].0 < pair[1].0));
                assert!(profile.iter().all(|(_, u)| (4.0..10.3).contains(u)));
            }
        }
        // Baseline and helix at 5 D, as others read the same file: 6.5 and 7.1 m/s.
        let [baseline, helix] = RUNS.map(|run| mean(&published(run, SECOND), CORE, 1));
        assert!((baseline - 6.5).abs() < 0.05 && (helix - 7.1).abs() < 0.05);
    }

    #[test]
    fn means_weigh_rings() {
        // u = |y|: the mean over a disc of radius R is 2 R / 3.
        let cone: Profile =
            (-100..=100).map(|n| (0.01 * f64::from(n), 0.01 * f64::from(n).abs())).collect();
        assert!((mean(&cone, 0.6, 1) - 0.4).abs() < 1e-3);
        assert!((at(&cone, 0.335) - 0.335).abs() < 1e-12);
        assert_eq!(difference(&cone, &cone), 0.0);
    }
}
