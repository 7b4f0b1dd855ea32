//! ElastoDyn: geometry, masses, structure of blades and tower.

use super::deck::Deck;
use super::version;
use crate::turbine_file::{BladeStructure, Hub, Mode, Nacelle, Rotor, Tower, TurbineFileError};

/// What ElastoDyn and the files it names hold.
pub(super) struct Structure {
    pub(super) rotor: Rotor,
    pub(super) blade: BladeStructure,
    pub(super) tower: Tower,
    pub(super) hub: Hub,
    pub(super) nacelle: Nacelle,
}

/// Names files in a group's source.
pub(super) type Source<'a> = dyn Fn(&[&Deck]) -> String + 'a;

pub(super) fn read(deck: &Deck, source: &Source) -> Result<Structure, TurbineFileError> {
    let tilt_deg = deck.number("ShftTilt")?;
    let overhang = deck.number("OverHang")?;
    let tower_height = deck.number("TowerHt")?;
    let top_to_shaft = deck.number("Twr2Shft")?;
    let rotor = Rotor {
        source: source(&[deck]),
        hub_radius: deck.number("HubRad")?,
        tip_radius: deck.number("TipRad")?,
        precone_deg: -deck.number("PreCone(1)")?,
        shaft_tilt_deg: -tilt_deg,
        overhang: -overhang,
        hub_height: tower_height + top_to_shaft + overhang * tilt_deg.to_radians().sin(),
    };
    let hub = Hub {
        source: source(&[deck]),
        mass: deck.number("HubMass")?,
        inertia: deck.number("HubIner")?,
    };
    let nacelle = Nacelle {
        source: source(&[deck]),
        mass: deck.number("NacMass")?,
        yaw_inertia: deck.number("NacYIner")?,
        center_of_mass: [deck.number("NacCMxn")?, deck.number("NacCMyn")?, deck.number("NacCMzn")?],
        yaw_bearing_mass: if deck.has("YawBrMass") { deck.number("YawBrMass")? } else { 0.0 },
    };
    let blade_deck = deck.deck("BldFile(1)")?;
    version::ELASTODYN.check(&blade_deck)?;
    let blade = blade(&blade_deck, rotor.tip_radius - rotor.hub_radius, source)?;
    let base_height = deck.number("TowerBsHt")?;
    let tower_deck = deck.deck("TwrFile")?;
    version::ELASTODYN.check(&tower_deck)?;
    let tower = Tower {
        base_height,
        top_height: tower_height,
        top_to_shaft,
        ..tower(&tower_deck, base_height, tower_height - base_height, source)?
    };
    Ok(Structure { rotor, blade, tower, hub, nacelle })
}

/// A factor that adjusts a column, one where the deck has none.
fn factor(deck: &Deck, key: &str) -> Result<f64, TurbineFileError> {
    if deck.has(key) { deck.number(key) } else { Ok(1.0) }
}

fn mode(deck: &Deck, shape: &str, damping: &str) -> Result<Mode, TurbineFileError> {
    let mut coefficients = [0.0; 5];
    for (index, coefficient) in coefficients.iter_mut().enumerate() {
        *coefficient = deck.number(&format!("{shape}({})", index + 2))?;
    }
    // Published to a few digits, they seldom add up exactly.
    let sum: f64 = coefficients.iter().sum();
    // Not so of what is not a number, too.
    let adds_up = (sum - 1.0).abs() <= 0.02;
    if !adds_up {
        let expected = "coefficients that add up to 1";
        return Err(deck.value(&format!("{shape}(2)"))?.error(expected));
    }
    let coefficients = coefficients.map(|coefficient| coefficient / sum);
    Ok(Mode { coefficients, damping_ratio: deck.number(damping)? / 100.0 })
}

fn blade(deck: &Deck, length: f64, source: &Source) -> Result<BladeStructure, TurbineFileError> {
    let columns = ["BlFract", "PitchAxis", "StrcTwst", "BMassDen", "FlpStff", "EdgStff"];
    let table = deck.table("NBlInpSt", &columns)?;
    let mass_factor = factor(deck, "AdjBlMs")?;
    let flap_factor = factor(deck, "AdjFlSt")?;
    let edge_factor = factor(deck, "AdjEdSt")?;
    let shares = table.column("BlFract")?;
    let twists = table.column("StrcTwst")?;
    let masses = table.column("BMassDen")?;
    let flaps = table.column("FlpStff")?;
    let edges = table.column("EdgStff")?;
    let section = |row: usize| {
        [
            shares[row] * length,
            twists[row],
            masses[row] * mass_factor,
            flaps[row] * flap_factor,
            edges[row] * edge_factor,
        ]
    };
    Ok(BladeStructure {
        source: source(&[deck]),
        sections: (0..shares.len()).map(section).collect(),
        flap_mode_1: mode(deck, "BldFl1Sh", "BldFlDmp1")?,
        flap_mode_2: mode(deck, "BldFl2Sh", "BldFlDmp2")?,
        edge_mode_1: mode(deck, "BldEdgSh", "BldEdDmp1")?,
    })
}

fn tower(
    deck: &Deck,
    base_height: f64,
    length: f64,
    source: &Source,
) -> Result<Tower, TurbineFileError> {
    let table = deck.table("NTwInpSt", &["HtFract", "TMassDen", "TwFAStif", "TwSSStif"])?;
    let mass_factor = factor(deck, "AdjTwMa")?;
    let fore_aft_factor = factor(deck, "AdjFASt")?;
    let side_factor = factor(deck, "AdjSSSt")?;
    let shares = table.column("HtFract")?;
    let masses = table.column("TMassDen")?;
    let fore_aft = table.column("TwFAStif")?;
    let side = table.column("TwSSStif")?;
    let section = |row: usize| {
        [
            base_height + shares[row] * length,
            masses[row] * mass_factor,
            fore_aft[row] * fore_aft_factor,
            side[row] * side_factor,
        ]
    };
    Ok(Tower {
        source: source(&[deck]),
        sections: (0..shares.len()).map(section).collect(),
        fore_aft_mode_1: mode(deck, "TwFAM1Sh", "TwrFADmp(1)")?,
        fore_aft_mode_2: mode(deck, "TwFAM2Sh", "TwrFADmp(2)")?,
        side_to_side_mode_1: mode(deck, "TwSSM1Sh", "TwrSSDmp(1)")?,
        side_to_side_mode_2: mode(deck, "TwSSM2Sh", "TwrSSDmp(2)")?,
        ..Tower::default()
    })
}
