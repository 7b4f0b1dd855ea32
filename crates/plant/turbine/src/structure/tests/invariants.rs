//! Symmetries, limits and promises that hold for any state.

use super::samples::*;
use crate::structure::coordinates::{Coordinates, GENERATOR, N_MODES, N_SHARED, TORSION};
use crate::structure::stations::LoadResultants;
use crate::structure::{
    AppliedLoads, DegreeOfFreedom, Pitch, Structure, StructureError, StructureSettings,
    StructureState,
};
use proptest::prelude::*;

const STEP: f64 = 0.02;

fn run(structure: &mut Structure, pitch: &[Pitch], n_steps: usize) {
    let applied = AppliedLoads { generator_torque: 3e5, ..AppliedLoads::NONE };
    (0..n_steps).for_each(|_| structure.advance(STEP, &applied, pitch));
}

fn moving(state: &StructureState, sign: f64, order: [usize; 3]) -> StructureState {
    let mut state = state.clone();
    state.velocities.shared = [0.4, -0.1, 0.3 * sign, 0.05 * sign, 1.5 * sign, 0.0];
    let blades = [[1.0, -0.2, 0.5 * sign], [-0.4, 0.3, 0.2 * sign], [0.6, 0.1, -0.7 * sign]];
    for (slot, blade) in order.into_iter().enumerate() {
        state.velocities.blades[slot] = blades[blade];
    }
    state
}

/// Largest difference of the coordinates, where `b` has been brought to the order of `a`.
fn gap(a: &Coordinates, b: &Coordinates) -> f64 {
    let difference = a.plus(-1.0, b);
    let all = difference.shared.iter().chain(difference.blades.iter().flatten());
    all.enumerate()
        .filter(|(index, _)| *index != GENERATOR)
        .fold(0.0, |worst, (_, value)| worst.max(value.abs()))
}

#[test]
fn any_blade_may_be_the_first() {
    let definition = plain();
    let pitch = [0.0, 0.1, 0.3].map(|angle| Pitch { angle, ..Pitch::default() });
    let third = std::f64::consts::TAU / 3.0;
    let mut one = structure(
        &definition,
        &StructureSettings { azimuth: 0.2 + third, ..StructureSettings::AT_REST },
    );
    let mut other =
        structure(&definition, &StructureSettings { azimuth: 0.2, ..StructureSettings::AT_REST });
    one.restore(moving(one.state(), 1.0, [0, 1, 2]));
    // What was blade 1, 120° on, is now blade 2.
    other.restore(moving(other.state(), 1.0, [2, 0, 1]));
    run(&mut one, &pitch, 200);
    run(&mut other, &[pitch[2], pitch[0], pitch[1]], 200);
    let mut renamed = other.state().coordinates;
    renamed.blades[..3].rotate_left(1);
    assert!(gap(&one.state().coordinates, &renamed) < 1e-9);
    let (a, b) = (one.loads(), other.loads());
    assert!((a.tower_base.moment - b.tower_base.moment).length() < 1e-3);
    assert!((a.blades[0].root.moment - b.blades[1].root.moment).length() < 1e-3);
}

#[test]
fn a_mirrored_turbine_moves_in_the_mirror() {
    // Untwisted, unpitched blades: turning the other way is the mirror image across y, blades 2 and 3
    // exchanged.
    let definition = plain();
    let pitch = [Pitch::default(); 3];
    let mut one =
        structure(&definition, &StructureSettings { azimuth: 0.2, ..StructureSettings::AT_REST });
    let mut other =
        structure(&definition, &StructureSettings { azimuth: -0.2, ..StructureSettings::AT_REST });
    one.restore(moving(one.state(), 1.0, [0, 1, 2]));
    other.restore(moving(other.state(), -1.0, [0, 2, 1]));
    for _ in 0..200 {
        one.advance(STEP, &AppliedLoads { generator_torque: 3e5, ..AppliedLoads::NONE }, &pitch);
        other.advance(STEP, &AppliedLoads { generator_torque: -3e5, ..AppliedLoads::NONE }, &pitch);
    }
    let mut image = other.state().coordinates;
    for coordinate in [2, 3, TORSION] {
        image.shared[coordinate] *= -1.0;
    }
    image.blades.swap(1, 2);
    image.blades.iter_mut().for_each(|blade| blade[2] *= -1.0);
    assert!(gap(&one.state().coordinates, &image) < 1e-9);
    let (a, b) = (one.loads().tower_base, other.loads().tower_base);
    assert!((a.force - b.force * basis::Vector3::new(1.0, -1.0, 1.0)).length() < 1e-3);
    assert!((a.moment - b.moment * basis::Vector3::new(-1.0, 1.0, -1.0)).length() < 1e-3);
}

#[test]
fn a_restored_state_continues_with_the_same_bits() {
    let definition = published(NREL_5);
    let settings =
        StructureSettings { rotor_speed: 1.2, pitch: 0.05, ..StructureSettings::AT_REST };
    let pitch = [Pitch { angle: 0.05, rate: 0.01, acceleration: 0.0 }; 3];
    let mut whole = structure(&definition, &settings);
    run(&mut whole, &pitch, 100);
    let mut resumed = structure(&definition, &settings);
    resumed.restore(whole.state().clone());
    run(&mut whole, &pitch, 100);
    run(&mut resumed, &pitch, 100);
    assert_eq!(whole.state(), resumed.state());
}

#[test]
fn degrees_of_freedom_that_are_held_stay() {
    let mut structure = structure(
        &published(IEA_15),
        &StructureSettings { rotor_speed: 0.7, ..StructureSettings::AT_REST },
    );
    structure.hold(&[
        DegreeOfFreedom::Generator,
        DegreeOfFreedom::TowerSideToSide1,
        DegreeOfFreedom::Edge1,
    ]);
    run(&mut structure, &[Pitch::default(); 3], 50);
    let state = structure.state();
    assert_eq!(state.velocities.shared[GENERATOR], 0.7);
    assert_eq!(state.coordinates.shared[2], 0.0);
    assert!(state.coordinates.blades.iter().all(|blade| blade[2] == 0.0));
    assert!(state.coordinates.blades[0][0] != 0.0);
}

#[test]
fn a_stiff_shaft_is_no_trouble_at_the_longest_step() {
    // 90 Hz against a step of 0.02 s, hit by a step of torque: bounded, and the mean twist is torque over
    // stiffness.
    let definition = published(IEA_22);
    let mut structure =
        structure(&definition, &StructureSettings { gravity: 0.0, ..StructureSettings::AT_REST });
    let held: Vec<DegreeOfFreedom> = DegreeOfFreedom::ALL
        .into_iter()
        .filter(|f| *f != DegreeOfFreedom::DriveTrain && *f != DegreeOfFreedom::Generator)
        .collect();
    structure.hold(&held);
    let applied = AppliedLoads { generator_torque: -1e7, ..AppliedLoads::NONE };
    let pitch = [Pitch::default(); 3];
    (0..2000).for_each(|_| structure.advance(STEP, &applied, &pitch));
    let (gear_ratio, train) = (definition.drive_train.gear_ratio, &definition.drive_train);
    let generator = gear_ratio * gear_ratio * train.generator_inertia;
    let share = 1.0 - generator / definition.drive_train_inertia();
    let twist = structure.state().coordinates.shared[TORSION];
    let expected = -1e7 * share / train.stiffness;
    assert!((twist / expected - 1.0).abs() < 1e-2, "{twist:e} {expected:e}");
}

#[test]
fn unsound_definitions_are_refused() {
    let refused = |change: &dyn Fn(&mut crate::Definition)| {
        let mut definition = plain();
        change(&mut definition);
        Structure::new(&definition, &StructureSettings::AT_REST).err()
    };
    assert!(matches!(
        refused(&|d| d.n_blades = 9),
        Some(StructureError::Blades { n_blades: 9, .. })
    ));
    assert!(matches!(
        refused(&|d| d.tower.sections.clear()),
        Some(StructureError::Sections { member: "tower", n_sections: 0, .. })
    ));
    assert!(matches!(
        refused(&|d| d.blade_structure.sections[1].span = 30.0),
        Some(StructureError::Sections { member: "blade", .. })
    ));
    assert!(matches!(
        refused(&|d| d.blade_structure.sections[1].mass = f64::NAN),
        Some(StructureError::Section { member: "blade", .. })
    ));
    let error = refused(&|d| d.tower.side_to_side_modes[1].coefficients[0] += 0.1);
    assert!(error.is_some_and(|e| e.to_string().contains("side-to-side mode 2 sum to 1.1")));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_mass_matrix_is_symmetric_and_positive_definite(
        n_blades in 1_usize..=4,
        shared in prop::array::uniform4(-1.0_f64..1.0),
        azimuth in 0.0_f64..std::f64::consts::TAU,
        twist in -0.05_f64..0.05,
        bends in prop::array::uniform12(-5.0_f64..5.0),
        pitch in -0.2_f64..1.6,
    ) {
        let mut definition = plain();
        definition.n_blades = n_blades;
        let structure = structure(&definition, &StructureSettings::AT_REST);
        let mut q = Coordinates::default();
        q.shared[..4].copy_from_slice(&shared);
        q.shared[GENERATOR] = azimuth;
        q.shared[TORSION] = twist;
        for blade in 0..n_blades {
            q.blades[blade].copy_from_slice(&bends[N_MODES * blade..][..N_MODES]);
        }
        let pitch = vec![Pitch { angle: pitch, ..Pitch::default() }; n_blades];
        let none = LoadResultants::default();
        let mass = structure.machine.equations_of_motion(&q, &Coordinates::default(), &pitch, &none).mass;
        let n = N_SHARED + N_MODES * n_blades;
        let full = |i: usize, j: usize| {
            let unit = |index: usize| {
                let mut unit = Coordinates::default();
                match index.checked_sub(N_SHARED) {
                    None => unit.shared[index] = 1.0,
                    Some(rest) => unit.blades[rest / N_MODES][rest % N_MODES] = 1.0,
                }
                unit
            };
            let (row, column) = (unit(i), mass.times(n_blades, &unit(j)));
            let shared: f64 = row.shared.iter().zip(&column.shared).map(|(a, b)| a * b).sum();
            let blades: f64 =
                row.blades.iter().flatten().zip(column.blades.iter().flatten()).map(|(a, b)| a * b).sum();
            shared + blades
        };
        // Cholesky's pivots of the matrix scaled to a unit diagonal.
        let scale: Vec<f64> = (0..n).map(|i| full(i, i).sqrt()).collect();
        let mut factor = vec![vec![0.0; n]; n];
        for i in 0..n {
            for j in 0..=i {
                let value = full(i, j) / (scale[i] * scale[j]);
                prop_assert!((value - full(j, i) / (scale[i] * scale[j])).abs() < 1e-12);
                let rest = value - (0..j).map(|k| factor[i][k] * factor[j][k]).sum::<f64>();
                factor[i][j] = if i == j {
                    prop_assert!(rest > 1e-6, "pivot {rest} of {i}");
                    rest.sqrt()
                } else {
                    rest / factor[j][j]
                };
            }
        }
    }
}
