//! The curves of the report through changes over the phase offset that were recorded in a table, drawn and
//! told: `cargo run -p wakemix-postprocessing --example recorded_offsets -- TABLE FOLDER`.
//!
//! `validation/data/synchronised-helix/power-over-offset.csv` is such a table: degrees, then gain and half of
//! its 95 % interval for each turbine, all in percent, from three blocks.

use basis::records::Statistic;
use postprocessing::offset_panel;
use report::{CurveEnd, OffsetFigure, OffsetPoint, Synchronisation};
use std::error::Error;
use std::path::PathBuf;

/// Blocks behind each interval (–).
const N_BLOCKS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let [table, folder] = [arguments.next(), arguments.next()];
    let table = std::fs::read_to_string(table.ok_or("name a table and a folder")?)?;
    let mut rows = Vec::new();
    for line in table.lines().skip(1) {
        let row: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        rows.push(row?);
    }
    let mut panels = Vec::new();
    for (place, title) in ["T2", "T3", "T2 + T3"].into_iter().enumerate() {
        let point = |row: &Vec<f64>| OffsetPoint {
            offset: row[0].to_radians(),
            change: Statistic {
                mean: 0.01 * row[1 + 2 * place],
                standard_deviation: 0.0,
                half_width_95: Some(0.01 * row[2 + 2 * place]),
                n_blocks: N_BLOCKS,
            },
        };
        let panel = offset_panel(title.to_owned(), rows.iter().map(point).collect());
        for (word, end) in [("highest", panel.highest), ("lowest", panel.lowest)] {
            let CurveEnd { offset, offset_95, change } = end.ok_or("no curve")?;
            let [offset, low, high] = [offset, offset_95[0], offset_95[1]].map(f64::to_degrees);
            let change = 100.0 * change;
            println!("{title}: {word} at {offset:.0}° ({low:.0} to {high:.0}°): {change:+.1} %");
        }
        panels.push(panel);
    }
    let figure = OffsetFigure {
        name: "power-over-offset".into(),
        title: "Power over the phase offset".into(),
        label: "power against the run bl-helix (%)".into(),
        panels,
    };
    let records = Synchronisation { offsets: vec![figure], ..Synchronisation::default() };
    report::write_synchronisation(&records, &PathBuf::from(folder.ok_or("name a folder")?))?;
    Ok(())
}
