//! The page of a sweep.

use super::{drawing, filled};
use crate::draw::Figure;
use crate::figures::sweep::{key_name, settings};
use crate::units::{Unit, Units};
use crate::{ReportError, words};
use basis::records::{Statistic, SweepPart, SweepRow, SweepTable, SweptKey};
use minijinja::{Value, context};

const TEMPLATE: &str = include_str!("sweep.html");
/// Reports of studies that a row links to at most.
const MOST_LINKS: usize = 8;

/// The page of `table` with `figures`, made by the program of `version`.
pub(crate) fn render(
    table: &SweepTable,
    figures: &[Figure],
    version: &str,
) -> Result<String, ReportError> {
    let drawings = figures.iter().map(drawing).collect::<Result<Vec<_>, _>>()?;
    let parts = table.part_names();
    let powers = table.rows.iter().flat_map(|row| &row.parts).map(|part| part.power.mean);
    let unit = Units::of(powers).power;
    let own = context! {
        title => table.case.clone(),
        description => description(table),
        version => version,
        headline => headline(table),
        convention => convention(table),
        remarks => table.remarks.iter().map(|remark| words::capitalised(remark)).collect::<Vec<_>>(),
        figures => drawings,
        heads => heads(table, &parts, &unit),
        rows => table.rows.iter().map(|row| line(table, row, &parts, &unit)).collect::<Vec<_>>(),
    };
    filled("sweep.html", TEMPLATE, own)
}

fn description(table: &SweepTable) -> String {
    let keys: Vec<String> = table.keys.iter().map(|key| key.key.clone()).collect();
    let over =
        if keys.is_empty() { String::new() } else { format!(" over {}", words::list(&keys)) };
    let winds = match table.seeds.len() {
        0 | 1 => String::new(),
        n => format!(", each in {n} winds"),
    };
    format!("{} runs{over}{winds}", table.rows.len())
}

/// The best run, of all together or of the first turbine, in a sentence.
fn headline(table: &SweepTable) -> String {
    let part = if table.has_wakes { "all" } else { "" };
    let of = |row: &'_ SweepRow| -> Option<(String, Statistic)> {
        let found = row.part(part).or(row.parts.first())?;
        let gain = found.gain.filter(|gain| gain.mean.is_finite())?;
        Some((found.name.clone(), gain))
    };
    let gains = table.rows.iter().filter_map(|row| Some((row, of(row)?)));
    let best = gains.max_by(|a, b| a.1.1.mean.total_cmp(&b.1.1.mean));
    let Some((row, (name, gain))) = best else { return "No run compares with another.".to_owned() };
    let whose = if name == "all" { "all turbines together" } else { name.as_str() };
    let settings: Vec<String> = settings(table, row, |_| true).collect();
    let with = if settings.is_empty() {
        String::new()
    } else {
        format!(" with {}", words::list(&settings))
    };
    let size = words::gain(&gain);
    let chance = match gain.half_width_95 {
        Some(half) if half >= gain.mean.abs() => "; the interval holds zero",
        _ => "",
    };
    let what = if gain.mean > 0.0 { "The most power" } else { "No run gains; the least loss" };
    format!("{what}: {}{with}; {whose}: {size}{chance}.", row.base)
}

fn convention(table: &SweepTable) -> String {
    if table.seeds.len() > 1 {
        let seeds: Vec<String> = table.seeds.iter().map(u64::to_string).collect();
        format!(
            "± is the half width of the 95 % interval by Student's t over the winds of seeds {}, taken as independent.",
            words::list(&seeds)
        )
    } else {
        "± is the half width of the 95 % interval from blocks of the analysed time.".to_owned()
    }
}

fn heads(table: &SweepTable, parts: &[&str], unit: &Unit) -> Vec<String> {
    let mut heads = vec!["Run".to_owned()];
    heads.extend(table.keys.iter().map(key_name));
    heads.extend(parts.iter().map(|name| format!("{name} ({})", unit.name)));
    heads.extend(parts.iter().map(|name| format!("{name} gain (%)")));
    heads
}

fn line(table: &SweepTable, row: &SweepRow, parts: &[&str], unit: &Unit) -> Value {
    let cell = |key: &SweptKey| {
        let degree = if key.label.ends_with("_deg") { "°" } else { "" };
        row.value(&key.key).map_or("–".to_owned(), |value| value.words() + degree)
    };
    let mut cells: Vec<String> = table.keys.iter().map(cell).collect();
    let cell = |of: &dyn Fn(&SweepPart) -> Option<String>| -> Vec<String> {
        let cell = |name: &&str| row.part(name).and_then(of).unwrap_or_else(|| "–".to_owned());
        parts.iter().map(cell).collect()
    };
    cells.extend(cell(&|part| Some(number(&part.power, 1.0 / unit.size, 3))));
    cells.extend(cell(&|part| Some(number(&part.gain?, 100.0, 2))));
    let links: Vec<Value> = row
        .studies
        .iter()
        .take(MOST_LINKS)
        .map(|study| match study.as_str() {
            "" => context! { href => "report.html", name => "study" },
            folder => context! { href => format!("{folder}/report.html"), name => folder },
        })
        .collect();
    context! { name => row.base.clone(), cells => cells, links => links }
}

/// A mean with its half width.
fn number(statistic: &Statistic, scale: f64, decimals: usize) -> String {
    let mean = words::number(scale * statistic.mean, decimals);
    match statistic.half_width_95 {
        Some(half) => format!("{mean} ± {}", words::number(scale * half, decimals)),
        None => mean,
    }
}
