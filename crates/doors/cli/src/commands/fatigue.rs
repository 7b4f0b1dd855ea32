//! `wakemix fatigue`: damage-equivalent loads of channels, or of a pitch bearing, in any table of results.

mod bearing;

use super::arguments::{bins, finite};
use super::output::{columns, detail, print, print_text};
use clap::Args;
use miette::{IntoDiagnostic, Result, miette};
use serde_json::json;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use wakemix::analysis::fatigue::{
    self, Cycle, EquivalentLoad, Fatigue, LoadCounter, Rainflow, RangeBins,
};
use wakemix::formats::table::{self, TableReader};
use wakemix::report::text_table::{Column, TextTable};

/// Arguments of `wakemix fatigue`.
#[derive(Args)]
pub(crate) struct FatigueArguments {
    /// OpenFAST output (.outb, .out), CSV with a column of time, or the folder of a run
    file: PathBuf,
    /// Channels, such as RootMyc1,TwrBsMyt; a unit at the end of a name may be left out
    #[arg(
        long,
        value_name = "NAME",
        required_unless_present = "bearing",
        conflicts_with = "bearing",
        value_delimiter = ','
    )]
    channel: Vec<String>,
    /// Wöhler slopes m of the S-N line: 4 is usual for welded steel, 10 for composite blades; one, 3 when
    /// left out, with --bearing
    #[arg(
        long,
        value_name = "M",
        required_unless_present = "bearing",
        value_delimiter = ',',
        value_parser = slope
    )]
    slope: Vec<f64>,
    /// Load of a blade's pitch bearing around its ring, from pitch and root moments (BldPitch1, RootMyb1,
    /// RootMxb1), instead of channels
    #[arg(long)]
    bearing: bool,
    /// Blade whose bearing it is; 1 when left out
    #[arg(long, value_name = "N", requires = "bearing")]
    blade: Option<NonZeroUsize>,
    /// Turbine whose bearing it is, such as T1, where the file holds several, as the records of a run do
    #[arg(long, value_name = "NAME", requires = "bearing")]
    turbine: Option<String>,
    /// Time at which the count begins (s); all of the file when left out
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = finite)]
    from: Option<f64>,
    /// Time at which the count ends (s), a row at T included; all of the file when left out
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = finite)]
    to: Option<f64>,
    /// Sort ranges into N equal bins first, as some studies do (200), and use the middle of each
    #[arg(long, value_name = "N", conflicts_with = "bearing", value_parser = bins)]
    bins: Option<NonZeroUsize>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// What was counted of a file.
struct Count {
    span: Span,
    channels: Vec<(table::Column, Fatigue)>,
}

/// The rows that were taken of a file.
struct Span {
    /// Time of the first and of the last (s).
    times: [f64; 2],
    n_samples: u64,
}

impl Span {
    /// From the first row to the last (s).
    fn duration(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// Mean time from row to row (s).
    fn interval(&self) -> f64 {
        self.duration() / (self.n_samples - 1) as f64
    }

    /// The first line of a text about `file`.
    fn line(&self, file: &Path) -> String {
        let Self { times: [first, last], n_samples } = self;
        let duration = self.duration();
        format!("{}: {first} to {last} s, {duration} s, {n_samples} samples\n", file.display())
    }

    /// On return `value`, an object about `file`, tells of the rows as well.
    fn tell(&self, file: &Path, value: &mut serde_json::Value) {
        value["file"] = json!(file.display().to_string());
        value["from_s"] = json!(self.times[0]);
        value["to_s"] = json!(self.times[1]);
        value["duration_s"] = json!(self.duration());
        value["n_samples"] = json!(self.n_samples);
    }
}

/// Prints equivalent loads; data goes to stdout.
///
/// # Errors
/// Files and channels that cannot be read, and times that leave nothing to count.
pub(crate) fn run(arguments: &FatigueArguments) -> Result<()> {
    let text = if arguments.bearing {
        let duty = bearing::count(arguments)?;
        if arguments.json { lines(&duty.json(arguments))? } else { duty.text(arguments) }
    } else {
        let count = count(arguments)?;
        if arguments.json { lines(&json(arguments, &count))? } else { text(arguments, &count) }
    };
    if arguments.json { print(&text) } else { print_text(&text) }
}

/// `value` as text that ends its last line.
fn lines(value: &serde_json::Value) -> Result<String> {
    Ok(serde_json::to_string_pretty(value).into_diagnostic()? + "\n")
}

/// Counts one channel, with or without bins.
enum Counter {
    Streaming(LoadCounter),
    Binned { rainflow: Rainflow, cycles: Vec<Cycle>, n_bins: NonZeroUsize },
}

impl Counter {
    fn new(slopes: &[f64], bins: Option<NonZeroUsize>) -> Result<Self> {
        Ok(match bins {
            None => Self::Streaming(LoadCounter::new(slopes).into_diagnostic()?),
            Some(n_bins) => Self::Binned { rainflow: Rainflow::new(), cycles: Vec::new(), n_bins },
        })
    }

    fn push(&mut self, sample: f64) -> Result<()> {
        match self {
            Self::Streaming(counter) => counter.push(sample),
            Self::Binned { rainflow, cycles, .. } => {
                rainflow.push(sample, |cycle| cycles.push(cycle))
            }
        }
        .into_diagnostic()
    }

    fn finish(self, slopes: &[f64], duration: f64) -> Result<Fatigue> {
        let (rainflow, mut cycles, n_bins) = match self {
            Self::Streaming(counter) => return counter.finish(duration).into_diagnostic(),
            Self::Binned { rainflow, cycles, n_bins } => (rainflow, cycles, n_bins),
        };
        rainflow.finish(|cycle| cycles.push(cycle));
        let bins = RangeBins::new(&cycles, n_bins);
        let load = |slope: &f64| {
            let load = bins.equivalent_load(*slope, duration)?;
            Ok(EquivalentLoad { slope: *slope, load })
        };
        let loads: Result<_, wakemix::analysis::AnalysisError> = slopes.iter().map(load).collect();
        Ok(Fatigue {
            duration,
            n_cycles: cycles.iter().fold(0.0, |sum, cycle| sum + cycle.count),
            largest_range: cycles.iter().map(|cycle| cycle.range).fold(0.0, f64::max),
            loads: loads.into_diagnostic()?,
        })
    }
}

/// The table that `arguments` name.
///
/// # Errors
/// A file that is none.
fn open(arguments: &FatigueArguments) -> Result<TableReader> {
    let table = TableReader::open(&arguments.file)?;
    detail(&format!("read: {}, of {} channels", table.path().display(), table.channels().count()));
    Ok(table)
}

fn count(arguments: &FatigueArguments) -> Result<Count> {
    let mut table = open(arguments)?;
    let names: Vec<&str> = arguments.channel.iter().map(|name| name.trim()).collect();
    table.select(&names)?;
    let mut counters: Vec<Counter> = names
        .iter()
        .map(|_| Counter::new(&arguments.slope, arguments.bins))
        .collect::<Result<_>>()?;
    let span = read_span(&mut table, arguments, |row| {
        for (counter, sample) in counters.iter_mut().zip(&row[1..]) {
            counter.push(*sample)?;
        }
        Ok(())
    })?;
    let counted =
        counters.into_iter().map(|counter| counter.finish(&arguments.slope, span.duration()));
    let channels = table.selected().cloned().zip(counted.collect::<Result<Vec<_>>>()?).collect();
    Ok(Count { span, channels })
}

/// Hands every row of `table` from --from to --to, time and the selected channels, to `take`.
///
/// # Errors
/// Rows that cannot be read, what `take` says, and times that leave nothing to count.
fn read_span(
    table: &mut TableReader,
    arguments: &FatigueArguments,
    mut take: impl FnMut(&[f64]) -> Result<()>,
) -> Result<Span> {
    let from = arguments.from.unwrap_or(f64::NEG_INFINITY);
    let to = arguments.to.unwrap_or(f64::INFINITY);
    let mut span = Span { times: [f64::NAN; 2], n_samples: 0 };
    // Times of the first and the last row (s), and whether --to leaves that one and others behind it out.
    let (mut rows, mut is_cut): (Option<(f64, f64)>, bool) = (None, false);
    let mut row = vec![0.0; table.selected().count() + 1];
    while table.read(&mut row)? {
        let (begin, _) = rows.unwrap_or((row[0], row[0]));
        rows = Some((begin, row[0]));
        is_cut = row[0] > to;
        // What follows need not even be sound.
        if is_cut {
            break;
        }
        if row[0] < from {
            continue;
        }
        if span.n_samples == 0 {
            span.times[0] = row[0];
        }
        span.times[1] = row[0];
        span.n_samples += 1;
        take(&row)?;
    }
    if span.n_samples < 2 || span.duration() <= 0.0 {
        return Err(too_few(table.path(), span.n_samples, rows, is_cut));
    }
    Ok(span)
}

/// The error that `n_samples` of the table at `path` are too few; `rows` are its first time and the last that
/// was read (s), `is_cut` whether --to ended the reading there.
fn too_few(path: &Path, n_samples: u64, rows: Option<(f64, f64)>, is_cut: bool) -> miette::Report {
    let problem = format!("{} leaves {n_samples} samples to count", path.display());
    match rows {
        Some((begin, _)) if is_cut => miette!(
            help = "give --to a time in seconds after --from and after the beginning of the file",
            "{problem} before --to: it begins at {begin} s"
        ),
        Some((_, end)) => miette!(
            help = "give --from a time in seconds before the end of the file",
            "{problem}: it ends at {end} s"
        ),
        None => miette!(
            help = "give --from a time in seconds before the end of the file",
            "{problem}: it has no rows"
        ),
    }
}

fn text(arguments: &FatigueArguments, count: &Count) -> String {
    let Count { span, channels } = count;
    let numbers = ["slope", "equivalent load", "cycles", "largest range"].map(Column::number);
    let mut table = TextTable::new([Column::words("channel")], numbers);
    for (column, fatigue) in channels {
        for EquivalentLoad { slope, load } in &fatigue.loads {
            table.row([
                name(column),
                slope.to_string(),
                six_digits(*load),
                format!("{:.1}", fatigue.n_cycles),
                six_digits(fatigue.largest_range),
            ]);
        }
    }
    let mut text = span.line(&arguments.file) + &table.fitted(columns());
    text.push_str(&fatigue::convention(arguments.bins.map(NonZeroUsize::get)));
    text.push('\n');
    text
}

/// A column's name, with its unit where the file tells it apart.
fn name(column: &table::Column) -> String {
    match column.unit.as_str() {
        "" => column.name.clone(),
        unit => format!("{} ({unit})", column.name),
    }
}

fn json(arguments: &FatigueArguments, count: &Count) -> serde_json::Value {
    let Count { span, channels } = count;
    let channels: Vec<serde_json::Value> = channels
        .iter()
        .map(|(column, fatigue)| {
            let loads: Vec<serde_json::Value> = fatigue
                .loads
                .iter()
                .map(|load| json!({ "slope": load.slope, "damage_equivalent_load": load.load }))
                .collect();
            json!({
                "name": column.name,
                "unit": column.unit,
                "n_cycles": fatigue.n_cycles,
                "largest_range": fatigue.largest_range,
                "loads": loads,
            })
        })
        .collect();
    let mut value = json!({
        "n_equivalent": fatigue::REFERENCE_FREQUENCY * span.duration(),
        "bins": arguments.bins,
        "convention": fatigue::convention(arguments.bins.map(NonZeroUsize::get)),
        "channels": channels,
    });
    span.tell(&arguments.file, &mut value);
    value
}

/// Six digits that count, without an exponent where loads usually lie.
fn six_digits(value: f64) -> String {
    let magnitude = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    if (-4.0..12.0).contains(&magnitude) {
        format!("{value:.*}", (5.0 - magnitude).max(0.0) as usize)
    } else {
        format!("{value:.5e}")
    }
}

fn slope(text: &str) -> Result<f64, String> {
    let slope = text.trim().parse().ok().filter(|slope: &f64| slope.is_finite() && *slope >= 1.0);
    slope.ok_or_else(|| {
        format!("\"{text}\" is not a slope: give a number of at least 1, such as 4 or 10")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_count() {
        assert_eq!(six_digits(25124.2917), "25124.3");
        assert_eq!(six_digits(0.001234567), "0.00123457");
        assert_eq!(six_digits(123456789.0), "123456789");
        assert_eq!(six_digits(0.0), "0.00000");
        assert_eq!(six_digits(1.5e20), "1.50000e20");
    }

    #[test]
    fn slopes_are_read_or_refused() {
        assert_eq!(slope("10"), Ok(10.0));
        assert_eq!(slope(" 3.5"), Ok(3.5));
        for text in ["0.5", "-4", "nan", "ten", "inf"] {
            assert!(slope(text).unwrap_err().contains("at least 1"), "{text}");
        }
    }
}
