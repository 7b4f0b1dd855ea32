//! Closed forms, balances and limits.

use super::*;
use proptest::prelude::*;

/// Thin aerofoil with a trace of drag: cl = 2π sin α, cd constant.
fn thin(drag: f64) -> impl Fn(f64) -> SectionCoefficients {
    move |angle: f64| SectionCoefficients { lift: 2.0 * PI * angle.sin(), drag, moment: 0.0 }
}

fn annulus(radius: f64, chord: f64, section_pitch: f64) -> Annulus {
    Annulus {
        n_blades: 3,
        radius,
        hub_radius: 2.0,
        tip_radius: 60.0,
        chord,
        section_pitch,
        cone_angle: 0.0,
    }
}

const NO_LOSS: Theory = Theory { tip_loss: false, hub_loss: false, drag_in_induction: true };

/// Thrust coefficient of the ring from blade forces, and from momentum: 4 F a (1 − a), or Buhl's parabola.
fn thrust_both_ways(ring: &Annulus, axial: f64, inflow: &Inflow) -> (f64, f64) {
    let solidity = ring.n_blades as f64 * ring.chord / (2.0 * PI * ring.radius);
    let blades = solidity * (inflow.relative_speed / axial).powi(2) * inflow.normal_coefficient;
    let (a, loss) = (inflow.axial_induction, inflow.loss_factor);
    let momentum = if a <= 0.4 {
        4.0 * loss * a * (1.0 - a)
    } else {
        8.0 / 9.0 + (4.0 * loss - 40.0 / 9.0) * a + (50.0 / 9.0 - 4.0 * loss) * a * a
    };
    (blades, momentum)
}

#[test]
fn blade_forces_balance_momentum_in_thrust_and_torque() {
    for (radius, chord, pitch, tangential) in [
        (20.0, 3.0, 0.1, 25.0),
        (50.0, 1.5, 0.0, 70.0),
        (58.0, 1.0, -0.05, 80.0),
        (5.0, 3.5, 0.3, 6.0),
    ] {
        let ring = annulus(radius, chord, pitch);
        let inflow = solve(&ring, 9.0, tangential, thin(0.01), Theory::default());
        let (blades, momentum) = thrust_both_ways(&ring, 9.0, &inflow);
        assert!((blades - momentum).abs() < 1e-9, "{blades} {momentum} {inflow:?}");
        // Angular momentum: 4 F a' (1 − a) λ_r per ring.
        let solidity = 3.0 * chord / (2.0 * PI * radius);
        let torque =
            solidity * (inflow.relative_speed / 9.0).powi(2) * inflow.tangential_coefficient;
        let swirl = 4.0
            * inflow.loss_factor
            * inflow.tangential_induction
            * (1.0 - inflow.axial_induction)
            * tangential
            / 9.0;
        assert!((torque - swirl).abs() < 1e-9, "{torque} {swirl}");
        let angle = (9.0 * (1.0 - inflow.axial_induction))
            .atan2(tangential * (1.0 + inflow.tangential_induction));
        assert!((angle - inflow.inflow_angle).abs() < 1e-10);
    }
}

#[test]
fn a_ring_shaped_after_glauert_finds_its_optimum() {
    // Glauert's optimum rotor with wake rotation, no drag, no losses: φ = (2/3) atan(1/λ_r), chord
    // σ c_l = 4 (1 − cos φ); Manwell, McGowan, Rogers, "Wind energy explained", 2nd ed., eq. 3.105-3.106.
    for speed_ratio in [0.5, 1.0, 3.0, 8.0] {
        let angle: f64 = 2.0 / 3.0 * (1.0f64 / speed_ratio).atan();
        let attack: f64 = 0.1;
        let lift = 2.0 * PI * attack.sin();
        let radius = 20.0;
        let chord = 2.0 * PI * radius / 3.0 * 4.0 * (1.0 - angle.cos()) / lift;
        let ring = annulus(radius, chord, angle - attack);
        let inflow = solve(&ring, 8.0, 8.0 * speed_ratio, thin(1e-9), NO_LOSS);
        assert!((inflow.inflow_angle - angle).abs() < 1e-7, "{inflow:?} {angle}");
        // a and a' of the optimum: λ_r² = (1 − a)(4a − 1)²/(1 − 3a), a' = (1 − 3a)/(4a − 1).
        let a = inflow.axial_induction;
        let expected = (1.0 - 3.0 * a) / (4.0 * a - 1.0);
        assert!(
            (inflow.tangential_induction / expected - 1.0).abs() < 1e-4,
            "{inflow:?} {expected}"
        );
    }
}

#[test]
fn a_symmetric_section_along_the_wind_lifts_nothing() {
    let still = solve(&annulus(30.0, 2.0, 0.1), 0.0, 0.0, thin(0.01), Theory::default());
    assert_eq!(still.forces(1.2, 2.0), [0.0, 0.0]);
    // In its own relative wind: pitch at which the angle of attack vanishes without any induction.
    let free = 10.0f64.atan2(40.0);
    let inflow = solve(&annulus(30.0, 2.0, free), 10.0, 40.0, thin(1e-12), Theory::default());
    assert!(inflow.angle_of_attack.abs() < 1e-9 && inflow.axial_induction.abs() < 1e-9);
}

#[test]
fn mirrored_winds_give_mirrored_forces() {
    let ring = annulus(30.0, 2.0, 0.1);
    let mirrored = Annulus { section_pitch: -0.1, ..ring };
    let inflow = solve(&ring, 10.0, 50.0, thin(0.01), Theory::default());
    let behind = solve(&mirrored, -10.0, 50.0, thin(0.01), Theory::default());
    assert!((inflow.axial_induction - behind.axial_induction).abs() < 1e-12);
    assert!((inflow.normal_coefficient + behind.normal_coefficient).abs() < 1e-12);
    assert!((inflow.tangential_coefficient - behind.tangential_coefficient).abs() < 1e-12);
    // A blade that turns the other way, nose first.
    let turned = Annulus { section_pitch: PI - 0.1, ..ring };
    let backwards = solve(&turned, 10.0, -50.0, thin(0.01), Theory::default());
    assert!((inflow.tangential_induction - backwards.tangential_induction).abs() < 1e-12);
    assert!((inflow.normal_coefficient - backwards.normal_coefficient).abs() < 1e-12);
    assert!((inflow.tangential_coefficient + backwards.tangential_coefficient).abs() < 1e-12);
}

#[test]
fn buhls_parabola_meets_momentum_theory() {
    for loss in [0.1, 0.5, 1.0] {
        let below = axial_induction(2.0 / 3.0, loss);
        let above = axial_induction(2.0 / 3.0 + 1e-9, loss);
        assert!((below - 0.4).abs() < 1e-12 && (above - below).abs() < 1e-7);
        // Through the removable point of the formula.
        let pole = (25.0 / 9.0 - 2.0 * loss) / (2.0 * loss);
        let sides = [pole - 1e-5, pole, pole + 1e-5].map(|k| axial_induction(k, loss));
        assert!((sides[0] - sides[1]).abs() < 1e-4 && (sides[2] - sides[1]).abs() < 1e-4);
    }
}

/// A wavy section with stall, asymmetric, with drag: nothing that a convergence proof could rely on.
fn wavy(seed: f64) -> impl Fn(f64) -> SectionCoefficients {
    move |angle: f64| SectionCoefficients {
        lift: 1.3 * (2.0 * angle).sin() + 0.7 * (9.0 * angle + seed).sin(),
        drag: 0.006 + 1.2 * angle.sin().powi(2) + 0.02 * (1.0 + (7.0 * angle + seed).sin()),
        moment: 0.0,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]
    #[test]
    fn every_ring_finds_its_inflow(
        share in 0.001..0.999f64, chord in 0.05..12.0f64, section_pitch in -3.2..3.2f64,
        axial in -30.0..30.0f64, tangential in -120.0..120.0f64, seed in 0.0..6.3f64,
    ) {
        let ring = annulus(2.0 + share * 58.0, chord, section_pitch);
        let inflow = solve(&ring, axial, tangential, wavy(seed), Theory::default());
        // Blade and air agree on the angle, and the air goes where the angle says.
        let (a, ap) = (inflow.axial_induction, inflow.tangential_induction);
        prop_assert!(a < 1.0, "{inflow:?}");
        let angle = (axial * (1.0 - a)).atan2(tangential * (1.0 + ap));
        let miss = (angle - inflow.inflow_angle).sin();
        prop_assert!(miss.abs() < 1e-6, "{miss} {inflow:?}");
    }
}

#[test]
fn a_coned_blade_slows_the_air_along_the_shaft() {
    // Momentum along the shaft: force × cos(cone) = mass flow × 2 a U, wind normal to the blade U cos(cone)
    // (1 − a).
    let cone_angle = 0.15_f64;
    let ring = Annulus { cone_angle, ..annulus(30.0, 3.0, 0.03) };
    let (wind, rotation) = (9.0, 45.0);
    let inflow = solve(&ring, wind * cone_angle.cos(), rotation, thin(0.01), NO_LOSS);
    let [normal, _] = inflow.forces(1.2, ring.chord);
    let mass_flow =
        1.2 * wind * cone_angle.cos() * (1.0 - inflow.axial_induction) * 2.0 * PI * ring.radius;
    let slowing = 2.0 * inflow.axial_induction * wind;
    assert!((3.0 * normal * cone_angle.cos() / (mass_flow * slowing) - 1.0).abs() < 1e-9);
    assert!(inflow.axial_induction < 0.4);
}
