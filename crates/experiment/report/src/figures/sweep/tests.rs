//! The figures that a table of a sweep allows.

use super::*;
use crate::draw::Shape;
use basis::records::examples::statistic;
use basis::records::{SWEEP_SCHEMA_VERSION, Setting, Statistic, SweepPart, SweptValue, WindGain};

fn key(key: &str, label: &str) -> SweptKey {
    SweptKey { key: key.into(), label: label.into(), of_studies: false }
}

/// A table over amplitude and Strouhal number, in `n_winds` winds, with a baseline.
fn table(n_winds: usize) -> SweepTable {
    let keys = vec![
        key("control.T1.strouhal", "strouhal"),
        key("control.T1.amplitude_deg", "amplitude_deg"),
    ];
    let row = |settings: Vec<Setting>, gain: Option<f64>| SweepRow {
        run: "helix".into(),
        base: if gain.is_some() { "helix".into() } else { "baseline".into() },
        compare_with: None,
        settings,
        studies: Vec::new(),
        seeds: (1..=n_winds as u64).collect(),
        parts: vec![SweepPart {
            name: "all".into(),
            power: statistic(1e7),
            gain: gain.map(|gain| Statistic { half_width_95: Some(0.01), ..statistic(gain) }),
            gains: gain.filter(|_| n_winds > 1).map_or(Vec::new(), |gain| {
                let in_wind = |seed| WindGain { study: format!("seed-{seed}"), seed, gain };
                (1..=n_winds as u64).map(in_wind).collect()
            }),
            loads: Vec::new(),
        }],
    };
    let mut rows = vec![row(Vec::new(), None)];
    for strouhal in [0.2, 0.25] {
        for amplitude in [2.0, 3.0, 4.0] {
            let settings = [(&keys[0], strouhal), (&keys[1], amplitude)].map(|(key, value)| {
                Setting { key: key.key.clone(), value: SweptValue::Number(value) }
            });
            rows.push(row(settings.to_vec(), Some(0.01 * amplitude * strouhal - 0.004)));
        }
    }
    SweepTable {
        schema_version: SWEEP_SCHEMA_VERSION,
        case: "case".into(),
        keys,
        seeds: (1..=n_winds as u64).filter(|_| n_winds > 1).collect(),
        has_wakes: true,
        rows,
        remarks: Vec::new(),
    }
}

fn names(table: &SweepTable) -> Vec<String> {
    all(table).into_iter().map(|figure| figure.name).collect()
}

/// All texts of `shapes`.
fn texts(shapes: &[Shape]) -> Vec<String> {
    let text = |shape: &Shape| match shape {
        Shape::Text { content, .. } => vec![content.clone()],
        Shape::Group { shapes, .. } => texts(shapes),
        _ => Vec::new(),
    };
    shapes.iter().flat_map(text).collect()
}

#[test]
fn each_table_has_the_figures_that_fit_it() {
    assert_eq!(names(&table(1)), ["sweep-lines", "sweep-map"]);
    assert_eq!(names(&table(3)), ["sweep-lines", "sweep-map", "sweep-winds"]);
    let mut of_seeds = table(3);
    of_seeds.keys.clear();
    of_seeds.rows.iter_mut().for_each(|row| row.settings.clear());
    assert_eq!(names(&of_seeds), ["sweep-winds"]);
    let mut alone = table(1);
    alone.rows.truncate(1);
    assert!(names(&alone).is_empty());
}

#[test]
fn lines_go_over_the_amplitude_and_maps_have_a_number_in_every_cell() {
    let figures = all(&table(1));
    let of_lines = texts(&figures[0].shapes);
    assert!(of_lines.iter().any(|text| text == "Strouhal number 0.25"), "{of_lines:?}");
    assert!(of_lines.iter().any(|text| text == "amplitude (°)"), "{of_lines:?}");
    let of_map = texts(&figures[1].shapes);
    for gain in ["0.0", "+0.2", "+0.4", "+0.1", "+0.3", "+0.6"] {
        assert!(
            of_map.iter().any(|text| text.trim_start_matches('+') == gain.trim_start_matches('+')),
            "{gain}: {of_map:?}"
        );
    }
    let inside = |figure: &crate::draw::Figure| {
        figure.shapes.iter().all(|shape| match shape {
            Shape::Text { position: [x, y], .. } => {
                (0.0..=figure.width).contains(x) && (0.0..=figure.height).contains(y)
            }
            _ => true,
        })
    };
    assert!(figures.iter().all(inside));
}
