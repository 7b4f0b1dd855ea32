//! Tests of Mann's synthesis.

use super::*;
use crate::inflow::spectra;
use proptest::prelude::*;

fn settings() -> MannSettings {
    MannSettings {
        n_points: [64, 24, 20],
        spacing: [12.0, 10.0, 11.0],
        length_scale: 33.6,
        anisotropy: 3.9,
        standard_deviation: 0.5,
        seed: 3,
        threads: Some(1),
    }
}

fn make(settings: &MannSettings) -> TurbulenceBox {
    generate(settings, |_| {}).unwrap()
}

#[test]
fn has_the_target_deviation_and_no_mean() {
    let turbulence = make(&settings());
    assert!((turbulence.standard_deviations()[0] / 0.5 - 1.0).abs() < 1e-6);
    assert!(turbulence.means().iter().all(|mean| mean.abs() < 1e-6));
    let [u, v, w] = turbulence.standard_deviations();
    assert!(u > v && v > w, "{u} {v} {w}");
    assert!(turbulence.shear_stress() < 0.0);
}

#[test]
fn is_free_of_divergence_wave_by_wave() {
    assert!(spectra::divergence_residual(&make(&settings())) < 1e-5);
}

/// Γ = 0: all components alike, no stress, up to the scatter of one draw.
#[test]
fn is_isotropic_without_shear() {
    let sizes =
        MannSettings { n_points: [48; 3], spacing: [14.0; 3], anisotropy: 0.0, ..settings() };
    let [mut v, mut w, mut stress] = [0.0; 3];
    for seed in 0..6 {
        let turbulence = make(&MannSettings { seed, ..sizes });
        let deviations = turbulence.standard_deviations();
        v += deviations[1] / 0.5 / 6.0;
        w += deviations[2] / 0.5 / 6.0;
        stress += turbulence.shear_stress() / 0.25 / 6.0;
    }
    // One draw scatters by about 2 %; six by less than 1 %.
    assert!((v - 1.0).abs() < 0.03 && (w - 1.0).abs() < 0.03, "{v} {w}");
    assert!(stress.abs() < 0.03, "{stress}");
}

#[test]
fn threads_change_no_bit_and_seeds_every_value() {
    let one = make(&settings());
    for threads in [2, 3, 7] {
        assert_eq!(one, make(&MannSettings { threads: Some(threads), ..settings() }));
    }
    assert_eq!(one, make(&settings()));
    assert_ne!(one, make(&MannSettings { seed: 4, ..settings() }));
}

/// Large eddies are the same ones when the grid is refined: they keep their numbers.
#[test]
fn a_finer_grid_keeps_the_large_eddies() {
    let coarse = make(&MannSettings { length_scale: 150.0, ..settings() });
    let fine = make(&MannSettings {
        n_points: [128, 48, 40],
        spacing: [6.0, 5.0, 5.5],
        length_scale: 150.0,
        ..settings()
    });
    let (mut product, mut coarse_square, mut fine_square) = (0.0, 0.0, 0.0);
    for x in 0..64 {
        for z in 0..20 {
            for y in 0..24 {
                let a = f64::from(coarse.at(0, [x, y, z]));
                let b = f64::from(fine.at(0, [2 * x, 2 * y, 2 * z]));
                product += a * b;
                coarse_square += a * a;
                fine_square += b * b;
            }
        }
    }
    assert!(product / (coarse_square * fine_square).sqrt() > 0.97);
}

/// Sheared eddies are tilted by the wind: air higher up is ahead.
#[test]
fn eddies_lean_downwind_with_height() {
    let turbulence =
        make(&MannSettings { n_points: [256, 24, 24], spacing: [10.0; 3], ..settings() });
    let correlation = |shift: usize| -> f64 {
        let mut sum = 0.0;
        for x in 0..256 {
            for z in 0..20 {
                for y in 0..24 {
                    let low = turbulence.at(0, [x, y, z]);
                    let high = turbulence.at(0, [(x + shift) % 256, y, z + 4]);
                    sum += f64::from(low * high);
                }
            }
        }
        sum
    };
    assert!(correlation(4) > correlation(252));
}

#[test]
fn refuses_settings_out_of_range() {
    for wrong in [
        MannSettings { n_points: [63, 24, 20], ..settings() },
        MannSettings { n_points: [64, 1, 20], ..settings() },
        MannSettings { spacing: [0.0, 1.0, 1.0], ..settings() },
        MannSettings { standard_deviation: -1.0, ..settings() },
        MannSettings { standard_deviation: f64::NAN, ..settings() },
        MannSettings { length_scale: -3.0, ..settings() },
        MannSettings { anisotropy: f64::INFINITY, ..settings() },
    ] {
        assert!(matches!(generate(&wrong, |_| {}), Err(InflowError::Setting { .. })));
    }
    let huge = MannSettings { n_points: [1 << 20, 1 << 20, 1 << 19], ..settings() };
    assert!(matches!(generate(&huge, |_| {}), Err(InflowError::Memory { .. })));
}

#[test]
fn progress_rises_to_one() {
    let reported = std::cell::RefCell::new(Vec::new());
    let two = MannSettings { threads: Some(2), ..settings() };
    generate(&two, |share| reported.borrow_mut().push(share)).unwrap();
    let reported = reported.into_inner();
    assert!(reported.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(reported.last(), Some(&1.0));
}

#[test]
fn a_break_of_progress_ends_it_wherever_it_is() {
    for threads in [1, 3] {
        for last in [0.0, 0.3, 0.85, 0.99] {
            let reported = std::cell::RefCell::new(Vec::new());
            let ended =
                generate_until(&MannSettings { threads: Some(threads), ..settings() }, |share| {
                    reported.borrow_mut().push(share);
                    if share > last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                });
            assert_eq!(ended, Err(InflowError::BrokenOff), "{threads} threads, {last}");
            let reported = reported.into_inner();
            // Never asked again after the break, and by a single thread before a tenth more is done.
            let (end, before) = reported.split_last().expect("some progress");
            assert!(before.iter().all(|share| *share <= last), "{threads} threads, {last}");
            assert!(*end > last && (threads > 1 || *end <= last + 0.1), "{last}: {end}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn any_size_reaches_its_target(
        half_x in 2_usize..20, n_y in 3_usize..17, n_z in 3_usize..17, anisotropy in 0.0..5.0_f64,
        deviation in 0.01..3.0_f64, seed: u64,
    ) {
        let settings = MannSettings {
            n_points: [2 * half_x, n_y, n_z], anisotropy, standard_deviation: deviation, seed, ..settings()
        };
        let turbulence = make(&settings);
        prop_assert!((turbulence.standard_deviations()[0] / deviation - 1.0).abs() < 1e-5);
        prop_assert!(turbulence.means().iter().all(|mean| mean.abs() < 1e-5 * deviation));
        prop_assert!(spectra::divergence_residual(&turbulence) < 1e-5);
    }
}
