//! Where velocity is averaged by phase: planes and a volume, cut to what is kept.

use basis::keys::Values;
use basis::records::{Grid, Plane, PlaneAxes};
use farm::Plan;
use flow::fields::FieldSource;
use std::ops::Range;

/// Memory of a point beside its sums (bytes): its velocity now, and in a volume its pressure.
const BUFFER_BYTES: u64 = 4 * size_of::<f32>() as u64;
/// Points that lie outside of an end by less than this count as on it (distances of points).
const ROUNDING: f64 = 1e-6;

/// A plane or a volume before it is looked at.
pub(super) struct Place {
    name: String,
    what: What,
    /// Points that are kept along x, y, z, of all that the plane or the volume has.
    kept: [Range<usize>; 3],
    /// Points of the whole plane or volume (–).
    n_whole: u64,
}

#[derive(Clone, Copy)]
enum What {
    /// Across the axis that is not spanned, at this position (m).
    Plane(PlaneAxes, f64),
    /// Of every so many cells.
    Volume(usize),
}

/// All that `values` ask for of the air of `plan`.
pub(super) fn of(plan: &Plan, values: &Values) -> Vec<Place> {
    let foot = plan.positions[0];
    let from = [foot.x, foot.y, plan.hub_height];
    let kinds = [
        ("crosswind_diameters", PlaneAxes::Crosswind, 0, "D"),
        ("beside_diameters", PlaneAxes::Streamwise, 1, "D-beside"),
        ("height_diameters", PlaneAxes::Horizontal, 2, "D-above"),
    ];
    let mut places = Vec::new();
    for (key, axes, across, suffix) in kinds {
        for distance in values.numbers(key) {
            let (mut kept, mut whole) = (kept(plan, values, 1, from), plan.n_points);
            // The plane itself has one point across.
            (kept[across], whole[across]) = (0..1, 1);
            places.push(Place {
                name: format!("{distance}{suffix}"),
                what: What::Plane(axes, from[across] + distance * plan.diameter),
                kept,
                n_whole: product(whole),
            });
        }
    }
    if values.has("volume_stride") {
        let stride = values.number("volume_stride") as usize;
        let (what, kept) = (What::Volume(stride), kept(plan, values, stride, from));
        let n_whole = product(plan.n_points.map(|n| n.div_ceil(stride)));
        places.push(Place { name: "volume".to_owned(), what, kept, n_whole });
    }
    places
}

fn product(n_points: [usize; 3]) -> u64 {
    n_points.map(|n| n as u64).iter().product()
}

/// Points along x, y, z of every `stride`-th cell of `plan` that `values` keep; lengths count `from` the
/// first hub (m).
fn kept(plan: &Plan, values: &Values, stride: usize, from: [f64; 3]) -> [Range<usize>; 3] {
    let (origin, keys) = (plan.origin.to_array(), ["x_diameters", "y_diameters", "z_diameters"]);
    std::array::from_fn(|axis| {
        let n = plan.n_points[axis].div_ceil(stride);
        let [low, high] = *values.numbers(keys[axis]) else { return 0..n };
        let first = origin[axis] + 0.5 * plan.spacing;
        let steps = |diameters: f64| {
            (from[axis] + diameters * plan.diameter - first) / (plan.spacing * stride as f64)
        };
        let begin = (steps(low) - ROUNDING).ceil().max(0.0) as usize;
        let end = (steps(high) + ROUNDING).floor().max(-1.0) + 1.0;
        // A point at least: what lies outside of the domain keeps the nearest.
        let begin = begin.min(n.saturating_sub(1));
        begin..(end as usize).clamp(begin + 1, n.max(begin + 1))
    })
}

impl Place {
    /// Points that are kept (–).
    pub(super) fn n_points(&self) -> u64 {
        product(self.kept.each_ref().map(|range| range.len()))
    }

    /// Memory of the velocity that it looks at (bytes): all of it, and what is kept.
    pub(super) fn buffers(&self) -> u64 {
        (self.n_whole + self.n_points()) * BUFFER_BYTES
    }
}

/// A plane or a volume at work.
pub(super) struct Taken {
    place: Place,
    grid: Grid,
    /// The whole plane as it was last; a volume is made anew each time.
    plane: Option<Plane>,
    velocity: [Vec<f32>; 3],
    /// None of planes, and of a flow that does not know it.
    pressure: Option<Vec<f32>>,
}

/// Velocity (m/s) and, where it is known, pressure over density (m²/s²).
pub(super) type Now<'a> = ([&'a [f32]; 3], Option<&'a [f32]>);

impl Taken {
    /// Of `place` in the flow of `fields`.
    pub(super) fn begin(place: Place, fields: &dyn FieldSource) -> Self {
        let (whole, plane, has_pressure) = match place.what {
            What::Plane(axes, position) => {
                let plane = fields.plane(&place.name, axes, position);
                (Grid::of_plane(&plane), Some(Plane { averaged: 0.0, ..plane }), false)
            }
            What::Volume(stride) => {
                let volume = fields.volume(stride);
                let (origin, n_points) = (volume.origin.to_array(), volume.n_points);
                let grid = Grid { origin, spacing: [volume.spacing; 3], n_points };
                (grid, None, volume.pressure.is_some())
            }
        };
        let firsts = std::array::from_fn(|axis| place.kept[axis].start);
        let grid = Grid {
            origin: whole.position(firsts),
            n_points: place.kept.each_ref().map(|range| range.len()),
            ..whole
        };
        let velocity = std::array::from_fn(|_| vec![0.0; grid.len()]);
        let pressure = has_pressure.then(|| vec![0.0; grid.len()]);
        Self { place, grid, plane, velocity, pressure }
    }

    /// Its name.
    pub(super) fn name(&self) -> &str {
        &self.place.name
    }

    /// The points that are kept.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Whether it knows the pressure.
    pub(super) fn has_pressure(&self) -> bool {
        self.pressure.is_some()
    }

    /// The air of `fields` now at the points that are kept.
    pub(super) fn now(&mut self, fields: &dyn FieldSource) -> Now<'_> {
        match (&mut self.plane, self.place.what) {
            (Some(plane), _) => {
                fields.refresh(plane);
                let n_points = Grid::of_plane(plane).n_points;
                for (own, whole) in self.velocity.iter_mut().zip(&plane.velocity) {
                    cut(&self.place.kept, n_points, whole, own);
                }
            }
            (None, What::Volume(stride)) => {
                let volume = fields.volume(stride);
                let velocity = self.velocity.iter_mut().zip(&volume.velocity);
                for (own, whole) in velocity.chain(self.pressure.iter_mut().zip(&volume.pressure)) {
                    cut(&self.place.kept, volume.n_points, whole, own);
                }
            }
            (None, What::Plane(..)) => {}
        }
        (self.velocity.each_ref().map(Vec::as_slice), self.pressure.as_deref())
    }
}

/// On return `cut` holds what of `whole`, of `n_points` along x, y, z, is `kept`.
fn cut(kept: &[Range<usize>; 3], n_points: [usize; 3], whole: &[f32], cut: &mut [f32]) {
    let [n_x, n_y, _] = n_points;
    let [along, beside, up] = kept;
    let mut rows = cut.chunks_exact_mut(along.len());
    for z in up.clone() {
        for y in beside.clone() {
            let first = n_x * (y + n_y * z);
            if let Some(row) = rows.next() {
                row.copy_from_slice(&whole[first + along.start..first + along.end]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_cut_out_in_order() {
        let n_points = [4, 3, 2];
        let whole: Vec<f32> = (0..24).map(|index| index as f32).collect();
        let kept = [1..3, 0..2, 1..2];
        let mut found = [0.0; 4];
        cut(&kept, n_points, &whole, &mut found);
        assert_eq!(found, [13.0, 14.0, 17.0, 18.0]);
    }
}
