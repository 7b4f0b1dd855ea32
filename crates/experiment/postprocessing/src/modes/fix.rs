//! What to do where there are no modes.

use analysis::modes::ModesError;

/// How to have modes in spite of `error`.
pub(crate) fn fix_of(error: &ModesError) -> &'static str {
    match error {
        ModesError::TooFew { .. } => {
            "make a longer run (time.duration), keep planes more often (output.plane_interval), or ask for a shorter --block"
        }
        ModesError::UnevenTimes { .. } => {
            "give instants that are evenly spaced: those of one run, with one output.plane_interval"
        }
        ModesError::Blocks { .. } => "ask for another --block or --overlap",
        ModesError::Frequency { .. } => {
            "keep planes more often (output.plane_interval), or leave --excitation and --rotor out"
        }
        ModesError::NoComponent => "name one of u, v, w with --component",
        ModesError::NoPoint { .. } => {
            "fill the holes, or give the part of the plane that was measured throughout"
        }
        ModesError::Values { .. } => "restore the file, or make the run again",
    }
}
