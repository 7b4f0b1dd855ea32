//! The hub vortex of a rotor with a helix, a diameter downstream: what its circle follows.

use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::AtLeast;
use crate::studies::{Carried, failure, summaries};
use analysis::AnalysisError;
use analysis::line::strongest_rotation;
use analysis::statistics::mean;
use basis::records::Plane;
use formats::netcdf::read_planes;
use formats::records::RunFolder;

/// Where the expected values come from, and how close to its correlations ours are to come (–): 0.9987 of
/// radius and amplitude, 0.9995 of frequency and Strouhal number there.
const SOURCE: &str = "Chen, van Vondelen, van Wingerden (2026), section 3.2.2";
const OF_RADIUS: f64 = 0.99;
const OF_FREQUENCY: f64 = 0.995;

/// Helices that are drawn (–), from amplitudes (deg) and Strouhal numbers (–) of the source.
const N_DRAWS: usize = 12;
const AMPLITUDES: [f64; 2] = [1.0, 6.0];
const STROUHALS: [f64; 2] = [0.1, 0.4];
const SEED: u64 = 3;
/// Wind (m/s) and rotor diameter (m) of the case, and the height of the hub (m).
const WIND: f64 = 10.0;
const DIAMETER: f64 = 126.0;
const HUB_HEIGHT: f64 = 90.0;
/// Time (s) in which the wake comes and the helix goes by, once it has faded in over a period.
const PASSING: f64 = 60.0;
/// Periods that are looked at, and planes in each of them (–).
const N_PERIODS: f64 = 2.0;
const PER_PERIOD: f64 = 24.0;
/// How far from the rotor's axis the hub vortex is looked for (diameters): within the wake, wherever that is.
const REACH: f64 = 0.3;
/// Share of the points there that are the fast region (–): as many as a disc of 0.095 diameters' radius has.
const FAST: f64 = 0.1;

/// A helix, and the circle of the hub vortex behind it.
struct Draw {
    /// Amplitude (deg) and Strouhal number (–).
    amplitude: f64,
    strouhal: f64,
    circle: Circle,
}

/// Mean place (m, from the rotor's axis: to the left looking downwind, and up), radius (m) and frequency
/// (Hz), positive from left to up: clockwise looking downwind.
struct Circle {
    centre: [f64; 2],
    radius: f64,
    frequency: f64,
}

/// Correlations over all draws, and the table of them on standard error.
pub(super) fn rows() -> Vec<Row> {
    let mut random = Random(SEED);
    let mut draws = Vec::new();
    for number in 1..=N_DRAWS {
        match drawn(number, &mut random) {
            Ok(draw) => draws.push(draw),
            Err(problem) => return failure(problem),
        }
    }
    let strouhal = |draw: &Draw| draw.circle.frequency.abs() * DIAMETER / WIND;
    tell!(
        "| draw | amplitude | St | radius | St of the circle | turns | mean place, left and up |"
    );
    for (number, draw) in draws.iter().enumerate() {
        let Circle { centre: [left, up], radius, frequency } = draw.circle;
        let sense = if frequency > 0.0 { "cw" } else { "ccw" };
        tell!(
            "| {} | {:.2}° | {:.4} | {:.4} D | {:.4} | {sense} | {:+.4} D, {:+.4} D |",
            number + 1,
            draw.amplitude,
            draw.strouhal,
            radius / DIAMETER,
            strouhal(draw),
            left / DIAMETER,
            up / DIAMETER
        );
    }
    let row = |what: &str, pairs: Vec<[f64; 2]>, expected: f64| Row {
        what: format!(
            "hub vortex at 1 D, {N_DRAWS} helices of 1 to 6° and St 0.1 to 0.4, nrel-5mw, {WIND} m/s even: correlation of {what}"
        ),
        measured: correlation(&pairs),
        expected,
        tolerance: AtLeast,
        unit: "–",
        source: SOURCE,
    };
    let radii = draws.iter().map(|draw| [draw.amplitude, draw.circle.radius]);
    let rates = draws.iter().map(|draw| [draw.strouhal, strouhal(draw)]);
    vec![
        row("its radius with the amplitude", radii.collect(), OF_RADIUS),
        row("its frequency with the Strouhal number", rates.collect(), OF_FREQUENCY),
    ]
}

/// Draws a helix, runs it as study `number`, or takes up what is there, and follows the hub vortex.
fn drawn(number: usize, random: &mut Random) -> Result<Draw, String> {
    let mut between = |[low, high]: [f64; 2]| low + (high - low) * random.uniform();
    // Whole hundredths and thousandths: what is printed is what was run.
    let amplitude = (100.0 * between(AMPLITUDES)).round() / 100.0;
    let strouhal = (1000.0 * between(STROUHALS)).round() / 1000.0;
    let period = DIAMETER / (strouhal * WIND);
    let spin_up = period + PASSING;
    let overrides = vec![
        format!("run.helix.control.T1.amplitude_deg={amplitude}"),
        format!("run.helix.control.T1.strouhal={strouhal}"),
        format!("time.spin_up={spin_up:.1}"),
        format!("time.duration={:.1}", spin_up + N_PERIODS * period),
        format!("output.plane_interval={:.1}", period / PER_PERIOD),
    ];
    let case = Carried::Own(include_str!("../../cases/hub-vortex.toml"));
    let name = format!("free-vortex-helix-{number:02}");
    let (_, folder) = summaries(case, &name, overrides)?;
    let path = RunFolder::new(&folder, "helix").instants_path("1D");
    let planes = read_planes(&path).map_err(|error| error.to_string())?;
    let (Some(first), Some(last)) = (planes.first(), planes.last()) else {
        return Err(format!("{} holds no plane", path.display()));
    };
    let interval = (last.time - first.time) / (planes.len() - 1) as f64;
    let places: Vec<[f64; 2]> = planes.iter().map(fast_place).collect();
    let circle = circle(&places, interval).map_err(|error| error.to_string())?;
    Ok(Draw { amplitude, strouhal, circle })
}

/// Where the wind about the axis of the rotor is fast (m, left and up from that axis).
///
/// As the source's filter of the hub vortex, which isolates the region of high speed and averages its points'
/// places: here the fastest points of those that are as near to the axis as the hub vortex comes.
fn fast_place(plane: &Plane) -> [f64; 2] {
    let n = plane.n_points[0];
    let mut near = Vec::new();
    for (index, speed) in plane.velocity[0].iter().enumerate() {
        let left = plane.origin[1] + (index % n) as f64 * plane.spacing[0];
        let up = plane.origin[2] + (index / n) as f64 * plane.spacing[1] - HUB_HEIGHT;
        if left.hypot(up) <= REACH * DIAMETER {
            near.push((*speed, [left, up]));
        }
    }
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let n_fast = (FAST * near.len() as f64).round().max(1.0) as usize;
    let fast = near.iter().take(n_fast);
    let sum = fast.fold([0.0; 2], |sum, (_, place)| [sum[0] + place[0], sum[1] + place[1]]);
    sum.map(|sum| sum / n_fast as f64)
}

/// The circle that `places` (left, up), `interval` (s) apart, run on: the strongest rotation in them.
fn circle(places: &[[f64; 2]], interval: f64) -> Result<Circle, AnalysisError> {
    let along = |axis: usize| places.iter().map(|place| place[axis]).collect::<Vec<f64>>();
    let (left, up) = (along(0), along(1));
    let line = strongest_rotation(&left, &up, interval)?;
    Ok(Circle {
        centre: [mean(&left), mean(&up)],
        radius: line.amplitude,
        frequency: line.frequency,
    })
}

/// Pearson's coefficient of `pairs` (–).
fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let n = pairs.len() as f64;
    let mean = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>() / n);
    let moment = |a: usize, b: usize| {
        pairs.iter().map(|pair| (pair[a] - mean[a]) * (pair[b] - mean[b])).sum::<f64>()
    };
    moment(0, 1) / (moment(0, 0) * moment(1, 1)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::PlaneAxes;
    use std::f64::consts::TAU;

    /// A wake of 6 m/s with a jet of 9 m/s at `place` (m), in wind of 10 m/s that begins at 0.45 D.
    fn with_jet(place: [f64; 2]) -> Plane {
        let (n, spacing) = (64, 3.0);
        let origin = [DIAMETER, -0.5 * spacing * 63.0, HUB_HEIGHT - 0.5 * spacing * 63.0];
        let speed = |index: usize| {
            let y = origin[1] + (index % n) as f64 * spacing;
            let z = origin[2] + (index / n) as f64 * spacing - HUB_HEIGHT;
            let away = (y - place[0]).hypot(z - place[1]) / 9.0;
            let inside = 6.0 + 3.0 * (-away * away).exp();
            if y.hypot(z) > 0.45 * DIAMETER { 10.0 } else { inside as f32 }
        };
        let streamwise: Vec<f32> = (0..n * n).map(speed).collect();
        Plane {
            name: "1D".to_owned(),
            axes: PlaneAxes::Crosswind,
            origin,
            spacing: [spacing; 2],
            n_points: [n, n],
            time: 0.0,
            averaged: 0.0,
            velocity: [streamwise, vec![0.0; n * n], vec![0.0; n * n]],
        }
    }

    #[test]
    fn the_hub_vortex_is_found_and_not_the_wind_around_the_wake() {
        for place in [[0.0, 0.0], [7.3, -4.1], [-11.0, 16.0]] {
            let found = fast_place(&with_jet(place));
            // A quarter of the points' distance: those at the edge come and go.
            let missed = (found[0] - place[0]).hypot(found[1] - place[1]);
            assert!(missed < 0.75, "{place:?}: {found:?}");
        }
    }

    #[test]
    fn a_circle_is_found_with_its_frequency_in_either_sense() {
        for frequency in [0.025, -0.025] {
            let place = |step: usize| {
                let angle = TAU * frequency * 1.7 * step as f64 + 1.0;
                [3.0 + 5.0 * angle.cos(), -2.0 + 5.0 * angle.sin()]
            };
            let places: Vec<[f64; 2]> = (0..48).map(place).collect();
            let found = circle(&places, 1.7).unwrap();
            assert!(
                (found.frequency - frequency).abs() < 1e-7 && (found.radius - 5.0).abs() < 1e-6
            );
            // Two periods and a little: the mean is near the middle.
            assert!((found.centre[0] - 3.0).hypot(found.centre[1] + 2.0) < 0.5);
        }
    }

    #[test]
    fn correlation_is_one_along_a_line_and_less_beside_it() {
        let line = [1.0, 2.0, 4.0, 7.0].map(|x| [x, 3.0 - 2.0 * x]);
        assert!((correlation(&line) + 1.0).abs() < 1e-12);
        // By hand: means 1 and 1/3, moments 2, 2/3 and 0.
        assert!(correlation(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]).abs() < 1e-12);
    }
}
