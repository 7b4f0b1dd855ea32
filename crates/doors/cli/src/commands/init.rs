//! `wakemix init`: a commented case file to begin with.

use super::arguments::{check_free, finite, positive};
use super::output::tell;
use clap::{Args, ValueEnum};
use miette::{Result, miette};
use std::path::{Path, PathBuf};
use wakemix::formats::{atomic, case, library};

/// Share of the wind's speed at which a wake is reckoned to travel (–).
const WAKE_SPEED: f64 = 0.6;
/// What the time that is not analysed is rounded up to, and has at least beyond the wake's passage (s).
const ROUNDED_TO: f64 = 100.0;
/// Cells across a rotor (–).
const CELLS: u8 = 12;
/// Strouhal number of the helix (–).
const STROUHAL: f64 = 0.25;
/// Blocks of ten minutes that are analysed (–).
const BLOCKS: f64 = 3.0;
/// Most turbines that are written (–).
const MOST_TURBINES: u64 = 50;

/// Sense of the helix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Sense {
    /// Counter-clockwise, looking downwind
    Ccw,
    /// Clockwise
    Cw,
}

/// Arguments of `wakemix init`.
#[derive(Args)]
pub(crate) struct InitArguments {
    /// File to write
    #[arg(default_value = "case.toml")]
    file: PathBuf,
    /// Turbine of the library (`wakemix turbine list`), or path of a turbine file, relative to FILE
    #[arg(long, value_name = "MODEL", default_value = "iea-15mw")]
    turbine: String,
    /// Turbines in the row
    #[arg(
        long,
        value_name = "N",
        default_value_t = 2,
        value_parser = clap::value_parser!(u64).range(1..=MOST_TURBINES)
    )]
    turbines: u64,
    /// Distance from turbine to turbine, in rotor diameters
    #[arg(long, value_name = "D", default_value_t = 5.0, value_parser = positive)]
    spacing: f64,
    /// Wind speed at hub height (m/s)
    #[arg(long, value_name = "M/S", default_value_t = 9.0, value_parser = positive)]
    speed: f64,
    /// Amplitude of the helix on the first turbine (degrees); 0 for no run with a helix
    #[arg(long, value_name = "DEG", default_value_t = 4.0, value_parser = finite)]
    helix: f64,
    /// Sense of the helix
    #[arg(long, value_enum, default_value = "ccw")]
    sense: Sense,
    /// Put the new file in the place of an old one
    #[arg(long)]
    overwrite: bool,
}

/// Writes the case that `arguments` ask for; it can be run as it stands.
///
/// # Errors
/// A file that is there already or cannot be written, a turbine that cannot be read, values that make no
/// case.
pub(crate) fn run(arguments: &InitArguments) -> Result<()> {
    let file = &arguments.file;
    check_free(std::slice::from_ref(file), arguments.overwrite)?;
    let diameter = diameter(arguments)?;
    let text = text(arguments, diameter);
    // The values are the user's: what the reader does not take is refused before it is written.
    case::parse(&file.display().to_string(), &text, &[])?;
    atomic::write(file, "the case file", text.as_bytes())?;
    tell(&format!("wrote {}", file.display()));
    tell(&format!("next: wakemix run {} --dry-run says what it costs", file.display()));
    Ok(())
}

/// Rotor diameter (m) of the turbine that is asked for.
fn diameter(arguments: &InitArguments) -> Result<f64> {
    let model = &arguments.turbine;
    let turbine = match library::text(model) {
        Some(_) => library::load(model),
        None => {
            let folder = arguments.file.parent().unwrap_or(Path::new(""));
            let path = folder.join(model);
            let known = path.is_file().then(|| path.display().to_string());
            library::load(&known.unwrap_or_else(|| model.clone()))
        }
    }?;
    let definition = &turbine.definition;
    if let Some(operation) = definition.operation
        && !(operation.cut_in..=operation.cut_out).contains(&arguments.speed)
    {
        let (cut_in, cut_out) = (operation.cut_in, operation.cut_out);
        return Err(miette!(
            help = format!("take a wind from {cut_in} to {cut_out} m/s"),
            "--speed {}: {model} stands still in that wind",
            arguments.speed
        ));
    }
    Ok(definition.rotor_diameter())
}

/// The case file, its comments true for a rotor of `diameter` (m).
fn text(arguments: &InitArguments, diameter: f64) -> String {
    let interval =
        line("plane_interval = 60.0", "s, wind at single instants, for the report's pictures");
    [
        head(arguments, diameter),
        turbines(arguments),
        runs(arguments, diameter),
        format!("\n[output]\n{interval}"),
    ]
    .concat()
}

/// Name, wind, grid and time.
fn head(arguments: &InitArguments, diameter: f64) -> String {
    let InitArguments { file, turbines, spacing, speed, .. } = arguments;
    let length = (*turbines - 1) as f64 * spacing * diameter;
    let passage = length / (WAKE_SPEED * speed);
    let spin_up = ((passage + ROUNDED_TO) / ROUNDED_TO).ceil() * ROUNDED_TO;
    let duration = spin_up + 600.0 * BLOCKS;
    let wake = format!(
        "s, not analysed: at {:.0} % of the wind's speed a wake takes {passage:.0} s to the last turbine",
        100.0 * WAKE_SPEED
    );
    [
        "# Written by `wakemix init`. docs/case-file.md explains every key; `wakemix schema` prints the schema with\n\
         # which editors complete keys. A key that is left out takes its default.\n"
            .to_owned(),
        format!("name = {}\n\n[wind]\n", quoted(&name_of(file))),
        line(&format!("speed = {speed:?}"), "m/s at hub height"),
        line("turbulence_intensity = 0.06", "standard deviation over mean speed"),
        line("shear_exponent = 0.1", "power law; the default"),
        line("seed = 1", "another seed is another turbulence of the same kind"),
        "\n[flow]\n".to_owned(),
        line(
            &format!("cells_per_diameter = {CELLS}"),
            &format!("coarse, {:.1} m: for a first look; 16 and more are for results", diameter / f64::from(CELLS)),
        ),
        "\n[time]\n".to_owned(),
        line(&format!("spin_up = {spin_up:?}"), &wake),
        line(
            &format!("duration = {duration:?}"),
            &format!("s, in all: {BLOCKS:.0} blocks of ten minutes are analysed"),
        ),
    ]
    .concat()
}

/// Name of the case in `file`: its own, with a dash for what no name may have.
fn name_of(file: &Path) -> String {
    let stem = file.file_stem().map_or("case".into(), |stem| stem.to_string_lossy());
    let plain = |c: char| if c.is_alphanumeric() || c == '_' { c } else { '-' };
    stem.chars().map(plain).take(64).collect()
}

/// The row.
fn turbines(arguments: &InitArguments) -> String {
    let mut text =
        "\n# Positions are in rotor diameters: x downwind, y to the left looking downwind.\n"
            .to_owned();
    for place in 0..arguments.turbines {
        text += &format!(
            "[[turbine]]\nname = \"T{}\"\nmodel = {}\nposition_diameters = [{:?}, 0.0]\n\n",
            place + 1,
            quoted(&arguments.turbine),
            place as f64 * arguments.spacing,
        );
    }
    text
}

/// A run without control of its own and, where asked for, one with a helix.
fn runs(arguments: &InitArguments, diameter: f64) -> String {
    let InitArguments { speed, helix, .. } = arguments;
    let mut text =
        "# All runs have the same wind. Without control of its own a turbine is greedy: each for itself.\n\
         [[run]]\nname = \"baseline\"\n"
            .to_owned();
    if *helix != 0.0 {
        let (sense, words) = match arguments.sense {
            Sense::Ccw => ("ccw", "counter-clockwise"),
            Sense::Cw => ("cw", "clockwise"),
        };
        let period = diameter / (STROUHAL * speed);
        text += &format!(
            "\n\
             # A helix on T1: its blades pitch by {helix:?}° one after the other, so that the wake turns {words}\n\
             # looking downwind, once in {period:.0} s (Strouhal number {STROUHAL}). Gains are against the first run.\n\
             [[run]]\n\
             name = \"helix-{sense}\"\n\
             control.T1 = {{ kind = \"helix\", sense = \"{sense}\", amplitude_deg = {helix:?}, strouhal = {STROUHAL} }}\n",
        );
    }
    text
}

/// `setting` with `comment` behind it.
fn line(setting: &str, comment: &str) -> String {
    format!("{setting:<33}# {comment}\n")
}

/// `text` as a string of TOML.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use wakemix::farm::case::Case;
    use wakemix::study::Prepared;

    fn arguments(file: PathBuf) -> InitArguments {
        InitArguments {
            file,
            turbine: "iea-15mw".to_owned(),
            turbines: 2,
            spacing: 5.0,
            speed: 9.0,
            helix: 4.0,
            sense: Sense::Ccw,
            overwrite: false,
        }
    }

    fn case_of(arguments: &InitArguments) -> (Case, String) {
        run(arguments).unwrap();
        let text = fs::read_to_string(&arguments.file).unwrap();
        // Not the reader alone: turbines, layout and control fit as well.
        (Prepared::read(&arguments.file, &[]).unwrap().case, text)
    }

    #[test]
    fn what_is_asked_for_is_written_and_can_be_run() {
        let folder = tempfile::tempdir().unwrap();
        let usual = arguments(folder.path().join("my row.toml"));
        let (case, _) = case_of(&usual);
        assert_eq!((case.name.as_str(), case.turbines.len(), case.runs.len()), ("my-row", 2, 2));
        assert!(run(&usual).unwrap_err().to_string().contains("is there already"));
        let other = InitArguments {
            turbine: "nrel-5mw".to_owned(),
            turbines: 8,
            spacing: 6.5,
            speed: 11.0,
            helix: 0.0,
            overwrite: true,
            ..usual
        };
        let (case, text) = case_of(&other);
        assert_eq!((case.turbines.len(), case.runs.len(), case.wind.speed), (8, 1, 11.0));
        assert!(!text.contains("helix"), "{text}");
        assert!(case.turbines.iter().all(|turbine| turbine.model == "nrel-5mw"));
        let still = InitArguments { speed: 39.0, ..arguments(folder.path().join("a.toml")) };
        assert!(run(&still).unwrap_err().to_string().contains("stands still"));
        let unknown = arguments(folder.path().join("b.toml"));
        assert!(run(&InitArguments { turbine: "iea-9mw".to_owned(), ..unknown }).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// Numbers in comments are those of the case.
    #[test]
    fn comments_are_true() {
        let folder = tempfile::tempdir().unwrap();
        for (name, n_turbines, speed, sense) in
            [("a", 1, 6.0, Sense::Cw), ("b", 3, 10.5, Sense::Ccw), ("c", 8, 24.0, Sense::Cw)]
        {
            let file = folder.path().join(format!("{name}.toml"));
            let wanted = InitArguments { turbines: n_turbines, speed, sense, ..arguments(file) };
            let (case, text) = case_of(&wanted);
            let prepared = Prepared::read(&wanted.file, &[]).unwrap();
            let says = |words: String| assert!(text.contains(&words), "{words}: {text}");
            says(format!("coarse, {:.1} m", prepared.plan.spacing));
            let last = case.turbines.iter().map(|turbine| turbine.position.own()[0]);
            let length = last.fold(0.0, f64::max) * prepared.plan.diameter;
            let passage = length / (WAKE_SPEED * speed);
            says(format!("a wake takes {passage:.0} s to the last turbine"));
            assert!(case.time.spin_up >= passage + 100.0);
            assert_eq!(case.time.duration - case.time.spin_up, 1800.0);
            says(format!("{:.0} blocks of ten minutes", BLOCKS));
            let period = prepared.plan.diameter / (0.25 * speed);
            says(format!("once in {period:.0} s (Strouhal number 0.25)"));
            says(format!("turns {}", if sense == Sense::Cw { "clockwise" } else { "counter-" }));
            // "The default", with that key left out.
            let without = text.replace("shear_exponent", "# shear_exponent");
            fs::write(&wanted.file, without).unwrap();
            let default = Prepared::read(&wanted.file, &[]).unwrap().case;
            assert_eq!(default.wind.shear, case.wind.shear);
            assert_eq!(case.runs[0].name, "baseline");
        }
    }
}
