//! What the levels of a box tell at an instant: over height, and of the layer as a whole.

use farm::precursor::hub_wind;
use flow::lattice::atmosphere::{
    LevelStatistics, friction_velocity, ground_heat_flux, layer_depth,
};

/// A quantity that every level has.
pub(super) struct OfLevel {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    pub(super) of: fn(&LevelStatistics) -> f64,
}

/// A box at an instant.
#[derive(Clone, Copy)]
pub(super) struct Instant<'a> {
    /// Its levels, from the ground up.
    pub(super) levels: &'a [LevelStatistics],
    /// Height of the hub (m).
    pub(super) hub: f64,
    /// The geostrophic wind that drives it, towards east and north (m/s).
    pub(super) geostrophic: [f64; 2],
}

/// A quantity of the layer as a whole.
pub(super) struct OfLayer {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    pub(super) of: fn(Instant) -> f64,
}

/// Places in [`OF_LEVELS`].
pub(super) const INTENSITY: usize = 4;
pub(super) const TEMPERATURE: usize = 5;
pub(super) const HEAT_FLUX: usize = 7;
pub(super) const STRESS: [usize; 4] = [11, 12, 13, 14];

macro_rules! of_level {
    ($name:literal, $unit:literal, $meaning:literal, $of:expr) => {
        OfLevel { name: $name, unit: $unit, meaning: $meaning, of: $of }
    };
}

/// What is kept of every level.
pub(super) const OF_LEVELS: [OfLevel; 17] = [
    of_level!("u", "m s-1", "mean wind towards east, along the box's x axis", |l| l.velocity[0]),
    of_level!("v", "m s-1", "mean wind towards north, along the box's y axis", |l| l.velocity[1]),
    of_level!("speed", "m s-1", "speed of the mean wind", |l| speed(horizontal(l))),
    of_level!("direction", "degree", "where the mean wind comes from, clockwise from north", |l| {
        direction(horizontal(l))
    }),
    of_level!(
        "turbulence_intensity",
        "1",
        "square root of 2/3 of the turbulent kinetic energy, over the speed",
        intensity
    ),
    of_level!("temperature", "K", "mean potential temperature", |l| l.temperature),
    of_level!(
        "stress",
        "m2 s-2",
        "magnitude of the flux of momentum, unresolved included",
        LevelStatistics::whole_stress
    ),
    of_level!(
        "heat_flux",
        "K m s-1",
        "flux of heat upwards, unresolved included",
        LevelStatistics::whole_heat_flux
    ),
    of_level!("uu", "m2 s-2", "variance of u", |l| l.variance[0]),
    of_level!("vv", "m2 s-2", "variance of v", |l| l.variance[1]),
    of_level!("ww", "m2 s-2", "variance of w", |l| l.variance[2]),
    of_level!("uw", "m2 s-2", "resolved flux of u upwards", |l| l.stress[0]),
    of_level!("vw", "m2 s-2", "resolved flux of v upwards", |l| l.stress[1]),
    of_level!("uw_unresolved", "m2 s-2", "unresolved flux of u upwards", |l| l.subgrid_stress[0]),
    of_level!("vw_unresolved", "m2 s-2", "unresolved flux of v upwards", |l| l.subgrid_stress[1]),
    of_level!("temperature_variance", "K2", "variance of temperature", |l| l.temperature_variance),
    of_level!("heat_flux_unresolved", "K m s-1", "unresolved flux of heat upwards", |l| {
        l.subgrid_heat_flux
    }),
];

/// Places in [`OF_LAYER`].
pub(super) const HUB_SPEED: usize = 0;
pub(super) const HUB_DIRECTION: usize = 1;
pub(super) const FRICTION: usize = 2;
pub(super) const GEOSTROPHIC: [usize; 2] = [6, 7];

/// What is kept of the layer.
pub(super) const OF_LAYER: [OfLayer; 8] = [
    OfLayer {
        name: "hub_speed",
        unit: "m s-1",
        meaning: "speed of the mean wind at hub height",
        of: |at| speed(hub_wind(at.levels, at.hub)),
    },
    OfLayer {
        name: "hub_direction",
        unit: "degree",
        meaning: "where the mean wind at hub height comes from, clockwise from north",
        of: |at| direction(hub_wind(at.levels, at.hub)),
    },
    OfLayer {
        name: "friction_velocity",
        unit: "m s-1",
        meaning: "friction velocity at the ground, from the second and third level",
        of: |at| friction_velocity(at.levels),
    },
    OfLayer {
        name: "boundary_layer_height",
        unit: "m",
        meaning: "height where the stress of this instant is a twentieth of the ground's, over 0.95",
        of: |at| depth(at.levels),
    },
    OfLayer {
        name: "inversion_height",
        unit: "m",
        meaning: "height where temperature rises most",
        of: |at| inversion(at.levels),
    },
    OfLayer {
        name: "ground_heat_flux",
        unit: "K m s-1",
        meaning: "flux of heat upwards at the ground, from the second and third level",
        of: |at| ground_heat_flux(at.levels),
    },
    OfLayer {
        name: "geostrophic_speed",
        unit: "m s-1",
        meaning: "speed of the geostrophic wind that drives the air",
        of: |at| speed(at.geostrophic),
    },
    OfLayer {
        name: "geostrophic_direction",
        unit: "degree",
        meaning: "where the geostrophic wind comes from, clockwise from north",
        of: |at| direction(at.geostrophic),
    },
];

/// Height where the stress is a twentieth of the ground's, over 0.95 (m); the highest level's where it never
/// gets so small.
pub(super) fn depth(levels: &[LevelStatistics]) -> f64 {
    let highest = levels.last().map_or(f64::NAN, |level| level.height);
    layer_depth(levels).unwrap_or(highest)
}

/// Where a wind towards `east` and `north` comes from (deg, clockwise from north).
pub(super) fn direction([east, north]: [f64; 2]) -> f64 {
    (-east).atan2(-north).to_degrees().rem_euclid(360.0)
}

/// Wind towards east and north of `speed` (m/s) that comes from `direction` (deg).
pub(super) fn wind(speed: f64, direction: f64) -> [f64; 2] {
    let (s, c) = direction.to_radians().sin_cos();
    [-speed * s, -speed * c]
}

/// Speed of a wind towards `east` and `north`.
fn speed([east, north]: [f64; 2]) -> f64 {
    east.hypot(north)
}

/// Mean wind of `level` towards east and north (m/s).
fn horizontal(level: &LevelStatistics) -> [f64; 2] {
    let [east, north, _] = level.velocity;
    [east, north]
}

fn intensity(level: &LevelStatistics) -> f64 {
    let [uu, vv, ww] = level.variance;
    let speed = speed(horizontal(level));
    if speed > 0.0 { ((uu + vv + ww) / 3.0).sqrt() / speed } else { 0.0 }
}

/// Height between the levels between which temperature rises most (m).
fn inversion(levels: &[LevelStatistics]) -> f64 {
    let rise = |pair: &[LevelStatistics]| pair[1].temperature - pair[0].temperature;
    let steepest = levels.windows(2).reduce(|a, b| if rise(b) > rise(a) { b } else { a });
    steepest.map_or(f64::NAN, |pair| 0.5 * (pair[0].height + pair[1].height))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five levels 20 m apart, whose stress falls to nothing at 90 m and whose temperature jumps at 80 m.
    fn levels() -> Vec<LevelStatistics> {
        (0..5)
            .map(|index| {
                let height = 10.0 + 20.0 * f64::from(index);
                LevelStatistics {
                    height,
                    velocity: [0.1 * height, 0.0, 0.0],
                    temperature: if height > 80.0 { 290.0 } else { 288.0 },
                    variance: [0.3, 0.2, 0.1],
                    stress: [-0.09 * (1.0 - height / 90.0), 0.0],
                    heat_flux: 0.02 - 1e-4 * height,
                    ..LevelStatistics::default()
                }
            })
            .collect()
    }

    #[test]
    fn the_layer_is_told_from_its_levels() {
        let levels = levels();
        let at = Instant { levels: &levels, hub: 60.0, geostrophic: [0.0, 7.0] };
        let of = |which: usize| (OF_LAYER[which].of)(at);
        assert!((of(HUB_SPEED) - 6.0).abs() < 1e-12);
        assert!((of(HUB_DIRECTION) - 270.0).abs() < 1e-12);
        assert!((of(FRICTION) - 0.3).abs() < 1e-12);
        // A twentieth at 85.5 m, over 0.95.
        assert!((of(3) - 90.0).abs() < 1e-9, "{}", of(3));
        assert_eq!(of(4), 80.0);
        assert!((of(5) - 0.02).abs() < 1e-12);
        assert_eq!([of(6), of(7)], [7.0, 180.0]);
        let at = |hub: f64| hub_wind(&levels, hub)[0];
        assert_eq!([at(0.0), at(200.0)], [1.0, 9.0]);
        let level = &levels[0];
        assert!(((OF_LEVELS[INTENSITY].of)(level) - 0.2f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn directions_are_where_the_wind_comes_from() {
        for (towards, from) in
            [([1.0, 0.0], 270.0), ([0.0, 1.0], 180.0), ([-1.0, 0.0], 90.0), ([0.0, -1.0], 0.0)]
        {
            assert!((direction(towards) - from).abs() < 1e-9, "{towards:?}");
            let again = wind(1.0, from);
            assert!((0..2).all(|axis| (again[axis] - towards[axis]).abs() < 1e-12));
        }
    }
}
