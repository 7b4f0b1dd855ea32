//! Cost of one step of a turbine on one core, part by part: `cargo bench -p wakemix-benches --bench turbine`.
//!
//! IEA 15 MW in a sheared wind of 9 m/s, flexible, steps of 0.02 s: the structure alone under loads that are
//! held, the blade elements alone with momentum theory and dynamic stall, actuator lines as in a lattice, the
//! whole turbine, and a row of its record as CSV and as `.outb`. Repeats are short, so that on a loaded
//! machine some go undisturbed; the best counts. A number after `--` is that of the repeats.

use basis::{Channel, Commands, PerBlade, Unit, Vector3};
use formats::openfast_output::{Encoding, Layout, OutbWriter};
use formats::records::SeriesWriter;
use formats::table::Column;
use std::f64::consts::TAU;
use std::fs;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use turbine::aero::blade_element::Theory;
use turbine::aero::induction::{Induction as Inflow, TwoConstant};
use turbine::aero::rotor::{self, RotorAerodynamics, RotorKinematics};
use turbine::structure::{AppliedLoads, ElementLoad, Pitch, Structure};
use turbine::{Definition, Induction, Turbine, TurbineSettings};

const INTERVAL: f64 = 0.02;
const AIR_DENSITY: f64 = 1.225;
const ROTOR_SPEED: f64 = 0.68;
/// Steps of a repeat.
const N_STEPS: usize = 50;
/// Rows of a repeat: enough that making the file counts for little.
const N_ROWS: usize = 500;

fn main() {
    let n_repeats = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(100);
    let file = formats::library::load("iea-15mw").expect("the library's own turbines are readable");
    let definition = Arc::new(file.definition);
    println!("microseconds a step (or row) on one core, best of {n_repeats}");
    let say = |name: &str, cost: &mut dyn FnMut() -> f64| {
        let best = (0..n_repeats).map(|_| cost()).fold(f64::INFINITY, f64::min);
        println!("{name:<44} {best:>8.2}");
    };
    let mut structure = StructureAlone::new(&definition);
    say("structure", &mut || structure.cost());
    let mut blades = BladesAlone::new(&definition);
    say("blade elements, momentum theory", &mut || blades.cost());
    let by_flow =
        Induction::ByFlow { smearing_length: 15.0, sample_spacing: 15.0, dynamic_stall: false };
    for (name, induction) in [
        ("turbine, momentum theory", Induction::ByMomentum(theory())),
        ("turbine, actuator lines", by_flow),
    ] {
        let mut turbine = machine(&definition, induction);
        say(name, &mut || whole(&mut turbine));
    }
    let turbine = machine(&definition, Induction::ByMomentum(theory()));
    let n_channels = turbine.channels().len();
    say(&format!("row of {n_channels} channels, CSV"), &mut || csv(n_channels));
    say(&format!("row of {n_channels} channels, .outb"), &mut || outb(n_channels));
}

fn theory() -> rotor::BemSettings {
    rotor::BemSettings {
        induction: Inflow::TwoConstant(TwoConstant::varying()),
        theory: Theory::default(),
        skewed_wake: true,
        dynamic_stall: true,
        tower: None,
    }
}

fn machine(definition: &Arc<Definition>, induction: Induction) -> Turbine {
    let settings = TurbineSettings {
        induction,
        flexible: true,
        air_density: AIR_DENSITY,
        yaw: 0.0,
        rotor_speed: ROTOR_SPEED,
        azimuth: 0.0,
        pitch: 0.0,
    };
    let made = Turbine::new(Arc::clone(definition), Vector3::ZERO, settings);
    made.expect("the library's own turbines have a structure")
}

fn wind(place: &Vector3) -> Vector3 {
    Vector3::new(9.0 + 0.006 * (place.z - 150.0), 0.0, 0.0)
}

/// Microseconds a step of `step`, called with the step's number, `n_steps` times.
fn per_step(n_steps: usize, step: impl FnMut(usize)) -> f64 {
    let start = Instant::now();
    (0..n_steps).for_each(step);
    1e6 * start.elapsed().as_secs_f64() / n_steps as f64
}

/// The structure under loads that are held.
struct StructureAlone {
    structure: Structure,
    loads: Vec<ElementLoad>,
    pitch: Vec<Pitch>,
}

impl StructureAlone {
    fn new(definition: &Arc<Definition>) -> Self {
        let whole = machine(definition, Induction::ByMomentum(theory()));
        let n_blades = definition.n_blades;
        let n_elements = whole.line().elements().len();
        // About rated thrust, shared alike.
        let force = Vector3::X * (2e6 / (n_blades * n_elements) as f64);
        let load = ElementLoad { force, moment: Vector3::ZERO };
        Self {
            structure: whole.structure().clone(),
            loads: vec![load; n_blades * n_elements],
            pitch: vec![Pitch::default(); n_blades],
        }
    }

    fn cost(&mut self) -> f64 {
        let Self { structure, loads, pitch } = self;
        per_step(N_STEPS, |_| {
            let applied = AppliedLoads { elements: loads, ..AppliedLoads::NONE };
            structure.advance(INTERVAL, black_box(&applied), pitch);
            black_box(structure.loads());
        })
    }
}

/// The blades of a stiff rotor that turns at one speed.
struct BladesAlone {
    rotor: RotorAerodynamics,
    state: rotor::BemState,
    loads: rotor::Loads,
    structure: Structure,
    pitch: Vec<Pitch>,
}

impl BladesAlone {
    fn new(definition: &Arc<Definition>) -> Self {
        let whole = machine(definition, Induction::ByMomentum(theory()));
        let rotor =
            RotorAerodynamics::new(definition, whole.line().elements(), AIR_DENSITY, theory());
        let (state, loads) = (rotor.start(), rotor.loads());
        let pitch = vec![Pitch::default(); definition.n_blades];
        Self { rotor, state, loads, structure: whole.structure().clone(), pitch }
    }

    fn cost(&mut self) -> f64 {
        let Self { rotor, state, loads, structure, pitch } = self;
        let still = turbine::motion::ElementMotion {
            position: Vector3::ZERO,
            velocity: Vector3::ZERO,
            axes: structure.frame(0.0).blade(0.0, 0.0),
            pitch: 0.0,
        };
        // A turn of the rotor in sixty postures, found beforehand.
        let turn: Vec<_> = (0..60)
            .map(|place| {
                let mut motions = vec![still; loads.elements.len()];
                structure.observe(TAU / ROTOR_SPEED * f64::from(place) / 60.0, pitch, &mut motions);
                let winds: Vec<Vector3> =
                    motions.iter().map(|motion| wind(&motion.position)).collect();
                (motions, winds)
            })
            .collect();
        let frame = structure.frame(0.0);
        per_step(N_STEPS, |step| {
            // The same kinematics for five steps, so that the rotor turns at about its speed.
            let (motions, winds) = &turn[step / 5 % turn.len()];
            let kinematics = RotorKinematics { frame: &frame, elements: motions, pitch };
            rotor.advance(INTERVAL, black_box(winds), kinematics, state, loads);
            black_box(&loads);
        })
    }
}

/// The whole turbine in the wind, its generator held at a torque.
fn whole(turbine: &mut Turbine) -> f64 {
    let n_blades = turbine.definition().n_blades;
    let commands =
        Commands { pitch: PerBlade::splat(n_blades, 0.0), generator_torque: 1.5e7, yaw_rate: 0.0 };
    let before = turbine.state().clone();
    let mut winds = vec![Vector3::ZERO; turbine.stations().len()];
    let cost = per_step(N_STEPS, |_| {
        for (wind_there, place) in winds.iter_mut().zip(turbine.stations()) {
            *wind_there = wind(place);
        }
        turbine.advance(INTERVAL, &winds, &commands);
        black_box(turbine.forces());
    });
    turbine.restore(before);
    cost
}

/// Rows of `n_channels` as loads are: no two values alike, and all digits in use.
fn rows(n_channels: usize) -> Vec<Vec<f64>> {
    let value = |row: usize, channel: usize| 1e6 * (0.013 * row as f64 + channel as f64).sin();
    (0..N_ROWS).map(|row| (0..n_channels).map(|channel| value(row, channel)).collect()).collect()
}

/// Microseconds a row of `n_channels` in a series.
fn csv(n_channels: usize) -> f64 {
    let path = std::env::temp_dir().join(format!("wakemix-bench-{}.csv", std::process::id()));
    let channel =
        |index| Channel { name: format!("channel{index}").into(), unit: Unit::KilonewtonMetre };
    let channels: Vec<Channel> = (0..n_channels).map(channel).collect();
    let rows = rows(n_channels);
    let mut writer =
        SeriesWriter::create(&path, &channels).expect("a temporary file can be written");
    let cost = per_step(N_ROWS, |step| {
        writer.write(black_box(&rows[step])).expect("a temporary file can be written");
    });
    fs::remove_file(writer.part_path()).expect("the bench's own file can be removed");
    cost
}

/// Microseconds a row of `n_channels` in a binary file, its end with scaling and copying shared among the
/// rows.
fn outb(n_channels: usize) -> f64 {
    let path = std::env::temp_dir().join(format!("wakemix-bench-{}.outb", std::process::id()));
    let channel = |channel| Column { name: format!("channel{channel}"), unit: "-".to_owned() };
    let layout = Layout {
        description: "bench".to_owned(),
        channels: (0..n_channels).map(channel).collect(),
        start: 0.0,
        interval: INTERVAL,
    };
    let rows = rows(n_channels);
    let start = Instant::now();
    let mut writer = OutbWriter::create(&path, layout, Encoding::Compressed)
        .expect("a temporary file can be written");
    for row in &rows {
        writer.write(black_box(row)).expect("a temporary file can be written");
    }
    writer.finish().expect("a temporary file can be written");
    let cost = 1e6 * start.elapsed().as_secs_f64() / N_ROWS as f64;
    fs::remove_file(&path).expect("the bench's own file can be removed");
    cost
}
