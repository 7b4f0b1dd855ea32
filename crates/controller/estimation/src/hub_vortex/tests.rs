//! A jet that circles in a wake, seen by a lidar of 80 points, against where it is.

use super::*;
use basis::scan::{Scan, ScanBlocks};
use basis::{HelixFrame, Sense};
use std::f64::consts::TAU;

const RADIUS: f64 = 63.0;
const INTERVAL: f64 = 0.1;
/// The source's helix: St 0.3 at 10 m/s on 126 m.
const RATE: f64 = TAU * 0.0238;

/// A wake with a jet in it.
#[derive(Clone, Copy)]
struct Wake {
    sense: Sense,
    /// Radius of the jet's circle (m).
    radius: f64,
    /// Middle of the circle: left and up (m).
    middle: [f64; 2],
    /// Phase of the circle at time zero (rad).
    phase: f64,
    /// Wind over a diameter of height (m/s).
    shear: f64,
    /// Standard deviation of noise (m/s).
    noise: f64,
    /// Share of points that are lost (–).
    dropout: f64,
    /// Times at which all are lost (s).
    blind: [f64; 2],
}

const PLAIN: Wake = Wake {
    sense: Sense::CounterClockwise,
    radius: 9.0,
    middle: [0.0, 0.0],
    phase: 0.7,
    shear: 0.0,
    noise: 0.0,
    dropout: 0.0,
    blind: [0.0, 0.0],
};

impl Wake {
    fn frame(&self) -> HelixFrame {
        HelixFrame { sense: self.sense, rate: RATE }
    }

    /// Left and up (m) of the jet at `time` (s): an open helix of tilt and yaw.
    fn jet(&self, time: f64) -> [f64; 2] {
        let own = self.frame().open_helix(self.radius, self.phase);
        let [tilt, yaw] = self.frame().to_fixed(time, own);
        [self.middle[0] - yaw, self.middle[1] + tilt]
    }

    /// On return `reading` is a scan at `time` (s).
    fn scan(&self, time: f64, random: &mut Random, reading: &mut [f64]) {
        let jet = self.jet(time);
        let blocks = ScanBlocks::of(reading).expect("80 points");
        let is_blind = (self.blind[0]..self.blind[1]).contains(&time);
        blocks.head[0] += 1.0;
        for (point, [y, z]) in grid().into_iter().enumerate() {
            let (x, r) = (2.0 * RADIUS, y.hypot(z) / RADIUS);
            let from_jet = (y - jet[0]).hypot(z - jet[1]);
            let wind = 10.0 - 4.5 * (-0.5 * (r / 0.8).powi(2)).exp()
                + 2.5 * (-0.5 * (from_jet / 12.0).powi(2)).exp()
                + self.shear * z / (2.0 * RADIUS);
            let speed = wind * x / (x * x + y * y + z * z).sqrt() + self.noise * random.normal();
            let is_lost = random.uniform() < self.dropout || is_blind;
            blocks.speeds[point] = if is_lost { f64::NAN } else { speed };
            blocks.places[0][point] = x;
            blocks.places[1][point] = y;
            blocks.places[2][point] = z;
            blocks.times[point] = time;
        }
    }

    fn follow(&self, settings: HubVortexSettings, duration: f64) -> Vec<(f64, HubVortex)> {
        let mut filter = HubVortexFilter::new(settings, 80).expect("such a filter can be");
        let (mut reading, mut random) = (vec![0.0; Scan::n_values(80)], Random(7));
        let n = (duration / INTERVAL) as usize;
        let one = |step: usize| {
            let time = step as f64 * INTERVAL;
            self.scan(time, &mut random, &mut reading);
            (time, filter.update(time, &Scan::of(&reading).expect("a scan")))
        };
        (0..n).map(one).collect()
    }

    fn robust(&self) -> HubVortexSettings {
        HubVortexSettings::robust(self.frame(), RADIUS, INTERVAL)
    }

    fn centroid(&self) -> HubVortexSettings {
        HubVortexSettings::centroid(self.frame(), RADIUS, INTERVAL)
    }

    fn of_source(&self) -> HubVortexSettings {
        HubVortexSettings::of_source(self.frame(), RADIUS, INTERVAL)
    }
}

/// 80 points of a square grid in the disc.
fn grid() -> Vec<[f64; 2]> {
    let spacing = RADIUS * (std::f64::consts::PI / 80.0).sqrt();
    let places = (-5..5).flat_map(|y| (-5..5).map(move |z| [y, z]));
    let places = places.map(|p| p.map(|index: i32| spacing * (f64::from(index) + 0.5)));
    places.filter(|[y, z]| y.hypot(*z) < RADIUS).collect()
}

/// Numbers of a congruence, good enough for noise.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64 + 0.5) / (1_u64 << 31) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// Greatest errors of the helix frame's radius, in parts of the circle's, and of its angle (°), once settled.
fn errors(wake: &Wake, found: &[(f64, HubVortex)]) -> (f64, f64) {
    let expected = wake.frame().open_helix(wake.radius, wake.phase);
    let settled = found.iter().filter(|(_, vortex)| vortex.settled);
    let mut most = (0.0_f64, 0.0_f64);
    for (_, HubVortex { helix, .. }) in settled {
        let radius = helix[0].hypot(helix[1]) / wake.radius - 1.0;
        let turn = helix[1].atan2(helix[0]) - expected[1].atan2(expected[0]);
        most.0 = most.0.max(radius.abs());
        most.1 = most.1.max(basis::angle::wrap_to_half_turn(turn).abs().to_degrees());
    }
    most
}

#[test]
fn a_circling_jet_is_found_and_stands_still_in_the_helix_frame() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        for radius in [5.0, 9.0, 15.0] {
            let wake = Wake { sense, radius, ..PLAIN };
            let found = wake.follow(wake.robust(), 120.0);
            assert!(found.last().expect("samples").1.settled);
            let (of_radius, of_angle) = errors(&wake, &found);
            assert!(
                of_radius < 0.02 && of_angle < 2.0,
                "{sense} {radius}: {of_radius} {of_angle}°"
            );
            let sure = found.iter().filter(|(_, v)| v.settled).map(|(_, v)| v.confidence);
            assert!(sure.fold(1.0, f64::min) > 0.9);
        }
    }
}

#[test]
fn without_its_delay_made_good_the_helix_frame_is_late_by_rate_times_delay() {
    let late = HubVortexSettings { compensates: false, ..PLAIN.robust() };
    let found = PLAIN.follow(late, 120.0);
    let made_good = PLAIN.follow(PLAIN.robust(), 120.0);
    let angle = |vortex: &HubVortex| vortex.helix[1].atan2(vortex.helix[0]);
    for ((_, late), (_, exact)) in found.iter().zip(&made_good).filter(|((_, v), _)| v.settled) {
        let turn = basis::angle::wrap_to_half_turn(angle(late) - angle(exact));
        assert!((late.delay - 2.5).abs() < 0.02);
        assert!((turn - RATE * late.delay).abs() < 1e-9, "{turn}");
    }
}

/// Mean of the helix frame over the last period against where it should be: parts of the radius, and °.
fn mean_errors(wake: &Wake, found: &[(f64, HubVortex)]) -> (f64, f64) {
    let n = (TAU / (RATE * INTERVAL)).round() as usize;
    let expected = wake.frame().open_helix(wake.radius, wake.phase);
    let mean = |axis: usize| {
        found[found.len() - n..].iter().map(|(_, vortex)| vortex.helix[axis]).sum::<f64>()
            / n as f64
    };
    let turn = mean(1).atan2(mean(0)) - expected[1].atan2(expected[0]);
    let radius = mean(0).hypot(mean(1)) / wake.radius - 1.0;
    (radius.abs(), basis::angle::wrap_to_half_turn(turn).abs().to_degrees())
}

/// Its points are 12 m apart, so that its place goes in steps; over a period they even out.
#[test]
fn the_fast_region_of_the_source_follows_the_jet() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        let wake = Wake { sense, radius: 15.0, ..PLAIN };
        let made_good = HubVortexSettings { compensates: true, ..wake.of_source() };
        let found = wake.follow(made_good, 120.0);
        let (of_radius, of_angle) = mean_errors(&wake, &found);
        assert!(of_radius < 0.1 && of_angle < 3.0, "{of_radius} {of_angle}°");
        let (of_radius, of_angle) = errors(&wake, &found);
        assert!(of_radius < 0.25 && of_angle < 12.0, "{of_radius} {of_angle}°");
        // As the source has it, late by the low-pass filter's 2.5 s.
        let late = wake.follow(wake.of_source(), 120.0);
        let (_, of_angle) = mean_errors(&wake, &late);
        assert!((of_angle - (RATE * 2.5).to_degrees()).abs() < 3.0, "{of_angle}°");
    }
}

/// Tilt and yaw of the last sample (m).
fn last(found: &[(f64, HubVortex)]) -> [f64; 2] {
    found.last().expect("samples").1.helix
}

#[test]
fn the_centroid_turns_with_the_jet_and_goes_with_its_circle() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        let of = |radius| {
            let wake = Wake { sense, radius, shear: 2.5, ..PLAIN };
            last(&wake.follow(wake.centroid(), 120.0))
        };
        let (narrow, wide) = (of(4.0), of(12.0));
        let ratio = wide[0].hypot(wide[1]) / narrow[0].hypot(narrow[1]);
        assert!((ratio / 3.0 - 1.0).abs() < 0.03, "{ratio}");
        let expected = Wake { sense, ..PLAIN }.frame().open_helix(1.0, PLAIN.phase);
        let turn = wide[1].atan2(wide[0]) - expected[1].atan2(expected[0]);
        assert!(basis::angle::wrap_to_half_turn(turn).abs() < 0.03, "{turn}");
    }
}

/// What is lost has a middle of its own: it takes none of the place, but leaves a noise.
#[test]
fn drop_outs_move_the_centroid_little() {
    let whole = last(&PLAIN.follow(PLAIN.centroid(), 120.0));
    let wake = Wake { dropout: 0.3, ..PLAIN };
    let found = last(&wake.follow(wake.centroid(), 120.0));
    let apart = (found[0] - whole[0]).hypot(found[1] - whole[1]);
    assert!(apart < 0.2 * whole[0].hypot(whole[1]), "{apart} m of {whole:?}");
}

#[test]
fn shear_and_a_middle_off_the_axis_do_not_move_the_robust_place() {
    let wake = Wake { shear: 2.5, middle: [4.0, -6.0], ..PLAIN };
    let found = wake.follow(wake.robust(), 120.0);
    let (of_radius, of_angle) = errors(&wake, &found);
    assert!(of_radius < 0.04 && of_angle < 3.0, "{of_radius} {of_angle}°");
    let mean = found.last().expect("samples").1.mean;
    assert!((mean[0] - 4.0).hypot(mean[1] + 6.0) < 0.6, "{mean:?}");
}

#[test]
fn noise_and_drop_outs_are_borne_and_told() {
    let wake = Wake { noise: 0.3, dropout: 0.2, ..PLAIN };
    let found = wake.follow(wake.robust(), 160.0);
    let (of_radius, of_angle) = errors(&wake, &found);
    assert!(of_radius < 0.35 && of_angle < 15.0, "{of_radius} {of_angle}°");
    let (of_radius, of_angle) = mean_errors(&wake, &found);
    assert!(of_radius < 0.08 && of_angle < 3.0, "{of_radius} {of_angle}°");
    let mean = |found: &[(f64, HubVortex)]| {
        found.iter().map(|(_, vortex)| vortex.confidence).sum::<f64>() / found.len() as f64
    };
    let clear = mean(&PLAIN.follow(PLAIN.robust(), 160.0));
    let noise_alone = Wake { noise: 3.0, ..PLAIN };
    let [some, little] = [mean(&found), mean(&noise_alone.follow(noise_alone.robust(), 160.0))];
    assert!(clear > some + 0.1 && some > little + 0.1, "{clear} {some} {little}");
}

#[test]
fn a_blind_lidar_is_told_and_what_it_left_out_does_not_turn_the_frame() {
    let wake = Wake { blind: [80.0, 90.0], ..PLAIN };
    let found = wake.follow(wake.robust(), 140.0);
    let at = |time: f64| found[(time / INTERVAL) as usize].1;
    assert!(!at(79.0).held && at(79.0).confidence > 0.9);
    assert!(at(85.0).held && at(86.0).confidence == 0.0);
    assert!((at(88.0).delay - at(87.0).delay - 1.0).abs() < 1e-9);
    let (of_radius, of_angle) = errors(&wake, &found);
    assert!(of_radius < 0.05 && of_angle < 4.0, "{of_radius} {of_angle}°");
    // Never seen anything: nothing is told.
    let blind = Wake { blind: [0.0, 1e9], ..PLAIN };
    let nothing = blind.follow(blind.robust(), 10.0);
    assert!(nothing.iter().all(|(_, vortex)| vortex.held && vortex.confidence == 0.0));
}

#[test]
fn a_record_gives_the_same_bits_and_a_checkpoint_goes_on_with_them() {
    let wake = Wake { noise: 0.3, dropout: 0.1, ..PLAIN };
    let mut random = Random(7);
    let readings: Vec<Vec<f64>> = (0..900)
        .map(|step| {
            let mut reading = vec![0.0; Scan::n_values(80)];
            wake.scan(f64::from(step) * INTERVAL, &mut random, &mut reading);
            reading
        })
        .collect();
    let scans = || {
        let times = (0..900).map(|step| f64::from(step) * INTERVAL);
        times.zip(readings.iter().map(|reading| Scan::of(reading).expect("a scan")))
    };
    for settings in [wake.robust(), wake.of_source()] {
        let whole = follow(settings, scans()).expect("it can be followed");
        let mut first = HubVortexFilter::new(settings, 80).expect("such a filter can be");
        for (time, scan) in scans().take(500) {
            first.update(time, &scan);
        }
        let stored = postcard::to_stdvec(first.state()).expect("plain data serialises");
        let mut second = HubVortexFilter::new(settings, 80).expect("such a filter can be");
        second.restore(postcard::from_bytes(&stored).expect("what was written is read"));
        for ((time, scan), expected) in scans().zip(&whole).skip(500) {
            assert_eq!(second.update(time, &scan), *expected);
        }
    }
}

#[test]
fn settings_that_cannot_be_are_refused_by_name() {
    let refused = |settings: HubVortexSettings| {
        HubVortexFilter::new(settings, 80).expect_err("refused").to_string()
    };
    let fine = PLAIN.robust();
    let window = Search { method: Method::Jet { width: 0.0 }, ..fine.search };
    assert!(refused(HubVortexSettings { search: window, ..fine }).contains("width"));
    let threshold = Search { method: Method::FastRegion { threshold: 1.0 }, ..fine.search };
    assert!(refused(HubVortexSettings { search: threshold, ..fine }).contains("threshold"));
    assert!(refused(HubVortexSettings { interval: 0.0, ..fine }).contains("interval"));
    assert!(refused(HubVortexSettings { cut_off: 6.0, ..fine }).contains("cut-off"));
    let still = HelixFrame { rate: 0.0, ..fine.frame };
    assert!(refused(HubVortexSettings { frame: still, ..fine }).contains("rate"));
}
