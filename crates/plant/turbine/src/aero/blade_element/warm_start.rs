//! Blade-element momentum theory from one time step to the next: one evaluation of the residual, at the last
//! inflow angle.

use super::{Annulus, FRAC_PI_2, Ring, SMALLEST_ANGLE, SectionCoefficients, Theory, Trial};
use serde::{Deserialize, Serialize};

/// Largest step of the inflow angle that needs no second evaluation (rad).
const SMALL_STEP: f64 = 2e-3;
/// A step that leads out of the neighbourhood (rad): the bracketed search then takes over.
const LARGEST_STEP: f64 = 0.1;
/// Smallest change of the angle that gives a slope (rad).
const LEAST_SECANT: f64 = 1e-9;
/// Evaluations before the bracketed search takes over (–).
const MAXIMUM_LOOKS: usize = 6;
/// Cosine of the angle (–) below which its tangent does not determine the induction.
const LEAST_COSINE: f64 = 0.1;
/// Largest tangential induction of a warm start (–); beyond it, in unusual winds, the search starts anew each
/// time.
const LARGEST_SWIRL: f64 = 1.0;
/// Uses of a slope before it is computed anew (–).
const SLOPE_LIFE: u8 = 16;

/// Where the search begins next time: angle and slope of the residual of the last one; by default, anywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WarmStart {
    angle: f64,
    slope: f64,
    /// Uses of the slope so far (–).
    age: u8,
}

/// Induction factors at the blade.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Factors {
    /// Axial induction factor a (–): axial wind × (1 − a) passes the blade.
    pub axial: f64,
    /// Tangential induction factor a′ (–): tangential wind × (1 + a′) passes it.
    pub tangential: f64,
}

/// Induction of one annulus like [`solve`](super::solve), starting from where it was last time.
///
/// A step of the inflow angle below 2e-3 rad uses a slope of the residual from the last sixteen calls; the
/// error of this slope, some percent of the step, is corrected by the next call. So a constant wind gives the
/// induction of `solve`, and a wind that changes from step to step gives it to about 1e-5 rad. Larger steps
/// take further evaluations. Without a solution near the last angle `solve`'s bracketed search finds one:
/// there is always a result, whatever `warm_start` holds. Of two solutions, as sections in stall have, it
/// keeps the one near the last angle.
pub fn solve_near(
    annulus: &Annulus,
    axial: f64,
    tangential: f64,
    section: impl Fn(f64) -> SectionCoefficients,
    theory: Theory,
    warm_start: &mut WarmStart,
) -> Factors {
    let Some(ring) = Ring::new(annulus, axial, tangential, section, theory) else {
        return Factors::default();
    };
    nearby(&ring, warm_start).unwrap_or_else(|| {
        let angle = ring.root();
        let trial = ring.state(angle);
        let beside = ring.state(angle + LEAST_SECANT).residual;
        *warm_start = WarmStart { angle, slope: (beside - trial.residual) / LEAST_SECANT, age: 0 };
        Factors { axial: trial.axial_induction, tangential: trial.tangential_induction }
    })
}

/// Induction of `ring` where its residual vanishes near `warm_start`, which on return holds that angle; None
/// where it does not.
fn nearby<Section: Fn(f64) -> SectionCoefficients>(
    ring: &Ring<'_, Section>,
    warm_start: &mut WarmStart,
) -> Option<Factors> {
    let WarmStart { mut angle, mut slope, mut age } = *warm_start;
    if !(slope > 0.0 && slope.is_finite()) {
        return None;
    }
    let mut trial = ring.state(angle);
    for _ in 0..MAXIMUM_LOOKS {
        let step = -trial.residual / slope;
        let next = angle + step;
        // A residual that is not a number ends here too.
        if !(step.abs() < LARGEST_STEP && (SMALLEST_ANGLE..FRAC_PI_2).contains(&next)) {
            return None;
        }
        if step.abs() < SMALL_STEP && (age < SLOPE_LIFE || step.abs() < LEAST_SECANT) {
            *warm_start = WarmStart { angle: next, slope, age: age.saturating_add(1) };
            return beside(ring, &trial, step);
        }
        let before = trial.residual;
        trial = ring.state(next);
        angle = next;
        slope = (trial.residual - before) / step;
        age = 0;
        if slope <= 0.0 {
            return None;
        }
    }
    None
}

/// Induction a small `step` of the angle (rad) from `trial`: the swirl is held, and the new angle gives the
/// axial induction.
fn beside<Section>(ring: &Ring<'_, Section>, trial: &Trial, step: f64) -> Option<Factors> {
    let tangential = trial.tangential_induction;
    if tangential.abs() > LARGEST_SWIRL {
        return None;
    }
    let (sine, cosine) = trial.direction;
    let axial = if cosine > LEAST_COSINE {
        // The tangent of the new angle to second order.
        let tangent = sine / cosine + step / (cosine * cosine) * (1.0 + sine / cosine * step);
        1.0 - tangent * (ring.tangential / ring.axial).abs() * (1.0 + tangential)
    } else {
        trial.axial_induction
    };
    (axial < 1.0).then_some(Factors { axial, tangential })
}

#[cfg(test)]
mod tests {
    use super::super::{axial_induction, loss_factor, solve};
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn annulus(radius: f64, chord: f64, section_pitch: f64) -> Annulus {
        let (hub_radius, tip_radius) = (2.0, 60.0);
        Annulus {
            n_blades: 3,
            radius,
            hub_radius,
            tip_radius,
            chord,
            section_pitch,
            cone_angle: 0.0,
        }
    }

    fn stalling(angle: f64) -> SectionCoefficients {
        let attached = 1.0 / (1.0 + ((angle.abs() - 0.25) / 0.03).exp());
        let lift = attached * 2.0 * PI * angle.sin() + (1.0 - attached) * 1.1 * (2.0 * angle).sin();
        SectionCoefficients { lift, drag: 0.01 + 1.3 * angle.sin().powi(2), moment: 0.0 }
    }

    #[test]
    fn a_wind_that_stays_gives_the_bracketed_searchs_answer_in_one_look() {
        let ring = annulus(45.0, 2.0, 0.02);
        let expected = solve(&ring, 9.0, 50.0, stalling, Theory::default());
        let mut warm_start = WarmStart::default();
        for _ in 0..5 {
            let looks = std::cell::Cell::new(0);
            let section = |angle: f64| {
                looks.set(looks.get() + 1);
                stalling(angle)
            };
            let before = warm_start;
            let got = solve_near(&ring, 9.0, 50.0, section, Theory::default(), &mut warm_start);
            assert!((got.axial - expected.axial_induction).abs() < 1e-10);
            assert!((got.tangential - expected.tangential_induction).abs() < 1e-10);
            assert!(before == WarmStart::default() || looks.get() == 1, "{}", looks.get());
        }
    }

    #[test]
    fn a_wind_that_drifts_needs_little_more_than_one_look() {
        let ring = annulus(45.0, 2.0, 0.02);
        let looks = std::cell::Cell::new(0);
        let section = |angle: f64| {
            looks.set(looks.get() + 1);
            stalling(angle)
        };
        let mut warm_start = WarmStart::default();
        let wind = |step: i32| 9.0 + (0.02 * f64::from(step)).sin();
        solve_near(&ring, wind(0), 50.0, section, Theory::default(), &mut warm_start);
        looks.set(0);
        let mut largest = 0.0_f64;
        for step in 1..=1000 {
            let (wind, theory) = (wind(step), Theory::default());
            let got = solve_near(&ring, wind, 50.0, section, theory, &mut warm_start);
            let expected = solve(&ring, wind, 50.0, stalling, theory);
            largest = largest.max((got.axial - expected.axial_induction).abs() * wind);
        }
        // Induced velocity (m/s), where the wind changes by up to 0.02 m/s a step.
        assert!(largest < 1e-3, "{largest}");
        assert!(looks.get() < 1100, "{}", looks.get());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// Every warm start leads to the solution.
        #[test]
        fn every_start_leads_to_the_answer(
            share in 0.02..0.99_f64, chord in 0.5..4.0_f64, pitch in -0.3..1.0_f64, wind in 1.0..25.0_f64,
            rotation in 3.0..90.0_f64, angle in -4.0..4.0_f64, slope in -3.0..30.0_f64, age in 0..40_u8,
        ) {
            let ring = annulus(2.0 + share * 58.0, chord, pitch);
            let mut warm_start = WarmStart { angle, slope, age };
            let mut next = || {
                solve_near(&ring, wind, rotation, stalling, Theory::default(), &mut warm_start)
            };
            prop_assert!(next().axial < 1.0);
            // Whatever slope it began with has been drawn anew by then.
            for _ in 0..40 {
                next();
            }
            let got = next();
            prop_assert!(got.axial < 1.0, "{got:?}");
            let (through, along) = (wind * (1.0 - got.axial), rotation * (1.0 + got.tangential));
            let (sine, cosine) = through.atan2(along).sin_cos();
            let section = stalling(through.atan2(along) - pitch);
            let sigma = 3.0 * chord / (2.0 * PI * ring.radius);
            let loss = loss_factor(&ring, Theory::default(), sine);
            let loading = sigma * (section.lift * cosine + section.drag * sine) / (4.0 * loss * sine * sine);
            // Blades that drive the air have induction beyond all bounds near κ = −1.
            if loading > -0.5 {
                let expected = axial_induction(loading, loss);
                prop_assert!((got.axial - expected).abs() < 1e-6, "{got:?} {expected}");
            }
        }
    }
}
