//! Mass and stiffness of a blade in a windIO file: matrices of its sections.

use super::node::{Curve, Node};
use crate::turbine_file::{BladeStructure, Mode, TurbineFileError};

/// Numbers of the upper half of a six by six matrix, row by row: forces and moments about x (towards the
/// suction side), y and z (along the blade), as BeamDyn has them.
const N_HALF: usize = 21;
/// Places in it: stiffness along the blade, its coupling with both bendings, and these (edgewise about x,
/// flapwise about y).
const AXIAL: usize = 11;
const AXIAL_EDGE: usize = 12;
const AXIAL_FLAP: usize = 13;
const EDGE: usize = 15;
const FLAP: usize = 18;
/// Most sections (–).
const MOST_SECTIONS: usize = 500;

/// What the file's `blade` has of it, `length` (m) long, mode shapes left out; none where it has none.
///
/// Bending is taken about the axes of the file's matrices, through the section's tension centre, and those
/// are taken to follow its twist, as ElastoDyn decks do.
///
/// # Errors
/// [`TurbineFileError`] naming file, line and key.
pub(super) fn read(
    blade: &Node,
    length: f64,
    source: &str,
) -> Result<Option<BladeStructure>, TurbineFileError> {
    let elastic = blade.optional("elastic_properties_mb");
    let Some(matrices) = elastic.and_then(|elastic| elastic.optional("six_x_six")) else {
        return Ok(None);
    };
    let twist = Curve::read(&matrices.get("twist")?)?;
    let (grid, stiffness) = rows(&matrices.get("stiff_matrix")?)?;
    let (mass_grid, inertia) = rows(&matrices.get("inertia_matrix")?)?;
    if mass_grid != grid {
        let grid = matrices.get("inertia_matrix")?.get("grid")?;
        return Err(grid.error("the grid of stiff_matrix", "both matrices on one grid"));
    }
    let section = |((place, k), m): ((&f64, &Vec<f64>), &Vec<f64>)| {
        let about_center = |bending: usize, coupling: usize| {
            let shift = if k[AXIAL] > 0.0 { k[coupling].powi(2) / k[AXIAL] } else { 0.0 };
            k[bending] - shift
        };
        let (flap, edge) = (about_center(FLAP, AXIAL_FLAP), about_center(EDGE, AXIAL_EDGE));
        [place * length, twist.at(*place).to_degrees(), m[0], flap, edge]
    };
    let unknown = Mode { coefficients: [f64::NAN; 5], damping_ratio: f64::NAN };
    let mut sections: Vec<[f64; 5]> =
        grid.iter().zip(&stiffness).zip(&inertia).map(section).collect();
    sections.dedup_by(|next, before| next[0] <= before[0]);
    Ok(Some(BladeStructure {
        source: format!("{source}, bending stiffness about the tension centres"),
        sections,
        flap_mode_1: unknown.clone(),
        flap_mode_2: unknown.clone(),
        edge_mode_1: unknown,
    }))
}

/// Grid and matrices of `node`, each half a matrix.
fn rows(node: &Node) -> Result<(Vec<f64>, Vec<Vec<f64>>), TurbineFileError> {
    let (grid, values) = (node.get("grid")?.numbers()?, node.get("values")?);
    let items = values.items()?;
    if items.len() != grid.len() || !(2..=MOST_SECTIONS).contains(&grid.len()) {
        return Err(values.error(
            &format!("{} matrices, one per grid point, 2 to {MOST_SECTIONS}", grid.len()),
            "as many matrices as grid points",
        ));
    }
    if grid.windows(2).any(|pair| pair[1] < pair[0]) {
        return Err(node.get("grid")?.error("a rising grid", "grid points in rising order"));
    }
    let half = |item: &Node| {
        let numbers = item.numbers()?;
        if numbers.len() == N_HALF {
            return Ok(numbers);
        }
        Err(item.error(
            &format!("{N_HALF} numbers, the upper half of a matrix"),
            "the upper half of the six by six matrix, row by row",
        ))
    };
    let matrices = items.iter().map(half).collect::<Result<_, _>>()?;
    Ok((grid, matrices))
}
