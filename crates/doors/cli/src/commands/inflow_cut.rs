//! `wakemix inflow cut`: a part of recorded wind as a file that other programs read.

use super::arguments::{check_free, finite, positive};
use super::output::{detail, tell};
use clap::Args;
use indicatif::HumanBytes;
use miette::miette;
use std::path::PathBuf;
use wakemix::flow::inflow::{Cut, CutError, CutPlanes, PlaneGrid, Planes};
use wakemix::formats::turbulence_box::{self, Origin};

/// Bytes of a point in a file of whole numbers, and of one in memory.
const DISK_OF_POINT: u64 = 6;
const MEMORY_OF_POINT: u64 = 12;

/// Arguments of `wakemix inflow cut`.
#[derive(Args)]
pub(crate) struct CutArguments {
    /// Record to take a part of: a slice of a run (RUN/slices-NAME-5D.bts), or any other .bts, .wnd or
    /// HAWC2-style box
    record: PathBuf,
    /// Where in the record the first block begins (s)
    #[arg(long, default_value_t = 0.0, value_parser = not_negative)]
    from: f64,
    /// Length of a block (s) [default: to the end of the record]
    #[arg(long, value_parser = positive)]
    duration: Option<f64>,
    /// Which of the blocks that follow one another, from 1
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    block: u64,
    /// Width of the rectangle (m) [default: that of the record]
    #[arg(long, value_parser = positive)]
    width: Option<f64>,
    /// Its height (m), half of it above the hub [default: the rows of the record]
    #[arg(long, value_parser = positive)]
    height: Option<f64>,
    /// Distance of its points along y and z (m), no finer than the record's [default: that of the record]
    #[arg(long, value_parser = positive)]
    spacing: Option<f64>,
    /// How far the rectangle stands to the left of the record's middle, looking downwind (m)
    #[arg(long, default_value_t = 0.0, value_parser = finite, allow_hyphen_values = true)]
    shift: f64,
    /// Hub height (m) [default: that of the record]
    #[arg(long, value_parser = positive)]
    hub_height: Option<f64>,
    /// File to write: NAME.bts (TurbSim) or NAME.wnd (Bladed, with NAME.sum beside it)
    #[arg(short, long)]
    output: PathBuf,
    /// Put the new file in the place of an old one
    #[arg(long)]
    overwrite: bool,
}

/// Writes the part of the record.
///
/// # Errors
/// A record that cannot be read or does not hold the part, a file that cannot be written.
pub(crate) fn run(arguments: &CutArguments) -> miette::Result<()> {
    turbulence_box::check_once(&arguments.output)?;
    check_free(&turbulence_box::files_of(&arguments.output)?, arguments.overwrite)?;
    let record = turbulence_box::open(&arguments.record)?;
    let hub_height = match arguments.hub_height {
        Some(hub_height) => hub_height,
        None => turbulence_box::hub_height(&arguments.record)?,
    };
    detail(&format!("read: {}", arguments.record.display()));
    let of_record = record.grid();
    let cut = arguments.cut();
    let mut planes =
        CutPlanes::new(record, &cut, hub_height).map_err(|error| refusal(arguments, &error))?;
    tell(&told(&planes.grid(), &of_record, hub_height));
    let description = format!(
        "wakemix {}: block {} of {}, shifted by {} m",
        env!("CARGO_PKG_VERSION"),
        cut.block,
        arguments.record.file_name().unwrap_or_default().to_string_lossy(),
        cut.shift
    );
    let origin = Origin { path: &arguments.record, hub_height, description: &description };
    turbulence_box::write_planes(&arguments.output, &mut planes, origin)?;
    tell(&format!("wrote {}", arguments.output.display()));
    Ok(())
}

impl CutArguments {
    fn cut(&self) -> Cut {
        let Self { from, duration, block, width, height, spacing, shift, .. } = *self;
        Cut { from, duration, block, width, height, spacing, shift }
    }
}

/// That the record does not hold the part, with the argument that is to blame.
fn refusal(arguments: &CutArguments, error: &CutError) -> miette::Report {
    let argument = error.key().map_or_else(String::new, |key| format!("--{key}: "));
    miette!("{argument}{}: {error}", arguments.record.display())
}

/// The size of the part on `grid` for a hub at `hub_height` (m), and what it costs to take it out of planes
/// on the grid `of_record`.
fn told(grid: &PlaneGrid, of_record: &PlaneGrid, hub_height: f64) -> String {
    let points = |grid: &PlaneGrid| (grid.n_y * grid.n_z) as u64;
    let [low, high] = grid.up();
    format!(
        "part: {} planes of {} × {} points, {} × {} m apart, one every {:.3} s; heights {low:.1} to {high:.1} m, hub {hub_height:.1} m, {:.2} m/s there; \
         memory {}, disk {}",
        grid.n_steps,
        grid.n_y,
        grid.n_z,
        grid.spacing[0],
        grid.spacing[1],
        grid.interval,
        grid.speed,
        HumanBytes((points(of_record) + 2 * points(grid)) * MEMORY_OF_POINT),
        HumanBytes(grid.n_steps as u64 * points(grid) * DISK_OF_POINT),
    )
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number < 0.0 { Err("a number from 0 on is needed".to_owned()) } else { Ok(number) }
}
