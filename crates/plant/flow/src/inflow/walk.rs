//! Wind, or temperature, at many positions, of which neighbours often share a plane or a row.

use basis::Vector3;

/// Writes what `at` gives at each of `positions` into `values`, of the same length: of what `plane` gives
/// for its x and `row` for its height, both asked again only where these differ from the position before.
#[inline(always)]
pub(super) fn walk<Plane, Row, Value>(
    positions: &[Vector3],
    values: &mut [Value],
    plane: impl Fn(f64) -> Plane,
    row: impl Fn(f64) -> Row,
    at: impl Fn(&Plane, &Row, f64) -> Value,
) {
    let Some(first) = positions.first() else { return };
    let (mut x, mut at_x) = (first.x, plane(first.x));
    let (mut z, mut at_z) = (first.z, row(first.z));
    for (position, value) in positions.iter().zip(values) {
        if position.x != x {
            x = position.x;
            at_x = plane(x);
        }
        if position.z != z {
            z = position.z;
            at_z = row(z);
        }
        *value = at(&at_x, &at_z, position.y);
    }
}
