//! The tables of the page: loads, what pitching cost, how pitch acts, what controllers found.

use crate::{assert_well_formed, page, synthetic};
use basis::records::{
    BearingLoad, ControlSummary, Finding, LoadKind, MeanderingAxis, MeanderingSummary, PitchDuty,
    PitchResponse, Statistic, examples,
};
use report::StudyRecords;

#[test]
fn what_pitching_cost_stands_in_the_tables_with_its_convention() {
    let mut study = synthetic::two_runs();
    assert!(!page(&study).contains("Pitch bearing"));
    for (run, scale) in [(0, 1.0), (1, 3.5)] {
        for turbine in &mut study.runs[run].summary.turbines {
            let loads = (0..36).map(|k| BearingLoad {
                position_deg: 10.0 * f64::from(k),
                load_kn_m: scale * 1e3 * (1.0 + f64::from(k).sin()),
            });
            turbine.pitch_duty = Some(PitchDuty {
                travel_deg: scale * 1200.0,
                travel_in_ten_minutes_deg: scale * 342.0,
                maximum_rate_deg_s: 2.0,
                moving_share: 1.0,
                n_reversals: 12,
                bearing_slope: 3.0,
                bearing_loads: loads.collect(),
                sample_interval: 0.25,
            });
        }
    }
    let page = page(&study);
    for expected in [
        "<td>Pitch bearing 1, where it is greatest, m = 3 (kN m)</td><td class=\"n\">2000</td><td class=\"pm\"></td><td class=\"n\">7000</td><td class=\"pm\">+250.0 %</td>",
        "<td>Pitch travel 1 (° in 10 min)</td><td class=\"n\">342</td><td class=\"pm\"></td><td class=\"n\">1197</td><td class=\"pm\">+250.0 %</td>",
        "Pitch-bearing load (van der Hoek et al., Eq. 9)",
        "m = 3, at 36 positions φ",
        "samples every 0.25 s.",
        "<td>T2</td><td class=\"n\">0</td><td class=\"n\">1000</td><td class=\"n\">3500</td>",
        "<td>T1</td><td class=\"n\">350</td>",
    ] {
        assert!(page.contains(expected), "`{expected}` is missing");
    }
    assert_eq!(page.matches("<td>T1</td><td class=\"n\">").count(), 36);
    assert_well_formed(&page);
}

#[test]
fn changes_of_loads_come_with_their_intervals() {
    let mut study = synthetic::two_runs();
    let label = "RootMyb1, m = 10 (kN m)";
    let kind = examples::damage_equivalent(10.0);
    for (run, value) in [(0, 12_500.0), (1, 10_000.0)] {
        let loads = &mut study.runs[run].summary.turbines[0].loads;
        loads.push(examples::load("RootMyb1", kind, value));
        loads.push(examples::load("RootMyb1", LoadKind::Deviation, 0.1 * value));
    }
    let cells = |change: &str| {
        format!(
            "<td>{label}</td><td class=\"n\">12500</td><td class=\"pm\"></td><td class=\"n\">10000</td><td class=\"pm\">{change}</td>"
        )
    };
    // A load without a change of its own stands beside that of the other run.
    let whole = page(&study);
    assert!(whole.contains(&cells("−20.0 %")));
    assert!(
        whole.contains("<td>RootMyb1, standard deviation (kN m)</td><td class=\"n\">1250</td>")
    );
    let mut change =
        Statistic { mean: -0.2, standard_deviation: 0.1, half_width_95: Some(0.034), n_blocks: 3 };
    let set = |study: &mut StudyRecords, change| {
        let loads = &mut study.runs[1].summary.turbines[0].loads;
        loads[0].change = Some(change);
    };
    set(&mut study, change);
    assert!(page(&study).contains(&cells("−20.0 % ± 3.4 %")));
    change.half_width_95 = None;
    set(&mut study, change);
    assert!(page(&study).contains(&cells("−20.0 % (no interval)")));
}

#[test]
fn what_a_controller_of_any_kind_found_stands_in_a_table() {
    let mut study = synthetic::two_runs();
    assert!(!page(&study).contains("What controllers found"));
    let finding = |name: &str, value| Finding {
        name: name.into(),
        value,
        unit: "s".into(),
        about: format!("{name} of the gust"),
    };
    study.runs[1].summary.turbines[1].control = ControlSummary {
        findings: vec![finding("lead", Some(12.34)), finding("length", None)],
        ..ControlSummary::plain("preview", "preview of the gust")
    };
    let page = page(&study);
    for expected in [
        "<td>preview of the gust</td><td>lead of the gust</td><td class=\"n\">12.3</td><td>s</td>",
        "<td>length of the gust</td><td class=\"n\">–</td><td>s</td>",
    ] {
        assert!(page.contains(expected), "`{expected}` is missing");
    }
    assert_well_formed(&page);
}

#[test]
fn the_offset_of_the_pitch_and_that_of_the_estimator_have_their_rows() {
    let mut study = synthetic::two_runs();
    let turned = "<td>blades, by the inverse multi-blade transformation</td><td class=\"n\"></td>";
    let estimator = "<td>model of the phase estimator</td><td class=\"n\">× 1.040</td>";
    assert!(!page(&study).contains(turned));
    study.runs[1].summary.turbines[1].pitch_response = Some(PitchResponse::Estimator {
        gain: 1.04,
        azimuth_offset: 0.5f64.to_radians(),
        before: 0.12,
        after: 0.0,
        transformation_offset: Some(35.2f64.to_radians()),
    });
    let both = page(&study);
    for (on, offset) in [(turned, "35.2"), (estimator, "0.5")] {
        let row = format!("{on}<td class=\"n\">{offset}</td><td class=\"n\"></td>");
        assert_eq!(both.matches(&row).count(), 1, "{on}");
    }
    assert_well_formed(&both);
    study.runs[1].summary.turbines[1].pitch_response =
        Some(PitchResponse::Transformation { azimuth_offset: 35.2f64.to_radians() });
    let alone = page(&study);
    assert!(alone.contains(turned) && !alone.contains(estimator));
    let damped = "<td>blades, under individual pitch control</td><td class=\"n\"></td><td class=\"n\">12.3</td>";
    assert!(!alone.contains(damped));
    study.runs[1].summary.turbines[1].individual_pitch_offset = Some(12.3f64.to_radians());
    let both = page(&study);
    assert!(both.contains(turned) && both.contains(damped));
    assert_well_formed(&both);
}

#[test]
fn what_a_turbine_made_of_meandering_stands_in_a_table_with_units() {
    let mut study = synthetic::two_runs();
    assert!(!page(&study).contains("factor reached"));
    let tilt = MeanderingAxis { amplitude: 7.5e6, reference: Some(5e6), factor: Some(1.5) };
    let turbine = &mut study.runs[1].summary.turbines[1];
    turbine.control = ControlSummary::plain("meandering", "meandering × 1.5 cw");
    turbine.meandering = Some(MeanderingSummary {
        locked_share: 0.9,
        frequency_hz: Some(0.0075),
        tilt: Some(tilt),
        yaw: Some(MeanderingAxis { amplitude: 12e6, reference: None, factor: None }),
    });
    study.runs[0].summary.turbines[1].meandering =
        Some(MeanderingSummary { locked_share: 0.0, frequency_hz: None, tilt: None, yaw: None });
    let page = page(&study);
    // 0.0075 Hz · 240 m / 9 m/s.
    let found = "<td class=\"n\">90.0 %</td><td class=\"n\">0.0075</td><td class=\"n\">0.200</td>";
    let none = "<td class=\"n\">–</td>";
    for expected in [
        "<th class=\"n\">amplitude (MN m)</th>".to_owned(),
        format!(
            "{found}<td>tilt</td><td class=\"n\">7.50</td><td class=\"n\">5.00</td><td class=\"n\">1.50</td>"
        ),
        format!("{found}<td>yaw</td><td class=\"n\">12.0</td>{none}{none}"),
        format!("<td class=\"n\">0.0 %</td>{none}{none}<td>tilt</td>{none}{none}{none}"),
    ] {
        assert!(page.contains(&expected), "`{expected}` is missing");
    }
    assert_well_formed(&page);
}
