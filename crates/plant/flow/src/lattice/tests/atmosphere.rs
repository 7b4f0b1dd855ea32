//! Air with temperature: what is kept, what the ground gives, the same bits on any number of threads.

use super::*;
use crate::FlowSolver;
use crate::lattice::atmosphere::{
    AirRow, Atmosphere, AtmosphereError, Damping, Driving, Heating, LevelStatistics, Perturbation,
};
use crate::lattice::cpu::Cpu;
use crate::lattice::engine::Engine;
use crate::lattice::probe::RowState;
use basis::PointForce;
use std::f64::consts::TAU;

/// A turbulent, stratified box over a cooled ground.
fn stratified(threads: usize, backend: Backend, ends: Ends) -> LatticeSettings {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [37, 9, 12], 0.1, 8.0);
    settings.ends = ends;
    settings.ground = Ground::WallStress { roughness_length: 0.1 };
    settings.threads = Some(threads);
    settings.backend = Some(backend);
    settings.atmosphere = Some(Atmosphere {
        coriolis: 1.4e-4,
        driving: Driving::Geostrophic([8.0, 0.0]),
        temperature: vec![[0.0, 265.0], [60.0, 265.0], [120.0, 268.0]],
        heating: Heating::Ground { temperature: 263.0, rate: -1e-4 },
        damping: Some(Damping { from: 90.0, rate: 0.01 }),
        perturbation: Some(Perturbation { below: 50.0, amplitude: 0.5, seed: 3 }),
        ..Atmosphere::new(265.0)
    });
    settings
}

fn windy(settings: LatticeSettings) -> Lattice {
    let k = TAU / 90.0;
    lattice(settings, move |_, x| {
        Vector3::new(8.0 + (k * x.y).sin(), (k * x.y + 0.03 * x.x).cos(), (k * x.y).cos())
    })
}

/// Wind and temperature of every cell, bit by bit.
fn bits(air: &Lattice) -> Vec<u32> {
    let [n_x, n_y, n_z] = air.n_cells();
    let mut row = AirRow::new(n_x);
    let mut bits = Vec::new();
    for index in 0..n_y * n_z {
        assert!(air.engine.read_air(index, &mut row));
        for column in row.velocity.iter().chain([&row.temperature]) {
            bits.extend(column[..n_x].iter().map(|value| value.to_bits()));
        }
    }
    bits
}

/// Models of eddies, each between both kinds of ends.
fn cases() -> impl Iterator<Item = (SubgridModel, Ends)> {
    let ends = [Ends::Periodic, Ends::InletOutlet];
    SubgridModel::ALL.into_iter().flat_map(move |model| ends.map(|ends| (model, ends)))
}

/// `settings` with `model`.
fn with(model: SubgridModel, settings: LatticeSettings) -> LatticeSettings {
    LatticeSettings { subgrid: Subgrid::new(model), ..settings }
}

/// What the levels tell of fluxes that are not resolved, bit by bit.
fn fluxes(air: &Lattice) -> Vec<u64> {
    let of_level = |level: &LevelStatistics| {
        let [uw, vw] = level.subgrid_stress;
        [uw, vw, level.subgrid_heat_flux].map(f64::to_bits)
    };
    air.level_statistics().iter().flat_map(of_level).collect()
}

/// Heat of all cells: the sum of mass times temperature over the reference (K).
fn heat(air: &Lattice) -> f64 {
    let [n_x, n_y, n_z] = air.n_cells();
    let (mut warm, mut state) = (AirRow::new(n_x), RowState::new(n_x));
    let mut sum = 0.0;
    for row in 0..n_y * n_z {
        assert!(air.engine.read_air(row, &mut warm));
        air.engine.read_row(row, &mut state);
        for (temperature, excess) in warm.temperature.iter().zip(&state.density_excess).take(n_x) {
            sum += f64::from(*temperature) * (1.0 + f64::from(*excess));
        }
    }
    sum
}

#[test]
fn the_number_of_threads_changes_no_bit_of_an_atmosphere() {
    for (model, ends) in cases() {
        let run = |threads| {
            let mut air = windy(with(model, stratified(threads, Backend::detect(), ends)));
            let push = |x, z| {
                let position = Vector3::new(x, 45.0, z);
                PointForce::of_body(position, Vector3::new(-3e4, 0.0, 0.0), 20.0)
            };
            air.advance(5.0, &[push(60.0, 25.0), push(250.0, 75.0)]).expect("no divergence");
            bits(&air)
        };
        let alone = run(1);
        for threads in [2, 3, 5, 13] {
            assert!(run(threads) == alone, "{model:?}, {ends:?}: {threads} threads");
        }
    }
}

#[test]
fn back_ends_agree_on_an_atmosphere() {
    let run = |backend| {
        let mut air = windy(stratified(1, backend, Ends::Periodic));
        air.advance(5.0, &[]).expect("no divergence");
        air.level_statistics()
    };
    let portable = run(Backend::Portable);
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        for (level, expected) in run(backend).iter().zip(&portable) {
            assert!((level.temperature - expected.temperature).abs() < 1e-4, "{backend:?}");
            assert!((level.velocity[0] - expected.velocity[0]).abs() < 1e-4, "{backend:?}");
            assert!((level.variance[2] - expected.variance[2]).abs() < 1e-4, "{backend:?}");
        }
    }
}

#[test]
fn an_atmosphere_read_back_goes_on_with_the_same_bits() {
    for (model, ends) in cases() {
        let settings = with(model, stratified(2, Backend::detect(), ends));
        let mut air = windy(settings.clone());
        // Not a multiple of the steps after which stability is found anew.
        air.advance(1.3, &[]).expect("no divergence");
        let mut state = Vec::new();
        air.write_state(&mut state).expect("memory");
        let kept = fluxes(&air);
        air.advance(3.0, &[]).expect("no divergence");
        let mut other = windy(LatticeSettings { threads: Some(29), ..settings });
        other.read_state(&mut state.as_slice()).expect("a state of this grid");
        assert!(fluxes(&other) == kept, "{model:?}, {ends:?}: what the levels tell at once");
        other.advance(3.0, &[]).expect("no divergence");
        assert!(bits(&air) == bits(&other), "{model:?}, {ends:?}");
    }
}

#[test]
fn a_checkpoint_has_the_same_bytes_from_any_number_of_threads() {
    let state = |threads| {
        let mut air = windy(stratified(threads, Backend::detect(), Ends::InletOutlet));
        air.advance(3.0, &[]).expect("no divergence");
        let mut state = Vec::new();
        air.write_state(&mut state).expect("memory");
        state
    };
    let alone = state(1);
    for threads in [2, 5] {
        // Other bytes lie in the padding of the populations' rows, which no cell reads.
        let found = state(threads);
        assert_eq!(found.len(), alone.len());
        let heat = 3 * 4 * 37 * 9 * 12;
        assert!(found[found.len() - heat..] == alone[alone.len() - heat..], "{threads} threads");
    }
}

#[test]
fn an_engine_that_starts_again_has_forgotten_what_was() {
    for (model, ends) in cases() {
        let settings = with(model, stratified(2, Backend::detect(), ends));
        let wind = Wind(|_, x: Vector3| Vector3::new(8.0 + (0.05 * x.y).sin(), 0.3, 0.1));
        let state = |runs: usize| {
            let mut engine = Cpu::new(&settings).expect("sound settings");
            for _ in 0..runs {
                engine.start(&wind);
                (0..10).for_each(|_| engine.step(&wind));
                engine.look(0, 1);
            }
            let mut row = AirRow::new(37);
            let mut bits = Vec::new();
            for index in 0..9 * 12 {
                assert!(engine.read_air(index, &mut row));
                for column in row.velocity.iter().chain([&row.temperature]) {
                    bits.extend(column[..37].iter().map(|value| value.to_bits()));
                }
            }
            bits
        };
        assert!(state(1) == state(2), "{model:?}, {ends:?}");
    }
}

#[test]
fn heat_stays_in_a_closed_box() {
    let mut settings = stratified(2, Backend::detect(), Ends::Periodic);
    if let Some(atmosphere) = &mut settings.atmosphere {
        atmosphere.heating = Heating::None;
        atmosphere.damping = None;
    }
    let mut air = windy(settings);
    let before = heat(&air);
    air.advance(50.0, &[]).expect("no divergence");
    let cells = air.settings().cells() as f64;
    let gained = (heat(&air) - before) / cells;
    assert!(gained.abs() < 1e-5, "{gained} K a cell");
}

#[test]
fn noise_never_grows_where_nothing_diffuses() {
    for wind in [Vector3::ZERO, Vector3::new(0.1, 0.05, 0.02), Vector3::new(0.12, 0.12, 0.12)] {
        let atmosphere = Atmosphere {
            gravity: 0.0,
            perturbation: Some(Perturbation { below: 100.0, amplitude: 1.0, seed: 7 }),
            ..Atmosphere::new(300.0)
        };
        let mut settings = periodic_box([16, 12, 10], 1e-9);
        settings.atmosphere = Some(atmosphere);
        let mut air = lattice(settings, move |_, _| wind);
        let variance = |air: &Lattice| -> f64 {
            air.level_statistics().iter().map(|level| level.temperature_variance).sum()
        };
        let before = variance(&air);
        air.advance(3000.0, &[]).expect("no divergence");
        assert!(variance(&air) < 1.01 * before, "{wind}: {} {before}", variance(&air));
    }
}

#[test]
fn the_ground_gives_the_heat_that_is_asked_for() {
    let flux = 0.05;
    let mut settings = stratified(2, Backend::detect(), Ends::Periodic);
    if let Some(atmosphere) = &mut settings.atmosphere {
        atmosphere.heating = Heating::Flux(flux);
        atmosphere.damping = None;
    }
    let mut air = windy(settings);
    let before = heat(&air);
    air.advance(50.0, &[]).expect("no divergence");
    let [n_x, n_y, _] = air.n_cells();
    let gained = (heat(&air) - before) / (n_x * n_y) as f64;
    // Kelvin of one cell of 10 m.
    let expected = flux * 50.0 / 10.0;
    assert!((gained / expected - 1.0).abs() < 1e-3, "{gained} K, {expected} K");
}

#[test]
fn warm_air_rises_and_a_cold_ground_takes_more_heat_from_more_wind() {
    let mut settings = stratified(1, Backend::detect(), Ends::Periodic);
    if let Some(atmosphere) = &mut settings.atmosphere {
        atmosphere.heating = Heating::Flux(0.2);
    }
    let mut air = windy(settings);
    air.advance(120.0, &[]).expect("no divergence");
    let levels = air.level_statistics();
    let up = |level: &LevelStatistics| level.heat_flux + level.subgrid_heat_flux;
    assert!(up(&levels[2]) > 0.02, "{:?}", levels[2]);

    let lost = |wind: f64| {
        let mut settings = stratified(1, Backend::detect(), Ends::Periodic);
        if let Some(atmosphere) = &mut settings.atmosphere {
            atmosphere.damping = None;
        }
        let mut air = lattice(settings, move |_, _| Vector3::new(wind, 0.0, 0.0));
        let before = heat(&air);
        air.advance(10.0, &[]).expect("no divergence");
        before - heat(&air)
    };
    let (calm, windy) = (lost(2.0), lost(8.0));
    assert!(calm > 0.0 && windy > 3.0 * calm, "{calm} {windy}");
}

#[test]
fn an_atmosphere_that_cannot_be_is_refused() {
    let refused = |change: fn(&mut LatticeSettings, &mut Atmosphere)| {
        let mut settings = stratified(1, Backend::detect(), Ends::Periodic);
        let mut atmosphere = settings.atmosphere.take().expect("it has one");
        change(&mut settings, &mut atmosphere);
        settings.atmosphere = Some(atmosphere);
        match settings.check() {
            Err(LatticeError::Atmosphere(error)) => error.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let slips = refused(|settings, _| settings.ground = Ground::Slip);
    assert!(slips.contains("give a roughness length"), "{slips}");
    let falls = refused(|_, air| air.temperature = vec![[10.0, 280.0], [5.0, 281.0]]);
    assert!(falls.contains("heights that rise"), "{falls}");
    let stiff = refused(|settings, air| {
        air.temperature = vec![[0.0, 280.0], [1.0, 9000.0]];
        settings.interval = 0.1;
    });
    assert!(stiff.contains("use a step of at most"), "{stiff}");
    let wrapped = refused(|settings, air| {
        settings.ground = Ground::Periodic;
        air.heating = Heating::Plates { ground: 290.0, top: 280.0 };
    });
    assert!(wrapped.contains("periodic upwards"), "{wrapped}");
    let mut conducting = periodic_box([8; 3], 0.1);
    conducting.atmosphere = Some(Atmosphere { prandtl: 0.7, ..Atmosphere::new(300.0) });
    let told = conducting.check().expect_err("it conducts too well").to_string();
    assert!(told.contains("the diffusivity of temperature, is 0.143 cells²"), "{told}");
    let cold = refused(|_, air| air.reference_temperature = -1.0);
    assert!(cold.contains("the reference temperature must be positive, not -1"), "{cold}");
    let nowhere = refused(|_, air| air.coriolis = f64::NAN);
    assert!(nowhere.contains("Coriolis"), "{nowhere}");
    assert!(matches!(
        Atmosphere { damping: Some(Damping { from: 1.0, rate: 10.0 }), ..Atmosphere::new(280.0) }
            .check(0.1, Ground::Slip),
        Err(AtmosphereError::Value { name: "damping rate", .. })
    ));
}

#[test]
fn air_over_a_slipping_ground_swings_about_the_wind_that_drives_it() {
    let coriolis = 0.02;
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [8, 6, 5], 0.1, 8.0);
    settings.ends = Ends::Periodic;
    settings.ground = Ground::Slip;
    let driving = Driving::Geostrophic([8.0, 0.0]);
    settings.atmosphere = Some(Atmosphere { coriolis, driving, ..Atmosphere::new(290.0) });
    let mut air = lattice(settings, |_, _| Vector3::new(8.0, 0.0, 0.0));
    assert!(air.drive([6.0, 1.0]));
    let steps = 600;
    air.advance(0.1 * f64::from(steps), &[]).expect("no divergence");
    // The departure turns to the right (Ekman 1905): (2, -1) m/s by f t.
    let (s, c) = (coriolis * 60.0_f64).sin_cos();
    let expected = [6.0 + 2.0 * c - s, 1.0 - 2.0 * s - c];
    for level in air.statistics_of(1..4) {
        for axis in 0..2 {
            assert!((level.velocity[axis] - expected[axis]).abs() < 5e-3, "{level:?} {expected:?}");
        }
    }
    assert_eq!(air.statistics_of(3..9).len(), 2);
    assert_eq!(air.statistics_of(1..3), air.level_statistics()[1..3]);
    let mut still = lattice(periodic_box([8; 3], 0.01), |_, _| Vector3::ZERO);
    assert!(!still.drive([6.0, 1.0]));
}
