//! `wakemix turbine`: the library of turbines, and what blade-element momentum says of them.

mod import;
mod words;

use super::arguments::{check_free, finite, positive};
use super::output::{columns, detail, print, print_text};
use clap::Subcommand;
use import::import;
use miette::{IntoDiagnostic, Result, miette};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use wakemix::control::baseline::Constants;
use wakemix::formats::turbine_file::TurbineFile;
use wakemix::formats::{atomic, library, openfast, windio};
use wakemix::report::text_table::{Column, TextTable};
use wakemix::study::{OffsetAnswer, OffsetQuestion, azimuth_offset};
use wakemix::turbine::Definition;
use wakemix::turbine::aero::blade_element::Theory;
use wakemix::turbine::steady::{Coefficients, SteadyRotor};
use words::{blade_mass, power, swashplate};

/// What to do with turbines.
#[derive(Debug, Subcommand)]
pub(crate) enum TurbineCommand {
    /// List the turbines that come with the program
    List,
    /// Describe a turbine: geometry, masses, ratings, and where every figure comes from
    Show {
        /// Name of the library, or path of a turbine file
        name: String,
        /// Print the whole file of a library turbine instead
        #[arg(long)]
        file: bool,
    },
    /// Convert an OpenFAST deck (.fst) or a windIO file (.yaml) into a turbine file
    ///
    /// Of a windIO file, mode shapes and controller gains are worked out where it has what they follow from.
    /// What it lacks beside, such as the generator's inertia, is listed with a template, OUTPUT's name with
    /// the end .missing.toml, to be filled in and given back with --complete; the exit code is 2 until the
    /// file is complete.
    Import {
        /// Main file of the deck, or the windIO file
        file: PathBuf,
        /// Turbine file to write (TOML)
        #[arg(short, long)]
        output: PathBuf,
        /// Put the new file in the place of an old one
        #[arg(long)]
        overwrite: bool,
        /// Short name, such as iea-15mw; the stem of OUTPUT when left out
        #[arg(long)]
        name: Option<String>,
        /// Name in words; the input's own title when left out
        #[arg(long)]
        title: Option<String>,
        /// Where the input comes from (publication, commit), noted with every group of figures
        #[arg(long)]
        source: Option<String>,
        /// Which polar of a windIO airfoil to take where it has several: words in its configuration, such as
        /// "fully turbulent"
        #[arg(long, value_name = "WORDS")]
        polars: Option<String>,
        /// Which polar of a windIO airfoil to take where it has several: that of the nearest Reynolds number
        #[arg(long, value_name = "RE", value_parser = positive)]
        reynolds: Option<f64>,
        /// File (TOML) with figures that the windIO file lacks, in the groups and keys of a turbine file
        #[arg(long, value_name = "FILE")]
        complete: Option<PathBuf>,
    },
    /// Print coefficients of power, thrust and torque of the rigid rotor in steady wind as CSV
    Steady {
        /// Name of the library, or path of a turbine file
        name: String,
        /// Tip-speed ratios, FROM:TO:COUNT or one value
        #[arg(long, value_name = "A:B:N", default_value = "4:12:17")]
        tsr: Range,
        /// Pitch angles (degrees), FROM:TO:COUNT or one value
        #[arg(long, value_name = "A:B:N", default_value = "0", allow_hyphen_values = true)]
        pitch: Range,
    },
    /// Find the azimuth offset that decouples tilt from yaw, over wind speed, as CSV
    Offset {
        /// Name of the library, or path of a turbine file
        name: String,
        /// Steady wind speeds (m/s), FROM:TO:COUNT or one value
        #[arg(long, value_name = "A:B:N", default_value = "9")]
        wind: Range,
        /// Strouhal number of the identification helices, with the wind and the rotor's diameter
        #[arg(long, value_name = "ST", default_value_t = 0.25, value_parser = positive)]
        strouhal: f64,
        /// Blades and tower that do not bend
        #[arg(long)]
        rigid: bool,
    },
}

/// Equally spaced values, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    from: f64,
    to: f64,
    count: usize,
}

impl Range {
    fn values(self) -> impl Iterator<Item = f64> {
        let steps = self.count.saturating_sub(1).max(1) as f64;
        (0..self.count).map(move |k| self.from + (self.to - self.from) * k as f64 / steps)
    }
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str| {
            finite(part).map_err(|_| {
                format!("\"{part}\" is not a number; write FROM:TO:COUNT, as in 6:11:11")
            })
        };
        let parts: Vec<&str> = text.split(':').collect();
        match parts[..] {
            [value] => Ok(Self { from: number(value)?, to: number(value)?, count: 1 }),
            [from, to, count] => {
                let count = count.trim().parse().ok().filter(|count| (1..=100_000).contains(count));
                let count =
                    count.ok_or("COUNT is a whole number from 1 to 100000, as in 6:11:11")?;
                Ok(Self { from: number(from)?, to: number(to)?, count })
            }
            _ => Err("write FROM:TO:COUNT, as in 6:11:11, or one value".to_owned()),
        }
    }
}

/// Runs `command`; data goes to stdout.
///
/// # Errors
/// Input that cannot be read, and output that cannot be written.
pub(crate) fn run(command: TurbineCommand) -> Result<()> {
    match command {
        TurbineCommand::List => list(),
        TurbineCommand::Show { name, file: false } => show(&load(&name)?),
        TurbineCommand::Show { name, file: true } => {
            let text = library::text(&name).map_or_else(
                || {
                    Ok::<_, miette::Report>(atomic::read_text(
                        Path::new(&name),
                        "the turbine file",
                    )?)
                },
                |text| Ok(text.to_owned()),
            )?;
            print(&text)
        }
        TurbineCommand::Import {
            file,
            output,
            overwrite,
            name,
            title,
            source,
            polars,
            reynolds,
            complete,
        } => {
            check_free(std::slice::from_ref(&output), overwrite)?;
            let stem = output.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            let options = openfast::ImportOptions { name: name.or(stem), title, source };
            let polars = windio::PolarChoice { configuration: polars, reynolds_number: reynolds };
            let further = windio::WindioOptions { polars, completion: complete };
            import(&file, &output, &options, &further)
        }
        TurbineCommand::Steady { name, tsr, pitch } => steady(&load(&name)?, tsr, pitch),
        TurbineCommand::Offset { name, wind, strouhal, rigid } => {
            offset(&name, wind, strouhal, !rigid)
        }
    }
}

/// The turbine of the library called `name`, or that of the file at that path.
fn load(name: &str) -> Result<TurbineFile> {
    let turbine = library::load(name)?;
    let of_library = library::text(name).is_some();
    let place = if of_library { ", which comes with the program" } else { "" };
    detail(&format!("read: turbine {name}{place}"));
    Ok(turbine)
}

fn list() -> Result<()> {
    let numbers = ["rated MW", "diameter m", "hub m"].map(Column::number);
    let headings = numbers.into_iter().chain([Column::words("")]);
    let mut table = TextTable::new([Column::words("name")], headings);
    for name in library::names() {
        let TurbineFile { title, definition, .. } = library::load(name)?;
        table.row([
            name.to_owned(),
            format!("{:.1}", 1e-6 * definition.rated_power),
            format!("{:.1}", definition.rotor_diameter()),
            format!("{:.1}", definition.rotor.hub_height),
            title,
        ]);
    }
    print(&table.fitted(columns()))
}

fn show(file: &TurbineFile) -> Result<()> {
    let TurbineFile { title, definition, controller, sources } = file;
    let ratio = controller.optimal_tip_speed_ratio;
    let best =
        SteadyRotor::new(definition, Theory::default()).coefficients(ratio, controller.fine_pitch);
    let mut text = format!("{}: {title}\n\n", definition.name);
    for (what, value) in rows(definition, controller, &best) {
        text += &format!("{what:24} {value}\n");
    }
    text += "\nsources\n";
    for (group, source) in sources {
        text += &format!("{group:16} {source}\n");
    }
    print_text(&text)
}

/// What there is to know of a turbine at a glance; `best` are its coefficients at the optimal tip-speed
/// ratio.
fn rows(
    definition: &Definition,
    controller: &Constants,
    best: &Coefficients,
) -> [(&'static str, String); 14] {
    [
        ("blades", definition.n_blades.to_string()),
        (
            "swept diameter",
            format!(
                "{:.2} m (tip radius {} m along the blade)",
                definition.rotor_diameter(),
                definition.rotor.tip_radius
            ),
        ),
        ("hub height", format!("{:.2} m", definition.rotor.hub_height)),
        (
            "precone, tilt, overhang",
            format!(
                "{:.2}°, {:.2}°, {:.2} m",
                definition.rotor.precone.to_degrees(),
                definition.rotor.shaft_tilt.to_degrees(),
                definition.rotor.overhang
            ),
        ),
        (
            "tower",
            format!(
                "{:.1} m to {:.1} m, {:.2} m to {:.2} m wide",
                definition.tower.base_height,
                definition.tower.top_height,
                definition.tower.profile.first().map_or(0.0, |p| p.diameter),
                definition.tower.profile.last().map_or(0.0, |p| p.diameter)
            ),
        ),
        ("cut-in, cut-out", operation(definition)),
        (
            "rated",
            format!(
                "{} at {:.3} rpm",
                power(definition.rated_power),
                definition.rated_rotor_speed * 30.0 / std::f64::consts::PI
            ),
        ),
        ("blade mass", blade_mass(definition.blade_mass())),
        (
            "inertia about the shaft",
            format!(
                "{:.4e} kg m2 rotor, {:.4e} kg m2 with generator",
                definition.rotor_inertia(),
                definition.drive_train_inertia()
            ),
        ),
        ("generator to grid", format!("{:.4}", definition.efficiency())),
        (
            "pitch actuator",
            format!(
                "{:.3} rad/s, damping {:.3}, {:.1} deg/s, {:.1}° to {:.1}°",
                definition.pitch_actuator.natural_frequency,
                definition.pitch_actuator.damping_ratio,
                definition.pitch_actuator.maximum_rate.to_degrees(),
                definition.pitch_actuator.minimum_pitch.to_degrees(),
                definition.pitch_actuator.maximum_pitch.to_degrees()
            ),
        ),
        ("swashplate", swashplate(definition)),
        (
            "best tip-speed ratio",
            format!(
                "{:.2}: power coefficient {:.4}, thrust coefficient {:.4} (rigid, pitch {:.2}°)",
                controller.optimal_tip_speed_ratio,
                best.power,
                best.thrust,
                controller.fine_pitch.to_degrees()
            ),
        ),
        (
            "tables",
            format!(
                "{} stations, {} polars, {} structural sections",
                definition.blade.len(),
                definition.polars.len(),
                definition.blade_structure.sections.len()
            ),
        ),
    ]
}

/// Between which mean wind speeds a turbine works, in words.
fn operation(definition: &Definition) -> String {
    definition.operation.map_or_else(
        || "not stated".to_owned(),
        |operation| format!("{:.1} m/s, {:.1} m/s", operation.cut_in, operation.cut_out),
    )
}

fn steady(file: &TurbineFile, tsr: Range, pitch: Range) -> Result<()> {
    let rotor = SteadyRotor::new(&file.definition, Theory::default());
    let mut text = BufWriter::new(Vec::new());
    writeln!(text, "tsr,pitch_deg,cp,ct,cq").into_diagnostic()?;
    for ratio in tsr.values() {
        for pitch_deg in pitch.values() {
            let c = rotor.coefficients(ratio, pitch_deg.to_radians());
            writeln!(text, "{ratio},{pitch_deg},{:.6},{:.6},{:.6}", c.power, c.thrust, c.torque)
                .into_diagnostic()?;
        }
    }
    let bytes = text.into_inner().map_err(|error| miette!("{error}"))?;
    print(&String::from_utf8_lossy(&bytes))
}

/// Nothing when the turbine called `name` works in all of `wind`.
fn check_wind(name: &str, wind: Range) -> Result<()> {
    let Some(operation) = load(name)?.definition.operation else { return Ok(()) };
    let works = operation.cut_in..=operation.cut_out;
    match [wind.from, wind.to].into_iter().find(|speed| !works.contains(speed)) {
        Some(speed) => Err(miette!(
            help = format!("take winds from {} to {} m/s", works.start(), works.end()),
            "--wind {speed}: {name} stands still in that wind"
        )),
        None => Ok(()),
    }
}

fn offset(name: &str, wind: Range, strouhal: f64, flexible: bool) -> Result<()> {
    check_wind(name, wind)?;
    let mut head = "wind_speed_m_s,azimuth_offset_deg,delay_s,moment_per_degree_mnm,\
                    relative_gain_without,relative_gain_with\n";
    for wind_speed in wind.values() {
        let question = OffsetQuestion { model: name.to_owned(), wind_speed, strouhal, flexible };
        let OffsetAnswer { decoupling, relative_gain: [without, with] } =
            azimuth_offset(&question)?;
        // Not before there is something to say: a question that cannot be answered leaves nothing.
        print(std::mem::take(&mut head))?;
        print(&format!(
            "{wind_speed},{:.2},{:.3},{:.4},{without:.4},{with:.4}\n",
            decoupling.azimuth_offset.to_degrees(),
            decoupling.delay,
            1e-6 * decoupling.gain.to_radians(),
        ))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_include_both_ends() {
        let range: Range = "6:11:11".parse().unwrap();
        let values: Vec<f64> = range.values().collect();
        assert_eq!((values.len(), values[0], values[1], values[10]), (11, 6.0, 6.5, 11.0));
        assert_eq!("-2".parse::<Range>().unwrap().values().collect::<Vec<_>>(), [-2.0]);
        for bad in ["6:11", "a", "6:11:0", "6:11:1.5", "1:2:3:4"] {
            assert!(bad.parse::<Range>().is_err(), "{bad}");
        }
    }
}
