//! From the map to the wind's frame: places of turbines, and the direction that the wind comes from.

/// Wind from the west (rad): its frame is the map's, x to the east and y to the north.
pub const FROM_WEST: f64 = 270.0_f64.to_radians();

/// A difference of places in the wind's frame is a whole number of these (in the layout's own unit): much
/// finer than anyone stakes out, and much coarser than the rounding of a turn, so that turbines which stand
/// side by side stay so.
const GRAIN: f64 = 1e-6;

/// Foot of a tower on the map, to the east and to the north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Position {
    /// In diameters of the first turbine.
    Diameters([f64; 2]),
    /// In metres.
    Metres([f64; 2]),
}

impl Position {
    /// East and north in its own unit.
    pub fn own(self) -> [f64; 2] {
        match self {
            Self::Diameters(place) | Self::Metres(place) => place,
        }
    }

    /// Metres in its unit, `diameter` (m) that of the first turbine.
    pub fn unit(self, diameter: f64) -> f64 {
        match self {
            Self::Diameters(_) => diameter,
            Self::Metres(_) => 1.0,
        }
    }
}

/// `positions` in the frame of wind from `direction` (rad, clockwise from north), in the layout's own unit: x
/// downwind, y to the left. The first turbine is where the map has it, of a map in metres at the origin, and
/// the others are turned about it; with wind from the west those of a map in diameters are where it has them,
/// bit for bit.
pub(crate) fn places(positions: &[Position], direction: f64) -> Vec<[f64; 2]> {
    let map = positions.iter().map(|position| position.own());
    let Some(&turbine) = positions.first() else { return Vec::new() };
    let first = turbine.own();
    let origin = match turbine {
        Position::Diameters(first) => first,
        // Of a map in metres the origin may be far away.
        Position::Metres(_) => [0.0; 2],
    };
    if direction == FROM_WEST {
        let moved = |[east, north]: [f64; 2]| match turbine {
            Position::Diameters(_) => [east, north],
            Position::Metres(_) => [east - first[0], north - first[1]],
        };
        return map.map(moved).collect();
    }
    let (sine, cosine) = direction.sin_cos();
    let on_grain = |length: f64| (length / GRAIN).round() * GRAIN;
    map.map(|[east, north]| {
        let (east, north) = (east - first[0], north - first[1]);
        [
            origin[0] + on_grain(-east * sine - north * cosine),
            origin[1] + on_grain(east * cosine - north * sine),
        ]
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(positions: &[[f64; 2]], degrees: f64) -> Vec<[f64; 2]> {
        let positions: Vec<Position> = positions.iter().copied().map(Position::Diameters).collect();
        places(&positions, degrees.to_radians())
    }

    #[test]
    fn each_quarter_of_the_compass_puts_downwind_where_it_belongs() {
        // T2 is east of T1, T3 north of it.
        let map = [[1.0, -2.0], [6.0, -2.0], [1.0, 1.0]];
        assert_eq!(turned(&map, 270.0), map);
        // From the north: downwind is south, left of it east.
        assert_eq!(turned(&map, 0.0), [[1.0, -2.0], [1.0, 3.0], [-2.0, -2.0]]);
        // From the east: downwind is west, left of it south.
        assert_eq!(turned(&map, 90.0), [[1.0, -2.0], [-4.0, -2.0], [1.0, -5.0]]);
        // From the south: downwind is north, left of it west.
        assert_eq!(turned(&map, 180.0), [[1.0, -2.0], [1.0, -7.0], [4.0, -2.0]]);
        // From the south-west: along the diagonal, which stands in one line.
        let diagonal = turned(&[[0.0, 0.0], [3.0, 3.0], [5.0, 5.0]], 225.0);
        assert!(diagonal.iter().all(|place| place[1] == 0.0), "{diagonal:?}");
        assert!((diagonal[2][0] - 50.0_f64.sqrt()).abs() < GRAIN);
    }

    #[test]
    fn turning_keeps_distances_and_abreast_stays_abreast() {
        for degrees in (0..720).map(|half| 0.5 * f64::from(half)) {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            for far in [-43.21, -1.0, 0.37, 7.0, 50.0] {
                let map = [[0.3, 0.7], [0.3 + far, 0.7 - 0.6 * far]];
                let found = turned(&map, degrees);
                assert_eq!(found[0], [0.3, 0.7]);
                let distance = (found[1][0] - 0.3).hypot(found[1][1] - 0.7);
                assert!((distance - far.hypot(0.6 * far)).abs() < 2.0 * GRAIN);
                // Turbines in a row across the wind.
                let across = |far: f64| [far * cosine, -far * sine];
                let row = turned(&[[0.0, 0.0], across(far), across(1.3 * far)], degrees);
                // From the west nothing is turned, and nothing rounded.
                let slack = if degrees == 270.0 { 1e-12 } else { 0.0 };
                assert!(row.iter().all(|place| place[0].abs() <= slack), "{degrees}: {row:?}");
                assert!(row[1][1] * far > 0.0, "to the left is to the left");
            }
        }
    }

    #[test]
    fn a_map_in_metres_counts_from_its_first_turbine() {
        let map = [[4e5, 5e6], [4e5 + 1000.0, 5e6]].map(Position::Metres);
        assert_eq!(places(&map, FROM_WEST), [[0.0, 0.0], [1000.0, 0.0]]);
        assert_eq!(places(&map, 0.0), [[0.0, 0.0], [0.0, 1000.0]]);
        assert_eq!((map[0].unit(240.0), Position::Diameters([0.0; 2]).unit(240.0)), (1.0, 240.0));
        assert!(places(&[], 1.0).is_empty());
    }
}
