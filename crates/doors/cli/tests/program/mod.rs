//! The program as a user starts it, and what it says.

use std::path::Path;
use std::process::{Command, Output};

/// What `wakemix` with `arguments` did in `folder`.
pub(crate) fn wakemix(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wakemix"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// What a command said beside its data: drawn messages wrap, what matters is the words.
pub(crate) fn said(output: &Output) -> String {
    let message = String::from_utf8_lossy(&output.stderr);
    let words: Vec<&str> = message.split_whitespace().filter(|word| *word != "│").collect();
    words.join(" ")
}
