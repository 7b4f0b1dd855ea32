//! Ctrl-C: what it stops, and how the same command is written once more.

use super::INTERRUPTED;
use super::output::{say, warn};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that Ctrl-C raises from now on; a second Ctrl-C ends the program at once.
pub(crate) fn on_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let installed = ctrlc::set_handler(move || {
        // A second Ctrl-C means now; the last checkpoint stands.
        if flag.swap(true, Ordering::SeqCst) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        say("\nstopping after this step; press Ctrl-C again to stop now");
    });
    if let Err(error) = installed {
        warn(&format!("Ctrl-C will not write a checkpoint: {error}"));
    }
    stop
}

/// `text` as one word of a shell.
pub(crate) fn shell_word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+%@".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_reads_a_word_back() {
        for (text, word) in [
            ("cases/a.toml", "cases/a.toml"),
            ("wind.speed=7", "wind.speed=7"),
            ("my case", "'my case'"),
            ("it's", r"'it'\''s'"),
            ("", "''"),
        ] {
            assert_eq!(shell_word(text), word);
        }
    }
}
