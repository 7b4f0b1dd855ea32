//! The box of cells in which a flow is resolved: its keys of `[flow]`, and what they say.

use crate::refinement;
use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Key, Objection, Slip, Table, Values, above, from, key};
use flow::lattice::{LatticeSettings, Stencil, Subgrid, SubgridModel};

/// Gaussian width of forces over cell size (–): two cells is the least that the lattice carries without
/// ringing.
pub const SMEARING_CELLS: f64 = 2.0;

/// Keys of `[flow]` for a box of cells.
pub static KEYS: [Key; 12] = [
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
        Holds::Choice(&["periodic", "slip", "open"]),
        "",
        Value("\"periodic\""),
        "`periodic`: what leaves on one side enters on the other. `slip`: the air slips along them. `open`: at each height and at each time wind enters through a side by which its mean along the side blows in, as it blows at that place, and leaves where the mean blows out; for wind that veers.",
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
    key(
        "subgrid",
        Holds::Choice(&SUBGRID_WORDS),
        "",
        Otherwise("`smagorinsky`"),
        "Model of the eddies that cells do not resolve. `smagorinsky`: from the strain of the cell. From the velocity gradient between neighbours, in a pass of its own and with 20 bytes more a cell: `wale` (Nicoud, Ducros 1999), `vreman` (Vreman 2004), `amd`: anisotropic minimum dissipation (Rozema et al. 2015). docs/validation/flow.md compares them.",
    ),
    key(
        "subgrid_constant",
        from(0.0, 1.0),
        "–",
        Otherwise("0.5 for `wale`, 0.07 for `vreman`, 0.3 for `amd`"),
        "Constant of the model that `subgrid` names, where that is not Smagorinsky's: C of (C Δ)² for `wale`, of C Δ² for the others.",
    ),
];

/// Words of `subgrid`.
pub const SUBGRID_WORDS: [&str; 4] = {
    let [first, second, third, fourth] = SubgridModel::ALL;
    [first.word(), second.word(), third.word(), fourth.word()]
};

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
    /// Model of unresolved eddies.
    pub subgrid: SubgridModel,
    /// Its constant (–); when absent that of the box's ground for Smagorinsky's, the usual one for others.
    pub constant: Option<f64>,
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
        if self.subgrid != settings.subgrid.model {
            settings.subgrid = Subgrid::new(self.subgrid);
        }
        if let Some(constant) = self.constant {
            settings.subgrid.constant = constant;
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
            sides: match all.word("sides") {
                "slip" => Sides::Slip,
                "open" => Sides::Open,
                _ => Sides::Periodic,
            },
            blockage: match all.word("blockage") {
                "corrected" => Blockage::Corrected,
                _ => Blockage::Felt,
            },
            method: Method {
                stencil: match all.word("velocity_set") {
                    "d3q27" => Stencil::D3Q27,
                    _ => Stencil::D3Q19,
                },
                subgrid: subgrid_of(&all),
                constant: all.optional_number(match subgrid_of(&all) {
                    SubgridModel::Smagorinsky => "smagorinsky_constant",
                    _ => "subgrid_constant",
                }),
            },
        }
    }
}

/// The model that `subgrid` among `values` names; Smagorinsky's where it is not there.
pub fn subgrid_of(values: &Values) -> SubgridModel {
    let word = values.has("subgrid").then(|| values.word("subgrid"));
    word.and_then(SubgridModel::of_word).unwrap_or(SubgridModel::Smagorinsky)
}

/// What about walls and the model of unresolved eddies in the `values` of `[flow]` cannot be.
pub fn check(values: &Values) -> Vec<Objection> {
    let model = subgrid_of(values);
    let mut objections = Vec::new();
    let chosen = |key, word| values.has(key) && values.word(key) == word;
    if chosen("sides", "open") && chosen("blockage", "corrected") {
        objections.push(Objection {
            key: Some("blockage"),
            message: "= \"corrected\" is for walls: through open sides the air gives way to the rotors, and by how much was not measured".to_owned(),
            label: "not with open sides",
            fix: "leave it out, or use flow.sides = \"periodic\"".to_owned(),
        });
    }
    let (foreign, own) = match model.needs_neighbours() {
        true => ("smagorinsky_constant", "subgrid_constant"),
        false => ("subgrid_constant", "smagorinsky_constant"),
    };
    if values.has(foreign) {
        objections.push(Objection {
            key: Some(foreign),
            message: format!("has no use where flow.subgrid is \"{}\"", model.word()),
            label: "of another model",
            fix: format!("give flow.{own}, or leave it out"),
        });
    }
    if model.needs_neighbours() && !values.tables(refinement::NAME).is_empty() {
        objections.push(Objection {
            key: Some("subgrid"),
            message: format!(
                "= \"{}\" needs the wind of neighbours, which boxes of finer cells do not hand each other",
                model.word()
            ),
            label: "not with [[flow.refinement]]",
            fix: "use flow.subgrid = \"smagorinsky\", or leave out [[flow.refinement]]".to_owned(),
        });
    }
    objections
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
    /// The wind that blows in enters and leaves through them.
    Open,
}

/// What becomes of the walls' effect on the rotors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blockage {
    /// The case's wind blows in, and rotors feel the walls.
    Felt,
    /// So much less blows in that a rotor works as in open air of the case's wind.
    Corrected,
}
