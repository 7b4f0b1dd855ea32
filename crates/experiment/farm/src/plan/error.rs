//! Why a case cannot be run as it stands, and the key that decides.

use super::{MAXIMUM_LATTICE_SPEED, MINIMUM_CELLS_PER_DIAMETER, MOST_LEVELS};
use thiserror::Error;

/// Why a case cannot be run as it stands.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlanError {
    /// A rotor reaches outside the air.
    #[error(
        "turbine {name} reaches outside the domain: its rotor spans {axis} = {low:.0} to {high:.0} m, the domain {domain_low:.0} to {domain_high:.0} m; {fix}"
    )]
    OutsideDomain {
        /// Turbine.
        name: String,
        /// Axis, in words.
        axis: &'static str,
        /// Lowest coordinate of the rotor (m).
        low: f64,
        /// Highest coordinate of the rotor (m).
        high: f64,
        /// Lowest coordinate of the domain (m).
        domain_low: f64,
        /// Highest coordinate of the domain (m).
        domain_high: f64,
        /// Key to raise.
        fix: &'static str,
    },
    /// Rotors that touch each other.
    #[error(
        "turbines {first} and {second} overlap: their towers are {distance:.0} m apart, their rotors need {needed:.0} m; move one of them (turbine.position_diameters)"
    )]
    Overlap {
        /// One turbine.
        first: String,
        /// The other.
        second: String,
        /// Distance of their towers (m).
        distance: f64,
        /// Least distance (m).
        needed: f64,
    },
    /// The grid is too coarse.
    #[error(
        "turbine {name} has only {cells:.1} cells across its rotor, at least {MINIMUM_CELLS_PER_DIAMETER} are needed; raise flow.cells_per_diameter to at least {needed:.0}"
    )]
    TooCoarse {
        /// Turbine.
        name: String,
        /// Cells across its rotor (–).
        cells: f64,
        /// Least `cells_per_diameter` (–).
        needed: f64,
    },
    /// A tip crosses more than a cell a step.
    #[error(
        "flow.step = {step} s is too long: the tip of {name} moves {cells:.2} cells a step at {tip_speed:.0} m/s; use at most {longest:.4} s, or leave the key out"
    )]
    TipOutruns {
        /// Turbine.
        name: String,
        /// Step given (s).
        step: f64,
        /// Cells a step (–).
        cells: f64,
        /// Tip speed (m/s).
        tip_speed: f64,
        /// Longest step (s).
        longest: f64,
    },
    /// The free stream moves too many cells a step.
    #[error(
        "flow.step = {step} s is too long: the wind moves {cells:.2} cells a step, the maximum is {MAXIMUM_LATTICE_SPEED}; use at most {longest:.4} s, or leave the key out"
    )]
    TooFast {
        /// Step given (s).
        step: f64,
        /// Cells a step (–).
        cells: f64,
        /// Longest step (s).
        longest: f64,
    },
    /// The free stream hardly moves in a step.
    #[error(
        "flow.step = {step:?} s is too short: the wind moves {cells:.1e} cells a step, which the lattice rounds away, and a run would take days; at least {shortest:.2e} s, or leave the key out"
    )]
    TooSlow {
        /// Step given (s).
        step: f64,
        /// Cells a step (–).
        cells: f64,
        /// Shortest step (s).
        shortest: f64,
    },
    /// A rotor turns so far in a step that the wake behind it is no helix.
    #[error(
        "{what}: {name} turns by {turn_deg:.0}° in a step {when}, the maximum is {most_deg:.0}°; {fix}"
    )]
    TurnsTooFar {
        /// Turbine.
        name: String,
        /// Key that decides.
        key: &'static str,
        /// What of it is wrong, in words.
        what: String,
        /// Angle (deg).
        turn_deg: f64,
        /// When it turns so far, in words.
        when: &'static str,
        /// Greatest angle (deg).
        most_deg: f64,
        /// What to change.
        fix: String,
    },
    /// A turbine stands still in this wind.
    #[error(
        "{what} gives {name} a mean wind of {speed:.2} m/s at its hub, and it works from {cut_in} to {cut_out} m/s: it would stand still; {fix}"
    )]
    NotInOperation {
        /// What makes the wind, such as `wind.speed = 39 m/s`.
        what: String,
        /// Key that decides.
        key: &'static str,
        /// Turbine.
        name: String,
        /// Mean wind at its hub (m/s).
        speed: f64,
        /// Its cut-in wind speed (m/s).
        cut_in: f64,
        /// Its cut-out wind speed (m/s).
        cut_out: f64,
        /// What to change.
        fix: &'static str,
    },
    /// The wind's profile is calm up to the rotor.
    #[error(
        "wind.roughness_length = {roughness_length} m is too much for a hub at {hub_height:.0} m: {highest:.1} m, a tenth of it, is the maximum; 0.0002 is calm sea, 0.03 farmland, 1 a town"
    )]
    TooRough {
        /// Roughness length given (m).
        roughness_length: f64,
        /// Hub height of the first turbine (m).
        hub_height: f64,
        /// Greatest roughness length (m).
        highest: f64,
    },
    /// The wind turns so far with height that part of the inlet lets none in.
    #[error(
        "wind.veer_deg_per_m turns the wind by {turn_deg:.0}° within the domain, which is {top:.0} m high, the maximum is {most_deg:.0}°; use at most {greatest_deg:.4}, or lower flow.height_diameters"
    )]
    VeersTooFar {
        /// Farthest direction from that at hub height (deg).
        turn_deg: f64,
        /// Farthest direction that may be (deg).
        most_deg: f64,
        /// Height of the domain (m).
        top: f64,
        /// Greatest veer (deg/m).
        greatest_deg: f64,
    },
    /// A plane across the wake where no air is.
    #[error(
        "the crosswind plane {distance} diameters behind the first turbine lies at x = {x:.0} m, the domain ends at {low:.0} and {high:.0} m; raise flow.downstream_diameters or take it away"
    )]
    CrosswindOutside {
        /// Distance (diameters of the first turbine).
        distance: f64,
        /// Its place (m).
        x: f64,
        /// Ends of the domain (m).
        low: f64,
        /// As above.
        high: f64,
    },
    /// A box of finer cells reaches too far.
    #[error(
        "the box flow.refinement.{number} spans {axis} = {low:.0} to {high:.0} m, and has room from {least:.0} to {most:.0} m in {around} before its sides and before the cells at the outlet that still eddies; {fix}"
    )]
    BoxOutside {
        /// Its number.
        number: Box<str>,
        /// Key that decides.
        key: &'static str,
        /// Axis, in words.
        axis: &'static str,
        /// Its ends (m).
        low: f64,
        /// As above.
        high: f64,
        /// What is around it and how many cells are to lie between, in words.
        around: Box<str>,
        /// Ends that it may have (m).
        least: f64,
        /// As above.
        most: f64,
        /// What to change.
        fix: Box<str>,
    },
    /// Two boxes of finer cells touch, and none lies within the other.
    #[error(
        "the boxes flow.refinement.{first} and flow.refinement.{second} overlap, or are less than {margin} cells apart, and neither lies within the other; lay one box around the turbines of both, or make them smaller"
    )]
    BoxesMeet {
        /// Number of one.
        first: usize,
        /// Number of the other.
        second: String,
        /// Cells that are to lie between.
        margin: usize,
    },
    /// Boxes within boxes within boxes.
    #[error(
        "{depth} boxes of flow.refinement lie within one another, at most {MOST_LEVELS} can; leave some out and raise flow.cells_per_diameter"
    )]
    TooManyLevels {
        /// How many lie within one another (–).
        depth: u32,
    },
    /// A rotor's forces reach over the edge of a box of finer cells.
    #[error(
        "turbine {name} stands neither in the box flow.refinement.{number} nor clear of it: rotor and tower with six cells around them, as far as forces are spread, reach {missing:.0} m beyond it {end}; to take it in, raise its {key} by {missing_diameters} (or name the turbine in its `around`), or make the box smaller"
    )]
    RotorAtEdge {
        /// Turbine.
        name: String,
        /// Number of the box.
        number: Box<str>,
        /// Key that decides.
        key: &'static str,
        /// Where it ends too early, in words.
        end: &'static str,
        /// How much too early (m).
        missing: f64,
        /// What the key lacks (diameters of the first turbine).
        missing_diameters: f64,
    },
    /// A ground that is too rough for the cells on it.
    #[error(
        "flow.ground has a roughness length of {roughness_length} m, and the lowest cells of {place} bear {highest:.3} m at most: the wind follows the logarithmic law at their middle, which is to lie well above it; lower it, or {fix}"
    )]
    RoughGround {
        /// Roughness length given (m).
        roughness_length: f64,
        /// Greatest one (m).
        highest: f64,
        /// Table whose cells they are.
        place: &'static str,
        /// What else to change.
        fix: &'static str,
    },
    /// Cells that the lattice does not take for another reason.
    #[error("the lattice does not take the cells of {place}: {reason}")]
    Cells {
        /// Table whose cells they are.
        place: &'static str,
        /// What it says, with what would do.
        reason: Box<str>,
    },
    /// A turbine without its model.
    #[error("turbine {name} has the model `{model}`, which was not loaded")]
    UnknownModel {
        /// Turbine.
        name: String,
        /// Model.
        model: String,
    },
}

impl PlanError {
    /// The key that decides, from the top of the case file; a name where several tables stand under one
    /// heading.
    pub fn key(&self) -> Vec<&str> {
        match self {
            Self::OutsideDomain { name, .. } => vec!["turbine", name, "position_diameters"],
            Self::Overlap { second, .. } => vec!["turbine", second, "position_diameters"],
            Self::TooCoarse { .. } => vec!["flow", "cells_per_diameter"],
            Self::TipOutruns { .. } | Self::TooFast { .. } | Self::TooSlow { .. } => {
                vec!["flow", "step"]
            }
            Self::TurnsTooFar { key, .. } => vec!["flow", *key],
            Self::NotInOperation { key, .. } => vec!["wind", *key],
            Self::TooRough { .. } => vec!["wind", "roughness_length"],
            Self::VeersTooFar { .. } => vec!["wind", "veer_deg_per_m"],
            Self::CrosswindOutside { .. } => vec!["output", "crosswind_diameters"],
            Self::BoxOutside { number, key, .. } | Self::RotorAtEdge { number, key, .. } => {
                vec!["flow", "refinement", number, key]
            }
            Self::BoxesMeet { second, .. } => vec!["flow", "refinement", second],
            Self::TooManyLevels { .. } => vec!["flow", "refinement"],
            Self::RoughGround { .. } => vec!["flow", "ground", "roughness_length"],
            Self::Cells { place, .. } => place.split('.').collect(),
            Self::UnknownModel { name, .. } => vec!["turbine", name, "model"],
        }
    }
}
