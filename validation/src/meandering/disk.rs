//! The source's section 4-2-1: the aeroelastic turbine in the rotating disk, loads brought to factors of
//! their own amplitude; and what it leaves open, the same where the disk meets a part of the rotor only.

use super::identify::decoupling;
use super::judge::{Record, Table};
use super::rig::{INTERVAL, Reading, Rig};
use crate::Row;
use crate::folds::larger;
use crate::row::Tolerance::AtMost;
use basis::{FixedFrame, Sense};
use control::meandering::{
    Decoupling, Followed, Meandering, MeanderingControlSettings, Reference, TwoAxisSettings,
};
use estimation::Estimator;
use estimation::phase_locked::{Leader, PhaseLockedSettings as Signal, TwoAxisLoop};
use flow::inflow::deterministic::Event;
use flow::inflow::deterministic::RotatingDisk;
use flow::inflow::{DeterministicWind, MeanProfile};
use std::f64::consts::TAU;

/// Where the expected values come from.
const SOURCE: &str = "van Veldhoven (2024), section 4-2-1";

/// Wind outside the disk (m/s).
const AMBIENT: f64 = 16.0;
/// Rotor diameter and hub height that the disk is made for (m).
const DIAMETER: f64 = 240.0;
const HUB_HEIGHT: f64 = 150.0;
/// Rotor speed at the beginning (rad/s).
const ROTOR_SPEED: f64 = 0.75;
/// Beginning of control, of what is judged, and end (s).
const START: f64 = 400.0;
const JUDGED: f64 = 600.0;
const END: f64 = 1500.0;
/// Width of the disk's edge (m), that of the grid which the source's wind stands on.
const EDGE: f64 = 14.0;
/// Target factors: the source's four, and those above that it tries in its second wind.
const FACTORS: [f64; 7] = [2.0, 1.75, 1.5, 1.25, 0.75, 0.5, 0.35];
/// Target factors when the wake's own part is followed and its amplitude observed.
const DEEP_FACTORS: [f64; 5] = [1.25, 0.75, 0.35, 0.2, 0.0];

/// The source's table 4-4: factor, changes (%) of the seven deviations and of power.
const PUBLISHED: [(f64, [f64; 8]); 4] = [
    (1.25, [1.3, 13.3, 19.4, 5.9, 28.0, -0.3, 22.3, 0.1]),
    (0.75, [-0.5, -10.8, -16.3, -0.2, -22.6, -2.6, -0.8, -0.9]),
    (0.5, [-0.9, -22.0, -34.3, -2.5, -47.0, -6.1, -15.4, -2.7]),
    (0.35, [-1.0, -27.9, -43.5, -2.8, -60.9, -8.0, -16.0, -4.0]),
];

/// Target factors where the disk meets a part of the rotor only.
const PARTIAL_FACTORS: [f64; 3] = [1.25, 0.75, 0.35];

/// Everything; prints the tables with intervals, gives what is claimed as rows.
pub fn disk() -> Vec<Row> {
    let full = Bench::new(0.0, following());
    let decoupling = decoupling(&full.rig, &full.loads);
    let Decoupling { azimuth_offset, delay, gain } = decoupling;
    tell!(
        "azimuth offset {:.1}°, delay {delay:.2} s, {:.0} MN m/rad",
        azimuth_offset.to_degrees(),
        1e-6 * gain
    );
    let mut rows = full.rows("full overlap");
    let given = full.given();
    let observed = Reference::Observed;
    for (followed, name, reference, factors) in [
        (Followed::Load, "load followed", given, &FACTORS[..]),
        (Followed::Wake, "wake followed", given, &FACTORS[3..]),
        (Followed::Wake, "wake followed, its amplitude observed", observed, &DEEP_FACTORS),
    ] {
        let claimed: &[_] = if reference == given { &PUBLISHED } else { &[] };
        let choice = LoopChoice { following: following(), followed, reference, decoupling };
        rows.extend(full.table(name, factors, choice, Some(claimed)));
    }
    rows.extend(tilt_leads(decoupling));
    // Pitch acts as it was found in full overlap: a turbine that is identified alone knows nothing of where
    // the wake will meet it.
    // Half a diameter aside the loop does not lock, nothing is pitched, and what then does not change is no
    // claim.
    let changes: Option<&[_]> = Some(&[]);
    for (aside, place, claimed) in [(0.25, "¼ D aside", changes), (0.5, "½ D aside", None)] {
        let partial = Bench::new(aside, following());
        rows.extend(partial.rows(place));
        for (how, followed, reference) in [
            ("load followed", Followed::Load, partial.given()),
            ("wake followed, observed", Followed::Wake, observed),
        ] {
            let choice = LoopChoice { following: following(), followed, reference, decoupling };
            let name = format!("{place}, {how}");
            rows.extend(partial.table(&name, &PARTIAL_FACTORS, choice, claimed));
        }
    }
    // Half a diameter aside the load circles against the disk: does a loop set so, or one of yaw alone, find
    // it?
    let against = TwoAxisSettings { sense: Sense::CounterClockwise, ..following() };
    let yaw_leads = TwoAxisSettings { leader: Leader::Yaw, ..following() };
    rows.extend(Bench::new(0.5, against).rows("½ D aside, the other sense followed"));
    rows.extend(Bench::new(0.5, yaw_leads).rows("½ D aside, yaw followed"));
    rows
}

/// The same in full overlap with a loop that the tilt moment alone leads, as the source's figure 2-15 has it;
/// yaw has the same phase a quarter period later.
fn tilt_leads(decoupling: Decoupling) -> Vec<Row> {
    let following = TwoAxisSettings { leader: Leader::Tilt, ..following() };
    let bench = Bench::new(0.0, following);
    let mut rows = bench.rows("full overlap, tilt leads");
    for (followed, name, reference, factors) in [
        (Followed::Load, "tilt leads, load followed", bench.given(), &FACTORS[3..]),
        (
            Followed::Wake,
            "tilt leads, wake followed, its amplitude observed",
            Reference::Observed,
            &DEEP_FACTORS[..],
        ),
    ] {
        let claimed: &[_] = if followed == Followed::Load { &PUBLISHED } else { &[] };
        let choice = LoopChoice { following, followed, reference, decoupling };
        rows.extend(bench.table(name, factors, choice, Some(claimed)));
    }
    rows
}

/// The turbine in the disk, and what it does without control.
struct Bench {
    rig: Rig,
    disk: RotatingDisk,
    baseline: Record,
    /// Tilt and yaw moments at every step (N m).
    loads: Vec<FixedFrame>,
    /// Mean amplitudes of tilt and yaw moment estimated by the loop (N m).
    amplitudes: [f64; 2],
    /// Largest error of the estimated rate from the disk's (–), and share of the time without lock (–).
    off_rate: f64,
    unlocked: f64,
}

impl Bench {
    /// The turbine `aside` (diameters) to the left of the middle of the disk's path, looking downwind, its
    /// loads followed as `following` says.
    fn new(aside: f64, following: TwoAxisSettings) -> Self {
        let disk = RotatingDisk::of_wake(DIAMETER, HUB_HEIGHT, AMBIENT, true);
        let middle = [-aside * DIAMETER, HUB_HEIGHT];
        let disk = RotatingDisk { edge: EDGE, middle, ..disk };
        let calm = DeterministicWind::steady(MeanProfile::Uniform { speed: AMBIENT }, HUB_HEIGHT);
        let wind = DeterministicWind { event: Event::RotatingDisk(disk), ..calm };
        let rig = Rig::new(wind, ROTOR_SPEED);
        let mut follower = TwoAxisLoop::new(&following, INTERVAL).expect("a sound loop");
        let (mut sums, mut off_rate, mut unlocked, mut n) = ([0.0; 2], 0.0, 0.0, 0.0);
        let (mut loads, mut baseline) = (Vec::new(), Record::new(disk));
        let mut machine = rig.clone();
        for _ in 0..n_steps(END) {
            let mut estimate = follower.estimate();
            let reading =
                machine.advance(|_, measurements| estimate = follower.update(measurements));
            if reading.time >= JUDGED {
                sums[0] += estimate.tilt.amplitude;
                sums[1] += estimate.yaw.amplitude;
                unlocked += f64::from(u8::from(!estimate.locked));
                n += 1.0;
                let true_rate = TAU * disk.frequency(reading.time);
                off_rate = larger(off_rate, (estimate.rate / true_rate - 1.0).abs());
                baseline.take(&reading);
            }
            loads.push(reading.loads);
        }
        let amplitudes = sums.map(|sum| sum / n);
        Self { rig, disk, baseline, loads, amplitudes, off_rate, unlocked: unlocked / n }
    }

    /// The estimated amplitudes as references.
    fn given(&self) -> Reference {
        let [tilt, yaw] = self.amplitudes;
        Reference::Given { tilt, yaw }
    }

    /// What the loop makes of the loads without control at `place`.
    fn rows(&self, place: &str) -> Vec<Row> {
        let [tilt, yaw] = self.amplitudes;
        tell!(
            "\n{place}: baseline amplitudes tilt {:.2}, yaw {:.2} MN m; unlocked {:.0} % of the time",
            1e-6 * tilt,
            1e-6 * yaw,
            100.0 * self.unlocked
        );
        vec![Row {
            what: format!("{place}, baseline: estimated rate off the disk's, at worst"),
            measured: self.off_rate,
            expected: 0.05,
            tolerance: AtMost,
            unit: "–",
            source: SOURCE,
        }]
    }

    /// Runs with `choice` at each of `factors` (–), printed; the factors reached, and what is claimed of
    /// changes beside those `published`, unless that is none.
    fn table(
        &self,
        name: &str,
        factors: &[f64],
        choice: LoopChoice,
        published: Option<&[(f64, [f64; 8])]>,
    ) -> Vec<Row> {
        let mut table = Table::new(name, &self.baseline);
        let mut rows = Vec::new();
        for factor in factors {
            let record = controlled(&self.rig, choice.settings(*factor), self.disk);
            rows.extend(table.add(*factor, record));
        }
        table.print();
        if let Some(published) = published {
            rows.extend(table.claims(published));
        }
        rows
    }
}

/// A run of `rig` under meandering control with `settings`.
fn controlled(rig: &Rig, settings: MeanderingControlSettings, circling: RotatingDisk) -> Record {
    let mut control = Meandering::new(settings, INTERVAL).expect("sound settings");
    let mut record = Record::new(circling);
    let mut machine = rig.clone();
    for _ in 0..n_steps(END) {
        let reading: Reading =
            machine.advance(|pitch, measurements| control.add_to(pitch, measurements));
        if reading.time >= JUDGED {
            record.take(&reading);
        }
    }
    record
}

fn n_steps(duration: f64) -> usize {
    (duration / INTERVAL).round() as usize
}

/// How the loads are followed: St 0.12 to 0.3 of the ambient wind, the disk being clockwise.
fn following() -> TwoAxisSettings {
    let rates = [0.12, 0.3].map(|strouhal| TAU * strouhal * AMBIENT / DIAMETER);
    let signal = Signal::between(rates);
    TwoAxisSettings { signal, sense: Sense::Clockwise, leader: Leader::Both }
}

/// What the runs of a table have in common.
#[derive(Clone, Copy)]
struct LoopChoice {
    following: TwoAxisSettings,
    followed: Followed,
    reference: Reference,
    decoupling: Decoupling,
}

impl LoopChoice {
    fn settings(&self, factor: f64) -> MeanderingControlSettings {
        let Self { following, followed, reference, decoupling } = *self;
        MeanderingControlSettings {
            follower: following,
            followed,
            factor,
            reference,
            decoupling,
            bandwidth: 0.02,
            proportional: 0.0,
            maximum_amplitude: 6.0_f64.to_radians(),
            maximum_offset: 0.0,
            needs_lock: true,
            start: START,
        }
    }
}
