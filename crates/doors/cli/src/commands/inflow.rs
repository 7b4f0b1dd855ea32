//! `wakemix inflow`: turbulence boxes made, looked at, converted.

use clap::{Args, Subcommand};
use indicatif::{HumanBytes, ProgressBar};
use miette::{IntoDiagnostic, miette};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use wakemix::flow::inflow::statistics::{BoxStatistics, statistics};
use wakemix::flow::inflow::{MeanProfile, mann};
use wakemix::formats::turbulence_box::{self, StoredBox};

/// Subcommands of `wakemix inflow`.
#[derive(Subcommand)]
pub(crate) enum InflowCommand {
    /// Make a box of Mann's turbulence and write it
    Generate(GenerateArguments),
    /// Print what a box holds: size, intensities, length scales, divergence
    Info {
        /// Header of HAWC2-style binaries (.toml) or TurbSim full field (.bts)
        file: PathBuf,
        /// Print JSON on stdout instead of text
        #[arg(long)]
        json: bool,
    },
    /// Convert a box between HAWC2-style binaries (.toml) and TurbSim's full field (.bts)
    Convert {
        /// Box to read
        from: PathBuf,
        /// Box to write; its ending chooses the format
        to: PathBuf,
    },
}

/// Arguments of `wakemix inflow generate`.
#[derive(Args)]
pub(crate) struct GenerateArguments {
    /// Mean speed at hub height (m/s)
    #[arg(long)]
    speed: f64,
    /// Turbulence intensity: streamwise standard deviation over mean speed (0.06 is 6 %)
    #[arg(long)]
    ti: f64,
    /// Length scale L of Mann's tensor (m)
    #[arg(long, default_value_t = 33.6)]
    length_scale: f64,
    /// Anisotropy Γ of Mann's tensor; 0 is isotropic
    #[arg(long, default_value_t = 3.9)]
    gamma: f64,
    /// Seed; the same seed gives the same box
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Points along x, y, z, such as 1024x96x64
    #[arg(long, value_parser = points)]
    size: [usize; 3],
    /// Distance of points (m): one for all axes, or three such as 10x8x8
    #[arg(long, value_parser = distances)]
    spacing: [f64; 3],
    /// Hub height (m)
    #[arg(long, default_value_t = 150.0)]
    hub_height: f64,
    /// Power-law exponent of the mean profile that is written beside the fluctuations
    #[arg(long, default_value_t = 0.0)]
    shear_exponent: f64,
    /// File to write: NAME.toml (HAWC2-style, with three .bin) or NAME.bts (TurbSim)
    #[arg(short, long)]
    output: PathBuf,
}

/// Runs `command`.
///
/// # Errors
/// Settings that make no box, files that cannot be read or written.
pub(crate) fn run(command: InflowCommand) -> miette::Result<()> {
    match command {
        InflowCommand::Generate(arguments) => generate(&arguments),
        InflowCommand::Info { file, json } => info(&file, json),
        InflowCommand::Convert { from, to } => {
            turbulence_box::check_name(&to)?;
            let stored = turbulence_box::read(&from)?;
            turbulence_box::write(&to, &stored)?;
            eprintln!("wrote {}", to.display());
            Ok(())
        }
    }
}

fn generate(arguments: &GenerateArguments) -> miette::Result<()> {
    if !(0.0..=1.0).contains(&arguments.ti) {
        return Err(miette!(
            help = "give a fraction: --ti 0.06 is 6 %",
            "--ti {} is no turbulence intensity",
            arguments.ti
        ));
    }
    let finite = [arguments.speed, arguments.hub_height]
        .iter()
        .all(|value| value.is_finite() && *value > 0.0);
    if !finite || !arguments.shear_exponent.is_finite() {
        return Err(miette!(
            help =
                "--speed in m/s and --hub-height in m are positive, --shear-exponent is a number",
            "speed, hub height or shear exponent is out of range"
        ));
    }
    turbulence_box::check_name(&arguments.output)?;
    let settings = mann::Settings {
        n_points: arguments.size,
        spacing: arguments.spacing,
        length_scale: arguments.length_scale,
        anisotropy: arguments.gamma,
        standard_deviation: arguments.ti * arguments.speed,
        seed: arguments.seed,
        threads: None,
    };
    let [n_x, n_y, n_z] = settings.n_points;
    eprintln!(
        "box: {n_x} × {n_y} × {n_z} points, {:.0} s of wind; memory {}, disk {}",
        n_x as f64 * settings.spacing[0] / arguments.speed,
        HumanBytes(mann::peak_memory(settings.n_points)),
        HumanBytes(12 * (n_x * n_y * n_z) as u64),
    );
    let bar = ProgressBar::new(1000);
    let turbulence = mann::generate(&settings, |share| bar.set_position((1000.0 * share) as u64));
    bar.finish_and_clear();
    let profile = MeanProfile::PowerLaw {
        hub_height: arguments.hub_height,
        speed: arguments.speed,
        exponent: arguments.shear_exponent,
    };
    let lowest_height = 0.5 * arguments.spacing[2];
    let stored = StoredBox {
        turbulence: turbulence.into_diagnostic()?,
        hub_speed: arguments.speed,
        hub_height: arguments.hub_height,
        lowest_height,
        mean_speeds: (0..n_z)
            .map(|z| profile.speed(lowest_height + z as f64 * arguments.spacing[2]))
            .collect(),
        description: format!(
            "wakemix {}: Mann, L {} m, Gamma {}, TI {}, seed {}",
            env!("CARGO_PKG_VERSION"),
            arguments.length_scale,
            arguments.gamma,
            arguments.ti,
            arguments.seed
        ),
    };
    turbulence_box::write(&arguments.output, &stored)?;
    eprintln!("wrote {}", arguments.output.display());
    Ok(())
}

fn info(file: &Path, json: bool) -> miette::Result<()> {
    let stored = turbulence_box::read(file)?;
    let numbers = statistics(&stored.turbulence);
    if json {
        let [u, ..] = numbers.standard_deviations;
        let value = serde_json::json!({
            "description": stored.description,
            "n_points": stored.turbulence.n_points(),
            "spacing": stored.turbulence.spacing(),
            "lengths": stored.turbulence.lengths(),
            "hub_speed": stored.hub_speed,
            "hub_height": stored.hub_height,
            "lowest_height": stored.lowest_height,
            "mean_speeds": stored.mean_speeds,
            "turbulence_intensity": u / stored.hub_speed,
            "statistics": numbers,
        });
        say(&(serde_json::to_string_pretty(&value).into_diagnostic()? + "\n"))
    } else {
        say(&text(&stored, &numbers))
    }
}

/// Writes `text` to stdout; a reader that has read enough, such as `head`, is no error.
fn say(text: &str) -> miette::Result<()> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).into_diagnostic(),
        _ => Ok(()),
    }
}

fn text(stored: &StoredBox, numbers: &BoxStatistics) -> String {
    let [n_x, n_y, n_z] = stored.turbulence.n_points();
    let [d_x, d_y, d_z] = stored.turbulence.spacing();
    let [l_x, l_y, l_z] = stored.turbulence.lengths();
    let three = |values: [f64; 3], digits: usize| {
        // What rounds to nothing is printed without a sign.
        let least = 0.5 * 0.1_f64.powi(digits as i32);
        values
            .map(|value| if value.abs() < least { 0.0 } else { value })
            .map(|value| format!("{value:10.digits$}"))
            .join("")
    };
    format!(
        "{}\n\
         points               {n_x} × {n_y} × {n_z} along x, y, z\n\
         spacing              {d_x:.3} × {d_y:.3} × {d_z:.3} m\n\
         repeats after        {l_x:.0} × {l_y:.0} × {l_z:.0} m, {:.1} s at {:.2} m/s\n\
         heights              {:.1} to {:.1} m, hub {:.1} m\n\
         mean speeds          {:.2} to {:.2} m/s\n\
         \x20                             u         v         w\n\
         mean           m/s   {}\n\
         deviation      m/s   {}\n\
         intensity      %     {}\n\
         length scale   m     {}\n\
         u'w'           {:.4} m²/s²\n\
         divergence     {:.1e} of the gradients, in Fourier space\n",
        stored.description,
        l_x / stored.hub_speed,
        stored.hub_speed,
        stored.lowest_height,
        stored.lowest_height + (n_z - 1) as f64 * d_z,
        stored.hub_height,
        stored.mean_speeds.iter().copied().fold(f64::INFINITY, f64::min),
        stored.mean_speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        three(numbers.means, 4),
        three(numbers.standard_deviations, 4),
        three(numbers.standard_deviations.map(|value| 100.0 * value / stored.hub_speed), 2),
        three(numbers.integral_scales, 1),
        numbers.shear_stress,
        numbers.divergence_residual,
    )
}

fn points(text: &str) -> Result<[usize; 3], String> {
    let values: Vec<usize> = text
        .split('x')
        .map(|part| part.trim().parse().map_err(|_| format!("`{part}` is no number of points")))
        .collect::<Result<_, _>>()?;
    values.try_into().map_err(|_| "three numbers such as 1024x96x64 are needed".to_owned())
}

fn distances(text: &str) -> Result<[f64; 3], String> {
    let values: Vec<f64> = text
        .split('x')
        .map(|part| part.trim().parse().map_err(|_| format!("`{part}` is no distance in metres")))
        .collect::<Result<_, _>>()?;
    match values[..] {
        [one] => Ok([one; 3]),
        [x, y, z] => Ok([x, y, z]),
        _ => Err("one distance, or three such as 10x8x8, are needed".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_or_refused() {
        assert_eq!(points("1024x96x64"), Ok([1024, 96, 64]));
        assert!(points("1024x96").unwrap_err().contains("three"));
        assert!(points("1024x-96x64").unwrap_err().contains("`-96`"));
        assert_eq!(distances("10"), Ok([10.0; 3]));
        assert_eq!(distances("10x8x7.5"), Ok([10.0, 8.0, 7.5]));
        assert!(distances("10x8").is_err());
    }
}
