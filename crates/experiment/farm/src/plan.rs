//! From layout to domain: cells, step, memory and cost, checked before anything runs.

mod boxes;
mod effort;
mod error;
mod grids;
mod step;
mod turning;

pub use effort::Effort;
pub use error::PlanError;
pub use grids::GridOfPlan;
pub use turning::{Turning, by_turns};

use crate::case::{Case, Method, Placement, Shear};
use basis::Vector3;
use flow::inflow::GREATEST_ROUGHNESS;
use flow::lattice::LatticeSettings;
use flow::lattice::refinement::Refinement;
use std::collections::BTreeMap;
use step::step;

/// Fastest free stream that the lattice carries without visible compressibility, in cells a step (Mach 0.2).
pub const MAXIMUM_LATTICE_SPEED: f64 = 0.12;
/// Fewest cells across a rotor on which an actuator line still means something.
pub const MINIMUM_CELLS_PER_DIAMETER: f64 = 8.0;
/// Speed of sound on the lattice, in cells a step: a tip that outruns it meets its own bound vortex
/// (docs/validation/actuator-line.md).
pub const LATTICE_SOUND_SPEED: f64 = 0.577_350_269_189_625_8;
/// Farthest that a wind which veers may turn between hub height and the ends of the domain below and above
/// (rad): wind comes in at every height of the inlet.
const FARTHEST_TURN: f64 = std::f64::consts::FRAC_PI_3;

/// Boxes of finer cells within one another at most (–): a step of the cells around all of them is cut into
/// sixteen.
pub const MOST_LEVELS: u32 = 4;

/// Step of turbines in prescribed wind unless the case says otherwise (s): a thirtieth of the fastest period
/// that carries load.
pub const PRESCRIBED_STEP: f64 = 0.02;
/// Farthest that a small, fast rotor turns in such a step in the mean wind (rad).
pub const FARTHEST_PRESCRIBED_TURN: f64 = 0.05;
/// Time between rows of the series in prescribed wind unless the case says otherwise (s).
pub const PRESCRIBED_ROW: f64 = 0.1;

/// What the layout needs to know of a turbine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Rotor diameter (m).
    pub diameter: f64,
    /// Hub height (m).
    pub hub_height: f64,
    /// Tip speed in the case's mean wind (m/s).
    pub tip_speed: f64,
    /// Tip speed at rated rotor speed (m/s), which stronger wind brings the rotor to.
    pub rated_tip_speed: f64,
}

/// Turbines where they stand.
#[derive(Clone, Debug)]
pub struct Layout<'a> {
    /// The turbines of the case, in its order, with what the layout must know of them.
    pub machines: Vec<(&'a Placement, Footprint)>,
    /// Foot of each one's tower, farm frame (m).
    pub positions: Vec<Vector3>,
}

impl Layout<'_> {
    /// Diameter that "diameters" in the case file means: the first turbine's (m).
    fn diameter(&self) -> f64 {
        self.machines[0].1.diameter
    }

    /// Hub height of the first turbine (m).
    fn hub_height(&self) -> f64 {
        self.machines[0].1.hub_height
    }
}

/// The box of air and the steps that a case needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Corner of the domain with the least coordinates, farm frame (m).
    pub origin: Vector3,
    /// Edge of a cell outside all boxes of finer ones (m).
    pub spacing: f64,
    /// Such cells along x, y, z, those beneath boxes included (–).
    pub n_cells: [usize; 3],
    /// Boxes of finer cells, in cells of the domain.
    pub boxes: Vec<Refinement>,
    /// How many boxes within one another each turbine stands in, in the case's order (–).
    pub levels: Vec<u32>,
    /// Points of planes and volumes along x, y, z, half a `spacing` inside of the domain (–): the middles of
    /// the cells outside all boxes, where there are any.
    pub n_points: [usize; 3],
    /// Step of the flow, on a lattice that of its finest cells, which is the control interval (s).
    pub interval: f64,
    /// Steps of one run (–).
    pub n_steps: u64,
    /// Steps before the analysis starts (–).
    pub n_spin_up_steps: u64,
    /// Steps in which wakes get their length, and a step its full cost (–); 0 where all steps cost alike.
    pub n_growing_steps: u64,
    /// Steps from one row of the series to the next (–).
    pub row_stride: u64,
    /// Diameter that "diameters" in the case file means: the first turbine's (m).
    pub diameter: f64,
    /// Hub height of the first turbine (m).
    pub hub_height: f64,
    /// Foot of each turbine's tower, farm frame (m).
    pub positions: Vec<Vector3>,
    /// Share of the domain's cross-section that the largest rotor takes (–).
    pub blockage: f64,
    /// Free-stream speed in cells per step (–).
    pub lattice_speed: f64,
    /// Angle by which the fastest rotor turns in a step in the mean wind, where the air has no cells (rad).
    pub turn: f64,
    /// How the air of the cells is computed.
    pub method: Method,
}

/// Sizes domain and step for `case` as its flow solver wants them; `footprints` holds one entry per
/// [machine](crate::case::Placement::machine) of the case.
///
/// # Errors
/// [`PlanError`] names what does not fit and the key that fixes it.
pub fn plan(case: &Case, footprints: &BTreeMap<String, Footprint>) -> Result<Plan, PlanError> {
    let mut machines = Vec::with_capacity(case.turbines.len());
    for placement in &case.turbines {
        let footprint = footprints.get(&placement.machine()).ok_or_else(|| {
            PlanError::UnknownModel { name: placement.name.clone(), model: placement.model.clone() }
        })?;
        machines.push((placement, *footprint));
    }
    check_roughness(case.wind.shear, machines[0].1.hub_height)?;
    let diameter = machines[0].1.diameter;
    let feet = case.feet(diameter);
    let positions: Vec<Vector3> = feet.iter().map(|&[x, y]| Vector3::new(x, y, 0.0)).collect();
    check_distances(&machines, &positions)?;
    (case.flow.solver.plan)(case, &Layout { machines, positions })
}

/// The plan of turbines in a box of cells, as the lattice needs it.
///
/// The step of the finest cells is the longest one that keeps tips well below the speed of sound on the
/// lattice and the free stream within [`MAXIMUM_LATTICE_SPEED`], rounded down so that a minute is a whole
/// number of steps of the domain's own cells.
///
/// # Errors
/// [`PlanError`] names what does not fit and the key that fixes it.
pub fn in_a_box(case: &Case, layout: &Layout) -> Result<Plan, PlanError> {
    let Layout { machines, positions } = layout;
    let diameter = layout.diameter();
    let cells_per_diameter = case.flow.domain().cells_per_diameter;
    let spacing = diameter / cells_per_diameter;
    let (origin, n_cells) = domain(case, positions, diameter, spacing);
    // Boxes want to know the cells, not the step.
    let cells = LatticeSettings::new(origin, spacing, n_cells, 1.0, case.wind.speed);
    let boxes::Boxes { outermost, levels } = boxes::lay_out(case, layout, &cells)?;
    let area = n_cells[1] as f64 * n_cells[2] as f64 * spacing * spacing;
    let widest = machines.iter().map(|(_, f)| f.diameter).fold(0.0, f64::max);
    let mut plan = Plan {
        origin,
        spacing,
        n_cells,
        n_points: n_cells,
        boxes: outermost,
        levels,
        interval: 0.0,
        n_steps: 0,
        n_spin_up_steps: 0,
        n_growing_steps: 0,
        row_stride: 1,
        diameter,
        hub_height: layout.hub_height(),
        positions: positions.clone(),
        blockage: std::f64::consts::PI / 4.0 * widest * widest / area,
        lattice_speed: 0.0,
        turn: 0.0,
        method: case.flow.domain().method,
    };
    check_resolution(machines, &plan, cells_per_diameter)?;
    plan.interval = step(case, machines, spacing, plan.depth())?;
    // Whole steps of the domain's own cells.
    let in_one = 1 << plan.depth();
    let steps = |duration: f64| in_one * (duration / plan.base_interval()).round() as u64;
    (plan.n_steps, plan.n_spin_up_steps) = (steps(case.time.duration), steps(case.time.spin_up));
    plan.row_stride = stride(case.output.interval.unwrap_or(0.0), plan.interval);
    plan.lattice_speed = case.wind.speed * plan.base_interval() / spacing;
    check_extent(machines, &plan)?;
    check_veer(case.wind.veer, &plan)?;
    check_planes(&case.output.crosswind_diameters, &plan)?;
    Ok(plan)
}

fn check_roughness(shear: Shear, hub_height: f64) -> Result<(), PlanError> {
    let highest = GREATEST_ROUGHNESS * hub_height;
    match shear {
        Shear::LogLaw { roughness_length } if roughness_length > highest => {
            Err(PlanError::TooRough { roughness_length, hub_height, highest })
        }
        _ => Ok(()),
    }
}

fn check_veer(veer: f64, plan: &Plan) -> Result<(), PlanError> {
    let top = plan.n_cells[2] as f64 * plan.spacing;
    let reach = plan.hub_height.max(top - plan.hub_height);
    let turn = veer.abs() * reach;
    if turn <= FARTHEST_TURN {
        return Ok(());
    }
    let [turn_deg, most_deg] = [turn, FARTHEST_TURN].map(f64::to_degrees);
    // Rounded down, so that what is printed can be taken.
    let greatest_deg = (1e4 * most_deg / reach).floor() / 1e4;
    Err(PlanError::VeersTooFar { turn_deg, most_deg, top, greatest_deg })
}

fn check_planes(distances: &[f64], plan: &Plan) -> Result<(), PlanError> {
    let low = plan.origin.x;
    let high = low + plan.n_points[0] as f64 * plan.spacing;
    for &distance in distances {
        let x = plan.positions[0].x + distance * plan.diameter;
        if !(low..=high).contains(&x) {
            return Err(PlanError::CrosswindOutside { distance, x, low, high });
        }
    }
    Ok(())
}

/// Steps nearest to `duration` (s), at least one.
fn stride(duration: f64, interval: f64) -> u64 {
    (duration / interval).round().max(1.0) as u64
}

/// The plan of turbines in air without cells, such as prescribed wind.
///
/// # Errors
/// None: every layout fits.
pub fn without_cells(case: &Case, layout: &Layout) -> Result<Plan, PlanError> {
    let positions = layout.positions.clone();
    let rotor_speed = |footprint: &Footprint| 2.0 * footprint.tip_speed / footprint.diameter;
    let fastest = layout.machines.iter().map(|(_, one)| rotor_speed(one)).fold(0.0, f64::max);
    let step = prescribed_step(fastest);
    Ok(without_air(case, layout.diameter(), layout.hub_height(), positions, step))
}

/// Step (s) in prescribed wind of rotors of which the fastest turns at `rotor_speed` (rad/s).
pub(crate) fn prescribed_step(rotor_speed: f64) -> f64 {
    PRESCRIBED_STEP.min(FARTHEST_PRESCRIBED_TURN / rotor_speed)
}

/// The same for a first turbine of `diameter` (m) and `hub_height` (m), in steps of `step` (s) unless the
/// case says otherwise.
pub(crate) fn without_air(
    case: &Case,
    diameter: f64,
    hub_height: f64,
    positions: Vec<Vector3>,
    step: f64,
) -> Plan {
    let interval = case.flow.step.unwrap_or(step);
    let n_spin_up_steps = (case.time.spin_up / interval).round() as u64;
    let row_stride =
        stride(case.output.interval.unwrap_or(PRESCRIBED_ROW / PRESCRIBED_STEP * step), interval);
    Plan {
        origin: Vector3::ZERO,
        spacing: 0.0,
        n_cells: [0; 3],
        boxes: Vec::new(),
        levels: Vec::new(),
        n_points: [0; 3],
        interval,
        n_steps: (case.time.duration / interval).round() as u64,
        n_spin_up_steps,
        n_growing_steps: 0,
        row_stride,
        diameter,
        hub_height,
        positions,
        blockage: 0.0,
        lattice_speed: 0.0,
        turn: 0.0,
        method: case.flow.domain().method,
    }
}

fn check_distances(
    machines: &[(&Placement, Footprint)],
    positions: &[Vector3],
) -> Result<(), PlanError> {
    for second in 1..machines.len() {
        for first in 0..second {
            let distance = (positions[first] - positions[second]).length();
            let needed = 0.5 * (machines[first].1.diameter + machines[second].1.diameter);
            if distance < needed {
                return Err(PlanError::Overlap {
                    first: machines[first].0.name.clone(),
                    second: machines[second].0.name.clone(),
                    distance,
                    needed,
                });
            }
        }
    }
    Ok(())
}

fn check_resolution(
    machines: &[(&Placement, Footprint)],
    plan: &Plan,
    cells_per_diameter: f64,
) -> Result<(), PlanError> {
    for (index, (placement, footprint)) in machines.iter().enumerate() {
        let cells = footprint.diameter / plan.spacing_at(index);
        if cells < MINIMUM_CELLS_PER_DIAMETER {
            return Err(PlanError::TooCoarse {
                name: placement.name.clone(),
                cells,
                needed: (MINIMUM_CELLS_PER_DIAMETER * cells_per_diameter / cells).ceil(),
            });
        }
    }
    Ok(())
}

fn domain(
    case: &Case,
    positions: &[Vector3],
    diameter: f64,
    spacing: f64,
) -> (Vector3, [usize; 3]) {
    let low = positions.iter().copied().reduce(Vector3::min).unwrap_or_default();
    let high = positions.iter().copied().reduce(Vector3::max).unwrap_or_default();
    let flow = case.flow.domain();
    let cells = |length: f64| (length / spacing).round().max(1.0) as usize;
    let length = high.x - low.x + (flow.upstream_diameters + flow.downstream_diameters) * diameter;
    let width = high.y - low.y + flow.width_diameters * diameter;
    let height = flow.height_diameters * diameter;
    let n_cells = [cells(length), cells(width), cells(height)];
    // Whole cells: the width is centred on the layout again after rounding.
    let y_low = 0.5 * (low.y + high.y) - 0.5 * n_cells[1] as f64 * spacing;
    (Vector3::new(low.x - flow.upstream_diameters * diameter, y_low, 0.0), n_cells)
}

fn check_extent(machines: &[(&Placement, Footprint)], plan: &Plan) -> Result<(), PlanError> {
    let low = plan.origin;
    let extent = Vector3::new(
        plan.n_cells[0] as f64 * plan.spacing,
        plan.n_cells[1] as f64 * plan.spacing,
        plan.n_cells[2] as f64 * plan.spacing,
    );
    let high = low + extent;
    for ((placement, footprint), position) in machines.iter().zip(&plan.positions) {
        let radius = 0.5 * footprint.diameter;
        let spans = [
            (
                "x",
                position.x - radius,
                position.x + radius,
                low.x,
                high.x,
                "raise flow.upstream_diameters or flow.downstream_diameters",
            ),
            (
                "y",
                position.y - radius,
                position.y + radius,
                low.y,
                high.y,
                "raise flow.width_diameters",
            ),
            (
                "z",
                footprint.hub_height - radius,
                footprint.hub_height + radius,
                low.z,
                high.z,
                "raise flow.height_diameters, or check hub height and rotor diameter",
            ),
        ];
        for (axis, span_low, span_high, domain_low, domain_high, fix) in spans {
            if span_low < domain_low || span_high > domain_high {
                return Err(PlanError::OutsideDomain {
                    name: placement.name.clone(),
                    axis,
                    low: span_low,
                    high: span_high,
                    domain_low,
                    domain_high,
                    fix,
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
