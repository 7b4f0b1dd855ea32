//! What there is to do after a study that was stopped: the same command once more.

use super::RunArguments;
use crate::commands::stop::shell_word;
use std::path::Path;
use wakemix::formats::records;

/// What there is to do after a study that was stopped, with its results in `directory`.
pub(super) fn interrupted(arguments: &RunArguments, directory: &Path) -> String {
    if arguments.dry_run {
        return "interrupted; a dry run leaves nothing to resume".to_owned();
    }
    // What lies there may be of the study that was to be overwritten.
    let kept = if arguments.overwrite {
        records::has_checkpoint(directory)
    } else {
        records::is_begun(directory)
    };
    let (what, how) = match (kept, arguments.overwrite) {
        (true, _) => ("interrupted; resume with", " --resume"),
        (false, true) => ("interrupted before anything was kept; begin again with", " --overwrite"),
        (false, false) => ("interrupted before anything was kept; begin again with", ""),
    };
    format!(
        "{what}: wakemix run {} -o {}{}{how}",
        shell_word(&arguments.case.display().to_string()),
        shell_word(&directory.display().to_string()),
        repeated(arguments)
    )
}

/// The runs and overrides of `arguments` as they were given, for the same command once more.
fn repeated(arguments: &RunArguments) -> String {
    let runs = arguments.runs.iter().map(|name| format!(" --run {}", shell_word(name)));
    let overrides = arguments.overrides.iter().map(|text| format!(" --set {}", shell_word(text)));
    let seeds = arguments.seeds.map(|n| format!(" --seeds {n}"));
    let jobs = arguments.jobs.map(|n| format!(" --jobs {n}"));
    runs.chain(overrides).chain(seeds).chain(jobs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::PathBuf;

    #[test]
    fn what_is_advised_is_what_there_is_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("out");
        let mut arguments = RunArguments {
            case: PathBuf::from("my case.toml"),
            output: None,
            runs: vec!["helix".to_owned()],
            seeds: None,
            jobs: None,
            overrides: Vec::new(),
            resume: false,
            overwrite: false,
            dry_run: true,
            check: false,
            json: false,
        };
        assert!(!interrupted(&arguments, &directory).contains("wakemix run"));
        arguments.dry_run = false;
        let place = shell_word(&directory.display().to_string());
        let begin = format!(
            "before anything was kept; begin again with: wakemix run 'my case.toml' -o {place} --run helix"
        );
        let advice = interrupted(&arguments, &directory);
        assert!(advice.ends_with(&begin), "{advice}");
        fs::create_dir_all(directory.join("helix")).unwrap();
        fs::write(directory.join("helix/manifest.json"), "{}").unwrap();
        let advice = interrupted(&arguments, &directory);
        assert!(advice.ends_with("--run helix --resume"), "{advice}");
        // What lies there is of the study that was to be overwritten, unless it has a checkpoint.
        arguments.overwrite = true;
        let advice = interrupted(&arguments, &directory);
        assert!(advice.ends_with("--run helix --overwrite"), "{advice}");
        fs::write(directory.join("helix/checkpoint"), "").unwrap();
        let advice = interrupted(&arguments, &directory);
        assert!(advice.ends_with("--run helix --resume"), "{advice}");
    }
}
