//! What stands where in the tables of a study, and how wide they are.

use super::*;
use wakemix::basis::Sense;
use wakemix::basis::records::examples::{self, damage_equivalent, load, statistic};
use wakemix::basis::records::{DeliveredPitch, FlowSummary};

fn turbine(name: &str, loads: &[Load]) -> TurbineSummary {
    TurbineSummary { loads: loads.to_vec(), ..examples::turbine(name, 1e7) }
}

fn summary(turbines: Vec<TurbineSummary>) -> Summary {
    examples::summary("baseline", turbines)
}

fn cells(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

#[test]
fn loads_stand_in_a_table_of_their_own() {
    let loads = [
        load("RootMyb1", damage_equivalent(10.0), 12_340.0),
        load("RootMyb1", LoadKind::Deviation, 99_999.0),
        load("RootMyc1", damage_equivalent(10.0), 99_999.0),
        load("TwrBsMyt", damage_equivalent(4.0), 67_890.0),
    ];
    let text = render(&[summary(vec![turbine("T1", &loads), turbine("T2", &loads[..1])])], 200);
    let lines: Vec<&str> = text.lines().collect();
    // Nobody gained, pitched or was compared: those columns are left out.
    assert_eq!(cells(lines[1]), ["run", "control", "power", "kW", "thrust", "kN", "rpm"], "{text}");
    assert_eq!(cells(lines[4]), ["baseline", "all", "20000"], "{text}");
    assert_eq!(cells(lines[6]), ["run", "flapwise", "MN", "m", "tower", "MN", "m"], "{text}");
    assert_eq!(cells(lines[7]), ["baseline", "T1", "12.34", "67.89"], "{text}");
    assert_eq!(cells(lines[8]), ["baseline", "T2", "12.34"], "{text}");
    // Cells stand under their headings.
    let end = lines[6].find("flapwise MN m").map(|start| start + "flapwise MN m".len());
    assert_eq!(lines[8].find("12.34").map(|start| start + 5), end, "{text}");
    let last = lines[lines.len() - 1];
    assert!(last.starts_with("1-Hz damage-equivalent loads, rainflow"), "{text}");
    assert!(last.contains("flapwise at the root of blade 1 (RootMyb1, m = 10); "), "{text}");
    assert!(last.ends_with("fore-aft at the tower base (TwrBsMyt, m = 4)"), "{text}");
}

#[test]
fn changes_stand_behind_their_loads_with_their_intervals() {
    let loads = [
        load("RootMyb1", damage_equivalent(10.0), 12_340.0),
        load("TwrBsMyt", damage_equivalent(4.0), 67_890.0),
    ];
    let mut compared = turbine("T1", &loads);
    let change = Statistic { half_width_95: Some(0.0312), ..statistic(-0.0678) };
    compared.loads[0].change = Some(change);
    let text = render(
        &[
            summary(vec![turbine("T1", &loads)]),
            summary(vec![compared, turbine("T2", &loads[..1])]),
        ],
        100,
    );
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("  T1  ")).collect();
    assert!(text.contains("flapwise MN m    change %  tower MN m\n"), "{text}");
    assert!(lines[2].ends_with("         12.34                   67.89"), "{text}");
    assert!(lines[3].ends_with("         12.34  -6.8 ± 3.1       67.89"), "{text}");
}

#[test]
fn a_column_that_no_turbine_fills_is_left_out() {
    let tower = load("TwrBsMyt", damage_equivalent(4.0), 1e3);
    let text = render(&[summary(vec![turbine("T1", &[tower])])], 100);
    assert!(!text.contains("flapwise") && text.contains("tower MN m"), "{text}");
    let text = render(&[summary(vec![turbine("T1", &[])])], 200);
    assert!(text.lines().nth(1).unwrap().ends_with("rpm"), "{text}");
    assert!(text.lines().last().unwrap().starts_with("± 95 %"), "{text}");
}

#[test]
fn turbines_without_wakes_are_not_added_up() {
    let mut alone = summary(vec![turbine("T1", &[]), turbine("T2", &[])]);
    assert!(render(std::slice::from_ref(&alone), 100).contains(" all "));
    alone.flow = Some(FlowSummary {
        solver: "turbulence".to_owned(),
        has_wakes: false,
        limits: String::new(),
        grids: Vec::new(),
    });
    let text = render(std::slice::from_ref(&alone), 100);
    assert!(!text.contains("all ") && !text.contains("20000"), "{text}");
    alone.turbines.pop();
    assert_eq!(render(&[alone], 100).matches("10000").count(), 1);
}

/// A staggered row of eight turbines with long names, in five runs with long names, everything in it large
/// and uncertain.
fn large_study() -> Vec<Summary> {
    let wide = |mean: f64| Statistic { half_width_95: Some(1.9634), ..statistic(mean) };
    let loads = ["RootMyb1", "TwrBsMyt"].map(|channel| Load {
        change: Some(wide(1.805)),
        ..load(channel, damage_equivalent(10.0), 187_820.0)
    });
    let machine = |place: usize| TurbineSummary {
        control: examples::helix(Sense::CounterClockwise, 4.0),
        power: Statistic { half_width_95: Some(4.535e6), ..statistic(2.2145e7) },
        power_gain: Some(wide(0.9138)),
        delivered_pitch: Some(DeliveredPitch {
            commanded_amplitude_deg: 4.0,
            delivered_amplitude_deg: 3.99,
            frequency_hz: 0.1184,
            excitation_frequency_hz: 0.0094,
            clipped_share: 0.0,
        }),
        ..turbine(&format!("row-{}-turbine-{place}", place % 2), &loads)
    };
    let run = |name: &str| Summary {
        array_power: Statistic { half_width_95: Some(6.91e6), ..statistic(1.77e8) },
        array_power_gain: Some(wide(0.1307)),
        ..examples::summary(name, (1..=8).map(machine).collect())
    };
    ["baseline", "helix-ccw-4-degrees", "synchronised-helix-offset-150-start-600"].map(run).into()
}

#[test]
fn the_widest_line_of_a_large_study_fits() {
    for (summaries, width) in [
        (large_study(), 100),
        (large_study(), 80),
        (large_study(), 60),
        (vec![summary(vec![turbine("T1", &[])])], 100),
    ] {
        let text = render(&summaries, width);
        let widest = text.lines().max_by_key(|line| line.chars().count()).unwrap();
        assert!(widest.chars().count() <= width, "{width}: {widest}");
    }
    // Everything is still there: eight turbines in three runs, once in each table.
    let text = render(&large_study(), 80);
    assert_eq!(text.matches("22145 ± 4535").count(), 24, "{text}");
    assert_eq!(text.matches("180.5 ± 196.3").count(), 48, "{text}");
    assert_eq!(text.matches("3.99° 0.1184 Hz").count(), 24, "{text}");
}

#[test]
fn models_are_shown_in_watts_and_newtons() {
    let small = |power: f64| TurbineSummary {
        power: statistic(power),
        thrust: statistic(2.9),
        ..examples::turbine("T1", 1e7)
    };
    let text = render(&[summary(vec![small(5.4321)])], 200);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(cells(lines[1])[2..6], ["power", "W", "thrust", "N"], "{text}");
    assert!(lines[2].contains("5.432") && lines[2].contains("2.900"), "{text}");
    let text = render(&[summary(vec![small(5.4321), turbine("T2", &[])])], 200);
    assert!(text.contains("power kW"), "{text}");
}
