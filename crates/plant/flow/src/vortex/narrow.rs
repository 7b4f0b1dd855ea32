//! Segments in single precision.

use super::segment::Segment;
use basis::Vector3;
use std::f64::consts::PI;

/// Lengths are divided by so much in single precision (m), so that their tenth powers stay within its range
/// from some millimetres to some ten kilometres; a power of two, which loses nothing.
pub(super) const UNIT: f64 = 16.0;

/// Distance from an end of a segment at which a place is that end, over the core (–).
const AT_END: f64 = 2e-3;
/// Roundings of its box's and its own size by which a place on a segment's line may be off it (–): its ends,
/// its direction, the place and the way between their centres have one each, and sums of them.
const ROUNDINGS: f64 = 16.0;

/// A segment in single precision, relative to the centre of the box that it is in and in [`UNIT`]s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Narrow {
    pub(super) from: [f32; 3],
    /// Unit vector from its beginning to its end; zero where they are one.
    pub(super) along: [f32; 3],
    /// Its length l, and 1/l².
    pub(super) length: f32,
    pub(super) inverse_squared: f32,
    /// Γ l/4π (m²/s).
    pub(super) strength: f32,
    /// r⁴ for a core r.
    pub(super) core: f32,
    /// Square of the product of the distances from both ends at which a place is an end itself: at some
    /// thousandths of the core, as far as rounding may bring it.
    pub(super) floor: f32,
    /// 1/δ², where δ is the distance from its line that rounding makes of none.
    pub(super) grain: f32,
}

impl Narrow {
    pub(super) fn of(segment: &Segment, centre: Vector3) -> Self {
        let Segment { from, to, circulation, core_squared } = *segment;
        let narrow = |way: Vector3| way.to_array().map(|x| x as f32);
        let (along, length) = ((to - from).normalize_or_zero(), (to - from).length() / UNIT);
        let inverse_squared = if along == Vector3::ZERO { 0.0 } else { length.powi(-2) };
        let size = (from - centre).length() / UNIT + length;
        let off = ROUNDINGS * 0.5 * f64::from(f32::EPSILON) * size;
        Self {
            from: narrow((from - centre) / UNIT),
            along: narrow(along),
            length: length as f32,
            inverse_squared: inverse_squared as f32,
            // Velocities have one length less than the strength: the unit, divided by here.
            strength: (circulation * length / (4.0 * PI * UNIT)) as f32,
            core: (core_squared / UNIT.powi(2)).powi(2) as f32,
            floor: (AT_END.powi(2) * core_squared / UNIT.powi(2) * length.powi(2)).max(1e-37)
                as f32,
            grain: off.powi(-2).min(1e30) as f32,
        }
    }
}
