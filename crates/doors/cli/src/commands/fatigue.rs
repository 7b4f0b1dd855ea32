//! `wakemix fatigue`: damage-equivalent loads of channels in any table of results.

use clap::Args;
use miette::{IntoDiagnostic, Result, miette};
use serde_json::json;
use std::fmt::Write as _;
use std::io::{ErrorKind, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use wakemix::analysis::fatigue::{
    self, Cycle, EquivalentLoad, Fatigue, LoadCounter, Rainflow, RangeBins,
};
use wakemix::formats::table::{Column, TableReader};

/// Arguments of `wakemix fatigue`.
#[derive(Args)]
pub(crate) struct FatigueArguments {
    /// OpenFAST output (.outb, .out), CSV with a column of time, or the folder of a run
    file: PathBuf,
    /// Channels, such as RootMyc1,TwrBsMyt; a unit at the end of a name may be left out
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    channel: Vec<String>,
    /// Wöhler slopes m of the S-N line: 4 is usual for welded steel, 10 for composite blades
    #[arg(long, value_name = "M", required = true, value_delimiter = ',', value_parser = slope)]
    slope: Vec<f64>,
    /// Time at which the count begins (s); all of the file when left out
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    from: Option<f64>,
    /// Time at which the count ends (s), a row at T included; all of the file when left out
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    to: Option<f64>,
    /// Sort ranges into N equal bins first, as some studies do (200), and use the middle of each
    #[arg(long, value_name = "N")]
    bins: Option<NonZeroUsize>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// What was counted of a file.
struct Count {
    /// First and last time counted (s).
    times: [f64; 2],
    n_samples: u64,
    channels: Vec<(Column, Fatigue)>,
}

/// Prints equivalent loads; data goes to stdout.
///
/// # Errors
/// Files and channels that cannot be read, and times that leave nothing to count.
pub(crate) fn run(arguments: &FatigueArguments) -> Result<()> {
    let count = count(arguments)?;
    let text = if arguments.json {
        serde_json::to_string_pretty(&json(arguments, &count)).into_diagnostic()? + "\n"
    } else {
        text(arguments, &count)
    };
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).into_diagnostic(),
        _ => Ok(()),
    }
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

fn count(arguments: &FatigueArguments) -> Result<Count> {
    let mut table = TableReader::open(&arguments.file)?;
    let names: Vec<&str> = arguments.channel.iter().map(|name| name.trim()).collect();
    table.select(&names)?;
    let mut counters: Vec<Counter> = names
        .iter()
        .map(|_| Counter::new(&arguments.slope, arguments.bins))
        .collect::<Result<_>>()?;
    let from = arguments.from.unwrap_or(f64::NEG_INFINITY);
    let to = arguments.to.unwrap_or(f64::INFINITY);
    let (mut times, mut n_samples) = ([f64::NAN; 2], 0_u64);
    // Times of the first and the last row (s), and whether --to leaves that one and others behind it out.
    let (mut rows, mut is_cut): (Option<(f64, f64)>, bool) = (None, false);
    let mut row = vec![0.0; names.len() + 1];
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
        if n_samples == 0 {
            times[0] = row[0];
        }
        times[1] = row[0];
        n_samples += 1;
        for (counter, sample) in counters.iter_mut().zip(&row[1..]) {
            counter.push(*sample)?;
        }
    }
    let duration = times[1] - times[0];
    if n_samples < 2 || duration <= 0.0 {
        return Err(too_few(table.path(), n_samples, rows, is_cut));
    }
    let counted = counters.into_iter().map(|counter| counter.finish(&arguments.slope, duration));
    let channels = table.selected().cloned().zip(counted.collect::<Result<Vec<_>>>()?).collect();
    Ok(Count { times, n_samples, channels })
}

/// The error that `n_samples` of the table at `path` are too few; `rows` are its first time and the last that was read (s),
/// `is_cut` whether --to ended the reading there.
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
    let Count { times: [first, last], n_samples, channels } = count;
    let name = |column: &Column| match column.unit.as_str() {
        "" => column.name.clone(),
        unit => format!("{} ({unit})", column.name),
    };
    let width = channels.iter().map(|(column, _)| name(column).chars().count()).max();
    let width = width.unwrap_or(0).max("channel".len());
    let mut text = format!(
        "{}: {first} to {last} s, {} s, {n_samples} samples\n{:<width$}  slope    equivalent load     cycles      largest range\n",
        arguments.file.display(),
        last - first,
        "channel",
    );
    for (column, fatigue) in channels {
        for EquivalentLoad { slope, load } in &fatigue.loads {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{:<width$} {slope:>6} {:>18} {:>10.1} {:>18}",
                name(column),
                six_digits(*load),
                fatigue.n_cycles,
                six_digits(fatigue.largest_range),
            );
        }
    }
    text.push_str(&fatigue::convention(arguments.bins.map(NonZeroUsize::get)));
    text.push('\n');
    text
}

fn json(arguments: &FatigueArguments, count: &Count) -> serde_json::Value {
    let Count { times: [first, last], n_samples, channels } = count;
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
    json!({
        "file": arguments.file.display().to_string(),
        "from_s": first,
        "to_s": last,
        "duration_s": last - first,
        "n_samples": n_samples,
        "n_equivalent": fatigue::REFERENCE_FREQUENCY * (last - first),
        "bins": arguments.bins,
        "convention": fatigue::convention(arguments.bins.map(NonZeroUsize::get)),
        "channels": channels,
    })
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
        format!("\"{text}\" is no slope: give a number of at least 1, such as 4 or 10")
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
