//! The box of cells in which a flow is resolved: its keys of `[flow]`, and what they say.

use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Key, Slip, Table, Values, above, from, key};
use flow::lattice::{LatticeSettings, Stencil};

/// Gaussian width of forces over cell size (–): two cells is the least that the lattice carries without
/// ringing.
pub const SMEARING_CELLS: f64 = 2.0;

/// Keys of `[flow]` for a box of cells.
pub static KEYS: [Key; 10] = [
    key(
        "cells_per_diameter",
        from(8.0, 200.0),
        "–",
        Value("16"),
        "Cells across the first rotor: the one number that trades time for detail. Time grows with its fourth power.",
    ),
    key(
        "upstream_diameters",
        from(1.0, 50.0),
        "D",
        Value("3"),
        "Air upstream of the foremost turbine.",
    ),
    key(
        "downstream_diameters",
        from(1.0, 100.0),
        "D",
        Value("4"),
        "Air downstream of the last turbine.",
    ),
    key(
        "width_diameters",
        from(2.0, 100.0),
        "D",
        Value("6"),
        "Width of the domain, on top of the lateral spread of the layout. Narrow domains block the flow.",
    ),
    key("height_diameters", from(1.0, 50.0), "D", Value("4"), "Height of the domain."),
    key(
        "ground",
        Holds::Ground(&GROUND),
        "",
        Value("\"slip\""),
        "`\"slip\"`: the air slips along the ground. `{ roughness_length = 0.001 }`: wall stress after the logarithmic law.",
    ),
    key(
        "sides",
        Holds::Choice(&["periodic", "slip"]),
        "",
        Value("\"periodic\""),
        "`periodic`: what leaves on one side enters on the other. `slip`: the air slips along them.",
    ),
    key(
        "blockage",
        Holds::Choice(&["felt", "corrected"]),
        "",
        Value("\"felt\""),
        "The walls hold the air together, so that a rotor meets more wind than in the open. `felt`: `wind.speed` blows in. `corrected`: so much less blows in that a rotor of thrust coefficient 0.8 works as in open air of `wind.speed` (axial momentum theory of a disc in a channel, Glauert 1935); for rotors below their rated wind.",
    ),
    key(
        "velocity_set",
        Holds::Choice(&["d3q19", "d3q27"]),
        "",
        Value("\"d3q19\""),
        "Velocities of the lattice. `d3q19`: rest, faces and edges of the cube. `d3q27`: corners too, at 2.2 times the time and 1.4 times the memory; it moves eddies alike whichever way the wind blows, where nineteen feed those of four and five cells (docs/validation/flow.md).",
    ),
    key(
        "smagorinsky_constant",
        from(0.0, 0.5),
        "–",
        Otherwise("0.12; 0.16 over a rough ground"),
        "Constant of Smagorinsky's eddy viscosity, whose filter is a cell wide.",
    ),
];

/// `flow.ground` of a rough ground.
pub static GROUND: Table = Table {
    heading: "flow.ground = { … }",
    about: "A rough ground.",
    keys: &[key(
        "roughness_length",
        above(0.0, 5.0),
        "m",
        Required,
        "Roughness length z₀: about 0.0002 on calm sea, 0.001 on open sea, 0.03 on farmland.",
    )
    .mistaken(&[Slip { unit: "mm", factor: 0.001 }])],
};

/// What the keys say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Cells per diameter of the first turbine (–).
    pub cells_per_diameter: f64,
    /// Domain upstream of the first turbine (diameters of the first turbine).
    pub upstream_diameters: f64,
    /// Domain downstream of the last turbine (diameters).
    pub downstream_diameters: f64,
    /// Domain width (diameters), plus the lateral spread of the layout.
    pub width_diameters: f64,
    /// Domain height (diameters).
    pub height_diameters: f64,
    /// What the air meets at the ground.
    pub ground: Ground,
    /// What it meets at the sides.
    pub sides: Sides,
    /// What becomes of the walls' effect on the rotors.
    pub blockage: Blockage,
    /// How the air is computed.
    pub method: Method,
}

/// How the lattice computes the air of a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Velocity set.
    pub stencil: Stencil,
    /// Constant of Smagorinsky's model (–); that of the box's ground when absent.
    pub smagorinsky: Option<f64>,
}

/// That of a case which says nothing of it.
impl Default for Method {
    fn default() -> Self {
        Domain::of(&Values::default()).method
    }
}

impl Method {
    /// Gives `settings` what the case asks for, and leaves what it does not.
    pub(crate) fn apply(self, settings: &mut LatticeSettings) {
        settings.stencil = self.stencil;
        if let Some(constant) = self.smagorinsky {
            settings.smagorinsky = constant;
        }
    }
}

impl Domain {
    /// What `values` say; keys that they do not hold have their defaults.
    pub fn of(values: &Values) -> Self {
        let mut all = Values::defaults(&KEYS);
        all.extend(values.iter().map(|(key, value)| (key, value.clone())));
        let rough = all.table("ground").map(|table| table.number("roughness_length"));
        Self {
            cells_per_diameter: all.number("cells_per_diameter"),
            upstream_diameters: all.number("upstream_diameters"),
            downstream_diameters: all.number("downstream_diameters"),
            width_diameters: all.number("width_diameters"),
            height_diameters: all.number("height_diameters"),
            ground: rough.map_or(Ground::Slip, |length| Ground::Rough { roughness_length: length }),
            sides: if all.word("sides") == "slip" { Sides::Slip } else { Sides::Periodic },
            blockage: match all.word("blockage") {
                "corrected" => Blockage::Corrected,
                _ => Blockage::Felt,
            },
            method: Method {
                stencil: match all.word("velocity_set") {
                    "d3q27" => Stencil::D3Q27,
                    _ => Stencil::D3Q19,
                },
                smagorinsky: all.optional_number("smagorinsky_constant"),
            },
        }
    }
}

/// The ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground {
    /// Air slips along it.
    Slip,
    /// Wall stress after the logarithmic law.
    Rough {
        /// Roughness length z₀ (m).
        roughness_length: f64,
    },
}

/// The lateral boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// What leaves on one side enters on the other.
    Periodic,
    /// Air slips along them.
    Slip,
}

/// What becomes of the walls' effect on the rotors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blockage {
    /// The case's wind blows in, and rotors feel the walls.
    Felt,
    /// So much less blows in that a rotor works as in open air of the case's wind.
    Corrected,
}
