//! The tower of a windIO file: a steel tube.

use super::node::{Curve, Node};
use crate::turbine_file::{Mode, Tower, TurbineFileError};
use std::f64::consts::PI;

/// The tower, and the height of its top (m); mode shapes are not in the file.
pub(super) fn read(root: &Node, source: &str) -> Result<(Tower, f64), TurbineFileError> {
    let tower = root.get("components")?.get("tower")?;
    let shape = tower.get("outer_shape_bem")?;
    let heights = Curve::read(&shape.get("reference_axis")?.get("z")?)?;
    let diameters = Curve::read(&shape.get("outer_diameter")?)?;
    let drag = match shape.optional("drag_coefficient") {
        Some(node) => Curve::read(&node)?,
        None => Curve::read(&shape.get("cd")?)?,
    };
    let place = |share: f64| [heights.at(share), diameters.at(share), drag.at(share)];
    let mut profile: Vec<[f64; 3]> = diameters.grid().iter().map(|share| place(*share)).collect();
    profile.dedup_by(|next, before| next[0] <= before[0]);
    let sections = sections(root, &tower, &heights, &diameters)?;
    let unknown = Mode { coefficients: [f64::NAN; 5], damping_ratio: f64::NAN };
    let (base_height, top_height) = (heights.at(0.0), heights.last());
    let tower = Tower {
        source: source.to_owned(),
        base_height,
        top_height,
        top_to_shaft: f64::NAN,
        profile,
        sections,
        fore_aft_mode_1: unknown.clone(),
        fore_aft_mode_2: unknown.clone(),
        side_to_side_mode_1: unknown.clone(),
        side_to_side_mode_2: unknown,
    };
    Ok((tower, top_height))
}

/// Height, mass and stiffness of the wall of the first layer; none where the file has no layers.
fn sections(
    root: &Node,
    tower: &Node,
    heights: &Curve,
    diameters: &Curve,
) -> Result<Vec<[f64; 4]>, TurbineFileError> {
    let structure = tower
        .optional("internal_structure_2d_fem")
        .or_else(|| tower.optional("elastic_properties_mb"));
    let Some(structure) = structure.filter(|structure| structure.optional("layers").is_some())
    else {
        return Ok(Vec::new());
    };
    let layers = structure.get("layers")?.items()?;
    let Some(wall) = layers.first() else { return Ok(Vec::new()) };
    let thickness = Curve::read(&wall.get("thickness")?)?;
    let name = wall.get("material")?;
    let materials = root.get("materials")?.items()?;
    let known = |material: &&Node| {
        material.optional("name").is_some_and(|node| node.text().ok() == name.text().ok())
    };
    let material = materials
        .iter()
        .find(known)
        .ok_or_else(|| name.error("the name of a material", "a name of the list materials"))?;
    let (modulus, density) = (material.number("E")?, material.number("rho")?);
    let outfitting = structure.number_or("outfitting_factor", 1.0)?;
    let section = |share: &f64| {
        let outer = diameters.at(*share);
        let inner = outer - 2.0 * thickness.at(*share);
        let area = PI / 4.0 * (outer.powi(2) - inner.powi(2));
        let stiffness = modulus * PI / 64.0 * (outer.powi(4) - inner.powi(4));
        [heights.at(*share), outfitting * density * area, stiffness, stiffness]
    };
    let mut rows: Vec<[f64; 4]> = thickness.grid().iter().map(section).collect();
    rows.dedup_by(|next, before| next[0] <= before[0]);
    Ok(rows)
}
