//! `wakemix surrogate train`: a surrogate of each output of a table.

use super::print::{outputs_text, parameters_text, train_json, validations_text};
use crate::commands::arguments::positive;
use crate::commands::output::{print_json, print_text, tell, warn};
use clap::{Args, ValueEnum};
use design::SurrogateTrend;
use design::regression::{
    KernelText, Scatter, TrainQuestion, Trained, draw_surrogate, fit_in_words, train,
};
use miette::Result;
use serde_json::json;
use std::path::{Path, PathBuf};
use wakemix::formats::atomic;

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
    /// Table: CSV with names in its first line, or .parquet
    file: PathBuf,
    /// Columns of the inputs, such as wind,turbulence,yaw
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    inputs: Vec<String>,
    /// Column of what is predicted; of several, such as power,RootMyb1, each becomes a surrogate of its own
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    output: Vec<String>,
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
    /// File to write the surrogate into (JSON), of several outputs a folder for a file of each; none when
    /// left out
    #[arg(short = 'o', long = "model", value_name = "FILE")]
    model: Option<PathBuf>,
    /// Folder to draw what was kept aside, cuts and a map into; of several outputs a folder in it for each
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// A share above zero and not above one.
fn share(text: &str) -> Result<f64, String> {
    let found = positive(text).ok().filter(|share| *share <= 1.0);
    found.ok_or_else(|| format!("\"{text}\" is no share: give one above 0, and 1 at most"))
}

/// Trains the surrogates that are asked for.
///
/// # Errors
/// A table that cannot be used, files that cannot be written.
pub(super) fn run(arguments: &TrainArguments) -> Result<()> {
    let mut all = Vec::new();
    for output in &arguments.output {
        let found = train(&arguments.question(output))?;
        let is_alone = arguments.output.len() == 1;
        let before = if is_alone { String::new() } else { format!("{}: ", output.trim()) };
        found.warnings.iter().for_each(|text| warn(&format!("{before}{text}")));
        arguments.keep(output, &found)?;
        all.push(found);
    }
    if arguments.json {
        let mut found: Vec<_> = all.iter().map(train_json).collect();
        return print_json(&match found.len() {
            1 => found.remove(0),
            _ => json!({ "outputs": found }),
        });
    }
    let [found] = &all[..] else { return print_text(&outputs_text(&all)) };
    let [n_rows, n_training, n_test] = found.n;
    let lead =
        format!("{n_rows} rows; {n_training} different inputs trained on, {n_test} kept aside\n");
    let rows = [
        ("trained on", found.on_training),
        ("kept aside", found.on_test),
        ("each left out", found.left_out),
    ];
    let unit = &found.model.output.unit;
    print_text(&(lead + &parameters_text(&found.model) + &validations_text(&rows, unit)))
}

/// `output` as the name of a file.
fn file_name(output: &str) -> String {
    let letter = |letter: char| match letter {
        '/' | '\\' | ':' => '-',
        other => other,
    };
    output.trim().chars().map(letter).collect()
}

impl TrainArguments {
    fn question(&self, output: &str) -> TrainQuestion {
        TrainQuestion {
            file: self.file.clone(),
            inputs: self.inputs.clone(),
            output: output.trim().to_owned(),
            kernel: self.kernel.clone(),
            trend: match self.trend {
                Trend::Zero => SurrogateTrend::Zero,
                Trend::Constant => SurrogateTrend::Constant,
                Trend::Linear => SurrogateTrend::Linear,
            },
            deviation: self.deviation.clone(),
            group: self.group.clone(),
            estimates_noise: self.noise == Noise::Estimated,
            split: self.split,
            seed: self.seed,
            n_starts: self.starts,
            n_inducing: self.inducing,
        }
    }

    /// Where what belongs to `output` goes in `path`: there itself, or among several in that folder.
    fn place_of(&self, output: &str, path: &Path, ending: &str) -> PathBuf {
        match self.output.len() {
            1 => path.to_owned(),
            _ => path.join(file_name(output) + ending),
        }
    }

    /// Writes and draws the surrogate of `output`.
    fn keep(&self, output: &str, found: &Trained) -> Result<()> {
        let model = self.model.as_ref().map(|path| self.place_of(output, path, ".json"));
        if let Some(path) = &model {
            if let Some(folder) = path.parent().filter(|_| self.output.len() > 1) {
                atomic::create_folder(folder)?;
            }
            found.model.write(path)?;
            tell(&format!("model: {}", path.display()));
        }
        let Some(folder) = &self.figures else { return Ok(()) };
        let folder = self.place_of(output, folder, "");
        let fit = fit_in_words(&[("trained on", found.on_training), ("kept aside", found.on_test)]);
        let pairs = &found.test_pairs;
        let scatter = (!pairs.is_empty()).then_some(Scatter { pairs, fit });
        let two = (found.model.inputs.len() > 1).then_some([0, 1]);
        let path = model.as_deref().unwrap_or(&self.file);
        let names = draw_surrogate(&found.model, path, scatter, two, &folder)?;
        tell(&format!("drawn in {}: {}", folder.join("figures").display(), names.join(", ")));
        Ok(())
    }
}
