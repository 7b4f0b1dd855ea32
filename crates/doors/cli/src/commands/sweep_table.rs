//! The table of a sweep on the terminal.

use wakemix::basis::records::{SweepRow, SweepTable};
use wakemix::postprocessing::analyses::with_interval;
use wakemix::report::text_table::{Column, TextTable, wrapped};

/// Damage-equivalent loads whose changes are printed: heading, channel, what it is.
const LOADS: [(&str, &str, &str); 2] = [
    ("flap", "RootMyb1", "flapwise at the root of blade 1"),
    ("tower", "TwrBsMyt", "fore-aft at the tower base"),
];

/// A line for each run in `width` columns: the swept values and power; in further tables, where there is no
/// room, gains of each turbine and of all, and loads; below it what the intervals are and what else there is
/// to know.
pub(crate) fn render(table: &SweepTable, width: usize) -> String {
    let parts = table.part_names();
    let (keys, columns) = heads(table, &parts);
    let mut lines = TextTable::new(keys, columns);
    for row in &table.rows {
        lines.row(cells(table, row, &parts));
    }
    let mut text = format!("{}: {}\n", table.case, what(table));
    text += &lines.fitted(width);
    text += &wrapped(&convention(table), width);
    if loads(table, &parts).next().is_some() {
        let told = LOADS.map(|(heading, channel, what)| format!("{heading}: {what} ({channel})"));
        let told = format!("changes of 1-Hz damage-equivalent loads; {}\n", told.join("; "));
        text += &wrapped(&told, width);
    }
    for remark in &table.remarks {
        text += &wrapped(&format!("{remark}\n"), width);
    }
    text
}

/// How much was made, in words.
fn what(table: &SweepTable) -> String {
    let keys: Vec<&str> = table.keys.iter().map(|key| key.key.as_str()).collect();
    let over = if keys.is_empty() { String::new() } else { format!(" over {}", keys.join(", ")) };
    match table.seeds.len() {
        0 | 1 => format!("{} runs{over}", table.rows.len()),
        n => format!("{} runs{over}, each in {n} winds", table.rows.len()),
    }
}

/// Turbines with those of their loads of which any row tells a change.
fn loads<'t>(
    table: &'t SweepTable,
    parts: &'t [&'t str],
) -> impl Iterator<Item = (&'t str, (&'static str, &'static str, &'static str))> + 't {
    let all = parts.iter().flat_map(|name| LOADS.into_iter().map(move |load| (*name, load)));
    all.filter(|(name, (_, channel, _))| {
        let mut loads = table.rows.iter().filter_map(|row| row.load(name, channel));
        loads.any(|load| load.change.is_some())
    })
}

/// Columns of run and swept values, and those of what came of them.
fn heads(table: &SweepTable, parts: &[&str]) -> (Vec<Column>, Vec<Column>) {
    let mut keys = vec![Column::words("run")];
    keys.extend(table.keys.iter().map(|key| Column::number(key.label.clone())));
    if !table.seeds.is_empty() {
        keys.push(Column::number("winds"));
    }
    let powers = parts.iter().map(|name| Column::number(format!("{name} kW")));
    let gains = parts.iter().map(|name| Column::number(format!("{name} gain %")));
    let loads = loads(table, parts);
    let loads = loads.map(|(name, (heading, ..))| Column::number(format!("{name} {heading} %")));
    (keys, powers.chain(gains).chain(loads).collect())
}

fn cells(table: &SweepTable, row: &SweepRow, parts: &[&str]) -> Vec<String> {
    let mut cells = vec![row.base.clone()];
    let value = |key: &str| row.value(key).map_or("–".to_owned(), |value| value.words());
    cells.extend(table.keys.iter().map(|key| value(&key.key)));
    if !table.seeds.is_empty() {
        cells.push(row.seeds.len().to_string());
    }
    let of = |name: &&str| row.part(name);
    let power = |name| of(name).map_or(String::new(), |part| with_interval(&part.power, 1e-3, 0));
    let gain = |name| {
        let gain = of(name).and_then(|part| part.gain.as_ref());
        gain.map_or(String::new(), |gain| with_interval(gain, 100.0, 2))
    };
    cells.extend(parts.iter().map(power));
    cells.extend(parts.iter().map(gain));
    cells.extend(loads(table, parts).map(|(name, (_, channel, _))| {
        let change = row.load(name, channel).and_then(|load| load.change.as_ref());
        change.map_or(String::new(), |change| with_interval(change, 100.0, 1))
    }));
    cells
}

fn convention(table: &SweepTable) -> String {
    if table.seeds.len() > 1 {
        let seeds: Vec<String> = table.seeds.iter().map(u64::to_string).collect();
        format!(
            "± 95 % by Student's t over the winds of seed {}, taken as independent; each gain is over the compared run in the same wind\n",
            seeds.join(", ")
        )
    } else {
        "± 95 % from blocks of the analysed time; gains compare the same blocks of the same wind\n"
            .to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::basis::records::examples::statistic;
    use wakemix::basis::records::{
        SWEEP_SCHEMA_VERSION, Setting, Statistic, SweepPart, SweptKey, SweptValue,
    };

    fn row(run: &str, amplitude: Option<f64>, gain: Option<f64>) -> SweepRow {
        let key = "control.T1.amplitude_deg".to_owned();
        let gain = gain.map(|gain| Statistic { half_width_95: Some(0.004), ..statistic(gain) });
        let power = Statistic { half_width_95: None, ..statistic(5e6) };
        let settings =
            amplitude.map(|amplitude| Setting { key, value: SweptValue::Number(amplitude) });
        SweepRow {
            run: run.into(),
            base: run.into(),
            compare_with: None,
            settings: settings.into_iter().collect(),
            studies: vec!["seed-1".into(), "seed-2".into()],
            seeds: vec![1, 2],
            parts: vec![SweepPart {
                name: "T1".into(),
                power,
                gain,
                gains: Vec::new(),
                loads: Vec::new(),
            }],
        }
    }

    #[test]
    fn every_run_has_its_values_and_its_gain_in_columns() {
        let table = SweepTable {
            schema_version: SWEEP_SCHEMA_VERSION,
            case: "case".into(),
            keys: vec![SweptKey {
                key: "control.T1.amplitude_deg".into(),
                label: "amplitude_deg".into(),
                of_studies: false,
            }],
            seeds: vec![1, 2],
            has_wakes: false,
            rows: vec![
                row("baseline", None, None),
                row("helix", Some(2.0), Some(-0.01)),
                row("helix", Some(4.5), Some(-0.03)),
            ],
            remarks: vec!["few winds".into()],
        };
        let text = render(&table, 100);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "case: 3 runs over control.T1.amplitude_deg, each in 2 winds");
        assert_eq!(lines[1], "run       amplitude_deg  winds  T1 kW     T1 gain %");
        assert_eq!(lines[2], "baseline              –      2   5000");
        assert_eq!(lines[4], "helix               4.5      2   5000  -3.00 ± 0.40");
        assert!(lines[5].contains("Student's t over the winds of seed 1, 2"), "{text}");
        assert!(text.ends_with("\nfew winds\n"), "{text}");
    }
}
