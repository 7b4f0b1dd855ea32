//! The models' own laws at one ring of air.

use super::*;
use crate::sample::polar;
use std::f64::consts::PI;

const WIND: f64 = 10.0;
const ROTATION: f64 = 50.0;

fn ring() -> Ring {
    Ring::new(Annulus {
        n_blades: 3,
        radius: 40.0,
        hub_radius: 2.0,
        tip_radius: 60.0,
        chord: 2.0,
        section_pitch: 0.03,
        cone_angle: 0.0,
    })
}

fn thin() -> Polar {
    polar(|angle| 2.0 * PI * angle.sin(), |_| 1e-3)
}

const NO_LOSS: Theory = Theory { tip_loss: false, hub_loss: false, drag_in_induction: true };
const ONSET: Onset = Onset { normal: WIND, tangential: ROTATION };

/// Thrust of the blades over ½ρ and the ring's area (m²/s²) at induced velocities `u` and `v` (m/s).
fn blade_thrust(annulus: &Annulus, polar: &Polar, u: f64, v: f64) -> f64 {
    let (through, along) = (WIND - u, ROTATION + v);
    let section = polar.at(through.atan2(along) - annulus.section_pitch);
    let solidity = 3.0 * annulus.chord / (2.0 * PI * annulus.radius);
    solidity * through.hypot(along) * (section.lift * along + section.drag * through)
}

#[test]
fn snel_and_schepers_follow_their_differential_equation() {
    let (ring, polar) = (ring(), thin());
    let annulus = ring.annulus_now(0.0, 40.0);
    let model = Induction::SnelSchepers(SnelSchepers::default());
    let mut induced = model.settled(ONSET, &annulus, &polar, NO_LOSS);
    let pitched = ring.annulus_now(0.04, 40.0);
    // Their equation by small explicit steps, swirl at its steady value.
    let (mut u, mut v) = (induced.normal.velocity, induced.tangential.velocity);
    let interval = 0.02;
    let substeps = 200;
    for step in 0..1500 {
        model.advance(
            interval,
            ONSET,
            &ring,
            &pitched,
            &polar,
            NO_LOSS,
            &Decay::default(),
            &mut induced,
        );
        for _ in 0..substeps {
            let thrust = blade_thrust(&pitched, &polar, u, v);
            let factor = snel_schepers::radial_factor(40.0 / 60.0);
            u += interval / f64::from(substeps) * (thrust - 4.0 * u * (WIND - u))
                / (4.0 * 60.0 * factor);
            let (through, along) = (WIND - u, ROTATION + v);
            let section = polar.at(through.atan2(along) - pitched.section_pitch);
            let solidity = 3.0 * 2.0 / (2.0 * PI * 40.0);
            let driving = section.lift * through - section.drag * along;
            v = solidity * through.hypot(along) * driving / (4.0 * through);
        }
        let got = induced.normal.velocity;
        assert!((got - u).abs() < 2e-3, "{step}: {got} {u}");
    }
    for _ in 0..20_000 {
        let decay = Decay::default();
        model.advance(interval, ONSET, &ring, &pitched, &polar, NO_LOSS, &decay, &mut induced);
    }
    let rest = model.settled(ONSET, &pitched, &polar, NO_LOSS).normal.velocity;
    assert!((induced.normal.velocity - rest).abs() < 1e-6, "{induced:?} {rest}");
}

#[test]
fn snel_and_schepers_hold_any_interval() {
    let (polar, model) = (thin(), Induction::SnelSchepers(SnelSchepers::default()));
    for radius in [2.5, 20.0, 59.5] {
        let ring = Ring::new(Annulus { radius, ..ring().annulus });
        let annulus = ring.annulus_now(0.0, radius);
        let onset = Onset { normal: WIND, tangential: 1.2 * radius };
        let rest = model.settled(onset, &annulus, &polar, Theory::default());
        for interval in [0.01, 1.0, 100.0] {
            let mut induced = Induced::default();
            for _ in 0..50_000 {
                let decay = Decay::default();
                let theory = Theory::default();
                model.advance(
                    interval,
                    onset,
                    &ring,
                    &annulus,
                    &polar,
                    theory,
                    &decay,
                    &mut induced,
                );
            }
            let (got, expected) = (induced.normal.velocity, rest.normal.velocity);
            assert!((got - expected).abs() < 1e-4, "{radius} {interval}: {got} {expected}");
        }
    }
}

#[test]
fn time_factor_stretches_time() {
    let (ring, polar) = (ring(), thin());
    let annulus = ring.annulus_now(0.0, 40.0);
    let run = |time_factor: f64, interval: f64| {
        let model = Induction::SnelSchepers(SnelSchepers { time_factor });
        let mut induced = Induced::default();
        for _ in 0..400 {
            model.advance(
                interval,
                ONSET,
                &ring,
                &annulus,
                &polar,
                NO_LOSS,
                &Decay::default(),
                &mut induced,
            );
        }
        induced.normal.velocity
    };
    assert!((run(1.0, 0.01) - run(2.5, 0.025)).abs() < 1e-12);
}

#[test]
fn a_ring_that_blades_have_left_is_less_covered() {
    let ring = ring();
    let inwards = ring.annulus_now(0.1, 38.0);
    assert!((inwards.chord / 2.0 - 40.0 / 38.0).abs() < 1e-12);
    assert!((inwards.section_pitch - 0.13).abs() < 1e-15);
    assert_eq!((inwards.radius, inwards.tip_radius), (40.0, 60.0));
    assert_eq!(ring.annulus_now(0.0, 40.0), ring.annulus);
}
