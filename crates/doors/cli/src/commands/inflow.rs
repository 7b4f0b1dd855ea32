//! `wakemix inflow`: turbulence boxes made, looked at, converted; wind of an atmosphere.

use super::arguments::{check_free, finite, positive};
use super::manner;
use super::output::{detail, refuse, tell};
use clap::{Args, Subcommand, ValueEnum};
use indicatif::{HumanBytes, ProgressBar};
use miette::{IntoDiagnostic, miette};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use wakemix::farm::case::Shear;
use wakemix::farm::wind::usual_length_scale;
use wakemix::flow::inflow::iec::TurbulenceClass;
use wakemix::flow::inflow::{MeanProfile, kaimal, mann};
use wakemix::formats::machine;
use wakemix::formats::turbulence_box::{self, StoredBox};

/// Subcommands of `wakemix inflow`.
#[derive(Subcommand)]
pub(crate) enum InflowCommand {
    /// Make a box of turbulence, Mann's or Kaimal's, and write it
    Generate(GenerateArguments),
    /// Print what a box holds: size, intensities, length scales, divergence
    Info {
        /// Box: .toml or .bin (HAWC2-style), .bts (TurbSim) or .wnd (Bladed)
        file: PathBuf,
        /// Print JSON on stdout instead of text
        #[arg(long)]
        json: bool,
    },
    /// Convert a box between HAWC2-style binaries (.toml, .bin), TurbSim's (.bts) and Bladed's (.wnd) full
    /// fields
    Convert {
        /// Box to read
        from: PathBuf,
        /// Box to write; its ending chooses the format
        to: PathBuf,
        /// Put the new file in the place of an old one
        #[arg(long)]
        overwrite: bool,
    },
    /// Spin up a periodic box of atmosphere, tell its statistics, and record planes of its wind for studies
    Precursor(super::inflow_precursor::PrecursorArguments),
    /// Take a block of recorded wind on a rectangle, moved sideways, for other programs (a case takes the
    /// same by wind.cut, without a file)
    Cut(super::inflow_cut::CutArguments),
    /// Write the wind of a case without turbulence (shear, veer, gusts, steps, rotating disk) as a full field
    Sample(super::inflow_sample::SampleArguments),
}

/// What turbulence is drawn from.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Model {
    /// Mann's tensor of sheared turbulence: free of divergence, repeats in all directions
    Mann,
    /// Kaimal's spectra of IEC 61400-1 edition 3, u with exponential coherence, as TurbSim's IECKAI
    Kaimal,
}

/// Category of turbulence of IEC 61400-1.
#[derive(Clone, Copy, ValueEnum)]
enum Class {
    /// 16 % at 15 m/s
    A,
    /// 14 %
    B,
    /// 12 %
    C,
}

/// What is scaled to exactly the target deviation.
#[derive(Clone, Copy, ValueEnum)]
enum Scale {
    /// Nothing: the deviation varies with the seed and the length of the record
    None,
    /// The point nearest the hub
    Hub,
    /// Every point
    EachPoint,
}

/// Arguments of `wakemix inflow generate`.
#[derive(Args)]
pub(crate) struct GenerateArguments {
    /// What turbulence is drawn from
    #[arg(long, value_enum, default_value = "mann")]
    model: Model,
    /// Mean speed at hub height (m/s)
    #[arg(long, value_parser = positive)]
    speed: f64,
    /// Turbulence intensity: streamwise standard deviation over mean speed (0.06 is 6 %)
    #[arg(long, required_unless_present = "class", conflicts_with = "class", value_parser = finite)]
    ti: Option<f64>,
    /// Normal turbulence model of a category instead of --ti
    #[arg(long, value_enum, ignore_case = true)]
    class: Option<Class>,
    /// Length scale L of Mann's tensor (m) [default: standard deviation over shear at the hub, as in a case]
    #[arg(long, value_parser = positive)]
    length_scale: Option<f64>,
    /// Anisotropy Γ of Mann's tensor; 0 is isotropic [default: 3.9]
    #[arg(long, value_parser = finite)]
    gamma: Option<f64>,
    /// What is scaled to exactly the target deviation, of --model kaimal [default: none]
    #[arg(long, value_enum)]
    scale: Option<Scale>,
    /// Seed; the same seed gives the same box
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Points along x (that is time), y, z, such as 1024x96x64
    #[arg(long, value_parser = points)]
    size: [usize; 3],
    /// Distance of points (m): one for all axes, or three such as 10x8x8
    #[arg(long, value_parser = distances)]
    spacing: [f64; 3],
    /// Time step (s); along x points then stand speed × time step apart, whatever --spacing says
    #[arg(long, value_parser = positive)]
    time_step: Option<f64>,
    /// Hub height (m)
    #[arg(long, default_value_t = 150.0, value_parser = positive)]
    hub_height: f64,
    /// Height of the lowest points (m) [default: half a spacing for mann, centred on the hub for kaimal]
    #[arg(long, value_parser = finite)]
    lowest_height: Option<f64>,
    /// Power-law exponent of the mean profile that is written beside the fluctuations
    #[arg(long, default_value_t = 0.0, value_parser = finite, allow_hyphen_values = true)]
    shear_exponent: f64,
    /// Roughness length (m): a logarithmic mean profile instead
    #[arg(long, conflicts_with = "shear_exponent", value_parser = positive)]
    roughness_length: Option<f64>,
    /// File to write: NAME.toml or NAME.bin (HAWC2-style), NAME.bts (TurbSim) or NAME.wnd (Bladed)
    #[arg(short, long)]
    output: PathBuf,
    /// Put the new file in the place of an old one
    #[arg(long)]
    overwrite: bool,
}

/// Runs `command`; exit code 0 done, 2 bad input, and of a precursor 3 diverged, 130 interrupted.
pub(crate) fn run(command: InflowCommand) -> ExitCode {
    let done = match command {
        InflowCommand::Precursor(arguments) => return super::inflow_precursor::run(&arguments),
        InflowCommand::Generate(arguments) => generate(&arguments),
        InflowCommand::Info { file, json } => super::inflow_info::run(&file, json),
        InflowCommand::Convert { from, to, overwrite } => convert(&from, &to, overwrite),
        InflowCommand::Cut(arguments) => super::inflow_cut::run(&arguments),
        InflowCommand::Sample(arguments) => super::inflow_sample::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => refuse(&report),
    }
}

fn convert(from: &Path, to: &Path, overwrite: bool) -> miette::Result<()> {
    check_free(&turbulence_box::files_of(to)?, overwrite)?;
    turbulence_box::convert(from, to)?;
    detail(&format!("read: {}", from.display()));
    tell(&format!("wrote {}", to.display()));
    Ok(())
}

fn generate(arguments: &GenerateArguments) -> miette::Result<()> {
    let plan = Plan::new(arguments)?;
    check_free(&turbulence_box::files_of(&arguments.output)?, arguments.overwrite)?;
    let [n_x, n_y, n_z] = arguments.size;
    let memory = match plan.settings {
        BoxSettings::Mann(_) => mann::peak_memory(arguments.size),
        BoxSettings::Kaimal(_) => kaimal::peak_memory(arguments.size),
    };
    tell(&format!(
        "box: {n_x} × {n_y} × {n_z} points, {:.0} s of wind; memory {}",
        n_x as f64 * plan.spacing[0] / arguments.speed,
        HumanBytes(memory),
    ));
    if let Some(free) = machine::free_memory().filter(|free| *free < memory) {
        return Err(miette!(
            help = "take fewer points, --size",
            "the box needs {} of memory, {} are free",
            HumanBytes(memory),
            HumanBytes(free)
        ));
    }
    let shown = manner::says_remarks();
    let bar = if shown { ProgressBar::new(1000) } else { ProgressBar::hidden() };
    let progress = |share: f64| bar.set_position((1000.0 * share) as u64);
    let turbulence = match &plan.settings {
        BoxSettings::Mann(settings) => mann::generate(settings, progress),
        BoxSettings::Kaimal(settings) => kaimal::generate(settings, progress),
    };
    bar.finish_and_clear();
    detail(&format!("built: {}", plan.description));
    let stored = StoredBox {
        turbulence: turbulence.into_diagnostic()?,
        hub_speed: arguments.speed,
        hub_height: arguments.hub_height,
        lowest_height: plan.lowest_height,
        mean_speeds: (0..n_z)
            .map(|z| plan.profile.speed(plan.lowest_height + z as f64 * plan.spacing[2]))
            .collect(),
        description: format!("wakemix {}: {}", env!("CARGO_PKG_VERSION"), plan.description),
    };
    turbulence_box::write(&arguments.output, &stored)?;
    tell(&format!("wrote {}", arguments.output.display()));
    Ok(())
}

/// Arguments, checked.
struct Plan {
    settings: BoxSettings,
    profile: MeanProfile,
    spacing: [f64; 3],
    lowest_height: f64,
    description: String,
}

enum BoxSettings {
    Mann(mann::MannSettings),
    Kaimal(kaimal::KaimalSettings),
}

impl Plan {
    fn new(arguments: &GenerateArguments) -> miette::Result<Self> {
        let speed = arguments.speed;
        let ti = arguments.ti.unwrap_or(0.0);
        if !(0.0..=1.0).contains(&ti) {
            return Err(miette!(
                help = "give a fraction: --ti 0.06 is 6 %",
                "--ti {ti} is not a turbulence intensity"
            ));
        }
        let standard_deviation = match arguments.class {
            Some(Class::A) => TurbulenceClass::A.standard_deviation(speed),
            Some(Class::B) => TurbulenceClass::B.standard_deviation(speed),
            Some(Class::C) => TurbulenceClass::C.standard_deviation(speed),
            None => ti * speed,
        };
        let [along, across, up] = arguments.spacing;
        let spacing = [arguments.time_step.map_or(along, |step| step * speed), across, up];
        let (n_points, seed) = (arguments.size, arguments.seed);
        let height = (n_points[2].saturating_sub(1)) as f64 * up;
        let lowest_height = arguments.lowest_height.unwrap_or(match arguments.model {
            Model::Mann => 0.5 * up,
            Model::Kaimal => arguments.hub_height - 0.5 * height,
        });
        if lowest_height < 0.0 {
            return Err(miette!(
                help =
                    "use fewer points along z, a smaller spacing, a higher hub or --lowest-height",
                "the lowest points would be at {lowest_height:.1} m, under the ground"
            ));
        }
        let place = Place { n_points, spacing, lowest_height, standard_deviation };
        let (settings, model) = match arguments.model {
            Model::Mann => mann_of(arguments, &place)?,
            Model::Kaimal => kaimal_of(arguments, &place)?,
        };
        let intensity = standard_deviation / speed;
        let description = format!("{model}, TI {intensity:.4}, seed {seed}");
        let profile = profile(arguments)?;
        Ok(Self { settings, profile, spacing, lowest_height, description })
    }
}

/// Points of a box and the deviation of the wind there.
struct Place {
    n_points: [usize; 3],
    /// Distance of points (m).
    spacing: [f64; 3],
    lowest_height: f64,
    /// Of the streamwise wind (m/s).
    standard_deviation: f64,
}

/// Settings of Mann's turbulence at `place`, and what the description of its box says of them.
fn mann_of(arguments: &GenerateArguments, place: &Place) -> miette::Result<(BoxSettings, String)> {
    if arguments.scale.is_some() {
        return Err(miette!(
            help = "a box of Mann's turbulence always has the target deviation as a whole",
            "--scale belongs to --model kaimal"
        ));
    }
    let shear = match arguments.roughness_length {
        None => Shear::PowerLaw { exponent: arguments.shear_exponent },
        Some(roughness_length) => Shear::LogLaw { roughness_length },
    };
    let intensity = place.standard_deviation / arguments.speed;
    let usual = || usual_length_scale(shear, intensity, arguments.hub_height);
    let length_scale = arguments.length_scale.unwrap_or_else(usual);
    let anisotropy = arguments.gamma.unwrap_or(3.9);
    let settings = mann::MannSettings {
        n_points: place.n_points,
        spacing: place.spacing,
        length_scale,
        anisotropy,
        standard_deviation: place.standard_deviation,
        seed: arguments.seed,
        threads: None,
    };
    let model = format!("Mann, L {length_scale:.1} m, Gamma {anisotropy}");
    Ok((BoxSettings::Mann(settings), model))
}

/// Settings of Kaimal's turbulence at `place`, and what the description of its box says of them.
fn kaimal_of(
    arguments: &GenerateArguments,
    place: &Place,
) -> miette::Result<(BoxSettings, String)> {
    if arguments.length_scale.is_some() || arguments.gamma.is_some() {
        return Err(miette!(
            help = "Kaimal's scales follow from the hub height",
            "--length-scale and --gamma belong to --model mann"
        ));
    }
    let settings = kaimal::KaimalSettings {
        n_points: place.n_points,
        spacing: place.spacing,
        hub_speed: arguments.speed,
        hub_height: arguments.hub_height,
        lowest_height: place.lowest_height,
        standard_deviation: place.standard_deviation,
        scaling: match arguments.scale {
            None | Some(Scale::None) => kaimal::Scaling::None,
            Some(Scale::Hub) => kaimal::Scaling::Hub,
            Some(Scale::EachPoint) => kaimal::Scaling::EachPoint,
        },
        seed: arguments.seed,
        threads: None,
    };
    Ok((BoxSettings::Kaimal(settings), turbulence_box::KAIMAL.to_owned()))
}

/// The mean profile that is written beside the fluctuations.
fn profile(arguments: &GenerateArguments) -> miette::Result<MeanProfile> {
    let (hub_height, speed) = (arguments.hub_height, arguments.speed);
    let profile = match arguments.roughness_length {
        None => MeanProfile::PowerLaw { hub_height, speed, exponent: arguments.shear_exponent },
        Some(roughness_length) => MeanProfile::LogLaw { hub_height, speed, roughness_length },
    };
    profile.check().into_diagnostic()?;
    Ok(profile)
}

fn points(text: &str) -> Result<[usize; 3], String> {
    let values: Vec<usize> = text
        .split('x')
        .map(|part| part.trim().parse().map_err(|_| format!("`{part}` is not a number of points")))
        .collect::<Result<_, _>>()?;
    values.try_into().map_err(|_| "three numbers such as 1024x96x64 are needed".to_owned())
}

fn distances(text: &str) -> Result<[f64; 3], String> {
    let values: Vec<f64> = text
        .split('x')
        .map(|part| positive(part).map_err(|_| format!("`{part}` is not a distance in metres")))
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
