//! The noise of the helix estimator: given per time, so that its interval does not matter; and what its forms
//! make of outliers.

mod machine;

use basis::Sense;
use basis::angle::wrap_to_half_turn;
use estimation::helix::*;
use estimation::{Estimator, HelixEstimator};
use machine::*;

/// Three helix periods.
const CONVERGED: f64 = 3.0 * PERIOD;

/// The filter is one whatever its interval: what it believes of its own errors, and the errors themselves
/// where noise of one intensity is read more or less often.
#[test]
fn variance_and_error_do_not_depend_on_the_interval() {
    let definition = definition();
    let sense = Sense::CounterClockwise;
    let forms = [
        HelixOptions { adaptation: None, ..HelixOptions::default() },
        HelixOptions::default(),
        HelixOptions { update_every: 2, ..HelixOptions::default() },
        HelixOptions::published(),
    ];
    for options in forms {
        let [fine, coarse] = [0.05, 0.1].map(|interval| {
            let set = HelixSettings { interval, ..setting(sense) };
            let mut model = model(&definition, sense, &options);
            let mut estimator = HelixEstimator::new(&definition, &set, options).unwrap();
            let mut dice = Dice(21);
            let world = World { noise: 0.05 * (0.1 / interval).sqrt(), ..World::new(sense, 1.0) };
            let (mut variance, mut square, mut n) = (0.0, 0.0, 0.0);
            for step in 0..(8.0 * PERIOD / interval) as usize {
                let read = world.read_every(interval, step, &mut model, &mut dice);
                let estimate = estimator.update(&read);
                if read.time > CONVERGED {
                    variance += estimate.tilt.phase_variance;
                    square += wrap_to_half_turn(estimate.tilt.phase - 1.0).powi(2);
                    n += 1.0;
                }
            }
            [variance / n, square / n]
        });
        let ratio = coarse[0] / fine[0];
        assert!((ratio - 1.0).abs() < 0.1, "{:?}: {ratio}", options.form);
        // Errors of one draw each, over some five memories of the filter.
        let ratio = coarse[1] / fine[1];
        assert!((0.2..5.0).contains(&ratio), "{:?}: {ratio}", options.form);
    }
}

/// Outliers pull the published form, which knows no Huber, further than the robust one.
#[test]
fn the_published_form_gives_every_innovation_its_full_weight() {
    let definition = definition();
    let sense = Sense::CounterClockwise;
    let published = HelixOptions::published();
    assert_eq!((published.huber_limit, published.rotor.weight), (None, false));
    let with_huber = HelixOptions { huber_limit: Some(3.0), ..published };
    let [plain, weighted] = [published, with_huber].map(|options| {
        let mut model = model(&definition, sense, &options);
        let mut estimator = HelixEstimator::new(&definition, &setting(sense), options).unwrap();
        let (world, mut dice, mut square) = (World::new(sense, 1.0), Dice(5), 0.0);
        for step in 0..(6.0 * PERIOD / INTERVAL) as usize {
            let mut read = world.read(step, &mut model, &mut dice);
            if dice.uniform() < 0.02 {
                read.flap_moments[0] *= 2.0;
            }
            let estimate = estimator.update(&read);
            if read.time > CONVERGED {
                square += wrap_to_half_turn(estimate.tilt.phase - 1.0).powi(2);
            }
        }
        square
    });
    assert!(plain > 1.2 * weighted, "{plain} {weighted}");
}
