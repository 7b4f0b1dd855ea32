//! Natural frequencies against published ones and estimates.

use super::samples::*;
use crate::definition::Definition;
use crate::structure::{AppliedLoads, DegreeOfFreedom, Pitch, StructureSettings};

/// Frequencies (Hz) of the turbine when all but `free` are locked and the rotor turns at `speed` (rad/s).
fn frequencies(
    definition: &Definition,
    free: &[DegreeOfFreedom],
    speed: f64,
) -> Vec<(f64, DegreeOfFreedom)> {
    let mut structure = structure(
        definition,
        &StructureSettings { rotor_speed: speed, ..StructureSettings::AT_REST },
    );
    let held: Vec<DegreeOfFreedom> =
        DegreeOfFreedom::ALL.into_iter().filter(|degree| !free.contains(degree)).collect();
    structure.hold(&held);
    structure.natural_modes().iter().map(|mode| (mode.frequency, mode.dominant())).collect()
}

/// The frequencies (Hz) that `kind` dominates, in `found`.
fn of(found: &[(f64, DegreeOfFreedom)], kind: DegreeOfFreedom) -> Vec<f64> {
    found
        .iter()
        .filter(|(_, dominant)| *dominant == kind)
        .map(|(frequency, _)| *frequency)
        .collect()
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "{what}: {found} Hz, expected {expected} Hz"
    );
}

#[test]
fn nrel_5mw_has_the_frequencies_of_its_report() {
    // Jonkman et al., NREL/TP-500-38060 (2009), table 9-1, FAST, parked: tower, drive train, then flapwise
    // and edgewise.
    let parked: Vec<DegreeOfFreedom> = DegreeOfFreedom::ALL
        .into_iter()
        .filter(|degree| *degree != DegreeOfFreedom::Generator)
        .collect();
    let found = frequencies(&published(NREL_5), &parked, 0.0);
    let first = |kind: DegreeOfFreedom| of(&found, kind)[0];
    close(first(DegreeOfFreedom::TowerForeAft1), 0.3240, 0.02, "tower fore-aft 1");
    close(first(DegreeOfFreedom::TowerSideToSide1), 0.3120, 0.02, "tower side-to-side 1");
    close(first(DegreeOfFreedom::TowerForeAft2), 2.9003, 0.02, "tower fore-aft 2");
    close(first(DegreeOfFreedom::TowerSideToSide2), 2.9361, 0.02, "tower side-to-side 2");
    close(first(DegreeOfFreedom::DriveTrain), 0.6205, 0.02, "drive train");
    let flap = of(&found, DegreeOfFreedom::Flap1);
    for (found, expected) in flap.iter().zip([0.6664, 0.6675, 0.6993]) {
        close(*found, expected, 0.03, "flapwise 1");
    }
    let edge = of(&found, DegreeOfFreedom::Edge1);
    for (found, expected) in edge.iter().zip([1.0793, 1.0898]) {
        close(*found, expected, 0.03, "edgewise 1");
    }
    let second = of(&found, DegreeOfFreedom::Flap2);
    close(second[0], 1.9223, 0.03, "flapwise 2");
    close(second[2], 2.0205, 0.03, "flapwise 2, collective");
}

#[test]
fn iea_15mw_rings_like_openfast() {
    // Spectral peaks of OpenFAST 5.0 runs from an impulsive start, 6.45 rpm: side-to-side 0.2374 Hz, edgewise
    // 0.765 Hz and, all blades against the free shaft, 1.765 Hz.
    let definition = published(IEA_15);
    let found = frequencies(&definition, &DegreeOfFreedom::ALL, 0.6753);
    close(of(&found, DegreeOfFreedom::TowerSideToSide1)[0], 0.2374, 0.02, "tower side-to-side 1");
    let edge = of(&found, DegreeOfFreedom::Edge1);
    close(edge[0], 0.765, 0.03, "edgewise 1");
    close(edge[2], 1.765, 0.03, "edgewise 1, collective");
}

#[test]
fn single_blades_have_the_frequencies_of_their_beams() {
    // Finite-element cantilevers of the same distributed mass, stiffness and twist, 200 elements: own
    // computation.
    for (text, flap, edge, second) in [
        (NREL_5, 0.6775, 1.0863, 1.9535),
        (IEA_15, 0.5387, 0.7279, 1.6032),
        (IEA_22, 0.3958, 0.5388, 1.1125),
    ] {
        let mut definition = published(text);
        definition.rotor.precone = 0.0;
        let settings = StructureSettings { gravity: 0.0, ..StructureSettings::AT_REST };
        let mut structure = structure(&definition, &settings);
        structure.hold(&DegreeOfFreedom::ALL[..6]);
        let modes: Vec<(f64, DegreeOfFreedom)> = structure
            .natural_modes()
            .iter()
            .map(|mode| (mode.frequency, mode.dominant()))
            .collect();
        close(of(&modes, DegreeOfFreedom::Flap1)[0], flap, 0.02, &definition.name);
        close(of(&modes, DegreeOfFreedom::Edge1)[0], edge, 0.03, &definition.name);
        // One function stands for the second mode here, which bends the shape towards the deck's own.
        close(of(&modes, DegreeOfFreedom::Flap2)[0], second, 0.07, &definition.name);
    }
}

#[test]
fn rotation_stiffens_flapwise_bending_by_the_southwell_coefficient() {
    // Even blade, one mode φ: ω² = ω₀² + Ω² S with S = ∫ μ x φ'² … / ∫ μ φ², both by quadrature here.
    let mut definition = plain();
    definition.rotor.precone = 0.0;
    definition.rotor.shaft_tilt = 0.0;
    let free = [DegreeOfFreedom::Flap1];
    let flap = |speed: f64| of(&frequencies(&definition, &free, speed), DegreeOfFreedom::Flap1)[1];
    let (radius, length) = (definition.rotor.hub_radius, definition.blade_length());
    let mode = definition.blade_structure.flap_modes[0];
    let slope = |share: f64| (3.0 * share - 1.5 * share * share) / length;
    let (mut shortened, mut mass, mut shortening) = (0.0, 0.0, 0.0);
    let n = 20_000;
    for k in 0..n {
        let share = (f64::from(k) + 0.5) / f64::from(n);
        shortening += slope(share).powi(2) * length / f64::from(n);
        shortened += (radius + share * length) * shortening;
        mass += mode.shape(share).powi(2);
    }
    let southwell = shortened / mass;
    let gain = (flap(2.0).powi(2) - flap(0.0).powi(2)) * std::f64::consts::TAU.powi(2) / 4.0;
    assert!((gain / southwell - 1.0).abs() < 0.01, "{gain} {southwell}");
}

#[test]
fn weight_bends_blades_edgewise_as_openfast_has_it() {
    // OpenFAST 5.0, 9 m/s steady, 6.4487 rpm: standard deviations over the turn, which weight alone makes.
    let speed = 6.448_66 * std::f64::consts::PI / 30.0;
    let settings = StructureSettings { rotor_speed: speed, ..StructureSettings::AT_REST };
    let mut structure = structure(&published(IEA_15), &settings);
    structure.hold(&[DegreeOfFreedom::Generator]);
    let n_per_turn = 465;
    let step = std::f64::consts::TAU / speed / f64::from(n_per_turn);
    let channels = ["IPDefl1", "RootMxc1"].map(|name| structure.channel(name).unwrap());
    let mut values = vec![0.0; structure.channels().len()];
    let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
    for turn in 0..60 {
        for _ in 0..n_per_turn {
            structure.advance(step, &AppliedLoads::NONE, &[Pitch::default(); 3]);
            structure.write_channels(&[0.0; 3], &mut values);
            for (k, &channel) in channels.iter().enumerate().filter(|_| turn >= 50) {
                let value = structure.channels()[channel].unit.of_si(values[channel]);
                sums[k] += value;
                squares[k] += value * value;
            }
        }
    }
    let n = 10.0 * f64::from(n_per_turn);
    let deviation = |k: usize| (squares[k] / n - (sums[k] / n).powi(2)).sqrt();
    assert!((deviation(0) / 0.8557 - 1.0).abs() < 0.02, "IPDefl1 {}", deviation(0));
    assert!((deviation(1) / 13_226.0 - 1.0).abs() < 0.02, "RootMxc1 {}", deviation(1));
}
