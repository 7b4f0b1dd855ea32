//! Tests of IEC turbulence.

use super::*;
use crate::inflow::iec::DEVIATION_RATIOS;

fn settings(seed: u64) -> KaimalSettings {
    KaimalSettings {
        n_points: [1024, 9, 7],
        spacing: [4.0, 10.0, 12.0],
        hub_speed: 8.0,
        hub_height: 100.0,
        lowest_height: 64.0,
        standard_deviation: 1.2,
        scaling: Scaling::None,
        seed,
        threads: Some(1),
    }
}

#[test]
fn is_the_same_for_any_number_of_threads_and_another_for_another_seed() {
    let one = generate(&settings(3), |_| {}).unwrap();
    let three = generate(&KaimalSettings { threads: Some(3), ..settings(3) }, |_| {}).unwrap();
    assert_eq!(one, three);
    assert_ne!(one, generate(&settings(4), |_| {}).unwrap());
}

#[test]
fn a_break_of_progress_ends_it_wherever_it_is() {
    for threads in [1, 3] {
        for last in [0.0, 0.3, 0.85, 0.99] {
            let reported = std::cell::RefCell::new(Vec::new());
            let ended = generate_until(
                &KaimalSettings { threads: Some(threads), ..settings(3) },
                |share| {
                    reported.borrow_mut().push(share);
                    if share > last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                },
            );
            assert_eq!(ended, Err(InflowError::BrokenOff), "{threads} threads, {last}");
            let reported = reported.into_inner();
            // Never asked again after the break, and by a single thread before a tenth more is done.
            let (end, before) = reported.split_last().expect("some progress");
            assert!(before.iter().all(|share| *share <= last), "{threads} threads, {last}");
            assert!(*end > last && (threads > 1 || *end <= last + 0.1), "{last}: {end}");
        }
    }
}

/// v and w have the same power at every point: the sum of the model's over the record's frequencies.
#[test]
fn lateral_points_have_the_power_of_the_model() {
    let settings = settings(1);
    let model = settings.model().unwrap();
    let turbulence = generate(&settings, |_| {}).unwrap();
    for component in [1, 2] {
        let expected: f64 = (1..512)
            .map(|wave| model.spectrum(component, settings.frequency(wave)) * settings.frequency(1))
            .sum();
        for point in [[0, 0], [4, 3], [8, 6]] {
            let square: f64 = (0..1024)
                .map(|x| f64::from(turbulence.at(component, [x, point[0], point[1]])).powi(2))
                .sum();
            assert!((square / 1024.0 / expected - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn scaling_meets_the_deviation_at_the_hub_or_everywhere() {
    let deviation = |turbulence: &TurbulenceBox, component: usize, point: [usize; 2]| {
        let square: f64 = (0..1024)
            .map(|x| f64::from(turbulence.at(component, [x, point[0], point[1]])).powi(2))
            .sum();
        (square / 1024.0).sqrt()
    };
    let hub = generate(&KaimalSettings { scaling: Scaling::Hub, ..settings(2) }, |_| {}).unwrap();
    let each =
        generate(&KaimalSettings { scaling: Scaling::EachPoint, ..settings(2) }, |_| {}).unwrap();
    for (component, ratio) in DEVIATION_RATIOS.into_iter().enumerate() {
        // The hub at 100 m is on row 3 and in column 4.
        assert!((deviation(&hub, component, [4, 3]) - 1.2 * ratio).abs() < 1e-5);
        for point in [[0, 0], [8, 6], [2, 5]] {
            assert!((deviation(&each, component, point) - 1.2 * ratio).abs() < 1e-5);
        }
    }
    assert!((deviation(&hub, 0, [0, 0]) - 1.2).abs() > 1e-3);
}

/// Over many seeds the cross-spectrum of u is the model's coherence times the spectrum, without a phase; v
/// has none.
#[test]
fn coherence_is_that_of_the_model() {
    let n_seeds = 60;
    let (mut u, mut v) = (Complex32::default(), Complex32::default());
    let mut power = 0.0;
    let wave = 6;
    let base = settings(0);
    let model = base.model().unwrap();
    for seed in 0..n_seeds {
        let settings = KaimalSettings { seed, ..base };
        let coherent = Coherent::new(&settings, &model);
        let phases = Phases::new(seed);
        let mut workspace = coherent::Workspace::default();
        let mut plane = vec![Complex32::default(); 63];
        assert!(coherent.fill(wave, 1.0, &phases, &mut workspace, &mut plane));
        for row in plane.chunks(9) {
            for pair in row.windows(3) {
                u += pair[0].conj() * pair[2];
                power += pair[0].norm_sqr();
            }
        }
        phases.fill(1, wave, 1.0, &mut workspace.bytes, &mut plane);
        v += plane[3].conj() * plane[5];
    }
    let expected = model.coherence(base.frequency(wave), 20.0);
    let measured = u / power;
    assert!((f64::from(measured.re) - expected).abs() < 0.04, "{measured} {expected}");
    assert!(measured.im.abs() < 0.04);
    assert!(v.norm() / (n_seeds as f32) < 0.4);
}

/// The roots of the eigenvalues give back the coherence that they were made of.
#[test]
fn little_is_clipped() {
    for n_points in [[1024, 9, 7], [1024, 31, 31], [64, 2, 2]] {
        let share = clipped_share(&KaimalSettings { n_points, ..settings(1) }).unwrap();
        assert!(share < 2e-4, "{n_points:?}: {share}");
    }
}

#[test]
fn settings_out_of_range_are_named() {
    for (wrong, name) in [
        (KaimalSettings { n_points: [1023, 9, 7], ..settings(1) }, "along x"),
        (KaimalSettings { n_points: [1024, 1, 7], ..settings(1) }, "points"),
        (KaimalSettings { hub_speed: 0.0, ..settings(1) }, "speed"),
        (KaimalSettings { standard_deviation: f64::NAN, ..settings(1) }, "deviation"),
        (KaimalSettings { spacing: [4.0, -1.0, 3.0], ..settings(1) }, "spacing"),
    ] {
        let error = generate(&wrong, |_| {}).unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
    }
}
