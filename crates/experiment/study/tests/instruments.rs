//! Instruments in the farm, in resolved flow and in prescribed wind: perfect ones change no bit, noise has
//! the deviation that was set, records hold the truth, and a run that was stopped goes on with the same
//! noise.

mod small;

use basis::{Commands, Truth, Vector3};
use farm::assemble::{self, TurbineModel};
use farm::case::Case;
use farm::{Air, Farm, Plan, Recorder};
use flow::WindField;
use flow::inflow::MeanProfile;
use flow::lattice::Lattice;
use small::{laid_out, options, uniform_air, written};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use study::{Observer, Outcome, Progress, Silent, StudyOptions};

const CASE: &str = r#"
name = "instruments"
[wind]
speed = 9.0
turbulence_intensity = 0.0
shear_exponent = 0.15
seed = 3
[flow]
solver = "uniform"
cells_per_diameter = 8
upstream_diameters = 1.0
downstream_diameters = 1.0
width_diameters = 2.0
height_diameters = 2.0
[time]
spin_up = 1.0
duration = 40.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [1.5, 0.0]
[[run]]
name = "sync"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
"#;

/// Noise of the encoder of generator speed (rpm), and of the strain gauges (MN m).
const SPEED_NOISE: f64 = 0.05;
const MOMENT_NOISE: f64 = 2.0;

/// The case with `overrides`, laid out, with its turbines.
fn case(overrides: &[String]) -> (Case, Plan, Vec<TurbineModel>) {
    let (case, plan, model) = laid_out(CASE, overrides, "iea-15mw");
    (case, plan, vec![model.clone(), model])
}

fn farm_of((case, plan, models): &(Case, Plan, Vec<TurbineModel>)) -> Farm<Air> {
    let air = if !case.flow.solver.resolves_induction {
        uniform_air(case)
    } else {
        let profile = Arc::new(MeanProfile::Uniform { speed: case.wind.speed });
        let site = farm::wind::Site { case, plan, models: &[], surroundings: None };
        let settings = assemble::lattice_settings(&site);
        Box::new(Lattice::new(settings, profile).expect("such air can be"))
    };
    assemble::farm(case, &case.runs[0], plan, models, air).expect("such a farm can be")
}

/// Both ways to have wind, with `more` overrides.
fn airs(more: &[&str]) -> [Vec<String>; 2] {
    ["uniform", "lattice"].map(|solver| {
        let solver = format!("flow.solver={solver}");
        [solver.as_str()].iter().chain(more).map(|text| (*text).to_owned()).collect()
    })
}

#[derive(Default)]
struct Records(Vec<(usize, Truth, Commands)>);

impl Recorder for Records {
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        self.0.push((turbine, *truth, *commands));
    }
}

fn records(farm: &mut Farm<Air>, n_steps: usize) -> Vec<(usize, Truth, Commands)> {
    let mut records = Records::default();
    for _ in 0..n_steps {
        farm.advance(&mut records).expect("the air stays finite");
    }
    records.0
}

#[test]
fn perfect_instruments_change_no_bit() {
    for overrides in airs(&[]) {
        let parts = case(&overrides);
        let recorded = records(&mut farm_of(&parts), 40);
        // The same turbines and controllers moved on by hand, with nothing between them; the air of the
        // lattice feels the turbines only through the farm, so that by hand it is asked for one step.
        let n_steps = if parts.0.flow.solver.resolves_induction { 1 } else { 40 };
        let mut by_hand = farm_of(&parts);
        for step in 0..n_steps {
            let interval = parts.1.interval;
            let time = step as f64 * interval;
            for index in 0..2 {
                let stations = by_hand.machines()[index].turbine.stations().to_vec();
                let mut winds = vec![Vector3::ZERO; stations.len()];
                by_hand.flow().sample(&stations, &mut winds);
                let machine = &mut by_hand.machines_mut()[index];
                let truth = machine.turbine.truth(time, interval);
                let commands = machine.controller.update(&truth.measured());
                assert_eq!(recorded[2 * step + index], (index, truth, commands));
                machine.turbine.advance(interval, &winds, &commands);
            }
        }
    }
}

#[test]
fn controllers_see_the_noise_and_records_hold_the_truth() {
    let speed = format!("turbine.T1.instruments.generator_speed={{ noise_rpm = {SPEED_NOISE} }}");
    for overrides in airs(&[&speed]) {
        let parts = case(&overrides);
        let mut farm = farm_of(&parts);
        let mut twin = farm_of(&parts);
        let (mut squares, mut n) = (0.0, 0.0);
        for step in 0..800 {
            let machine = &farm.machines()[0];
            let truth = machine.turbine.truth(farm.time(), parts.1.interval);
            let shown = twin.machines_mut()[0].sensing.gauge(&truth);
            squares += (shown.generator_speed - truth.generator_speed).powi(2);
            n += 1.0;
            let expected = twin.machines_mut()[0].controller.update(&shown);
            let recorded = records(&mut farm, 1);
            assert_eq!(recorded[0], (0, truth, expected), "step {step}");
            assert_eq!(shown.azimuth.to_bits(), truth.azimuth.to_bits());
        }
        // Four standard errors.
        let deviation = (squares / n).sqrt() * 30.0 / std::f64::consts::PI;
        assert!((deviation / SPEED_NOISE - 1.0).abs() < 4.0 / (2.0 * n).sqrt(), "{deviation} rpm");
        // Torque follows the speed that is shown: less than the noise, since a filter stands before it.
        let commands = |farm: &mut Farm<Air>| records(farm, 20)[2 * 19].2;
        assert_ne!(commands(&mut farm_of(&parts)), commands(&mut farm_of(&case(&overrides[..1]))));
    }
}

/// The estimated wind follows the strain gauges; commands and loads do not while the turbine only monitors.
#[test]
fn noise_reaches_the_phase_estimator_and_nothing_else() {
    let gauges = format!("turbine.T2.instruments.flap_moments={{ noise_mnm = {MOMENT_NOISE} }}");
    let [noisy, _] = airs(&[&gauges]);
    let run = |overrides: &[String]| {
        let mut farm = farm_of(&case(overrides));
        let records = records(&mut farm, 1500);
        let controller = &farm.machines()[1].controller;
        let signals = controller.signals();
        let mut values = vec![f64::NAN; signals.len()];
        controller.write_signals(&mut values);
        let [wind, phase] = ["EstWind", "EstWindTiltPhase"].map(|wanted| {
            values[signals
                .iter()
                .position(|signal| signal.name == wanted)
                .expect("T2 looks for the helix")]
        });
        (records, wind, phase)
    };
    let (truth, wind, phase) = run(&noisy[..1]);
    let (noisy, misled_wind, misled_phase) = run(&noisy);
    assert_eq!(truth, noisy);
    assert_ne!(phase, misled_phase);
    assert!((wind - misled_wind).abs() < 1.0, "{wind} {misled_wind}");
}

#[test]
fn noise_belongs_to_the_winds_seed_and_the_turbine() {
    let all = ["T1", "T2"].map(|name| {
        format!("turbine.{name}.instruments.rotor_speed={{ noise_rpm = {SPEED_NOISE} }}")
    });
    let shown = |seed: &str| {
        let parts = case(&[all[0].clone(), all[1].clone(), seed.to_owned()]);
        let mut farm = farm_of(&parts);
        [0, 1].map(|index| {
            let machine = &mut farm.machines_mut()[index];
            let truth = machine.turbine.truth(0.0, 0.02);
            machine.sensing.gauge(&truth).rotor_speed - truth.rotor_speed
        })
    };
    let [first, second] = shown("wind.seed=3");
    assert_ne!(first, second);
    assert_eq!(shown("wind.seed=3"), [first, second]);
    assert_ne!(shown("wind.seed=4"), [first, second]);
}

/// Stops a run at the first sign of life, after a step.
struct Stopper<'a>(&'a AtomicBool);

impl Observer for Stopper<'_> {
    fn advanced(&mut self, _: &Progress) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[test]
fn a_stopped_run_goes_on_with_the_same_bits() {
    let folder = written(CASE);
    let overrides = [
        "time.duration=10",
        "turbine.T1.instruments.generator_speed={ noise_rpm = 0.05, dropout = 0.1, time_constant = 0.1 }",
        "turbine.T2.instruments.flap_moments={ noise_mnm = 1, frequency_hz = 2 }",
        "turbine.T2.instruments.azimuth={ resolution_deg = 0.5, noise_deg = 0.2 }",
        "run.sync.control.T2={ kind = \"meandering\", factor = 1.5, amplitude_deg = 2, azimuth_offset_deg = 0, delay = 0, moment_per_degree_mnm = 4 }",
    ]
    .map(str::to_owned);
    // The series of a run that is stopped `n_stops` times, a step apart: noise, drop-outs and slow
    // instruments have states that change from step to step.
    let series = |name: &str, n_stops: usize| {
        let output = folder.path().join(name);
        let mut options = StudyOptions {
            output: Some(output.clone()),
            overrides: overrides.to_vec(),
            ..options(folder.path())
        };
        for _ in 0..n_stops {
            let stop = AtomicBool::new(false);
            let part = study::run(&options, &stop, &mut Stopper(&stop)).expect("the study runs");
            assert!(!matches!(part, Outcome::Done { .. }), "it is not stopped");
            options.resume = true;
        }
        let last = study::run(&options, &AtomicBool::new(false), &mut Silent);
        assert!(matches!(last.expect("the study runs"), Outcome::Done { .. }));
        read(&output)
    };
    assert!(series("whole", 0) == series("broken", 20), "the series differ");
}

fn read(output: &Path) -> Vec<u8> {
    fs::read(output.join("sync").join("series.csv")).expect("the run leaves a series")
}
