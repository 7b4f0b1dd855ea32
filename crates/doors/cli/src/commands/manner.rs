//! How the program speaks, for every command alike: how much it says, and in what colours.

use clap::{ArgAction, Args, ColorChoice, ValueEnum};
use std::ffi::OsString;
use std::sync::atomic::{AtomicI8, AtomicU8, Ordering};

/// How much is said: 0 as usual, less below, more above.
static LEVEL: AtomicI8 = AtomicI8::new(0);
/// Place of the choice of colours in [`CHOICES`].
static COLOR: AtomicU8 = AtomicU8::new(0);
const CHOICES: [Color; 3] = [Color::Auto, Color::Always, Color::Never];

/// Options that every command has.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Manner {
    /// Say less on standard error: neither progress nor remarks; with -qq no warnings either
    #[arg(short, long, global = true, action = ArgAction::Count)]
    quiet: u8,
    /// Say more on standard error: what is read, what is built, and how long each stage takes
    #[arg(short, long, global = true, action = ArgAction::Count)]
    verbose: u8,
    /// When to use colours
    #[arg(long, global = true, value_enum, default_value = "auto", value_name = "WHEN")]
    color: Color,
}

/// When colours are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless the environment variable NO_COLOR is set
    Auto,
    /// Always, also into files and pipes
    Always,
    /// Never
    Never,
}

impl Manner {
    /// On return everything is said in this manner.
    pub(crate) fn hold(&self) {
        let level = i16::from(self.verbose) - i16::from(self.quiet);
        LEVEL.store(level.clamp(-2, 1) as i8, Ordering::Relaxed);
        let place = CHOICES.iter().position(|choice| *choice == self.color).unwrap_or(0);
        COLOR.store(place as u8, Ordering::Relaxed);
    }
}

/// Whether progress and remarks are said.
pub(crate) fn says_remarks() -> bool {
    LEVEL.load(Ordering::Relaxed) >= 0
}

/// Whether warnings are said.
pub(crate) fn says_warnings() -> bool {
    LEVEL.load(Ordering::Relaxed) >= -1
}

/// Whether details are said.
pub(crate) fn says_details() -> bool {
    LEVEL.load(Ordering::Relaxed) > 0
}

/// Whether colours are asked for or forbidden; none where the terminal decides.
pub(crate) fn color() -> Option<bool> {
    match CHOICES[usize::from(COLOR.load(Ordering::Relaxed))] {
        Color::Auto => None,
        Color::Always => Some(true),
        Color::Never => Some(false),
    }
}

/// The colours that `words` of a command line ask for, before they are read as a whole: what is wrong with
/// them is drawn in these.
pub(crate) fn color_of(words: impl IntoIterator<Item = OsString>) -> ColorChoice {
    let mut choice = ColorChoice::Auto;
    let mut is_next = false;
    for word in words {
        let word = word.to_string_lossy();
        let value = if is_next { Some(&*word) } else { word.strip_prefix("--color=") };
        match value {
            Some("always") => choice = ColorChoice::Always,
            Some("never") => choice = ColorChoice::Never,
            Some(_) => choice = ColorChoice::Auto,
            None if word == "--" => break,
            None => (),
        }
        is_next = value.is_none() && word == "--color";
    }
    choice
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_known_before_the_rest_is_read() {
        let of = |words: &[&str]| color_of(words.iter().map(OsString::from));
        assert_eq!(of(&["wakemix", "run", "--color", "never", "--oops"]), ColorChoice::Never);
        assert_eq!(of(&["wakemix", "--color=always", "run"]), ColorChoice::Always);
        assert_eq!(of(&["wakemix", "run", "--", "--color=always"]), ColorChoice::Auto);
        assert_eq!(of(&["wakemix", "--color", "often"]), ColorChoice::Auto);
        assert_eq!(of(&["wakemix", "--color=never", "--color", "always"]), ColorChoice::Always);
    }
}
