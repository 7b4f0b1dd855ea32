//! The free wake against closed forms, its rotors against momentum theory and the flow of rings together, and
//! a helix in it beside a published study.

mod budget;
mod held;
mod hub_vortex;
mod open_loop;
mod rotor;
mod shear;
mod vortices;
mod wake;
mod wing;

use crate::Row;
use report::ReportError;
use std::path::Path;

/// Segments, rings and helices, an elliptic wing, and the sum over boxes of vortices.
pub fn free_vortex() -> Vec<Row> {
    let mut rows = vortices::rows();
    rows.extend(wing::rows());
    rows
}

/// Power and thrust of three rotors at their best tip-speed ratio.
pub fn free_vortex_rotor() -> Vec<Row> {
    rotor::rows()
}

/// Impulse, momentum, energy and circulation of a rotor and its wake.
pub fn free_vortex_budget() -> Vec<Row> {
    budget::rows()
}

/// Profiles of the wake and loading of the blades beside the lattice's, and the outer vortices' helix.
pub fn free_vortex_wake() -> Vec<Row> {
    wake::rows()
}

/// The figures of [`free_vortex_wake`], drawn into `folder`/figures; gives their names.
///
/// # Errors
/// Those of [`report::write_synchronisation`].
pub fn free_vortex_wake_pictures(folder: &Path) -> Result<Vec<String>, ReportError> {
    wake::pictures(folder)
}

/// The hub vortex' circle at 1 D against amplitude and Strouhal number of helices drawn at random.
pub fn free_vortex_helix() -> Vec<Row> {
    hub_vortex::rows()
}

/// The hub vortex' circle at 1 D against the amplitude of helices at one Strouhal number.
pub fn free_vortex_amplitude() -> Vec<Row> {
    hub_vortex::rows_at_one_strouhal()
}

/// Power and blade loads of two turbines with a helix in even, sheared and turbulent wind.
pub fn free_vortex_open_loop() -> Vec<Row> {
    open_loop::rows()
}

/// Height of a wake in sheared wind, beside the lattice's.
pub fn free_vortex_shear() -> Vec<Row> {
    shear::rows()
}
