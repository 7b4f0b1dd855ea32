//! The hub vortex of a rotor with a helix, a diameter downstream as a lidar sees it: what its circle follows.

use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::AtLeast;
use crate::studies::{Carried, failure, summaries};
use analysis::AnalysisError;
use analysis::line::strongest_rotation;
use analysis::statistics::mean;
use basis::scan::Scan;
use estimation::hub_vortex::{HubVortexSettings, follow};
use formats::records::{RunFolder, StoredScans, read_scans};

/// Where the expected values come from, and how close to its correlations ours are to come (–): 0.9987 of
/// radius and amplitude, 0.9995 of frequency and Strouhal number there. The bounds are this program's.
const SOURCE: &str = "Chen, van Vondelen, van Wingerden (2026), section 3.2.2";
const OF_RADIUS: f64 = 0.99;
const OF_FREQUENCY: f64 = 0.995;

/// Helices that are drawn (–), from amplitudes (deg) and Strouhal numbers (–) of the source.
const N_DRAWS: usize = 12;
const AMPLITUDES: [f64; 2] = [1.0, 6.0];
const STROUHALS: [f64; 2] = [0.1, 0.4];
const SEED: u64 = 3;
/// Amplitudes (deg) of helices at one Strouhal number (–).
const GROWING: [f64; 4] = [1.5, 3.0, 4.5, 5.8];
const FIXED: f64 = 0.3;
/// Wind (m/s) and rotor diameter (m) of the case.
const WIND: f64 = 10.0;
const DIAMETER: f64 = 126.0;
/// Time (s) in which the wake comes and the helix goes by, once it has faded in over a period.
const PASSING: f64 = 60.0;
/// Time that is looked at (s), two periods of the slowest helix: the same for all, so that the lines of a
/// record's own spectrum do not follow the frequency that was set.
const RECORD: f64 = 252.0;
/// Filters by which the hub vortex is found, the source's, the one that bears shear and noise, and that of
/// the whole wake: what they look for, and how a row names it.
const FILTERS: [(&str, &str); 3] = [
    ("fast region", ""),
    ("fitted jet", " by a fitted jet"),
    ("centroid", " by the wind's centroid over the disc"),
];

/// A helix, and the circle of the hub vortex behind it by each of the [`FILTERS`].
struct Draw {
    /// Amplitude (deg) and Strouhal number (–).
    amplitude: f64,
    strouhal: f64,
    circles: [Circle; 3],
}

/// Mean place (m, from the rotor's axis: to the left looking downwind, and up), radius (m) and frequency
/// (Hz), positive from left to up: clockwise looking downwind.
struct Circle {
    centre: [f64; 2],
    radius: f64,
    frequency: f64,
}

impl Circle {
    /// Strouhal number of its frequency (–), positive counter-clockwise, as the helix turns.
    fn strouhal(&self) -> f64 {
        -self.frequency * DIAMETER / WIND
    }
}

/// Correlations over all draws by each filter, and the table of draws on standard error.
pub(super) fn rows() -> Vec<Row> {
    let mut random = Random(SEED);
    let mut draws = Vec::new();
    for number in 1..=N_DRAWS {
        match drawn(number, &mut random) {
            Ok(draw) => draws.push(draw),
            Err(problem) => return failure(problem),
        }
    }
    (0..FILTERS.len()).flat_map(|filter| of_filter(filter, &draws)).collect()
}

/// Correlation of the radius with the amplitude at one Strouhal number by each filter, and the table of
/// helices on standard error.
pub(super) fn rows_at_one_strouhal() -> Vec<Row> {
    let mut helices = Vec::new();
    for (number, amplitude) in GROWING.into_iter().enumerate() {
        match followed(&format!("free-vortex-amplitude-{}", number + 1), amplitude, FIXED) {
            Ok(helix) => helices.push(helix),
            Err(problem) => return failure(problem),
        }
    }
    let row = |(filter, (_, by)): (usize, (&str, &str))| {
        print_draws(filter, &helices);
        let radii: Vec<f64> = helices.iter().map(|helix| helix.circles[filter].radius).collect();
        Row {
            what: format!(
                "hub vortex at 1 D{by}, {} helices of 1.5 to 5.8° at St {FIXED}, nrel-5mw, {WIND} m/s even: correlation of its radius with the amplitude",
                GROWING.len()
            ),
            measured: correlation(&radii, &GROWING),
            expected: OF_RADIUS,
            tolerance: AtLeast,
            unit: "–",
            source: SOURCE,
        }
    };
    FILTERS.into_iter().enumerate().map(row).collect()
}

/// The two correlations by filter number `filter`. Radii fall with the Strouhal number as well as they grow
/// with the amplitude, and both are drawn: that with the amplitude at one Strouhal number is printed beside
/// them.
fn of_filter(filter: usize, draws: &[Draw]) -> [Row; 2] {
    let (name, by) = FILTERS[filter];
    print_draws(filter, draws);
    let of = |value: &dyn Fn(&Draw, &Circle) -> f64| -> Vec<f64> {
        draws.iter().map(|draw| value(draw, &draw.circles[filter])).collect()
    };
    let (amplitudes, strouhals) = (of(&|draw, _| draw.amplitude), of(&|draw, _| draw.strouhal));
    let (radii, rates) = (of(&|_, circle| circle.radius), of(&|_, circle| circle.strouhal()));
    tell!(
        "{name}: correlation of the radius with the amplitude at one Strouhal number {:.4}, with the Strouhal number at one amplitude {:.4}",
        partial_correlation(&radii, &amplitudes, &strouhals),
        partial_correlation(&radii, &strouhals, &amplitudes)
    );
    let row = |what: &str, measured: f64, expected: f64| Row {
        what: format!(
            "hub vortex at 1 D{by}, {N_DRAWS} helices of 1 to 6° and St 0.1 to 0.4, nrel-5mw, {WIND} m/s even: correlation of {what}"
        ),
        measured,
        expected,
        tolerance: AtLeast,
        unit: "–",
        source: SOURCE,
    };
    [
        row("its radius with the amplitude", correlation(&radii, &amplitudes), OF_RADIUS),
        row(
            "its frequency with the Strouhal number",
            correlation(&rates, &strouhals),
            OF_FREQUENCY,
        ),
    ]
}

fn print_draws(filter: usize, draws: &[Draw]) {
    tell!("by its {}:", FILTERS[filter].0);
    tell!(
        "| draw | amplitude | St | radius | St of the circle | turns | mean place, left and up |"
    );
    for (number, draw) in draws.iter().enumerate() {
        let circle = &draw.circles[filter];
        let Circle { centre: [left, up], radius, frequency } = circle;
        let sense = if *frequency > 0.0 { "cw" } else { "ccw" };
        tell!(
            "| {} | {:.2}° | {:.4} | {:.4} D | {:.4} | {sense} | {:+.4} D, {:+.4} D |",
            number + 1,
            draw.amplitude,
            draw.strouhal,
            radius / DIAMETER,
            circle.strouhal(),
            left / DIAMETER,
            up / DIAMETER
        );
    }
}

/// Draws a helix, runs it as study `number`, or takes up what is there, and follows the hub vortex.
fn drawn(number: usize, random: &mut Random) -> Result<Draw, String> {
    let mut between = |[low, high]: [f64; 2]| low + (high - low) * random.uniform();
    // Whole hundredths and thousandths: what is printed is what was run.
    let amplitude = (100.0 * between(AMPLITUDES)).round() / 100.0;
    let strouhal = (1000.0 * between(STROUHALS)).round() / 1000.0;
    followed(&format!("free-vortex-helix-{number:02}"), amplitude, strouhal)
}

/// Runs a helix of this `amplitude` (deg) and Strouhal number (–) as study `name`, or takes up what is there,
/// and follows the hub vortex.
fn followed(name: &str, amplitude: f64, strouhal: f64) -> Result<Draw, String> {
    let period = DIAMETER / (strouhal * WIND);
    let spin_up = period + PASSING;
    let overrides = vec![
        format!("run.helix.control.T1.amplitude_deg={amplitude}"),
        format!("run.helix.control.T1.strouhal={strouhal}"),
        format!("time.spin_up={spin_up:.1}"),
        format!("time.duration={:.1}", spin_up + RECORD),
    ];
    let case = Carried::Own(include_str!("../../cases/hub-vortex.toml"));
    let (_, folder) = summaries(case, name, overrides)?;
    let path = RunFolder::new(&folder, "helix").scans_path("T1", "lidar");
    let scans = read_scans(&path).map_err(|error| error.to_string())?;
    let circles =
        circles(&scans, spin_up).map_err(|problem| format!("{}: {problem}", path.display()))?;
    Ok(Draw { amplitude, strouhal, circles })
}

/// The circles that the hub vortex runs on in `scans` after `spin_up` (s), by each of the [`FILTERS`].
fn circles(scans: &StoredScans, spin_up: f64) -> Result<[Circle; 3], String> {
    let frame = scans.helix.ok_or("its turbine pitched no helix")?;
    let [first, .., last] = scans.times[..] else {
        return Err("there are no two scans".to_owned());
    };
    let interval = (last - first) / (scans.n_scans() - 1) as f64;
    let readings = (0..scans.n_scans()).map(|index| {
        let mut reading = Vec::new();
        scans.reading(index, 0..scans.n_points(), &mut reading);
        (scans.times[index], reading)
    });
    let readings: Vec<(f64, Vec<f64>)> = readings.collect();
    let radius = 0.5 * scans.rotor_diameter;
    let of = |settings| {
        let places = places(settings, &readings, spin_up)?;
        circle(&places, interval).map_err(|error| error.to_string())
    };
    Ok([
        of(HubVortexSettings::of_source(frame, radius, interval))?,
        of(HubVortexSettings::robust(frame, radius, interval))?,
        of(HubVortexSettings::centroid(frame, radius, interval))?,
    ])
}

/// Where the hub vortex is (m, left and up) in each of the `readings` of a lidar, each with its time (s),
/// after `spin_up` (s).
///
/// Before the low-pass filter: that would damp the radius the more the faster the helix is, and of noise
/// the fit of a circle takes care.
fn places(
    settings: HubVortexSettings,
    readings: &[(f64, Vec<f64>)],
    spin_up: f64,
) -> Result<Vec<[f64; 2]>, String> {
    let scans = readings.iter().filter_map(|(time, reading)| Some((*time, Scan::of(reading)?)));
    let followed = follow(settings, scans).map_err(|error| error.to_string())?;
    let analysed = || readings.iter().zip(&followed).filter(|((time, _), _)| *time > spin_up);
    let (n_held, n) = (analysed().filter(|(_, now)| now.held).count(), analysed().count());
    if n_held > 0 {
        tell!("the hub vortex was not found in {n_held} of {n} scans, and taken to have stayed");
    }
    Ok(analysed().map(|(_, now)| now.place).collect())
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

/// Pearson's coefficient of `a` and `b` (–).
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let (mean_a, mean_b) = (mean(a), mean(b));
    let sum = |x: &[f64], from: f64, y: &[f64], of: f64| {
        x.iter().zip(y).map(|(x, y)| (x - from) * (y - of)).sum::<f64>()
    };
    let scales = sum(a, mean_a, a, mean_a) * sum(b, mean_b, b, mean_b);
    sum(a, mean_a, b, mean_b) / scales.sqrt()
}

/// Pearson's coefficient of what a linear regression on `fixed` leaves of `a` and of `b` (–).
fn partial_correlation(a: &[f64], b: &[f64], fixed: &[f64]) -> f64 {
    let [together, of_a, of_b] = [correlation(a, b), correlation(a, fixed), correlation(b, fixed)];
    (together - of_a * of_b) / ((1.0 - of_a * of_a) * (1.0 - of_b * of_b)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::scan::ScanBlocks;
    use basis::{HelixFrame, Sense};
    use std::f64::consts::TAU;

    /// A scan of 80 points over the rotor's disc, 12.6 m apart, 1 D downwind at `time` (s): a wake with a
    /// jet of 2 m/s and 12 m at `place` (m).
    fn reading(time: f64, place: [f64; 2]) -> Vec<f64> {
        let grid = (-5..5).flat_map(|y| (-5..5).map(move |z| [y, z]));
        let grid = grid.map(|p: [i32; 2]| p.map(|index| 12.6 * (f64::from(index) + 0.5)));
        let points: Vec<[f64; 2]> = grid.filter(|[y, z]| y.hypot(*z) <= 63.0).collect();
        assert_eq!(points.len(), 80);
        let mut reading = vec![0.0; Scan::n_values(points.len())];
        let blocks = ScanBlocks::of(&mut reading).expect("whole points");
        blocks.head.copy_from_slice(&[1.0, 1.0]);
        let [downwind, left, up] = blocks.places;
        for (index, [y, z]) in points.into_iter().enumerate() {
            let away = (y - place[0]).hypot(z - place[1]) / 12.0;
            let speed = 5.0 + (y.hypot(z) / 63.0).powi(2) + 2.0 * (-0.5 * away * away).exp();
            (downwind[index], left[index], up[index]) = (DIAMETER, y, z);
            // A beam sees the cosine of an axial wind.
            blocks.speeds[index] = speed * DIAMETER / (DIAMETER * DIAMETER + y * y + z * z).sqrt();
            blocks.times[index] = time;
        }
        reading
    }

    #[test]
    fn both_filters_find_the_circle_of_a_jet() {
        let (frequency, interval) = (-0.025, 0.5);
        let at = |step: u32| {
            let time = interval * f64::from(step);
            let angle = TAU * frequency * time + 1.0;
            (time, reading(time, [1.0 + 13.0 * angle.cos(), -2.0 + 13.0 * angle.sin()]))
        };
        let readings: Vec<(f64, Vec<f64>)> = (0..240).map(at).collect();
        let frame = HelixFrame { sense: Sense::CounterClockwise, rate: TAU * 0.025 };
        let found = [
            (HubVortexSettings::of_source(frame, 63.0, interval), 0.2),
            (HubVortexSettings::robust(frame, 63.0, interval), 0.05),
        ];
        for (settings, tolerance) in found {
            let places = places(settings, &readings, 39.9).unwrap();
            assert_eq!(places.len(), 160);
            let circle = circle(&places, interval).unwrap();
            assert!((circle.radius / 13.0 - 1.0).abs() < tolerance, "{}", circle.radius);
            assert!((circle.frequency / frequency - 1.0).abs() < 0.02, "{}", circle.frequency);
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
        let along = [1.0, 2.0, 4.0, 7.0];
        assert!((correlation(&along, &along.map(|x| 3.0 - 2.0 * x)) + 1.0).abs() < 1e-12);
        // By hand: means 1 and 1/3, moments 2, 2/3 and 0.
        assert!(correlation(&[0.0, 1.0, 2.0], &[0.0, 1.0, 0.0]).abs() < 1e-12);
    }

    #[test]
    fn what_a_second_cause_does_is_taken_off() {
        let amplitudes = [1.0, 2.0, 3.0, 5.0, 6.0];
        let strouhals = [0.3, 0.1, 0.35, 0.2, 0.4];
        let radii: Vec<f64> =
            amplitudes.iter().zip(&strouhals).map(|(a, st)| 2.0 * a - 20.0 * st + 9.0).collect();
        let whole = correlation(&radii, &amplitudes);
        assert!(whole < 0.95, "{whole}");
        assert!((partial_correlation(&radii, &amplitudes, &strouhals) - 1.0).abs() < 1e-9);
        assert!((partial_correlation(&radii, &strouhals, &amplitudes) + 1.0).abs() < 1e-9);
        // Nothing to take off: the second is not along the third, the first neither.
        let (a, b, c) = ([1.0, -1.0, 1.0, -1.0], [1.0, -1.0, 0.0, 0.0], [1.0, 1.0, -1.0, -1.0]);
        assert!((partial_correlation(&a, &b, &c) - correlation(&a, &b)).abs() < 1e-12);
    }
}
