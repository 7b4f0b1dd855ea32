//! `wakemix analyse`: what the records of runs tell. Arguments and help come from the list of analyses.

use super::arguments::finite;
use super::manner::says_remarks;
use super::output::{columns, detail, print_json, print_text, tell};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Command, Error, FromArgMatches, Subcommand, value_parser};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use miette::Result;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use wakemix::postprocessing::analyses::{
    ANALYSES, Analysis, AnalysisSetting, Of, Request, Takes, Told, Watch,
};

/// Steps of a bar.
const STEPS: u64 = 1000;
/// Name of the argument with the folders.
const FOLDERS: &str = "folders";

/// One analysis, and its settings.
pub(crate) struct AnalyseCommand {
    analysis: Analysis,
    request: Request,
    json: bool,
}

impl Subcommand for AnalyseCommand {
    fn augment_subcommands(command: Command) -> Command {
        command.subcommands(ANALYSES.iter().map(offered))
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        ANALYSES.iter().any(|analysis| analysis.name == name)
    }
}

impl FromArgMatches for AnalyseCommand {
    fn from_arg_matches(matches: &ArgMatches) -> std::result::Result<Self, Error> {
        requested(ANALYSES, matches)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> std::result::Result<(), Error> {
        *self = requested(ANALYSES, matches)?;
        Ok(())
    }
}

/// `analysis` as a command.
fn offered(analysis: &Analysis) -> Command {
    let folders = Arg::new(FOLDERS).required(true).value_parser(value_parser!(PathBuf));
    let folders = match analysis.of {
        Of::Run(about) => folders.value_name("RUN").help(about),
        Of::Runs(about) => folders.value_name("RUN").help(about).num_args(1..),
        Of::Studies(about) => folders.value_name("STUDY").help(about).num_args(1..),
    };
    let json = Arg::new("json")
        .long("json")
        .action(ArgAction::SetTrue)
        .help("Print JSON on stdout instead of text");
    Command::new(analysis.name)
        .about(analysis.about)
        .arg(folders)
        .args(analysis.settings.iter().map(argument))
        .arg(json)
}

/// `setting` as an argument.
fn argument(setting: &AnalysisSetting) -> Arg {
    let argument =
        Arg::new(setting.name).long(setting.name).value_name(setting.value).help(setting.about);
    match setting.takes {
        Takes::Text => argument,
        Takes::Texts => argument.action(ArgAction::Append),
        Takes::Number => argument.value_parser(finite),
        Takes::Choice(words) => {
            let word = |(word, about): &(&'static str, &'static str)| {
                PossibleValue::new(*word).help(*about)
            };
            argument.value_parser(PossibleValuesParser::new(words.iter().map(word)))
        }
    }
}

/// What `matches` ask of one of `analyses`.
fn requested(
    analyses: &[Analysis],
    matches: &ArgMatches,
) -> std::result::Result<AnalyseCommand, Error> {
    let missing = || Error::new(ErrorKind::MissingSubcommand);
    let (name, matches) = matches.subcommand().ok_or_else(missing)?;
    let analysis = analyses.iter().find(|analysis| analysis.name == name).ok_or_else(missing)?;
    let folders = matches.get_many::<PathBuf>(FOLDERS).into_iter().flatten().cloned();
    let mut request =
        Request { folders: folders.collect(), columns: Some(columns()), ..Request::default() };
    for setting in analysis.settings {
        for value in matches.get_raw(setting.name).into_iter().flatten() {
            request = request.with(setting.name, &value.to_string_lossy());
        }
    }
    Ok(AnalyseCommand { analysis: *analysis, request, json: matches.get_flag("json") })
}

/// Prints the answer; data goes to stdout.
///
/// # Errors
/// Records that cannot be read or lack what is needed.
pub(crate) fn run(command: &AnalyseCommand) -> Result<()> {
    for folder in &command.request.folders {
        detail(&format!("reading: {}", folder.display()));
    }
    let request = Request { watch: watch(), ..command.request.clone() };
    let answer = (command.analysis.run)(&request)?;
    for remark in &answer.remarks {
        tell(remark);
    }
    if command.json { print_json(&answer.json) } else { print_text(&answer.text) }
}

/// Says what an analysis tells while it works: its cost, and how far it is; now and then a line where nobody
/// sees a bar.
fn watch() -> Watch {
    let bar = if says_remarks() { ProgressBar::new(STEPS) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("[{bar:32}] {percent} %, about {eta} left") {
        bar.set_style(style.progress_chars("=> "));
    }
    let (is_drawn, told) = (std::io::stderr().is_terminal(), AtomicU64::new(0));
    Watch::new(move |what| match what {
        Told::Cost(text) => bar.suspend(|| tell(text)),
        Told::Share(share) => {
            let step = (share * STEPS as f64) as u64;
            bar.set_position(step);
            if step == STEPS {
                bar.finish_and_clear();
            }
            let tenth = 10 * step / STEPS;
            let is_new = told.fetch_max(tenth, Ordering::Relaxed) < tenth;
            if is_new && !is_drawn && tenth < 10 {
                tell(&format!("{tenth}0 %, about {} left", HumanDuration(bar.eta())));
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::postprocessing::PostprocessingError;
    use wakemix::postprocessing::analyses::Answer;

    /// Somebody's own analysis.
    const OWN: Analysis = Analysis {
        name: "own",
        about: "What nobody else asks",
        of: Of::Run("Folder of a run"),
        settings: &[AnalysisSetting {
            name: "times",
            value: "N",
            takes: Takes::Number,
            about: "Factor",
        }],
        run: |request| -> std::result::Result<Answer, PostprocessingError> {
            Ok(Answer { text: format!("{:?}\n", request.number("times")), ..Answer::default() })
        },
    };

    fn parsed(words: &[&str]) -> std::result::Result<AnalyseCommand, Error> {
        let list = [ANALYSES, &[OWN]].concat();
        let command = Command::new("analyse").subcommands(list.iter().map(offered));
        requested(&list, &command.try_get_matches_from(words)?)
    }

    #[test]
    fn arguments_come_from_the_descriptors() {
        let gains = ["analyse", "gains", "a", "b", "--run", "x", "--run", "y", "--json"];
        let gains = parsed(&gains).expect("sound words");
        assert_eq!(gains.request.folders, [PathBuf::from("a"), PathBuf::from("b")]);
        assert_eq!(gains.request.texts("run"), ["x", "y"]);
        assert!(gains.json);
        let phase = parsed(&["analyse", "phase", "a", "--estimator", "published", "--from", "60"]);
        let phase = phase.expect("sound words").request;
        assert_eq!(
            (phase.text("estimator"), phase.number("from")),
            (Some("published"), Some(60.0))
        );
        for wrong in [
            &["analyse", "phase", "a", "--estimator", "best"][..],
            &["analyse", "lock", "a", "--from", "noon"],
            &["analyse", "lock"],
            &["analyse", "phase", "a", "b"],
            &["analyse", "nothing", "a"],
        ] {
            assert!(parsed(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn an_analysis_of_ones_own_is_a_line_in_a_list() {
        let own = parsed(&["analyse", "own", "a", "--times", "2"]).expect("sound words");
        let answer = (own.analysis.run)(&own.request).expect("an answer");
        assert_eq!(answer.text, "Some(2.0)\n");
    }
}
