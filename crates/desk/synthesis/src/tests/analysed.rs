//! Margins, predictors, reduction.

use super::*;
use std::f64::consts::PI;

fn unity() -> StateSpace {
    StateSpace::gain(mat![[1.0]], None)
}

/// L = k/(s (s + 1) (s + 2)): gain margin 6/k; the phase at the crossover tells the others.
#[test]
fn margins_of_one_channel_are_their_closed_forms() {
    let plant = rational(&[2.0], &[1.0, 3.0, 2.0, 0.0]);
    let around = Loop::new(plant.clone(), unity()).unwrap();
    let found = around.output_margins().unwrap()[0];
    assert!((found.gain_increase.unwrap() - 3.0).abs() < 1e-9, "{found:?}");
    assert_eq!(found.gain_decrease, None);
    let crossover = found.crossover.unwrap();
    assert!((plant.singular_values(crossover).unwrap()[0] - 1.0).abs() < 1e-9);
    let phase = 0.5 * PI - crossover.atan() - (0.5 * crossover).atan();
    assert!((found.phase.unwrap() - phase).abs() < 1e-9, "{found:?} {phase}");
    assert!((found.delay.unwrap() - phase / crossover).abs() < 1e-9);
    assert_eq!(around.input_margins().unwrap()[0], found);
    // Half the margin's gain is stood, twice is not.
    assert!(Loop::new(plant.clone(), unity().scaled(2.9)).unwrap().stable_or_error().is_ok());
    assert!(Loop::new(plant, unity().scaled(3.1)).unwrap().stable_or_error().is_err());
}

/// L = 2/(s − 1): stable down to half the gain.
#[test]
fn a_plant_that_is_not_stable_has_a_least_gain() {
    let around = Loop::new(rational(&[2.0], &[1.0, -1.0]), unity()).unwrap();
    let found = around.output_margins().unwrap()[0];
    assert!((found.gain_decrease.unwrap() - 0.5).abs() < 1e-12, "{found:?}");
    assert_eq!(found.gain_increase, None);
    // Crossover at √3; phase of 2/(√3 i − 1) is −120°.
    assert!((found.phase.unwrap() - PI / 3.0).abs() < 1e-9);
}

/// For 1/s, (S − T)/2 = (s − 1)/(2 (s + 1)) is all-pass: the disc margin is 2 (any gain, 90°), S reaches
/// 1/√2 at 1 rad/s.
#[test]
fn an_integrator_has_the_largest_disc_margin() {
    let around = Loop::new(rational(&[1.0], &[1.0, 0.0]), unity()).unwrap();
    let found = around.output_disc_margin().unwrap();
    assert!((found.size - 2.0).abs() < 1e-6 && (found.phase - 0.5 * PI).abs() < 1e-6, "{found:?}");
    assert!((around.bandwidth().unwrap().unwrap() - 1.0).abs() < 1e-9);
}

/// Every gain and phase that a disc margin allows is stood, one at a time, by each channel.
#[test]
fn margins_of_channels_are_no_less_than_the_disc_margin() {
    let plant = Numbers::new(5).system(4, 2, 2, 0.2);
    let problem = mixed_sensitivity(&plant, &weights(2)).unwrap();
    let found = h_infinity(&problem, &HInfinityOptions::default()).unwrap();
    let interval = 0.05;
    let sampled = Loop::new(
        bilinear(&plant, interval).unwrap(),
        bilinear(&found.controller, interval).unwrap(),
    )
    .unwrap();
    let disc = sampled.output_disc_margin().unwrap();
    for margin in sampled.output_margins().unwrap() {
        assert!(margin.phase.is_none_or(|phase| phase >= disc.phase * (1.0 - 1e-6)));
        assert!(margin.gain_increase.is_none_or(|gain| gain >= disc.gain[1] * (1.0 - 1e-6)));
        assert!(margin.gain_decrease.is_none_or(|gain| gain <= disc.gain[0] * (1.0 + 1e-6)));
    }
    let all = sampled.input_disc_margin().unwrap();
    assert!(all.size > 0.0 && all.size <= 2.0);
}

/// With an exact model the loop is the one without delay, and then the delay.
#[test]
fn a_predictor_takes_an_exact_delay_out_of_the_loop() {
    let (interval, delay) = (0.5, 7);
    let model = zero_order_hold(&Numbers::new(9).system(3, 2, 2, -0.4), interval).unwrap();
    let controller = StateSpace::new(
        identity(2),
        interval * identity(2),
        0.05 * model.gain_at_rest().unwrap().transpose(),
        0.1 * model.gain_at_rest().unwrap().transpose(),
        Some(interval),
    );
    let delayed = series(&model, &sample_delay(2, delay, interval).unwrap()).unwrap();
    let undelayed = Loop::new(model.clone(), controller.clone()).unwrap();
    undelayed.stable_or_error().unwrap();
    let predictor = smith_predictor(&model, delay, &controller).unwrap();
    let around = Loop::new(delayed, predictor).unwrap();
    around.stable_or_error().unwrap();
    let (fast, late) = (
        undelayed.complementary_sensitivity().unwrap(),
        around.complementary_sensitivity().unwrap(),
    );
    for input in 0..2 {
        let (fast, late) =
            (step_response(&fast, input, 90).unwrap(), step_response(&late, input, 90).unwrap());
        for k in 0..90 {
            for output in 0..2 {
                let exact = if k < delay { 0.0 } else { fast[k - delay][output] };
                assert!((late[k][output] - exact).abs() < 1e-12, "{k} {late:?}");
            }
        }
    }
}

#[test]
fn a_controller_of_lower_order_tells_its_loss() {
    let plant = Numbers::new(21).system(6, 2, 2, -0.3);
    let problem = mixed_sensitivity(&plant, &weights(2)).unwrap();
    let found = h_infinity(&problem, &HInfinityOptions::default()).unwrap();
    let reduced = reduced_to_tolerance(&problem, &found.controller, 0.05).unwrap();
    assert!(reduced.controller.order() < found.controller.order());
    assert!(reduced.norm_after <= 1.05 * reduced.norm_before);
    assert!((reduced.norm_before / found.achieved.gain - 1.0).abs() < 1e-6);
    let tail: f64 = reduced.hankel_singular_values[reduced.controller.order()..].iter().sum();
    assert!(reduced.difference.unwrap() <= 2.0 * tail * (1.0 + 1e-6));
    let whole = reduced_to_order(&problem, &found.controller, found.controller.order()).unwrap();
    assert!((whole.norm_after / whole.norm_before - 1.0).abs() < 1e-4);
}

/// A controller that is not stable itself keeps its loop stable with fewer states, in either time.
#[test]
fn a_controller_that_is_not_stable_is_reduced_by_its_factors() {
    // A pole at 4 between zeros at 1 and infinity: only a controller with a pole on the right holds it
    // (parity interlacing).
    let plant =
        series(&rational(&[1.0, -1.0], &[1.0, -4.0]), &rational(&[1.0], &[1e-5, 0.0205, 1.0]))
            .unwrap();
    let weights = SensitivityWeights {
        performance: Some(performance_weight(0.1, 20.0, 0.5).unwrap()),
        complementary: None,
        control: Some(StateSpace::gain(mat![[0.1]], None)),
    };
    let problem = mixed_sensitivity(&plant, &weights).unwrap();
    for problem in [problem.with_system(bilinear(&problem.system, 0.02).unwrap()), problem.clone()]
    {
        let found = h_infinity(&problem, &HInfinityOptions::default()).unwrap();
        assert!(!found.controller.is_stable().unwrap());
        let whole =
            reduced_to_order(&problem, &found.controller, found.controller.order()).unwrap();
        assert!((whole.norm_after / whole.norm_before - 1.0).abs() < 1e-3, "{whole:?}");
        // Of normalised factors none is above one.
        assert!(whole.hankel_singular_values[0] < 1.0, "{whole:?}");
        let reduced = reduced_to_tolerance(&problem, &found.controller, 0.2).unwrap();
        assert!(reduced.controller.order() < found.controller.order());
        assert!(reduced.norm_after <= 1.2 * reduced.norm_before && reduced.difference.is_none());
    }
}

/// Weights of the source around a plant with zeros in the right half plane and a delay of 11 s, every 0.5
/// s.
#[test]
fn a_delayed_plant_is_held_by_a_predictor_around_a_robust_controller() {
    let interval = 0.5;
    let channel = rational(&[-1.0, 0.05], &[1.0, 0.2, 0.01]).repeated(2).unwrap();
    let coupled = StateSpace::gain(mat![[0.2, -0.02], [-0.02, 0.2]], None);
    let plant = zero_order_hold(&series(&channel, &coupled).unwrap(), interval).unwrap();
    let sampled = |weight: StateSpace| bilinear(&weight.repeated(2).unwrap(), interval).unwrap();
    let weights = SensitivityWeights {
        performance: Some(sampled(performance_weight(0.02, 10.0, 0.625).unwrap())),
        complementary: None,
        control: Some(sampled(control_weight(0.15, 10.0, 0.4).unwrap())),
    };
    let problem = mixed_sensitivity(&plant, &weights).unwrap();
    let found = h_infinity(&problem, &HInfinityOptions::default()).unwrap();
    assert!(found.achieved.gain <= found.bound * (1.0 + 1e-5) && found.bound < 1.0);
    let delay = 22;
    let controller = smith_predictor(&plant, delay, &found.controller).unwrap();
    let delayed = series(&plant, &sample_delay(2, delay, interval).unwrap()).unwrap();
    let around = Loop::new(delayed.clone(), controller.clone()).unwrap();
    let margin = around.output_margins().unwrap()[0];
    let (gain, later) = (margin.gain_increase.unwrap(), margin.delay.unwrap());
    let disc = around.output_disc_margin().unwrap();
    assert!(gain > 1.5 && disc.size > 0.5, "{margin:?} {disc:?}");
    // Gains on either side of the margin, both channels alike.
    let with = |factor: f64| {
        Loop::new(delayed.scaled(factor), controller.clone()).unwrap().stable_or_error()
    };
    assert!(with(disc.gain[1] * 0.999).is_ok() && with(disc.gain[0] * 1.001).is_ok());
    // One channel alone, at its margin.
    let one = |factor: f64, samples: usize| {
        let others = StateSpace::gain(mat![[factor, 0.0], [0.0, 1.0]], Some(interval));
        let late = sample_delay(1, samples, interval).unwrap();
        let direct = StateSpace::gain(mat![[1.0]], Some(interval));
        let later = lti::matrices::append(&[&late, &direct]).unwrap();
        let plant = series(&series(&delayed, &others).unwrap(), &later).unwrap();
        Loop::new(plant, controller.clone()).unwrap().stable_or_error()
    };
    assert!(one(0.99 * gain, 0).is_ok() && one(1.01 * gain, 0).is_err());
    let samples = (later / interval).floor() as usize;
    assert!(one(1.0, samples).is_ok() && one(1.0, samples + 1).is_err(), "{later}");
    // From the loop without its delay, without states for it.
    let undelayed = Loop::new(plant.clone(), found.controller).unwrap();
    let predicted = predicted_margins(&undelayed, delay).unwrap();
    let exact = around.output_margins().unwrap();
    for (found, exact) in predicted.channels.iter().zip(&exact) {
        let pairs = [
            (found.gain_increase, exact.gain_increase),
            (found.gain_decrease, exact.gain_decrease),
            (found.phase, exact.phase),
            (found.delay, exact.delay),
            (found.crossover, exact.crossover),
        ];
        for (found, exact) in pairs {
            let distance = found.unwrap_or(0.0) - exact.unwrap_or(0.0);
            assert!(distance.abs() <= 1e-6 * exact.unwrap_or(0.0).abs(), "{found:?} {exact:?}");
        }
    }
    assert!((predicted.disc.size / disc.size - 1.0).abs() < 1e-6, "{predicted:?} {disc:?}");
    let peak = around.sensitivity().unwrap().h_infinity_norm().unwrap();
    assert!((predicted.sensitivity.gain / peak.gain - 1.0).abs() < 1e-6, "{predicted:?} {peak:?}");
    // Plants whose delay is not the one predicted, on either side of what they may be.
    let late_by = |samples: usize| {
        let plant = series(&plant, &sample_delay(2, samples, interval).unwrap()).unwrap();
        Loop::new(plant, controller.clone()).unwrap().stable_or_error()
    };
    let [shorter, longer] = predicted.mismatch.map(|time| (time.unwrap() / interval) as usize);
    assert!(late_by(delay - shorter).is_ok() && late_by(delay - shorter - 1).is_err());
    assert!(late_by(delay + longer).is_ok() && late_by(delay + longer + 1).is_err());
}

/// The margins of a loop with `delay` predicted samples, and whether it is stable where the plant is
/// another number of samples late.
fn beside_states(
    plant: &StateSpace,
    controller: &StateSpace,
    delay: usize,
) -> (PredictedMargins, Box<dyn Fn(usize) -> bool>) {
    let undelayed = Loop::new(plant.clone(), controller.clone()).unwrap();
    let margins = predicted_margins(&undelayed, delay).unwrap();
    let predictor = smith_predictor(plant, delay, controller).unwrap();
    let plant = plant.clone();
    let late_by = move |samples: usize| {
        let interval = plant.interval.unwrap();
        let late = sample_delay(plant.outputs(), samples, interval).unwrap();
        let loop_of = Loop::new(series(&plant, &late).unwrap(), predictor.clone()).unwrap();
        loop_of.stable_or_error().is_ok()
    };
    (margins, Box::new(late_by))
}

/// gain/(z − pole), every second.
fn first_order(pole: f64, gain: f64) -> StateSpace {
    StateSpace::new(mat![[pole]], mat![[gain]], mat![[1.0]], mat![[0.0]], Some(1.0))
}

/// A mode that hardly dies away has a peak that is narrower than any even step; integral control is infinite
/// at rest.
#[test]
fn a_narrow_peak_of_a_predicted_loop_is_not_stepped_over() {
    let (radius, angle, delay) = (0.9995_f64, 0.35_f64, 20);
    let (sine, cosine) = angle.sin_cos();
    let mode = StateSpace::new(
        mat![[radius * cosine, radius * sine], [-radius * sine, radius * cosine]],
        mat![[-0.02], [0.0]],
        mat![[1.0, 0.5]],
        mat![[0.0]],
        Some(1.0),
    );
    let plant = parallel(&first_order(0.9, 0.1), &mode).unwrap();
    let (margins, late_by) = beside_states(&plant, &first_order(1.0, 0.04), delay);
    assert!(margins.channels[0].gain_decrease.is_none_or(|gain| gain > 0.01), "{margins:?}");
    let longer = margins.mismatch[1].unwrap() as usize;
    let stable: Vec<bool> = (0..=longer + 1).map(|more| late_by(delay + more)).collect();
    assert!(stable[..=longer].iter().all(|stable| *stable) && !stable[longer + 1], "{margins:?}");
    assert!(longer < 10, "{longer}: it is the mode's");
}

/// Where T is above one half at half the sample rate, a sample more is too much, and no less has a border.
#[test]
fn a_fast_predicted_loop_stands_less_than_a_sample() {
    let plant = first_order(0.2, 0.8);
    let gain = StateSpace::gain(mat![[1.2]], Some(1.0));
    for controller in [&first_order(0.3, 1.1), &gain] {
        let (margins, late_by) = beside_states(&plant, controller, 4);
        assert!(late_by(4));
        let longer = margins.mismatch[1].unwrap();
        let first = (5..60).find(|samples| !late_by(*samples)).unwrap();
        assert!(longer <= (first - 4) as f64 && longer > 0.0, "{longer} {first} {margins:?}");
        assert!(margins.channels[0].delay.unwrap() <= longer + 1e-9, "{margins:?}");
    }
}

/// A transform and its inverse leave a whole generalised plant as it was.
#[test]
fn a_closed_loop_is_the_same_in_either_time() {
    let plant = Numbers::new(2).system(3, 1, 1, -0.3);
    let closed = feedback(&plant, &StateSpace::gain(mat![[0.1]], None)).unwrap();
    let back = inverse_bilinear(&bilinear(&closed, 0.1).unwrap()).unwrap();
    assert!((&back.a - &closed.a).norm_l2() < 1e-12);
}
