//! The Kalman filter and the phase-locked loops behind one seam, on the same blade moments: error, settling,
//! noise, cost.
//!
//! The filter knows the rotor and tells the phase of the *wind*, the helix's rate given or estimated; the
//! loops know nothing but a band of rates and tell the phase of the *load*. Each is judged against its own
//! truth: the load's is read off the same record without noise and turbulence.

use super::rig::{self, Instruments, Noise};
use super::wind::degrees;
use super::{
    Machine, OWN, PERIOD, PHASE, ROTOR_SPEED, SPEED, pitch, reading, robust, row, setting, trial,
};
use crate::Row;
use crate::folds::larger;
use basis::mbc::to_fixed_frame;
use basis::{FixedFrame, Measurements, PerBlade, Sense};
use estimation::helix::{HelixEstimator, HelixOptions, HelixSettings, MeasurementModel};
use estimation::phase_locked::{
    GeneratorKind, Leader, PhaseLockedSettings, TwoAxisLoop, TwoAxisSettings,
};
use estimation::{EstimationError, Estimator, Oscillation, Quantity};
use rig::INTERVAL;
use std::f64::consts::{SQRT_2, TAU};
use std::sync::Arc;
use std::time::Instant;

/// Length of a record, and what is left out before errors count (s): six periods, in which a loop of the
/// usual gains comes from half a turn to two degrees.
const DURATION: f64 = 1500.0;
const JUDGED: f64 = 6.0 * PERIOD;
/// An error that stays below is settled (deg).
const SETTLED: f64 = 10.0;
/// Aims: own model without noise, with 5 %, and a turbine in turbulence (deg).
const AIMS: [f64; 3] = [0.5, 4.0, 20.0];
/// Aim of a loop's update, and what the filter's may cost at a control interval of 0.1 s (µs).
const COSTS: [f64; 2] = [1.0, 100.0];
const SENSE: Sense = Sense::CounterClockwise;

/// A record with its truth.
struct Known {
    name: &'static str,
    /// Largest error that is aimed at (deg).
    aim: f64,
    rate: f64,
    record: Vec<Measurements<'static>>,
    /// Phases of tilt and yaw (rad) over the angle of the excitation, of the wind and of the load.
    wind: [f64; 2],
    load: [f64; 2],
}

/// What an estimator makes of a record.
struct Outcome {
    /// Time from which the worse axis' error stays below [`SETTLED`] (s); infinite if it never does.
    settling: f64,
    /// Root mean square of the worse axis' error (deg), and its mean over both axes (deg).
    rms: f64,
    mean: f64,
    /// Root mean square of the rate's error (–).
    rate: f64,
    /// Mean trust, and share of instants without usable measurements (–).
    trust: f64,
    held: f64,
    /// Wall time of an update (µs).
    cost: f64,
}

/// All of it, IEA 15 MW; prints the table.
pub fn estimators() -> Vec<Row> {
    let file = formats::library::load("iea-15mw").expect("the library's own turbines are readable");
    let machine = Machine { definition: Arc::new(file.definition), constants: file.controller };
    side_by_side(&machine).unwrap_or_else(|error| {
        tell!("the estimators could not be made: {error}");
        vec![row("the estimators are made".to_owned(), f64::NAN, 0.0, "–")]
    })
}

fn side_by_side(machine: &Machine) -> Result<Vec<Row>, EstimationError> {
    tell!(
        "| record | estimator | within {SETTLED:.0}° after, s | worse axis, rms deg | mean, deg | rate, % | trust | held, % |"
    );
    tell!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let (mut rows, mut costs) = (Vec::new(), [0.0_f64; 4]);
    for (index, known) in records(machine)?.iter().enumerate() {
        // On the turbine in prescribed wind the wake stays with the blades, on its own model it is the
        // model's.
        let options = if known.aim == AIMS[2] { robust() } else { HelixOptions::default() };
        let sought = HelixOptions { rate: Some(1e-9), ..options };
        let mut outcomes = vec![
            ("filter", judge(known, &mut filter(machine, options)?)),
            ("filter that estimates the rate", judge(known, &mut filter(machine, sought)?)),
        ];
        let extended = GeneratorKind::extended(SQRT_2, 1.0).expect("damping √2 has a dc gain");
        for (name, kind) in [("loops, MSTOGI", GeneratorKind::Mixed), ("loops, ESOGI", extended)] {
            outcomes.push((name, judge(known, &mut loops(kind))));
        }
        for (place, (name, outcome)) in outcomes.iter().enumerate() {
            tell!("| {} | {name} | {} |", known.name, outcome.line());
            // The first record meets cold caches.
            costs[place] = if index == 0 { f64::INFINITY } else { costs[place].min(outcome.cost) };
            let what = format!("{}: {name}, worse axis, rms error", known.name);
            rows.push(row(what, outcome.rms, known.aim, "deg"));
        }
    }
    let names = ["filter", "filter that estimates the rate", "loops, MSTOGI", "loops, ESOGI"];
    for (place, (name, cost)) in names.iter().zip(costs).enumerate() {
        let most = COSTS[usize::from(place < 2)];
        rows.push(row(format!("{name}: wall time of an update"), cost, most, "µs"));
    }
    Ok(rows)
}

impl Outcome {
    fn line(&self) -> String {
        format!(
            "{:.0} | {:.2} | {:+.2} | {:.2} | {:.2} | {:.1}",
            self.settling,
            self.rms,
            self.mean,
            100.0 * self.rate,
            self.trust,
            100.0 * self.held
        )
    }
}

/// Setting of the filter: the usual rate.
fn filter(machine: &Machine, options: HelixOptions) -> Result<HelixEstimator, EstimationError> {
    machine.estimator(&machine.definition, SENSE, options)
}

/// Settings of the loops: St 0.15 to 0.3, the helix at 0.25.
fn loops(kind: GeneratorKind) -> TwoAxisLoop {
    let rates = [0.6, 1.2].map(|factor| factor * TAU / PERIOD);
    let signal = PhaseLockedSettings { generator: kind, ..PhaseLockedSettings::between(rates) };
    let settings = TwoAxisSettings { signal, sense: SENSE, leader: Leader::Both };
    TwoAxisLoop::new(&settings, INTERVAL).expect("a sound loop")
}

fn judge<E: Estimator>(known: &Known, estimator: &mut E) -> Outcome {
    let started = Instant::now();
    let estimates: Vec<Oscillation> =
        known.record.iter().map(|read| estimator.update(read).into()).collect();
    let cost = 1e6 * started.elapsed().as_secs_f64() / known.record.len() as f64;
    let (mut squares, mut sum, mut rate, mut trust, mut held) = ([0.0; 2], 0.0, 0.0, 0.0, 0.0);
    let (mut n, mut settling) = (0.0, 0.0);
    for (read, estimate) in known.record.iter().zip(&estimates) {
        let truth = match estimate.quantity {
            Quantity::Wind => known.wind,
            Quantity::Load => known.load,
        };
        let angle = known.rate * read.time;
        let errors = [0, 1].map(|axis| degrees(estimate.phases[axis] - truth[axis] - angle));
        if errors.iter().any(|error| error.is_nan() || error.abs() > SETTLED) {
            settling = read.time;
        }
        if read.time >= JUDGED {
            squares.iter_mut().zip(errors).for_each(|(square, error)| *square += error * error);
            sum += 0.5 * (errors[0] + errors[1]);
            rate += (estimate.rate / known.rate - 1.0).powi(2);
            trust += estimate.trust;
            held += f64::from(u8::from(estimate.held));
            n += 1.0;
        }
    }
    let last = known.record.last().map_or(0.0, |read| read.time);
    Outcome {
        settling: if settling == last { f64::INFINITY } else { settling },
        rms: (larger(squares[0], squares[1]) / n).sqrt(),
        mean: sum / n,
        rate: (rate / n).sqrt(),
        trust: trust / n,
        held: held / n,
        cost,
    }
}

fn records(machine: &Machine) -> Result<Vec<Known>, EstimationError> {
    let own = |name, aim, noise, dropouts, amplitude, off| {
        own_model(machine, name, aim, Instruments { noise, dropouts }, amplitude, off)
    };
    Ok(vec![
        own("own model, no noise", AIMS[0], 0.0, 0.0, 0.0, 1.0)?,
        own("own model, 5 % noise", AIMS[1], 0.05, 0.0, 0.0, 1.0)?,
        own("own model, 20 % noise", 4.0 * AIMS[1], 0.2, 0.0, 0.0, 1.0)?,
        own("own model, 5 % noise, one reading in ten lost", AIMS[1], 0.05, 0.1, 0.0, 1.0)?,
        own("own model, 5 % noise, own pitch 4°", AIMS[1], 0.05, 0.0, OWN, 1.0)?,
        own("own model, 5 % noise, rate 2 % above nominal", AIMS[1], 0.05, 0.0, 0.0, 1.02)?,
        turbine(machine, "turbine, turbulence 6 %", 0.06, 0.0),
        turbine(machine, "turbine, turbulence 6 %, own pitch 4°", 0.06, OWN),
        turbine(machine, "turbine, turbulence 12 %", 0.12, 0.0),
    ])
}

/// Moments that the filter's own model makes with finer blades, in 1 m/s of helix at `off` (–) of the usual
/// rate.
fn own_model(
    machine: &Machine,
    name: &'static str,
    aim: f64,
    instruments: Instruments,
    own: f64,
    off: f64,
) -> Result<Known, EstimationError> {
    let rate = off * TAU / PERIOD;
    let finer = HelixSettings { n_elements: 32, ..setting(SENSE) };
    let mut calm = machine.gradient(SENSE, 0.0);
    calm.rate = rate;
    let made = |instruments| {
        let mut model =
            MeasurementModel::new(&machine.definition, &finer, &HelixOptions::default())?;
        let (mut noise, mut shown) = (Noise(5), PerBlade::splat(3, 0.0));
        let instant = |step: usize| {
            let time = step as f64 * INTERVAL;
            let (azimuth, angle) = (ROTOR_SPEED * time, rate * time + PHASE);
            let yaw = (angle + SENSE.yaw_lead()).sin();
            let wind = FixedFrame { average: SPEED, tilt: angle.sin(), yaw };
            let pitch = pitch(&calm, time, azimuth, own, 2.1, 3);
            let moments = model.moments(INTERVAL, wind, azimuth, ROTOR_SPEED, &pitch);
            rig::read(&reading(time, azimuth, pitch, moments), instruments, &mut shown, &mut noise)
        };
        Ok((0..(DURATION / INTERVAL) as usize).map(instant).collect::<Vec<_>>())
    };
    let load = swing(&made(Instruments::default())?, rate);
    let wind = [PHASE, SENSE.yaw_lead() + PHASE];
    Ok(Known { name, aim, rate, record: made(instruments)?, wind, load })
}

/// An aeroelastic turbine in shear and turbulence of `intensity` (–) that carries a helix.
fn turbine(machine: &Machine, name: &'static str, intensity: f64, own: f64) -> Known {
    let made = |intensity| {
        let wind = machine.gradient(SENSE, intensity);
        let trial = trial(wind, own, Instruments::default(), DURATION);
        let mut record = Vec::new();
        rig::drive(&machine.definition, &machine.constants, &trial, |read| record.push(*read));
        record
    };
    let rate = TAU / PERIOD;
    let [tilt, yaw] = machine.gradient(SENSE, 0.0).truth();
    let wind = [tilt, SENSE.yaw_lead() + yaw];
    let load = swing(&made(0.0), rate);
    Known { name, aim: AIMS[2], rate, record: made(intensity), wind, load }
}

/// Phases (rad) of tilt and yaw moment over the angle of an excitation of `rate` (rad/s), by the last whole
/// periods of `record` after [`JUDGED`].
fn swing(record: &[Measurements], rate: f64) -> [f64; 2] {
    let n_period = TAU / rate / INTERVAL;
    let n_late = record.iter().filter(|read| read.time >= JUDGED).count() as f64;
    let n = ((n_late / n_period).floor() * n_period).round() as usize;
    let late = &record[record.len() - n..];
    let loads = |read: &Measurements| to_fixed_frame(read.azimuth, &read.flap_moments);
    let mut sums = [[0.0; 2]; 2];
    for read in late {
        let (load, (sine, cosine)) = (loads(read), (rate * read.time).sin_cos());
        for (sums, load) in sums.iter_mut().zip([load.tilt, load.yaw]) {
            sums[0] += load * sine;
            sums[1] += load * cosine;
        }
    }
    sums.map(|[sine, cosine]| cosine.atan2(sine))
}
