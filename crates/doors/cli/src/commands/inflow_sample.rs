//! `wakemix inflow sample`: the wind of a case without turbulence as a file that other programs read.

use super::arguments::{check_free, positive};
use super::output::{detail, tell};
use clap::Args;
use miette::{IntoDiagnostic, miette};
use std::path::PathBuf;
use wakemix::farm::case::Solver;
use wakemix::flow::inflow::{PlaneGrid, sampled};
use wakemix::formats::turbulence_box::{self, StoredBox};
use wakemix::study::Prepared;

/// Width and height of the grid over the first rotor's diameter (–), where no spacing is given.
const REACH: f64 = 1.2;

/// Arguments of `wakemix inflow sample`.
#[derive(Args)]
pub(crate) struct SampleArguments {
    /// Case file (TOML), or the name of a shipped case, with flow.solver = "uniform": shear,
    /// wind.veer_deg_per_m and wind.event are sampled for time.duration
    case: PathBuf,
    /// Override a key of the case, as in `--set wind.speed=8` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Points along y and z, such as 31x31
    #[arg(long, default_value = "31x31", value_parser = across)]
    size: [usize; 2],
    /// Distance of points (m): one for both axes, or two such as 8x10 [default: 1.2 diameters of the first
    /// turbine over the points]
    #[arg(long, value_parser = distances)]
    spacing: Option<[f64; 2]>,
    /// Time between planes (s)
    #[arg(long, default_value_t = 0.1, value_parser = positive)]
    time_step: f64,
    /// File to write: NAME.bts (TurbSim), NAME.wnd (Bladed), NAME.toml or NAME.bin (HAWC2-style)
    #[arg(short, long)]
    output: PathBuf,
    /// Put the new file in the place of an old one
    #[arg(long)]
    overwrite: bool,
}

/// Writes the wind of the case around the first turbine.
///
/// # Errors
/// A case that cannot be read or has another kind of wind, a grid that makes no sense, a file that cannot be
/// written.
pub(crate) fn run(arguments: &SampleArguments) -> miette::Result<()> {
    check_free(&turbulence_box::files_of(&arguments.output)?, arguments.overwrite)?;
    let setup = Prepared::read(&arguments.case, &arguments.overrides)?;
    detail(&format!("read: case {}", arguments.case.display()));
    if setup.case.flow.solver != Solver::UNIFORM {
        return Err(miette!(
            help = "use --set flow.solver=uniform; turbulence is made by `wakemix inflow generate`",
            "{}: only the wind of flow.solver = \"uniform\" can be sampled",
            arguments.case.display()
        ));
    }
    let (plan, wind) = (&setup.plan, &setup.case.wind);
    let [n_y, n_z] = arguments.size;
    let intervals = |n: usize| n.saturating_sub(1).max(1) as f64;
    let usual = [n_y, n_z].map(|n| REACH * plan.diameter / intervals(n));
    let spacing = arguments.spacing.unwrap_or(usual);
    let [width, height] = [(n_y, 0), (n_z, 1)].map(|(n, axis)| spacing[axis] * (n - 1) as f64);
    let lowest = (plan.hub_height - 0.5 * height).max(0.5 * spacing[1]);
    let grid = PlaneGrid {
        n_y,
        n_z,
        spacing,
        first: [-0.5 * width, lowest],
        interval: arguments.time_step,
        speed: wind.speed,
        // The end of the run has its plane, too.
        n_steps: (setup.case.time.duration / arguments.time_step).ceil() as usize + 1,
        repeats: true,
    };
    let (turbulence, mean_speeds) = sampled(&*setup.mean_inflow, &grid).into_diagnostic()?;
    let stored = StoredBox {
        turbulence,
        hub_speed: wind.speed,
        hub_height: plan.hub_height,
        lowest_height: lowest,
        mean_speeds,
        description: format!(
            "wakemix {}: wind of case {} without turbulence",
            env!("CARGO_PKG_VERSION"),
            setup.case.name
        ),
    };
    turbulence_box::write(&arguments.output, &stored)?;
    tell(&format!("wrote {}", arguments.output.display()));
    Ok(())
}

fn across(text: &str) -> Result<[usize; 2], String> {
    let points = |part: &str| part.trim().parse().ok().filter(|n| (1..=10_000).contains(n));
    let (y, z) = text.split_once('x').ok_or("two numbers such as 31x31 are needed")?;
    match (points(y), points(z)) {
        (Some(y), Some(z)) => Ok([y, z]),
        _ => Err("two numbers of points from 1 to 10000, such as 31x31, are needed".to_owned()),
    }
}

fn distances(text: &str) -> Result<[f64; 2], String> {
    let distance =
        |part: &str| part.trim().parse().ok().filter(|d: &f64| d.is_finite() && *d > 0.0);
    let (y, z) = text.split_once('x').unwrap_or((text, text));
    match (distance(y), distance(z)) {
        (Some(y), Some(z)) => Ok([y, z]),
        _ => Err("one distance in metres, or two such as 8x10, are needed".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_across_are_read_or_refused() {
        assert_eq!(across("31x21"), Ok([31, 21]));
        assert!(across("31").unwrap_err().contains("31x31"));
        assert!(across("0x21").is_err() && across("31xx").is_err());
        assert_eq!(distances("8"), Ok([8.0, 8.0]));
        assert_eq!(distances("8x10.5"), Ok([8.0, 10.5]));
        assert!(distances("8x-1").is_err() && distances("8xnan").is_err());
    }
}
