//! The correction against straight wings, Prandtl and Lamb-Oseen, and its table against direct integration.

use super::*;

/// One straight wing, as a one-bladed rotor of so large a radius that its trailing vortices are straight.
fn wing(half_span: f64, n: usize, core: f64) -> Span {
    let middle = 1000.0 * half_span;
    // Cosine spacing; control points midway in the angle, which makes the midpoint rule exact for the
    // ellipse.
    let at = |angle: f64| middle - half_span * angle.cos();
    Span {
        borders: (0..=n).map(|i| at(PI * i as f64 / n as f64)).collect(),
        centres: (0..n).map(|i| at(PI * (i as f64 + 0.5) / n as f64)).collect(),
        cores: vec![core; n + 1],
    }
}

fn ellipse(span: &Span, half_span: f64) -> Vec<f64> {
    let middle = 1000.0 * half_span;
    span.centres.iter().map(|r| (1.0 - ((r - middle) / half_span).powi(2)).sqrt()).collect()
}

/// Correction of the downwash at each station, by direct integration of a helix so slow that it passes only
/// once.
fn missing(span: &Span, circulation: &[f64], core: f64, smearing_length: f64) -> Vec<f64> {
    let n = circulation.len();
    let advance = 10.0 * smearing_length;
    span.centres
        .iter()
        .map(|&r| {
            (0..=n)
                .map(|border| {
                    let inner = if border > 0 { circulation[border - 1] } else { 0.0 };
                    let outer = if border < n { circulation[border] } else { 0.0 };
                    let helix = Helix { radius: span.borders[border], advance, lead: 0.0 };
                    (inner - outer) * helix.correction_influence(r, core, smearing_length).0
                })
                .sum()
        })
        .collect()
}

#[test]
fn blob_share_has_its_limits() {
    assert!((blob_share(0.01) / (4.0 / (3.0 * PI.sqrt()) * 1e-6) - 1.0).abs() < 1e-3);
    // erf(1) = 0.842700792949715.
    assert!(
        (blob_share(1.0) - (0.842_700_792_949_715 - 2.0 / PI.sqrt() * (-1.0_f64).exp())).abs()
            < 1e-14
    );
    assert!((blob_share(6.0) - 1.0).abs() < 1e-12 && (blob_share(4.999) - 1.0).abs() < 1e-9);
}

#[test]
fn a_straight_trailing_vortex_misses_what_lamb_and_oseen_say() {
    // Half an infinite vortex smeared by a Gaussian: 1/(4πy) (1 − exp(−y²/ε²)).
    let (core, width) = (1e-3, 1.0);
    for y in [0.05, 0.3, 1.0, 2.5] {
        let helix = Helix { radius: 1e4 + y, advance: 10.0, lead: 0.0 };
        let exact = -(-(y * y) / (width * width)).exp() / (4.0 * PI * y);
        let (axial, _) = helix.correction_influence(1e4, core, width);
        assert!((axial / exact - 1.0).abs() < 2e-3, "{axial} against {exact} at {y}");
    }
}

#[test]
fn elliptic_wing_recovers_prandtls_constant_downwash() {
    // Γ = Γ₀ √(1 − (y/s)²) has the downwash Γ₀ / (4 s) everywhere; a coarse line sees only its smeared part.
    let half_span = 1.0;
    let span = wing(half_span, 60, 1e-4);
    let circulation = ellipse(&span, half_span);
    let n = circulation.len();
    for smearing_length in [0.05, 0.25, 0.6] {
        let hidden = missing(&span, &circulation, 1e-4, smearing_length);
        for (station, r) in span.centres.iter().enumerate() {
            let seen: f64 = (0..=n)
                .map(|border| {
                    let inner = if border > 0 { circulation[border - 1] } else { 0.0 };
                    let outer = if border < n { circulation[border] } else { 0.0 };
                    let y = span.borders[border] - r;
                    let smeared = 1.0 - (-(y / smearing_length).powi(2)).exp();
                    -(inner - outer) * smeared / (4.0 * PI * y)
                })
                .sum();
            let downwash = seen + hidden[station];
            assert!(
                (downwash / -0.25 - 1.0).abs() < 0.01,
                "{downwash} at {r}, ε {smearing_length}"
            );
        }
    }
}

#[test]
fn nothing_is_missing_at_the_optimal_width() {
    let span = Span { borders: vec![1.0, 5.0, 10.0], centres: vec![3.0, 7.5], cores: vec![0.5; 3] };
    let correction = SmearingCorrection::new(3, &span, 0.5);
    assert!(correction.axial.iter().chain(&correction.tangential).all(|v| *v == 0.0));
}

#[test]
fn equal_blades_miss_the_same_and_tips_miss_downwash() {
    let borders: Vec<f64> = (0..=16).map(|i| 3.0 + f64::from(i) * 57.0 / 16.0).collect();
    let centres = borders.windows(2).map(|b| 0.5 * (b[0] + b[1])).collect();
    let span = Span { borders, centres, cores: vec![0.5; 17] };
    let correction = SmearingCorrection::new(3, &span, 15.0);
    let helix = correction.helix(60.0 * 0.08);
    let circulations = vec![50.0; 48];
    let tips: Vec<_> =
        (0..3).map(|b| correction.velocity_correction(helix, b, 15, &circulations)).collect();
    for tip in &tips {
        assert!(tip.0 < 0.0 && tip.1 < 0.0, "upwind and against the rotation: {tip:?}");
        assert!((tip.0 - tips[0].0).abs() < 1e-12);
    }
    let middle = correction.velocity_correction(helix, 0, 7, &circulations);
    assert!(middle.0.abs() < 0.2 * tips[0].0.abs());
}

#[test]
fn the_table_interpolates_the_helix() {
    let borders: Vec<f64> = (0..=8).map(|i| 3.0 + f64::from(i) * 57.0 / 8.0).collect();
    let centres: Vec<f64> = borders.windows(2).map(|b| 0.5 * (b[0] + b[1])).collect();
    let span = Span { borders: borders.clone(), centres: centres.clone(), cores: vec![0.5; 9] };
    let correction = SmearingCorrection::new(3, &span, 15.0);
    let advance = 60.0 * 0.0776;
    let circulations = vec![50.0; 24];
    let (axial, tangential) =
        correction.velocity_correction(correction.helix(advance), 1, 7, &circulations);
    let mut exact = (0.0, 0.0);
    for ahead in 0..3 {
        for (radius, sign) in [(borders[0], -1.0), (borders[8], 1.0)] {
            let helix = Helix { radius, advance, lead: TAU * f64::from(ahead) / 3.0 };
            let influence = helix.correction_influence(centres[7], 0.5, 15.0);
            exact.0 += sign * 50.0 * influence.0;
            exact.1 += sign * 50.0 * influence.1;
        }
    }
    assert!((axial / exact.0 - 1.0).abs() < 0.01, "{axial} against {}", exact.0);
    assert!((tangential / exact.1 - 1.0).abs() < 0.02, "{tangential} against {}", exact.1);
}
