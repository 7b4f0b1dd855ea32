//! One module per command.

pub(crate) mod analyse;
mod arguments;
#[cfg(feature = "campaign")]
pub(crate) mod campaign;
pub(crate) mod cases;
pub(crate) mod definition;
pub(crate) mod fatigue;
#[cfg(feature = "design")]
pub(crate) mod identify;
pub(crate) mod inflow;
mod inflow_cut;
mod inflow_info;
mod inflow_precursor;
mod inflow_sample;
pub(crate) mod init;
pub(crate) mod manner;
pub(crate) mod output;
pub(crate) mod report;
pub(crate) mod run;
mod stop;
#[cfg(feature = "design")]
pub(crate) mod surrogate;
mod sweep_table;
#[cfg(feature = "design")]
pub(crate) mod synthesize;
pub(crate) mod table;
#[cfg(feature = "tune")]
pub(crate) mod tune;
pub(crate) mod turbine;
#[cfg(feature = "validate")]
pub(crate) mod validate;

/// Exit code of input that cannot be used.
pub(crate) const BAD_INPUT: u8 = 2;
/// Exit code of a simulation that diverged.
pub(crate) const DIVERGED: u8 = 3;
/// Exit code when nobody reads the output any more, that of other programs whose pipe is closed.
pub(crate) const CLOSED_PIPE: u8 = 141;
/// Exit code of a run that was interrupted and can be resumed.
pub(crate) const INTERRUPTED: u8 = 130;
