//! Slopes of wind and temperature along the three axes at the cells of a row.

use crate::lattice::atmosphere::stratification::Warmth;
use crate::lattice::fields::{Field, Fields};
use crate::lattice::layout::Edge;
use crate::simd::Simd;

/// The slope of a quantity along an axis: a share of the cell before and one of the cell behind.
#[derive(Clone, Copy)]
struct Slope {
    places: [*const f32; 2],
    shares: [f32; 2],
}

impl Slope {
    /// That at the cells from `x` (per cell).
    ///
    /// # Safety
    /// Whole vectors of a row from `x`, padding included.
    #[inline(always)]
    unsafe fn at<S: Simd>(&self, x: usize) -> S {
        let [before, behind] = self.places;
        let [first, last] = self.shares;
        // SAFETY: handed through.
        unsafe {
            let before = S::splat(first) * S::load(before.wrapping_add(x));
            S::splat(last).mul_add(S::load(behind.wrapping_add(x)), before)
        }
    }
}

/// Slopes of the wind at a row: component by component, axis by axis.
pub(super) struct Slopes([[Slope; 3]; 3]);

/// What becomes of wind along `component` beyond an `edge` that `axis` leads through: 1 or −1.
fn turned(edge: Edge, component: usize, axis: usize) -> f32 {
    match edge {
        Edge::Periodic | Edge::Open => 1.0,
        Edge::Slip if component == axis => -1.0,
        Edge::Slip => 1.0,
        Edge::Hold => -1.0,
    }
}

impl Slopes {
    /// Those at row (`y`, `z`), over a `rough` ground or another one.
    #[inline(always)]
    pub(super) fn new(fields: &Fields, rough: bool, place: [usize; 2]) -> Self {
        Self(std::array::from_fn(|component| {
            std::array::from_fn(|axis| wind(fields, rough, place, component, axis))
        }))
    }

    /// The gradient of the wind at the cells from `x`.
    ///
    /// # Safety
    /// Whole vectors of a row from `x`, padding included.
    #[inline(always)]
    pub(super) unsafe fn wind<S: Simd>(&self, x: usize) -> [[S; 3]; 3] {
        let mut gradient = [[S::splat(0.0); 3]; 3];
        for (slopes, row) in self.0.iter().zip(&mut gradient) {
            for (slope, value) in slopes.iter().zip(row) {
                // SAFETY: handed through.
                *value = unsafe { slope.at(x) };
            }
        }
        gradient
    }

    /// Slopes of the temperature of `warmth` at the same row.
    #[inline(always)]
    pub(super) fn of_temperature(
        &self,
        fields: &Fields,
        warmth: &Warmth<'_>,
        [y, z]: [usize; 2],
    ) -> WarmSlopes {
        let at = |y, z| fields.row(warmth.temperature, y, z).cast_const();
        let here = at(y, z);
        let along =
            Slope { places: [here.wrapping_sub(1), here.wrapping_add(1)], shares: [-0.5, 0.5] };
        let across = Slope {
            places: [at(fields.beside(y, -1), z), at(fields.beside(y, 1), z)],
            shares: [-0.5, 0.5],
        };
        // Upwards between the levels below and above, where there are such.
        let (below, above) = (fields.above(z, -1), fields.above(z, 1));
        let n_steps = usize::from(below.is_some()) + usize::from(above.is_some());
        let share = 1.0 / n_steps.max(1) as f32;
        let (below, above) = (below.unwrap_or(z), above.unwrap_or(z));
        let upwards = Slope { places: [at(y, below), at(y, above)], shares: [-share, share] };
        let means = [below, above].map(|level| warmth.levels[level].mean);
        WarmSlopes { axes: [along, across, upwards], mean: share * (means[1] - means[0]) }
    }
}

/// The slope of wind along `component` along `axis` at a row.
#[inline(always)]
fn wind(fields: &Fields, rough: bool, [y, z]: [usize; 2], component: usize, axis: usize) -> Slope {
    let at = |y, z| fields.row(Field::Wind(component), y, z).cast_const();
    let here = at(y, z);
    let mut shares = [-0.5, 0.5];
    let places = match axis {
        0 => [here.wrapping_sub(1), here.wrapping_add(1)],
        1 => {
            let ends = [y == 0, y + 1 == fields.n_cells[1]];
            for (share, at_end) in shares.iter_mut().zip(ends) {
                if at_end {
                    *share *= turned(fields.sides, component, axis);
                }
            }
            [at(fields.beside(y, -1), z), at(fields.beside(y, 1), z)]
        }
        _ => {
            let levels = [-1, 1].map(|offset| fields.above(z, offset));
            for ((share, level), edge) in shares.iter_mut().zip(levels).zip(fields.levels) {
                if level.is_none() {
                    *share *= turned(edge, component, axis);
                }
            }
            if rough && levels[0].is_none() && levels[1].is_some() && component != axis {
                // The mean wind bends most here: half a difference would be half of its slope.
                shares = [-1.0, 1.0];
            }
            levels.map(|level| at(y, level.unwrap_or(z)))
        }
    };
    Slope { places, shares }
}

/// Slopes of the temperature at a row.
pub(super) struct WarmSlopes {
    axes: [Slope; 3],
    /// That of the means of the levels (K per cell).
    mean: f32,
}

/// Slopes of the temperature of some cells (K per cell).
pub(super) struct WarmSlope<S> {
    /// Along each axis.
    pub(super) along: [S; 3],
    /// The same upwards of what departs from the level's mean.
    pub(super) departing: S,
}

impl WarmSlopes {
    /// Those of the cells from `x`.
    ///
    /// # Safety
    /// Whole vectors of a row from `x`, padding included.
    #[inline(always)]
    pub(super) unsafe fn at<S: Simd>(&self, x: usize) -> WarmSlope<S> {
        let [along, across, upwards] = &self.axes;
        // SAFETY: handed through.
        let along = unsafe { [along.at::<S>(x), across.at(x), upwards.at(x)] };
        WarmSlope { along, departing: along[2] - S::splat(self.mean) }
    }
}
