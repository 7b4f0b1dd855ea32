//! What can be wrong with a turbine's structural data.

/// A structure that cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StructureError {
    /// Fewer than two sections, or sections that do not follow each other.
    #[error("{member}: {n_sections} structural sections do not increase from 0 to {length} m")]
    Sections {
        /// Blade or tower.
        member: &'static str,
        /// Sections given (–).
        n_sections: usize,
        /// Length that they must span (m).
        length: f64,
    },
    /// A section whose mass or stiffness no beam can have.
    #[error("{member}: mass or stiffness at {position} m is not positive and finite")]
    Section {
        /// Blade or tower.
        member: &'static str,
        /// Distance from the clamped end (m).
        position: f64,
    },
    /// A mode shape that is not one at the free end.
    #[error(
        "{member}: coefficients of {mode} sum to {sum}, a shape that is one at the free end sums to one"
    )]
    Shape {
        /// Blade or tower.
        member: &'static str,
        /// Which mode.
        mode: &'static str,
        /// Sum of the coefficients (–).
        sum: f64,
    },
    /// Number of blades outside what one rotor carries.
    #[error("a rotor of {n_blades} blades: from 1 to {maximum} can be modelled")]
    Blades {
        /// Blades given (–).
        n_blades: usize,
        /// Most that a rotor may have (–).
        maximum: usize,
    },
}
