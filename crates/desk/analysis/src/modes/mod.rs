//! Modes of a wake: what moves together, by energy (POD) and by energy at each frequency (SPOD).
//!
//! Instants come strip by strip of points, each strip with all of its time, so that what is held is a strip,
//! and neither the plane's history nor its blocks. Energies are means over the area.
//!
//! Sources: Sirovich (1987), "Turbulence and the dynamics of coherent structures", Quart. Appl. Math. 45
//! (method of snapshots); Towne, Schmidt and Colonius (2018), "Spectral proper orthogonal decomposition and
//! its relationship to dynamic mode decomposition and resolvent analysis", J. Fluid Mech. 847 (spectral
//! estimation of §3.2).

mod eigen;
mod error;
mod gram;
mod names;
mod pod;
mod snapshots;
mod spod;
mod strip;

pub use error::ModesError;
pub use names::{FrequencyNames, NamedFrequency};
pub use pod::{Pod, PodSettings, pod};
pub use snapshots::{HeldSnapshots, Snapshots, area_share};
pub use spod::{SpectralModes, Spod, SpodSettings, Window, spod};
pub use strip::strip_bytes;

#[cfg(test)]
mod tests;
