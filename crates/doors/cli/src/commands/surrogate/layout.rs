//! `wakemix surrogate layout`: what surrogates say of turbines behind one another.

use crate::commands::output::{columns, print_json, print_text, tell, warn};
use clap::Args;
use design::layout::{Layout, LayoutAverage, Uncertain, draw_layout, predict_layout};
use miette::Result;
use serde_json::{Value, json};
use std::path::PathBuf;
use wakemix::report::text_table::{Column, TextTable};

/// Arguments of `wakemix surrogate layout`.
#[derive(Args)]
pub(crate) struct LayoutArguments {
    /// Layout (TOML): surrogates, turbines, strategies and the record of the wind that comes to each
    file: PathBuf,
    /// CSV to write every prediction into
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Folder to draw the figures into, as SVG and PNG in its folder `figures`
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Predicts a layout, and prints its means over the directions of the wind.
///
/// # Errors
/// Files that cannot be read, used or written.
pub(super) fn run(arguments: &LayoutArguments) -> Result<()> {
    let found = predict_layout(&arguments.file)?;
    found.warnings.iter().for_each(|text| warn(text));
    if let Some(path) = &arguments.output {
        found.write(path)?;
        tell(&format!("predictions: {}", path.display()));
    }
    if let Some(folder) = &arguments.figures {
        let names = draw_layout(&found, folder)?;
        tell(&format!("drawn in {}: {}", folder.join("figures").display(), names.join(", ")));
    }
    if arguments.json { print_json(&as_json(&found)) } else { print_text(&as_text(&found)) }
}

fn turbine<'a>(found: &'a Layout, average: &LayoutAverage) -> &'a str {
    average.turbine.map_or("all", |turbine| &found.turbines[turbine])
}

fn as_text(found: &Layout) -> String {
    let headings = found.outputs.iter().flat_map(|port| {
        let unit = if port.unit.is_empty() { "–" } else { &port.unit };
        [Column::number(format!("{} ({unit})", port.name)), Column::number("change (%)")]
    });
    let mut table = TextTable::new(
        [Column::words("strategy"), Column::words("turbine")],
        headings.collect::<Vec<_>>(),
    );
    for average in &found.averages {
        let mut row =
            vec![found.strategies[average.strategy].clone(), turbine(found, average).to_owned()];
        for (value, change) in average.values.iter().zip(&average.changes) {
            row.push(value.map_or(String::new(), |value| format!("{:.5e}", value.mean)));
            row.push(change.map_or(String::new(), |change| {
                format!("{:.2} ± {:.2}", 100.0 * change.mean, 100.0 * change.half_width_95())
            }));
        }
        table.row(row);
    }
    table.fitted(columns())
        + "means over the directions of the wind; ±: half of the 95 % interval of the surrogates' curves, without the scatter of the wind\n"
}

fn as_json(found: &Layout) -> Value {
    let uncertain = |value: &Option<Uncertain>| {
        value.map(|value| json!({ "mean": value.mean, "deviation": value.deviation }))
    };
    let averages = found.averages.iter().map(|average| {
        let all = |values: &[Option<Uncertain>]| -> Value {
            let named = found.outputs.iter().zip(values);
            named.map(|(port, value)| (port.name.clone(), json!(uncertain(value)))).collect()
        };
        json!({
            "strategy": found.strategies[average.strategy],
            "turbine": average.turbine.map(|turbine| &found.turbines[turbine]),
            "values": all(&average.values),
            "changes": all(&average.changes),
        })
    });
    json!({
        "outputs": found.outputs,
        "averages": averages.collect::<Vec<_>>(),
        "warnings": found.warnings,
    })
}
