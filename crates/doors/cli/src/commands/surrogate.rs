//! `wakemix surrogate`: Gaussian processes from tables, trained, asked, validated and shown.

mod layout;
mod print;
mod train;

use self::print::{parameters_json, parameters_text, validate_json, validations_text};
use super::output::{print_json, print_text, tell, warn};
use clap::{Args, Subcommand};
use design::SurrogateModel;
use design::regression::{
    PredictQuestion, Scatter, ValidateQuestion, cuts, draw_surrogate, fit_in_words, predict,
    validate,
};
use miette::{Result, miette};
use serde_json::json;
use std::path::PathBuf;

/// Subcommands of `wakemix surrogate`.
#[derive(Subcommand)]
pub(crate) enum SurrogateCommand {
    /// Train a surrogate on the rows of a table, and test it on those kept aside
    Train(train::TrainArguments),
    /// Predict at the rows of a table, with bands
    Predict(PredictArguments),
    /// Hold a surrogate against the rows of a table
    Validate(ValidateArguments),
    /// Print hyperparameters and cuts of a surrogate, or draw it
    Show(ShowArguments),
    /// Predict power and loads of turbines behind one another, over the direction of the wind
    Layout(layout::LayoutArguments),
}

/// Arguments of `wakemix surrogate predict`.
#[derive(Args)]
pub(crate) struct PredictArguments {
    /// Surrogate that `wakemix surrogate train` wrote
    model: PathBuf,
    /// Table with its inputs: CSV, or .parquet
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
    /// Table with its inputs and output: CSV, or .parquet
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

/// Does what `command` asks for.
///
/// # Errors
/// Files that cannot be read, used or written.
pub(crate) fn run(command: &SurrogateCommand) -> Result<()> {
    match command {
        SurrogateCommand::Train(arguments) => train::run(arguments),
        SurrogateCommand::Predict(arguments) => run_predict(arguments),
        SurrogateCommand::Validate(arguments) => run_validate(arguments),
        SurrogateCommand::Show(arguments) => run_show(arguments),
        SurrogateCommand::Layout(arguments) => layout::run(arguments),
    }
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
        let fit = fit_in_words(&[("of the table", found.on_table)]);
        let scatter = Some(Scatter { pairs: &found.pairs, fit });
        let names = draw_surrogate(&found.model, &arguments.model, scatter, None, folder)?;
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
