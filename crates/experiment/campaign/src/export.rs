//! Scripts that have a scheduler make the tasks.

use crate::error::CampaignError;
use crate::table::{Table, check_version};
use std::path::Path;

/// A scheduler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Slurm's array jobs.
    Slurm,
    /// HyperQueue's task arrays.
    HyperQueue,
    /// GNU parallel.
    Parallel,
}

/// What a script is made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Script {
    /// The scheduler.
    pub format: Format,
    /// The program, as a shell calls it.
    pub program: String,
    /// Tasks that one job makes one after the other (–).
    pub chunk: i64,
}

/// A script for the scheduler of `script` that makes all tasks of the campaign in `folder`; what is done
/// already is passed over when it comes up.
///
/// # Errors
/// [`CampaignError::NoCampaign`], [`CampaignError::Table`].
pub fn export(folder: &Path, script: &Script) -> Result<String, CampaignError> {
    let table = Table::open(folder)?;
    let meta = table.meta()?;
    check_version(folder, &meta)?;
    let n_tasks = table.counts()?.all();
    let chunk = script.chunk.clamp(1, n_tasks);
    let n_jobs = (n_tasks + chunk - 1) / chunk;
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let (folder, program) = (word(&folder.display().to_string()), word(&script.program));
    let threads = meta.threads.map_or("$(nproc)".to_owned(), |threads| threads.to_string());
    let head = format!(
        "# The {n_tasks} tasks of the campaign {}, {chunk} a job; made by `wakemix campaign export`.\n",
        meta.name
    );
    let range = |first: &str| {
        format!(
            "first=$((({first} - 1) * {chunk} + 1))\nexec {program} campaign exec {folder} \"$first-$((first + {chunk} - 1))\" --jobs 1\n"
        )
    };
    Ok(match script.format {
        Format::Slurm => {
            let cpus = meta.threads.map_or("#SBATCH --exclusive\n".to_owned(), |threads| {
                format!("#SBATCH --cpus-per-task={threads}\n")
            });
            format!(
                "#!/bin/bash\n{head}# sbatch THIS_FILE; a cluster's MaxArraySize may ask for a greater --chunk.\n#SBATCH --job-name={}\n#SBATCH --array=1-{n_jobs}\n{cpus}set -eu\n{}",
                name(&meta.name),
                range("SLURM_ARRAY_TASK_ID")
            )
        }
        Format::HyperQueue => format!(
            "#!/bin/bash\n{head}# bash THIS_FILE, with a server (`hq server start`) and workers (`hq worker start`) running.\nset -eu\nhq submit --name={} --array=1-{n_jobs} --cpus={threads} -- bash -c {}\n",
            name(&meta.name),
            word(&range("HQ_TASK_ID"))
        ),
        Format::Parallel => format!(
            "#!/bin/bash\n{head}# bash THIS_FILE, or with further options of parallel, such as --sshloginfile or -j.\nset -eu\ncores=$(nproc)\nthreads={threads}\nseq 1 {chunk} {n_tasks} | parallel -j $((cores / threads > 0 ? cores / threads : 1)) \"$@\" {}\n",
            word(&format!(
                "{program} campaign exec {folder} \"{{}}-$(({{}} + {chunk} - 1))\" --jobs 1"
            ))
        ),
    })
}

/// `name` for a scheduler: without blanks.
fn name(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' })
        .collect()
}

/// `text` as one word of a shell.
fn word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+%@".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}
