//! The flexible turbine by itself: natural frequencies beside published ones, what free motion keeps, loads
//! in closed form.

use crate::Row;
use crate::folds::larger;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use turbine::Definition;
use turbine::structure::{
    AppliedLoads, DegreeOfFreedom, GRAVITY, Pitch, Structure, StructureSettings,
};

/// Where the expected values come from.
const PUBLISHED: &str = "NREL/TP-500-38060 (2009), table 9-1, FAST";
const OPENFAST: &str = "OpenFAST 5.0.0, spectral peaks";
const FINITE_ELEMENTS: &str = "finite-element cantilevers, 200 elements, own computation";
const CONSERVATION: &str = "energy is kept";
const SECTIONS: &str = "sums over the blade's sections";

/// Step of the free vibrations (s): the default.
const STEP: f64 = 0.02;
const STILL: [Pitch; 3] = [Pitch { angle: 0.0, rate: 0.0, acceleration: 0.0 }; 3];

/// Frequencies of three turbines, energy of free motion, and loads of a spinning rigid rotor.
///
/// # Panics
/// When a library turbine cannot be read.
pub fn structure() -> Vec<Row> {
    let mut rows = Vec::new();
    machine_rows(&mut rows);
    blade_rows(&mut rows);
    energy_rows(&mut rows);
    spinning_rows(&mut rows);
    rows
}

fn definition_of(name: &str) -> Definition {
    formats::library::load(name).expect("library turbines can be read").definition
}

/// `definition` with `held` held, as `settings` have it.
fn built(
    definition: &Definition,
    settings: &StructureSettings<'_>,
    held: &[DegreeOfFreedom],
) -> Structure {
    let mut structure = Structure::new(definition, settings).expect("library turbines are sound");
    structure.hold(held);
    structure
}

/// Frequencies (Hz) that `kind` dominates, rising.
fn frequencies(structure: &Structure, kind: DegreeOfFreedom) -> Vec<f64> {
    let modes = structure.natural_modes();
    modes.iter().filter(|mode| mode.dominant() == kind).map(|mode| mode.frequency).collect()
}

/// One frequency; `share` is the tolerance over it (–).
fn frequency_row(
    what: String,
    measured: Option<f64>,
    expected: f64,
    share: f64,
    source: &'static str,
) -> Row {
    let measured = measured.unwrap_or(f64::NAN);
    Row { what, measured, expected, tolerance: Within(share * expected), unit: "Hz", source }
}

/// Whole machines: NREL 5 MW parked, after table 9-1 of Jonkman et al., NREL/TP-500-38060 (2009), its FAST
/// column; IEA 15 MW turning at 6.45 rpm, after the spectral peaks of an OpenFAST 5.0.0 run from an impulsive
/// start.
fn machine_rows(rows: &mut Vec<Row>) {
    let nrel = built(
        &definition_of("nrel-5mw"),
        &StructureSettings::AT_REST,
        &[DegreeOfFreedom::Generator],
    );
    let turning = StructureSettings { rotor_speed: 0.6753, ..StructureSettings::AT_REST };
    let iea = built(&definition_of("iea-15mw"), &turning, &[]);
    for (name, structure, kind, what, place, expected, share) in [
        ("nrel-5mw", &nrel, DegreeOfFreedom::TowerForeAft1, "tower fore-aft 1", 0, 0.3240, 0.02),
        (
            "nrel-5mw",
            &nrel,
            DegreeOfFreedom::TowerSideToSide1,
            "tower side-to-side 1",
            0,
            0.3120,
            0.02,
        ),
        ("nrel-5mw", &nrel, DegreeOfFreedom::TowerForeAft2, "tower fore-aft 2", 0, 2.9003, 0.02),
        (
            "nrel-5mw",
            &nrel,
            DegreeOfFreedom::TowerSideToSide2,
            "tower side-to-side 2",
            0,
            2.9361,
            0.02,
        ),
        ("nrel-5mw", &nrel, DegreeOfFreedom::DriveTrain, "drive train", 0, 0.6205, 0.02),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Flap1, "flapwise 1, yawing", 0, 0.6664, 0.03),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Flap1, "flapwise 1, tilting", 1, 0.6675, 0.03),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Flap1, "flapwise 1, collective", 2, 0.6993, 0.03),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Edge1, "edgewise 1, vertical", 0, 1.0793, 0.03),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Edge1, "edgewise 1, horizontal", 1, 1.0898, 0.03),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Flap2, "flapwise 2, yawing", 0, 1.9223, 0.03),
        ("nrel-5mw", &nrel, DegreeOfFreedom::Flap2, "flapwise 2, collective", 2, 2.0205, 0.03),
        (
            "iea-15mw",
            &iea,
            DegreeOfFreedom::TowerSideToSide1,
            "tower side-to-side 1",
            0,
            0.2374,
            0.02,
        ),
        ("iea-15mw", &iea, DegreeOfFreedom::Edge1, "edgewise 1", 0, 0.765, 0.03),
        ("iea-15mw", &iea, DegreeOfFreedom::Edge1, "edgewise 1, collective", 2, 1.765, 0.03),
    ] {
        let found = frequencies(structure, kind).get(place).copied();
        let source = if name == "nrel-5mw" { PUBLISHED } else { OPENFAST };
        rows.push(frequency_row(format!("{name}: {what}"), found, expected, share, source));
    }
}

/// Single blades at rest beside finite-element cantilevers of the same mass, stiffness and twist (200
/// elements, own computation).
fn blade_rows(rows: &mut Vec<Row>) {
    let held = &DegreeOfFreedom::ALL[..6];
    for (name, flapwise, edgewise) in
        [("nrel-5mw", 0.6775, 1.0863), ("iea-15mw", 0.5387, 0.7279), ("iea-22mw", 0.3958, 0.5388)]
    {
        let mut definition = definition_of(name);
        definition.rotor.precone = 0.0;
        let alone = built(
            &definition,
            &StructureSettings { gravity: 0.0, ..StructureSettings::AT_REST },
            held,
        );
        for (kind, what, expected) in [
            (DegreeOfFreedom::Flap1, "flapwise", flapwise),
            (DegreeOfFreedom::Edge1, "edgewise", edgewise),
        ] {
            let found = frequencies(&alone, kind).first().copied();
            let what = format!("{name}: blade alone, {what} 1, beside finite elements");
            rows.push(frequency_row(what, found, expected, 0.03, FINITE_ELEMENTS));
        }
    }
}

/// Largest change of energy in undamped free motion, as a share of the motion's energy at its beginning.
fn energy_rows(rows: &mut Vec<Row>) {
    let mut definition = definition_of("iea-15mw");
    let (blade, tower) = (&mut definition.blade_structure, &mut definition.tower);
    definition.drive_train.damping = 0.0;
    blade.edge_mode.damping_ratio = 0.0;
    for modes in [&mut blade.flap_modes, &mut tower.fore_aft_modes, &mut tower.side_to_side_modes] {
        modes.iter_mut().for_each(|mode| mode.damping_ratio = 0.0);
    }
    for (what, held, rotor_speed, duration) in [
        ("at rest, 1000 periods of the tower", &[DegreeOfFreedom::Generator][..], 0.0, 4300.0),
        ("turning freely, 1100 edgewise periods", &[][..], 0.79, 600.0),
    ] {
        let mut structure = built(&definition, &StructureSettings::AT_REST, held);
        let mut state = structure.state().clone();
        // A metre per second at the tips, less at the tower.
        state.velocities.shared = [0.4, -0.1, 0.3, 0.05, rotor_speed, 0.0];
        state.velocities.blades[..3].copy_from_slice(&[
            [1.0, -0.2, 0.5],
            [-0.4, 0.3, 0.2],
            [0.6, 0.1, -0.7],
        ]);
        structure.restore(state);
        let before = structure.energy();
        let mut worst = 0.0;
        for _ in 0..(duration / STEP) as usize {
            structure.advance(STEP, &AppliedLoads::NONE, &STILL);
            worst = larger(worst, (structure.energy().total() - before.total()).abs());
        }
        rows.push(Row {
            what: format!("iea-15mw, undamped free vibration {what}: change of energy"),
            measured: worst / before.kinetic,
            expected: 1e-4,
            tolerance: AtMost,
            unit: "–",
            source: CONSERVATION,
        });
    }
}

/// Rigid IEA 15 MW spinning: pull and weight at the blade roots beside sums over the blade's own sections.
fn spinning_rows(rows: &mut Vec<Row>) {
    const SPEED: f64 = 0.79;
    let mut definition = definition_of("iea-15mw");
    // Straight blades: what prebend does to the centres of mass is not in the sums below.
    definition.blade.iter_mut().for_each(|station| station.prebend = 0.0);
    let moment_of_mass = |apex: i32, root: i32| {
        let sections = &definition.blade_structure.sections;
        let n = 400;
        let mut sum = 0.0;
        for pair in sections.windows(2) {
            let length = pair[1].span - pair[0].span;
            for k in 0..n {
                let share = (f64::from(k) + 0.5) / f64::from(n);
                let span = pair[0].span + share * length;
                let density = pair[0].mass + share * (pair[1].mass - pair[0].mass);
                sum += density * length / f64::from(n)
                    * (definition.rotor.hub_radius + span).powi(apex)
                    * span.powi(root);
            }
        }
        sum
    };
    let (cone_sine, cone_cosine) = definition.rotor.precone.sin_cos();
    let tilt_cosine = definition.rotor.shaft_tilt.cos();
    let spun = |gravity: f64| {
        let settings =
            StructureSettings { gravity, rotor_speed: SPEED, ..StructureSettings::AT_REST };
        let mut structure = built(&definition, &settings, &DegreeOfFreedom::ALL);
        (0..100).for_each(|_| structure.advance(STEP, &AppliedLoads::NONE, &STILL));
        let root: Vec<(Vector3, Vector3)> =
            structure.loads().blades.iter().map(|b| (b.root.force, b.root.moment)).collect();
        root
    };
    let azimuth = SPEED * STEP * 99.5;
    let weightless = spun(0.0)[0];
    let heavy = spun(GRAVITY)[0];
    let square = SPEED * SPEED;
    let pull = square * moment_of_mass(1, 0);
    let bend = square * moment_of_mass(1, 1);
    let weight = GRAVITY * moment_of_mass(0, 1);
    for (what, measured, expected, scale) in [
        ("pull along the blade, MN", weightless.0.z, pull * cone_cosine * cone_cosine, pull),
        ("flapwise moment of the pull, MN m", weightless.1.y, bend * cone_cosine * cone_sine, bend),
        (
            "edgewise moment of weight, MN m",
            heavy.1.x - weightless.1.x,
            weight * tilt_cosine * azimuth.sin(),
            weight,
        ),
    ] {
        rows.push(Row {
            what: format!("iea-15mw, rigid, straight, spinning at 7.5 rpm: {what}"),
            measured: 1e-6 * measured,
            expected: 1e-6 * expected,
            tolerance: Within(1e-10 * scale),
            unit: "",
            source: SECTIONS,
        });
    }
}
