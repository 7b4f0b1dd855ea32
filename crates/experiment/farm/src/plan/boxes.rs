//! Boxes of finer cells: from the layout to cells, and checked before anything runs.

use super::{Footprint, Layout, MOST_LEVELS, PlanError};
use crate::case::{Case, Placement};
use crate::domain::{SMEARING_CELLS, Sides};
use crate::refinement::{Asked, asked};
use basis::Vector3;
use flow::lattice::LatticeSettings;
use flow::lattice::refinement::{MARGIN, Refinement, WARM_MARGIN};
use flow::lattice::spreading::REACH;

/// Rounding of lengths in cells (–).
const ROUNDING: f64 = 1e-6;
const AXES: [&str; 3] = ["x", "y", "z"];

/// The boxes of a plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Boxes {
    /// Those that lie in no other, in cells of the domain.
    pub(super) outermost: Vec<Refinement>,
    /// How many boxes within one another each turbine stands in (–).
    pub(super) levels: Vec<u32>,
}

/// A box that was asked for, with those within it.
struct Wanted {
    /// Its number in the case.
    number: usize,
    low: Vector3,
    high: Vector3,
    within: Vec<Wanted>,
}

/// A grid of cells in which boxes are to be laid out.
struct Around {
    /// Number of the box that it is; none for the domain.
    number: Option<usize>,
    origin: Vector3,
    spacing: f64,
    n_cells: [usize; 3],
    /// Cells before its end along x in which there is to be no box (–).
    kept: usize,
    /// Whether a box may reach to its first and last cells along each axis.
    walls: [[bool; 2]; 3],
    /// Cells before its sides, and between boxes, where there is to be none.
    margin: usize,
}

/// The boxes that `case` asks for, in the cells that `settings` lay out.
///
/// # Errors
/// [`PlanError`] with what would do.
pub(super) fn lay_out(
    case: &Case,
    layout: &Layout,
    settings: &LatticeSettings,
) -> Result<Boxes, PlanError> {
    let mut wanted = Vec::new();
    for (number, asked) in asked(&case.flow.values).iter().enumerate() {
        wanted.push(Wanted::of(number, asked, layout));
    }
    // The largest first: whatever lies within another finds it there.
    wanted.sort_by(|a, b| b.volume().total_cmp(&a.volume()));
    let margin = if case.wind.precursor.is_some() { WARM_MARGIN } else { MARGIN };
    let mut tree = Vec::new();
    for one in wanted {
        one.place(&mut tree, margin)?;
    }
    let domain = Around {
        number: None,
        origin: settings.origin,
        spacing: settings.spacing,
        n_cells: settings.n_cells,
        kept: settings.sponge_cells(),
        walls: [[false; 2], [case.flow.domain().sides != Sides::Open; 2], [true; 2]],
        margin,
    };
    let outermost = domain.refined(&tree)?;
    if let Some(depth) = outermost.iter().map(Refinement::depth).max()
        && depth > MOST_LEVELS
    {
        return Err(PlanError::TooManyLevels { depth });
    }
    let feet = layout.machines.iter().zip(&layout.positions);
    let level = |((placement, footprint), foot): (&(&Placement, Footprint), &Vector3)| {
        let rotor = Rotor { name: &placement.name, foot: *foot, footprint };
        rotor.level(layout.diameter(), &tree, &outermost, &domain)
    };
    let levels = feet.map(level).collect::<Result<_, _>>()?;
    Ok(Boxes { outermost, levels })
}

impl Wanted {
    fn of(number: usize, asked: &Asked, layout: &Layout) -> Self {
        let is_meant =
            |name: &String| asked.around.is_empty() || asked.around.iter().any(|it| it == name);
        let machines = layout.machines.iter().zip(&layout.positions);
        let feet = machines.filter(|((placement, _), _)| is_meant(&placement.name));
        let feet: Vec<Vector3> = feet.map(|(_, foot)| *foot).collect();
        let low = feet.iter().copied().reduce(Vector3::min).unwrap_or_default();
        let high = feet.iter().copied().reduce(Vector3::max).unwrap_or_default();
        let aside = 0.5 * asked.width_diameters;
        let before = Vector3::new(asked.upstream_diameters, aside, 0.0);
        let after = Vector3::new(asked.downstream_diameters, aside, asked.height_diameters);
        let diameter = layout.diameter();
        Self {
            number,
            low: low - before * diameter,
            high: high + after * diameter,
            within: Vec::new(),
        }
    }

    fn volume(&self) -> f64 {
        (self.high - self.low).to_array().iter().product()
    }

    /// Puts it among `others`, or within the one that holds it.
    fn place(self, others: &mut Vec<Wanted>, margin: usize) -> Result<(), PlanError> {
        let spans = |other: &Wanted| {
            let (low, high) = (self.low - other.low, other.high - self.high);
            low.min(high).min_element() >= -ROUNDING
        };
        if let Some(other) = others.iter_mut().find(|other| spans(other)) {
            return self.place(&mut other.within, margin);
        }
        let meets = |other: &&Wanted| {
            let overlap = self.high.min(other.high) - self.low.max(other.low);
            overlap.min_element() > 0.0
        };
        if let Some(other) = others.iter().find(meets) {
            let (first, second) = (other.number.min(self.number), other.number.max(self.number));
            return Err(PlanError::BoxesMeet { first, second: second.to_string(), margin });
        }
        others.push(self);
        Ok(())
    }
}

impl Around {
    /// The boxes `wanted` in it, in its cells.
    fn refined(&self, wanted: &[Wanted]) -> Result<Vec<Refinement>, PlanError> {
        let mut boxes: Vec<Refinement> = Vec::with_capacity(wanted.len());
        for (index, one) in wanted.iter().enumerate() {
            let mut cut = self.cut(one)?;
            let margin = self.margin;
            let apart = |other: &Refinement| {
                (0..3).any(|axis| {
                    let end = |one: &Refinement| one.first_cell[axis] + one.n_cells[axis] + margin;
                    end(other) <= cut.first_cell[axis] || end(&cut) <= other.first_cell[axis]
                })
            };
            if let Some(place) = boxes.iter().position(|other| !apart(other)) {
                let numbers = [wanted[place].number, wanted[index].number];
                let [first, second] = [numbers[0].min(numbers[1]), numbers[0].max(numbers[1])];
                return Err(PlanError::BoxesMeet { first, second: second.to_string(), margin });
            }
            cut.within = self.inside(one, &cut).refined(&one.within)?;
            boxes.push(cut);
        }
        Ok(boxes)
    }

    /// The cells of the box `one` of it, which are `cut`.
    fn inside(&self, one: &Wanted, cut: &Refinement) -> Self {
        let first = Vector3::from_array(cut.first_cell.map(|n| n as f64));
        Self {
            number: Some(one.number),
            origin: self.origin + first * self.spacing,
            spacing: 0.5 * self.spacing,
            n_cells: cut.fine_cells(),
            kept: 0,
            margin: self.margin,
            walls: std::array::from_fn(|axis| {
                let end = cut.first_cell[axis] + cut.n_cells[axis];
                [
                    self.walls[axis][0] && cut.first_cell[axis] == 0,
                    self.walls[axis][1] && end == self.n_cells[axis],
                ]
            }),
        }
    }

    /// The cells of it that `one` covers, rounded outwards, with nothing within it.
    fn cut(&self, one: &Wanted) -> Result<Refinement, PlanError> {
        let [low, high] =
            [one.low, one.high].map(|corner| ((corner - self.origin) / self.spacing).to_array());
        let (mut first_cell, mut n_cells) = ([0; 3], [0; 3]);
        for axis in 0..3 {
            let n = self.n_cells[axis] as f64;
            let kept = if axis == 0 { self.kept as f64 } else { 0.0 };
            let first = (low[axis] + ROUNDING).floor();
            let end = (high[axis] - ROUNDING).ceil();
            let margin = self.margin as f64;
            let apart = [first >= margin, end + margin <= n - kept];
            // Sides along which air slips, or that lead to each other, are as good as none to a box from the
            // one to the other.
            let whole = axis != 1 || (first == 0.0 && end == n);
            let stands = [first == 0.0 && whole, end == n && whole];
            let good: [bool; 2] =
                std::array::from_fn(|side| apart[side] || (self.walls[axis][side] && stands[side]));
            if good != [true; 2] {
                return Err(self.refusal(one, axis, usize::from(good[0])));
            }
            (first_cell[axis], n_cells[axis]) = (first as usize, (end - first) as usize);
        }
        Ok(Refinement { first_cell, n_cells, within: Vec::new() })
    }

    /// That `one` comes too close to the lower (0) or upper (1) `side` of it along `axis`.
    fn refusal(&self, one: &Wanted, axis: usize, side: usize) -> PlanError {
        let [low, high] = [one.low, one.high].map(|corner| corner.to_array()[axis]);
        let (start, length) = (self.origin.to_array()[axis], self.n_cells[axis] as f64);
        let margin = self.margin as f64 * self.spacing;
        let kept = if axis == 0 { self.kept as f64 * self.spacing } else { 0.0 };
        let (own, further) = match (axis, side) {
            (0, 0) => ("upstream_diameters", "flow.upstream_diameters"),
            (0, _) => ("downstream_diameters", "flow.downstream_diameters"),
            (1, _) => ("width_diameters", "flow.width_diameters"),
            _ => ("height_diameters", "flow.height_diameters"),
        };
        let (around, further) = match self.number {
            None => ("the domain".to_owned(), further.to_owned()),
            Some(number) => {
                (format!("flow.refinement.{number}"), format!("flow.refinement.{number}.{own}"))
            }
        };
        let whole = if axis == 0 || !self.walls[axis][1] { "" } else { ", or make it reach them" };
        PlanError::BoxOutside {
            number: one.number.to_string().into(),
            key: own,
            axis: AXES[axis],
            low,
            high,
            around: format!("{around}: {} cells", self.margin).into(),
            least: start + if axis == 2 { 0.0 } else { margin },
            most: start + length * self.spacing - margin - kept,
            fix: format!("lower its {own}, or raise {further}{whole}").into(),
        }
    }
}

/// A turbine that stands in a box, or beside it.
struct Rotor<'a> {
    name: &'a str,
    foot: Vector3,
    footprint: &'a Footprint,
}

impl Rotor<'_> {
    /// How many boxes within one another it stands in: of those `wanted`, which `boxes` of the grid `around`
    /// are.
    fn level(
        &self,
        diameter: f64,
        wanted: &[Wanted],
        boxes: &[Refinement],
        around: &Around,
    ) -> Result<u32, PlanError> {
        for (one, cut) in wanted.iter().zip(boxes) {
            let inside = around.inside(one, cut);
            let extent = Vector3::from_array(inside.n_cells.map(|n| n as f64)) * inside.spacing;
            let (low, high) = (inside.origin, inside.origin + extent);
            let [need_low, need_high] = self.reach(inside.spacing);
            let (before, after) = ((need_low - low).to_array(), (high - need_high).to_array());
            let short = |axis: usize, side: usize| {
                let room = [before, after][side][axis];
                (room < -ROUNDING && !inside.walls[axis][side]).then_some((axis, side, -room))
            };
            let sides = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 1)];
            let Some((axis, side, missing)) =
                sides.into_iter().find_map(|(axis, side)| short(axis, side))
            else {
                return Ok(1 + self.level(diameter, &one.within, &cut.within, &inside)?);
            };
            let [need_low, need_high] = self.reach(around.spacing);
            let overlap = (need_high.min(high) - need_low.max(low)).min_element();
            if overlap > 0.0 {
                return Err(self.refusal(diameter, one, (axis, side), missing));
            }
        }
        Ok(0)
    }

    /// Where its forces lie, as they are spread on cells of `spacing` (m), whichever way it faces.
    fn reach(&self, spacing: f64) -> [Vector3; 2] {
        let beyond = REACH * SMEARING_CELLS * spacing;
        let aside = 0.5 * self.footprint.diameter + beyond;
        let up = self.footprint.hub_height + aside;
        let to = |sign: f64, z| self.foot + Vector3::new(sign * aside, sign * aside, z);
        [to(-1.0, 0.0), to(1.0, up)]
    }

    /// That it lies neither in `one` nor apart from it, which misses some length (m) at a side of an axis.
    fn refusal(
        &self,
        diameter: f64,
        one: &Wanted,
        (axis, side): (usize, usize),
        missing: f64,
    ) -> PlanError {
        let (key, end, share) = match (axis, side) {
            (0, 0) => ("upstream_diameters", "upstream", 1.0),
            (0, _) => ("downstream_diameters", "downstream", 1.0),
            (1, 0) => ("width_diameters", "to the right", 2.0),
            (1, _) => ("width_diameters", "to the left", 2.0),
            _ => ("height_diameters", "upwards", 1.0),
        };
        // Rounded up, so that what is printed can be taken.
        let missing_diameters = (share * missing / diameter * 100.0).ceil() / 100.0;
        PlanError::RotorAtEdge {
            name: self.name.to_owned(),
            number: one.number.to_string().into(),
            key,
            end,
            missing,
            missing_diameters,
        }
    }
}
