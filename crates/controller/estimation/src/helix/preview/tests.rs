//! A shear that turns at the helix's rate, carried by the wind towards a lidar that looks at it.

use super::*;
use basis::angle::wrap_to_half_turn;
use basis::mixed;
use basis::scan::ScanBlocks;

const RADIUS: f64 = 120.0;
const SPEED: f64 = 9.0;
/// St 0.25: a period of 107 s.
const RATE: f64 = TAU * 0.25 * SPEED / (2.0 * RADIUS);
const INTERVAL: f64 = 0.2;
const PERIOD: f64 = TAU / RATE;
/// Two diameters and a half: 0.62 of a period.
const UPSTREAM: f64 = 600.0;

/// What is wrong with a scan.
#[derive(Clone, Copy, Default)]
struct Flaws {
    /// Standard deviation of each speed (m/s).
    noise: f64,
    /// Share of points that are lost (–).
    dropout: f64,
}

/// A number from −√3 to √3, of variance one.
fn random(seed: u64) -> f64 {
    let share = (mixed(seed) >> 11) as f64 / (1_u64 << 53) as f64;
    3.0_f64.sqrt() * (2.0 * share - 1.0)
}

/// Tilt and yaw at the rotor at a time (s), each with a constant, and the wave's phase (rad) among them.
struct Wave {
    sense: Sense,
    phases: fn(f64) -> [f64; 2],
    amplitude: f64,
}

impl Wave {
    fn at(&self, time: f64) -> [f64; 2] {
        let [tilt, yaw] = (self.phases)(time);
        let angle = RATE * time;
        let yaw_angle = angle + self.sense.yaw_lead() + yaw;
        [0.9 + self.amplitude * (angle + tilt).sin(), -0.3 + self.amplitude * yaw_angle.sin()]
    }

    /// A scan of a grid of 9 × 9 points at `time` (s); lines of sight from the rotor's centre.
    fn scan(&self, time: f64, upstream: f64, flaws: Flaws) -> Vec<f64> {
        let mut values = vec![0.0; Scan::n_values(81)];
        let mut blocks = ScanBlocks::of(&mut values).expect("whole points");
        let [tilt, yaw] = self.at(time + upstream / SPEED);
        let seed = (time / INTERVAL).round() as u64 * 1000;
        for point in 0..81 {
            let place = |index: usize| 26.0 * (index as f64 - 4.0);
            let (left, up) = (place(point % 9), place(point / 9));
            let wind = SPEED + 2.0 * (tilt * up - yaw * left) / RADIUS;
            let along = -upstream / (upstream * upstream + left * left + up * up).sqrt();
            let draw = |which: u64| random(seed + 2 * point as u64 + which);
            let is_lost = draw(0) < 3.0_f64.sqrt() * (2.0 * flaws.dropout - 1.0);
            let speed = wind * along + flaws.noise * draw(1);
            blocks.speeds[point] = if is_lost { f64::NAN } else { speed };
            for (block, value) in blocks.places.iter_mut().zip([-upstream, left, up]) {
                block[point] = value;
            }
            blocks.times[point] = time;
        }
        values
    }
}

fn estimator(sense: Sense) -> PreviewEstimator {
    let settings = PreviewSettings { sense, rate: RATE, radius: RADIUS, speed_factor: 1.0 };
    PreviewEstimator::new(settings).expect("sound settings")
}

/// Estimates each interval up to `duration` (s), each with the time; scans come where `sees` says so.
fn run(
    wave: &Wave,
    upstream: f64,
    flaws: Flaws,
    duration: f64,
    sees: impl Fn(f64) -> bool,
) -> Vec<(f64, PreviewEstimate)> {
    let mut estimator = estimator(wave.sense);
    let n = (duration / INTERVAL) as usize;
    let one = |step: usize| {
        let time = step as f64 * INTERVAL;
        let values = sees(time).then(|| wave.scan(time, upstream, flaws));
        let scan = values.as_deref().and_then(Scan::of);
        (time, estimator.update((time, INTERVAL), scan.as_ref(), 0.0))
    };
    (0..n).map(one).collect()
}

/// Errors of tilt's and yaw's phase (deg).
fn errors(wave: &Wave, time: f64, found: &PreviewEstimate) -> [f64; 2] {
    let truth = (wave.phases)(time);
    let phases = [found.tilt.phase, found.yaw.phase];
    [0, 1].map(|axis| wrap_to_half_turn(phases[axis] - truth[axis]).to_degrees())
}

const STEADY: fn(f64) -> [f64; 2] = |_| [0.7, 2.5];

#[test]
fn a_turning_shear_is_found_without_lag_in_either_sense() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        let wave = Wave { sense, phases: STEADY, amplitude: 0.8 };
        let found = run(&wave, UPSTREAM, Flaws::default(), 4.0 * PERIOD, |_| true);
        let settled = UPSTREAM / SPEED + 0.5 * PERIOD + INTERVAL;
        for (time, found) in found.iter().filter(|(time, _)| *time > settled) {
            let [tilt, yaw] = errors(&wave, *time, found);
            assert!(tilt.abs() < 0.01 && yaw.abs() < 0.01, "{time} s: {tilt}, {yaw}");
            assert!((found.tilt.amplitude - 0.8).abs() < 1e-6);
            assert!((found.yaw.amplitude - 0.8).abs() < 1e-6);
            assert_eq!((found.share, found.lag), (1.0, 0.0));
            assert!((found.ahead - UPSTREAM / SPEED).abs() < 1e-6);
            assert!(found.trust.overall() > 0.99);
        }
    }
}

#[test]
fn noise_and_lost_beams_turn_the_phase_by_less_than_two_degrees() {
    let wave = Wave { sense: Sense::CounterClockwise, phases: STEADY, amplitude: 0.8 };
    let flaws = Flaws { noise: 1.0, dropout: 0.3 };
    // Of five scans one never comes.
    let sees = |time: f64| (time / INTERVAL).round() as u64 % 5 != 3;
    let settled = UPSTREAM / SPEED + 0.5 * PERIOD + INTERVAL;
    let found = run(&wave, UPSTREAM, flaws, 5.0 * PERIOD, sees);
    for (time, found) in found.iter().filter(|(time, _)| *time > settled) {
        let [tilt, yaw] = errors(&wave, *time, found);
        assert!(tilt.abs() < 2.0 && yaw.abs() < 2.0, "{time} s: {tilt}, {yaw}");
        assert_eq!(found.share, 1.0);
    }
}

/// A phase that swings within four periods is followed with no lag, and all but the share of its swing that a
/// mean over a period takes: 1 − sin(π/4)/(π/4), a tenth.
#[test]
fn a_helix_of_changing_phase_is_followed_without_lag() {
    fn swing(time: f64) -> f64 {
        0.5 * (TAU * time / (4.0 * PERIOD)).sin()
    }
    let wave = Wave {
        sense: Sense::Clockwise,
        phases: |time| [0.7 + swing(time), 2.5 + swing(time)],
        amplitude: 0.8,
    };
    let found = run(&wave, UPSTREAM, Flaws::default(), 12.0 * PERIOD, |_| true);
    for axis in 0..2 {
        let (mut sum, mut squares, mut lagging, mut slopes) = (0.0, 0.0, 0.0, 0.0);
        let mut n = 0.0;
        for (time, found) in found.iter().filter(|(time, _)| *time > 4.0 * PERIOD) {
            let error = errors(&wave, *time, found)[axis].to_radians();
            let slope = (swing(time + 0.1) - swing(time - 0.1)) / 0.2;
            sum += error;
            squares += error * error;
            lagging -= error * slope;
            slopes += slope * slope;
            n += 1.0;
        }
        // A lag by Δ has the error −Δ times the slope; half a slot is what a window can be off by.
        let lag = lagging / slopes;
        assert!(lag.abs() < 0.5 * PERIOD / N_SLOTS as f64, "axis {axis}: {lag} s");
        let rms = (squares / n - (sum / n).powi(2)).sqrt();
        assert!(rms < 0.15 * 0.5 / 2.0_f64.sqrt(), "axis {axis}: {rms}");
    }
}

#[test]
fn a_lidar_that_looks_too_near_is_told_its_lag() {
    // 0.3 of a period ahead, where half a one is needed.
    let upstream = 0.3 * PERIOD * SPEED;
    let wave = Wave { sense: Sense::CounterClockwise, phases: STEADY, amplitude: 0.8 };
    let found = run(&wave, upstream, Flaws::default(), 4.0 * PERIOD, |_| true);
    let (time, last) = found.last().expect("estimates");
    assert!((last.lag - 0.2 * PERIOD).abs() < 1e-6 * PERIOD, "{}", last.lag);
    assert!((last.ahead - 0.3 * PERIOD).abs() < 1e-6 * PERIOD);
    assert_eq!(last.share, 1.0);
    // A steady phase is found all the same.
    assert!(errors(&wave, *time, last).iter().all(|error| error.abs() < 0.1));
    let least = estimator(wave.sense).least_distance(SPEED);
    assert!((least - 0.5 * PERIOD * SPEED).abs() < 1e-9);
}

#[test]
fn a_blind_lidar_counts_less_as_its_wind_runs_out_and_for_nothing_then() {
    let wave = Wave { sense: Sense::CounterClockwise, phases: STEADY, amplitude: 0.8 };
    let (blind, back) = (4.0 * PERIOD, 6.0 * PERIOD);
    let sees = |time: f64| time < blind || time >= back;
    let found = run(&wave, UPSTREAM, Flaws::default(), 9.0 * PERIOD, sees);
    let slot = PERIOD / N_SLOTS as f64;
    // What is seen lasts for the way; the window's later half is empty at its end.
    let runs_out = blind + UPSTREAM / SPEED;
    for (time, found) in found.iter().filter(|(time, _)| *time > 2.0 * PERIOD) {
        if *time < runs_out - 0.5 * PERIOD || *time > back + UPSTREAM / SPEED + 0.5 * PERIOD + slot
        {
            assert_eq!(found.share, 1.0, "{time} s");
        } else if *time > runs_out + 4.0 * slot && *time < back + UPSTREAM / SPEED - 4.0 * slot {
            assert_eq!(found.share, 0.0, "{time} s");
        }
        if found.share > 0.0 {
            assert!(errors(&wave, *time, found).iter().all(|error| error.abs() < 0.1), "{time} s");
        }
    }
}

/// Tilt and yaw that are eddies alone: no phase in them is to be trusted.
#[test]
fn eddies_alone_are_not_trusted() {
    let mut estimator = estimator(Sense::CounterClockwise);
    let keeps = (-INTERVAL * SPEED / RADIUS).exp();
    let (mut eddies, mut trust, mut n) = ([0.0; 2], 0.0, 0.0);
    let wave = Wave { sense: Sense::CounterClockwise, phases: STEADY, amplitude: 0.0 };
    for step in 0..(60.0 * PERIOD / INTERVAL) as u64 {
        let time = step as f64 * INTERVAL;
        for (axis, eddy) in eddies.iter_mut().enumerate() {
            let push = random(7 + 2 * step + axis as u64);
            *eddy = keeps * *eddy + 0.6 * (1.0_f64 - keeps * keeps).sqrt() * push;
        }
        let mut values = wave.scan(time, UPSTREAM, Flaws::default());
        let blocks = ScanBlocks::of(&mut values).expect("whole points");
        for point in 0..81 {
            let [left, up] = [blocks.places[1][point], blocks.places[2][point]];
            let along = -UPSTREAM / (UPSTREAM * UPSTREAM + left * left + up * up).sqrt();
            blocks.speeds[point] += 2.0 * (eddies[0] * up - eddies[1] * left) / RADIUS * along;
        }
        let found = estimator.update((time, INTERVAL), Scan::of(&values).as_ref(), 0.0);
        if time > 10.0 * PERIOD {
            trust += found.trust.overall();
            n += 1.0;
        }
    }
    assert!(trust / n < 0.1, "{}", trust / n);
}

/// A line of sight far off the axis tells of the axial wind only what is left of it there.
#[test]
fn points_that_look_across_the_wind_are_left_out() {
    // 59.5° and 60.5° off the axis, behind the rotor, and at its centre.
    let places = [(-100.0, 169.8), (-100.0, 176.7), (100.0, 0.0), (0.0, 0.0)];
    let mut values = vec![0.0; Scan::n_values(places.len())];
    let blocks = ScanBlocks::of(&mut values).expect("whole points");
    for (point, (downwind, up)) in places.into_iter().enumerate() {
        blocks.speeds[point] = -4.0;
        blocks.places[0][point] = downwind;
        blocks.places[2][point] = up;
    }
    let scan = Scan::of(&values).expect("whole points");
    let seen: Vec<bool> = (0..places.len()).map(|index| point(&scan, index).is_some()).collect();
    assert_eq!(seen, [true, false, false, false]);
    let wind = point(&scan, 0).expect("seen").wind;
    assert!((wind - 4.0 / 59.5_f64.to_radians().cos()).abs() < 0.01, "{wind}");
}

#[test]
fn it_goes_on_from_its_state_to_the_same_bits() {
    let wave = Wave { sense: Sense::Clockwise, phases: STEADY, amplitude: 0.8 };
    let flaws = Flaws { noise: 0.5, dropout: 0.2 };
    let [mut whole, mut resumed] = [0, 1].map(|_| estimator(wave.sense));
    let n = (2.0 * PERIOD / INTERVAL) as usize;
    for step in 0..n {
        let time = step as f64 * INTERVAL;
        let values = wave.scan(time, UPSTREAM, flaws);
        let scan = Scan::of(&values);
        let found = whole.update((time, INTERVAL), scan.as_ref(), 0.2);
        if step > n / 2 {
            assert_eq!(resumed.update((time, INTERVAL), scan.as_ref(), 0.2), found);
        } else if step == n / 2 {
            resumed.restore(whole.state().clone());
        }
    }
}

/// The phase is that of the wind without the rotor: what the rotor slows at the scan is made good.
#[test]
fn the_slowing_at_the_scan_is_made_good() {
    let wave = Wave { sense: Sense::CounterClockwise, phases: STEADY, amplitude: 0.8 };
    let induction = 0.3;
    let share = slowing::speed_share(UPSTREAM, RADIUS, induction);
    let mut estimator = estimator(wave.sense);
    let mut found = PreviewEstimate::NONE;
    let n = (3.0 * PERIOD / INTERVAL) as usize;
    for step in 0..n {
        let time = step as f64 * INTERVAL;
        let mut values = wave.scan(time, UPSTREAM, Flaws::default());
        let blocks = ScanBlocks::of(&mut values).expect("whole points");
        blocks.speeds.iter_mut().for_each(|speed| *speed *= share);
        found = estimator.update((time, INTERVAL), Scan::of(&values).as_ref(), induction);
    }
    let speed = estimator.speed().expect("a wind was seen");
    assert!((found.ahead - UPSTREAM / speed).abs() < 1e-9);
    // The grid's upper half is faster in shear, its lower half slower by as much.
    assert!((speed - SPEED).abs() < 1e-9, "{speed}");
    let time = (n - 1) as f64 * INTERVAL;
    assert!(errors(&wave, time, &found).iter().all(|error| error.abs() < 0.01));
    assert!((found.tilt.amplitude - 0.8).abs() < 1e-6, "{}", found.tilt.amplitude);
}

/// What carries a shear is the wind where the shear shows.
#[test]
fn the_speed_is_that_of_the_rim_more_than_of_the_middle() {
    let mut estimator = estimator(Sense::CounterClockwise);
    // Half the radius and the whole of it, four points each, once with one more in the middle.
    let mut values = vec![0.0; Scan::n_values(9)];
    let mut blocks = ScanBlocks::of(&mut values).expect("whole points");
    for point in 0..9 {
        let (distance, wind) = match point {
            8 => (0.0, 1.0),
            _ if point % 2 == 0 => (0.5 * RADIUS, 4.0),
            _ => (RADIUS, 9.0),
        };
        let (sine, cosine) = (std::f64::consts::FRAC_PI_4 * point as f64).sin_cos();
        let (left, up) = (distance * cosine, distance * sine);
        let length = (UPSTREAM * UPSTREAM + distance * distance).sqrt();
        blocks.speeds[point] = -wind * UPSTREAM / length;
        for (block, value) in blocks.places.iter_mut().zip([-UPSTREAM, left, up]) {
            block[point] = value;
        }
    }
    estimator.update((0.0, INTERVAL), Scan::of(&values).as_ref(), 0.0);
    let speed = estimator.speed().expect("a wind was seen");
    assert!((speed - (0.25 * 4.0 + 9.0) / 1.25).abs() < 1e-9, "{speed}");
}

#[test]
fn a_preview_takes_the_place_of_the_loads_as_far_as_it_sees() {
    let axis = |amplitude: f64, phase: f64| Axis {
        amplitude,
        amplitude_variance: 0.01,
        phase,
        phase_variance: 0.04,
    };
    let own = axis(1.0, 0.2);
    let seen = axis(2.0, 1.2);
    assert_eq!(own.blended(seen, 1.0).amplitude, 2.0);
    assert!((own.blended(seen, 1.0).phase - 1.2).abs() < 1e-12);
    let half = own.blended(seen, 0.5);
    assert!((half.phase - 0.7).abs() < 1e-12 && (half.amplitude - 1.5).abs() < 1e-12);
    // The short way round.
    let around = axis(1.0, 0.1).blended(axis(1.0, TAU - 0.1), 0.5);
    assert!(wrap_to_half_turn(around.phase).abs() < 1e-12);
}
