//! Wind at many positions, of which neighbours often share a plane or a row.

use basis::Vector3;

/// Writes `wind` at each of `positions` into `velocities`, of the same length: of what `plane` gives for its
/// x and `row` for its height, both asked again only where these differ from the position before.
#[inline(always)]
pub(super) fn walk<Plane, Row>(
    positions: &[Vector3],
    velocities: &mut [Vector3],
    plane: impl Fn(f64) -> Plane,
    row: impl Fn(f64) -> Row,
    wind: impl Fn(&Plane, &Row, f64) -> Vector3,
) {
    let Some(first) = positions.first() else { return };
    let (mut x, mut at_x) = (first.x, plane(first.x));
    let (mut z, mut at_z) = (first.z, row(first.z));
    for (position, velocity) in positions.iter().zip(velocities) {
        if position.x != x {
            x = position.x;
            at_x = plane(x);
        }
        if position.z != z {
            z = position.z;
            at_z = row(z);
        }
        *velocity = wind(&at_x, &at_z, position.y);
    }
}
