//! `wakemix surrogate`: Gaussian processes from tables, trained, asked, validated and shown.

mod print;

use self::print::{parameters_json, parameters_text, train_json, validate_json, validations_text};
use super::arguments::positive;
use super::output::{print_json, print_text, tell, warn};
use clap::{Args, Subcommand, ValueEnum};
use design::regression::{
    KernelText, PredictQuestion, TrainQuestion, ValidateQuestion, cuts, draw_surrogate, predict,
    train, validate,
};
use design::{SurrogateModel, SurrogateTrend};
use miette::{Result, miette};
use serde_json::json;
use std::path::PathBuf;

/// Subcommands of `wakemix surrogate`.
#[derive(Subcommand)]
pub(crate) enum SurrogateCommand {
    /// Train a surrogate on the rows of a table, and test it on those kept aside
    Train(TrainArguments),
    /// Predict at the rows of a table, with bands
    Predict(PredictArguments),
    /// Hold a surrogate against the rows of a table
    Validate(ValidateArguments),
    /// Print hyperparameters and cuts of a surrogate, or draw it
    Show(ShowArguments),
}

/// Mean far from all data.
#[derive(Clone, Copy, ValueEnum)]
enum Trend {
    /// Zero
    Zero,
    /// A constant
    Constant,
    /// A constant and a slope for each input
    Linear,
}

/// Where noise comes from.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Noise {
    /// Estimated, beyond what --deviation knows
    Estimated,
    /// What --deviation knows alone
    Known,
}

/// Arguments of `wakemix surrogate train`.
#[derive(Args)]
pub(crate) struct TrainArguments {
    /// CSV with names in its first line
    file: PathBuf,
    /// Columns of the inputs, such as wind,turbulence,yaw
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    inputs: Vec<String>,
    /// Column of what is predicted
    #[arg(long, value_name = "NAME")]
    output: String,
    /// Kernel: se, matern32, matern52, rq, periodic(INPUT:PERIOD); inputs in parentheses, + and * between
    #[arg(long, value_name = "KERNEL", default_value = "matern52", value_parser = KernelText::new)]
    kernel: KernelText,
    /// Mean far from all data
    #[arg(long, value_enum, default_value = "constant")]
    trend: Trend,
    /// Whether a noise is estimated
    #[arg(long, value_enum, default_value = "estimated")]
    noise: Noise,
    /// Column with a known standard deviation of each value, in its unit
    #[arg(long, value_name = "NAME")]
    deviation: Option<String>,
    /// Column with the number of the noise group of each row: 0, 1, 2, …
    #[arg(long, value_name = "NAME")]
    group: Option<String>,
    /// Share of the different inputs that is trained on; the others test
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = share)]
    split: f64,
    /// Seed of the split and of the starts of the search
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Starts of the search
    #[arg(long, value_name = "N", default_value_t = 16)]
    starts: usize,
    /// Take so many inducing points instead of all data; above 10000 inputs it is 1000 when left out
    #[arg(long, value_name = "N")]
    inducing: Option<usize>,
    /// File to write the surrogate into (JSON); it is not written when left out
    #[arg(short = 'o', long = "model", value_name = "FILE")]
    model: Option<PathBuf>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Arguments of `wakemix surrogate predict`.
#[derive(Args)]
pub(crate) struct PredictArguments {
    /// Surrogate that `wakemix surrogate train` wrote
    model: PathBuf,
    /// CSV with its inputs
    file: PathBuf,
    /// CSV to write rows and predictions into
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Means without deviations: many times faster
    #[arg(long)]
    means: bool,
    /// Noise group of the observations whose deviation is told
    #[arg(long, value_name = "N", default_value_t = 0)]
    group: usize,
}

/// Arguments of `wakemix surrogate validate`.
#[derive(Args)]
pub(crate) struct ValidateArguments {
    /// Surrogate that `wakemix surrogate train` wrote
    model: PathBuf,
    /// CSV with its inputs and output
    file: PathBuf,
    /// Column with a known standard deviation of each value, in its unit
    #[arg(long, value_name = "NAME")]
    deviation: Option<String>,
    /// Column with the number of the noise group of each row: 0, 1, 2, …
    #[arg(long, value_name = "NAME")]
    group: Option<String>,
    /// Folder to draw predicted over true values into
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Arguments of `wakemix surrogate show`.
#[derive(Args)]
pub(crate) struct ShowArguments {
    /// Surrogate that `wakemix surrogate train` wrote
    model: PathBuf,
    /// Folder to draw the figures into, as SVG and PNG in its folder `figures`
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
    /// Two inputs to draw a map over; the first two when left out
    #[arg(long, value_name = "NAME", value_delimiter = ',', num_args = 1)]
    over: Vec<String>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// A share above zero and not above one.
fn share(text: &str) -> Result<f64, String> {
    let found = positive(text).ok().filter(|share| *share <= 1.0);
    found.ok_or_else(|| format!("\"{text}\" is no share: give one above 0, and 1 at most"))
}

/// Does what `command` asks for.
///
/// # Errors
/// Files that cannot be read, used or written.
pub(crate) fn run(command: &SurrogateCommand) -> Result<()> {
    match command {
        SurrogateCommand::Train(arguments) => run_train(arguments),
        SurrogateCommand::Predict(arguments) => run_predict(arguments),
        SurrogateCommand::Validate(arguments) => run_validate(arguments),
        SurrogateCommand::Show(arguments) => run_show(arguments),
    }
}

fn run_train(arguments: &TrainArguments) -> Result<()> {
    let trend = match arguments.trend {
        Trend::Zero => SurrogateTrend::Zero,
        Trend::Constant => SurrogateTrend::Constant,
        Trend::Linear => SurrogateTrend::Linear,
    };
    let found = train(&TrainQuestion {
        file: arguments.file.clone(),
        inputs: arguments.inputs.clone(),
        output: arguments.output.clone(),
        kernel: arguments.kernel.clone(),
        trend,
        deviation: arguments.deviation.clone(),
        group: arguments.group.clone(),
        estimates_noise: arguments.noise == Noise::Estimated,
        split: arguments.split,
        seed: arguments.seed,
        n_starts: arguments.starts,
        n_inducing: arguments.inducing,
    })?;
    found.warnings.iter().for_each(|text| warn(text));
    if let Some(path) = &arguments.model {
        found.model.write(path)?;
        tell(&format!("model: {}", path.display()));
    }
    if arguments.json {
        return print_json(&train_json(&found));
    }
    let [n_rows, n_training, n_test] = found.n;
    let unit = &found.model.output.unit;
    let lead =
        format!("{n_rows} rows; {n_training} different inputs trained on, {n_test} kept aside\n");
    let rows = [
        ("trained on", found.on_training),
        ("kept aside", found.on_test),
        ("each left out", found.left_out),
    ];
    print_text(&(lead + &parameters_text(&found.model) + &validations_text(&rows, unit)))
}

fn run_predict(arguments: &PredictArguments) -> Result<()> {
    let found = predict(&PredictQuestion {
        model: arguments.model.clone(),
        file: arguments.file.clone(),
        means_only: arguments.means,
        group: arguments.group,
    })?;
    found.warnings.iter().for_each(|text| warn(text));
    found.write(&arguments.output)?;
    tell(&format!("{} predictions: {}", found.means.len(), arguments.output.display()));
    Ok(())
}

fn run_validate(arguments: &ValidateArguments) -> Result<()> {
    let found = validate(&ValidateQuestion {
        model: arguments.model.clone(),
        file: arguments.file.clone(),
        deviation: arguments.deviation.clone(),
        group: arguments.group.clone(),
    })?;
    found.warnings.iter().for_each(|text| warn(text));
    if let Some(folder) = &arguments.figures {
        let (model, pairs) = (&found.model, Some(&found.pairs[..]));
        let names = draw_surrogate(model, &arguments.model, pairs, None, folder)?;
        tell(&format!("drawn in {}: {}", folder.join("figures").display(), names.join(", ")));
    }
    if arguments.json {
        return print_json(&validate_json(&found));
    }
    let rows = [("table", found.on_table), ("each training input left out", found.left_out)];
    print_text(&validations_text(&rows, &found.model.output.unit))
}

fn run_show(arguments: &ShowArguments) -> Result<()> {
    let model = SurrogateModel::read(&arguments.model)?;
    if let Some(folder) = &arguments.figures {
        let two = two_of(&arguments.over, &model)?;
        let names = draw_surrogate(&model, &arguments.model, None, two, folder)?;
        tell(&format!("drawn in {}: {}", folder.join("figures").display(), names.join(", ")));
    }
    if arguments.json {
        let cuts = cuts(&model, &arguments.model)?;
        let cut = |cut: &design::regression::Cut| {
            json!({
                "input": model.inputs[cut.input].name,
                "places": cut.places,
                "means": cut.predictions.iter().map(|found| found.mean).collect::<Vec<_>>(),
                "deviations":
                    cut.predictions.iter().map(|found| found.standard_deviation).collect::<Vec<_>>(),
            })
        };
        let cuts: Vec<_> = cuts.iter().map(cut).collect();
        return print_json(&json!({ "parameters": parameters_json(&model), "cuts": cuts }));
    }
    print_text(&(format!("{}\n", model.description) + &parameters_text(&model)))
}

/// The inputs that a map goes over.
fn two_of(names: &[String], model: &SurrogateModel) -> Result<Option<[usize; 2]>> {
    let index = |name: &String| {
        let place = model.inputs.iter().position(|port| port.name == name.trim());
        place.ok_or_else(|| {
            let all: Vec<&str> = model.inputs.iter().map(|port| port.name.as_str()).collect();
            miette!(help = format!("give two of {}", all.join(", ")), "it has no input \"{name}\"")
        })
    };
    match names {
        [] => Ok((model.inputs.len() > 1).then_some([0, 1])),
        [first, second] => Ok(Some([index(first)?, index(second)?])),
        _ => Err(miette!(
            help = "such as --over wind,yaw",
            "a map goes over two inputs, not {}",
            names.len()
        )),
    }
}
