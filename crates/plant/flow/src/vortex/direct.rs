//! Direct summation in double precision: the oracle of everything faster.

use super::segment::Segment;
use basis::Vector3;

/// On return `velocities` (m/s) holds what `segments` induce at each of `positions` (m, farm frame), of the
/// same length.
pub fn direct(segments: &[Segment], positions: &[Vector3], velocities: &mut [Vector3]) {
    for (position, velocity) in positions.iter().zip(velocities) {
        *velocity = segments.iter().map(|segment| segment.velocity(*position)).sum();
    }
}
