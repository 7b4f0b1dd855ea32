//! What is read in groups is what is read at once.

use super::*;
use crate::gains;
use basis::Unit;
use basis::channels::{OPERATION, ROOT_MYC, SYNC_SHARE, of_meandering};
use basis::records::SettingValue;
use formats::records::{RunFolder, SeriesWriter};
use std::f64::consts::TAU;
use std::path::Path;

/// A turbine that pitches, one that looks for its helix and one that follows meandering; a baseline beside
/// it.
const CASE: &str = r#"
name = "groups"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 10.0
duration = 1300.0
[output]
interval = 0.4
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[turbine]]
name = "T3"
model = "nrel-5mw"
position_diameters = [10.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "all"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 90.0, amplitude_deg = 2.0, azimuth_offset_deg = 0.0 }
control.T3 = { kind = "meandering", factor = 1.0, amplitude_deg = 0.0 }
"#;

/// Rows of a whole run (–).
const N_ROWS: u32 = 3250;
/// Budgets (bytes): a result at a time, a few of them, all at once.
const BUDGETS: [usize; 3] = [0, 9 * 8 * N_ROWS as usize, usize::MAX];

/// Leaves the first `n_rows` rows of the series of run number `run`, without the channel called `without`.
fn leave(study: &Path, setup: &Prepared, run: usize, n_rows: u32, without: &str) -> RunFolder {
    let folder = RunFolder::new(study, &setup.case.runs[run].name);
    folder.create().expect("a folder");
    let mut channels = vec![TIME, WIND_U];
    for turbine in ["T1", "T2", "T3"] {
        let of_blades =
            (1..=3).flat_map(|blade| [BLD_PITCH, ROOT_MYC].map(|own| own.of_blade(blade)));
        let loads = ["RootMxb1", "RootMyb1", "TwrBsMyt", "Spn1MLxb1"];
        let loads = loads.map(|name| Channel::new(name, Unit::KilonewtonMetre));
        let own = OPERATION.into_iter().chain(of_blades).chain(loads);
        let own = own.chain(of_meandering()).chain([SYNC_SHARE]);
        channels.extend(own.map(|channel| channel.of(turbine)));
    }
    channels.retain(|channel| channel.name != without);
    let interval = setup.plan.row_interval();
    let mut writer = SeriesWriter::create(&folder.series_path(), &channels).expect("a file");
    for row in 1..=n_rows {
        let time = interval * f64::from(row);
        // Each channel swings about a mean of its own, in the second run a little more.
        let value = |(place, channel): (usize, &Channel)| match &*channel.name {
            "Time" => time,
            name if name.ends_with("Azimuth") => (1.2 * time).rem_euclid(TAU),
            name if name.ends_with("Lock") => 1.0,
            _ => {
                let own = 0.01 * place as f64;
                1.0 + own + (0.1 + 0.02 * run as f64) * ((0.3 + own) * time).sin()
            }
        };
        let values: Vec<f64> = channels.iter().enumerate().map(value).collect();
        writer.write(&values).expect("a row");
    }
    writer.finish().expect("a file");
    folder
}

fn setup(folder: &Path) -> Prepared {
    let path = folder.join("case.toml");
    std::fs::write(&path, CASE).expect("a file");
    Prepared::read(&path, &[]).expect("a sound case")
}

/// What turbines leave whose pitch limits held these shares of the commands back (–).
fn left(clipped_shares: [f64; 3]) -> [Left; 3] {
    clipped_shares.map(|clipped_share| Left { clipped_share, remarks: Vec::new() })
}

#[test]
fn groups_of_columns_make_the_same_summary_as_all_at_once() {
    let study = tempfile::tempdir().expect("a folder");
    let setup = setup(study.path());
    assert_eq!(setup.plan.n_steps, setup.plan.row_stride * u64::from(N_ROWS));
    let folders = [0, 1].map(|run| leave(study.path(), &setup, run, N_ROWS, ""));
    let summaries = BUDGETS.map(|budget| {
        let [mut there, mut own] = [0, 1].map(|run: usize| {
            Columns::within(budget, &folders[run], &setup).expect("a series of its own")
        });
        let [baseline, run] = [&setup.case.runs[0], &setup.case.runs[1]];
        let summary = summarise(&setup, run, &mut own, &left([0.0, 0.5, 0.0]), Cost::default());
        let mut summary = summary.expect("all channels");
        gains::add(&mut summary, (run, &mut own), (baseline, &mut there)).expect("gains");
        summary
    });
    let [one_by_one, few, whole] = &summaries;
    assert_eq!(one_by_one, whole);
    assert_eq!(few, whole);
    // Nothing was the same for want of anything to compare.
    let [first, second, third] = whole.turbines.as_slice() else { panic!("three turbines") };
    assert!(first.delivered_pitch.is_some() && second.delivered_pitch.is_some());
    assert!(third.meandering.is_some_and(|found| found.tilt.is_some()));
    let kinds = whole.turbines.iter().map(|turbine| turbine.control.kind.as_str());
    assert_eq!(kinds.collect::<Vec<_>>(), ["helix", "phase-sync", "meandering"]);
    let [helix, sync] = [first, second].map(|turbine| turbine.control.excitation);
    let helix = helix.expect("a helix");
    assert_eq!((helix.sense, helix.strouhal), (Some(basis::Sense::CounterClockwise), 0.25));
    assert!((helix.amplitude_deg - 4.0).abs() < 1e-12 && helix.phase_offset_deg.is_none());
    let offset = sync.and_then(|sync| sync.phase_offset_deg).expect("a helix to join");
    assert!((offset - 90.0).abs() < 1e-12);
    assert_eq!(third.control.excitation, None);
    let held: Vec<_> = whole
        .warnings
        .iter()
        .filter(|warning| warning.kind == WarningKind::PitchHeldBack)
        .map(|warning| warning.turbine.as_deref())
        .collect();
    assert!(held.contains(&Some("T2")), "{held:?}");
    for turbine in [first, second, third] {
        assert_eq!(turbine.loads.len(), 8);
        assert!(turbine.loads.iter().all(|load| load.change.is_some()));
        let equivalent = turbine.loads.iter().filter(|load| load.kind.is_damage_equivalent());
        assert_eq!(equivalent.count(), 4);
        assert!(turbine.pitch_duty.is_some() && turbine.power_gain.is_some());
    }
    assert!(whole.array_power_gain.is_some());
    assert!(!whole.has_wakes());
    assert_eq!(whole.flow.as_ref().map(|flow| flow.solver.as_str()), Some("uniform"));
    let rotor = third.rotor.expect("a place");
    assert_eq!(rotor.diameter, setup.plan.diameter);
    assert_eq!(rotor.hub, [10.0 * setup.plan.diameter, 0.0, setup.plan.hub_height]);
    let settings = first.control.settings.as_deref().expect("settings");
    let amplitude = settings.iter().find(|setting| setting.key == "amplitude_deg");
    assert_eq!(amplitude.map(|set| &set.value), Some(&SettingValue::Number(4.0)));
}

/// A turbine that stands still in the run compared with costs its own gain, not the summary.
#[test]
fn a_gain_over_no_power_is_not_defined_and_the_rest_goes_on() {
    let study = tempfile::tempdir().expect("a folder");
    let setup = setup(study.path());
    let [baseline, run] = [&setup.case.runs[0], &setup.case.runs[1]];
    for (still, undefined) in [
        (&["T2"][..], vec![Some("T2")]),
        (&["T1", "T2", "T3"], vec![Some("T1"), Some("T2"), Some("T3")]),
    ] {
        let folder = leave(study.path(), &setup, 1, N_ROWS, "");
        let mut own = Columns::open(&folder, &setup).expect("a series");
        let folder = leave(study.path(), &setup, 0, N_ROWS, "");
        let mut series =
            formats::records::read_series(&folder.series_path(), |_| true).expect("it");
        for turbine in still {
            let power = GEN_PWR.at(turbine);
            let place = series.names.iter().position(|name| *name == power).expect("its power");
            series.columns[place].fill(0.0);
        }
        let mut there = Columns::of_series(series, &setup);
        let summary = summarise(&setup, run, &mut own, &left([0.0; 3]), Cost::default());
        let mut summary = summary.expect("all channels");
        let n_before = summary.warnings.len();
        gains::add(&mut summary, (run, &mut own), (baseline, &mut there)).expect("gains");
        assert_eq!(summary.compare_with.as_deref(), Some("baseline"));
        let told = &summary.warnings[n_before..];
        assert!(told.iter().all(|warning| warning.kind == WarningKind::GainUndefined), "{told:?}");
        let about: Vec<_> = told.iter().map(|warning| warning.turbine.as_deref()).collect();
        assert_eq!(about, undefined);
        for turbine in &summary.turbines {
            let is_defined = !still.contains(&turbine.name.as_str());
            assert_eq!(turbine.power_gain.is_some(), is_defined, "{}", turbine.name);
            assert!(turbine.loads.iter().all(|load| load.change.is_some()), "{}", turbine.name);
        }
        assert_eq!(summary.array_power_gain.is_some(), still.len() < 3);
    }
}

#[test]
fn a_channel_that_is_missing_is_named_however_the_rest_is_read() {
    let study = tempfile::tempdir().expect("a folder");
    let setup = setup(study.path());
    for missing in ["T2.GenPwr", "T1.BldPitch3", "T2.SyncShare", "T3.MeandLock", "Wind.U"] {
        let folder = leave(study.path(), &setup, 1, 600, missing);
        for budget in BUDGETS {
            let mut columns = Columns::within(budget, &folder, &setup).expect("a series");
            let run = &setup.case.runs[1];
            let error = summarise(&setup, run, &mut columns, &left([0.0; 3]), Cost::default());
            match error {
                Err(StudyError::MissingChannel { channel }) => assert_eq!(channel, missing),
                other => panic!("{missing} within {budget}: {other:?}"),
            }
        }
    }
}
