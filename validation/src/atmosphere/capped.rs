//! The neutral boundary layer under its own inversion of Berg, Patton and Sullivan (2020).

use crate::Row;
use crate::row::Tolerance::Within;
use crate::studies::{failure, precursor};
use formats::records::{PrecursorResult, ProfileRow};

const SOURCE: &str =
    "case of Berg, Patton, Sullivan (2020) on cells of 5 m, 120 to 125 ks, read second hand";
/// Height (m), speed (m/s), turbulence intensity (–) and turning from the lowest of them (deg).
const PROFILE: [[f64; 4]; 4] = [
    [27.0, 3.71, 0.086, 0.0],
    [90.0, 4.39, 0.060, 1.5],
    [153.0, 4.77, 0.048, 3.1],
    [250.0, 5.21, 0.032, 5.8],
];
const FRICTION_VELOCITY: f64 = 0.208;
const INVERSION: f64 = 352.0;

/// Profiles of the shipped case.
pub fn capped_boundary_layer() -> Vec<Row> {
    match precursor("precursor-berg", "capped-boundary-layer", Vec::new()) {
        Ok((result, _)) => rows(&result),
        Err(problem) => failure(problem),
    }
}

fn rows(result: &PrecursorResult) -> Vec<Row> {
    let row = |what: String, measured, expected, within, unit| Row {
        what: format!("capped boundary layer, 10 m cells, 57 to 62 ks: {what}"),
        measured,
        expected,
        tolerance: Within(within),
        unit,
        source: SOURCE,
    };
    let u_star = result.friction_velocity;
    let mut rows = vec![row(
        "friction velocity".to_owned(),
        u_star,
        FRICTION_VELOCITY,
        0.1 * FRICTION_VELOCITY,
        "m/s",
    )];
    let lowest = at(&result.profile, PROFILE[0][0], |level| level.direction_deg);
    for [height, speed, intensity, turning] in PROFILE {
        let of = |what: fn(&ProfileRow) -> f64| at(&result.profile, height, what);
        let name = |what: &str| format!("{what} at {height:.0} m");
        rows.push(row(name("speed"), of(|level| level.speed), speed, 0.05 * speed, "m/s"));
        let found = 100.0 * of(|level| level.turbulence_intensity);
        let expected = 100.0 * intensity;
        rows.push(row(name("turbulence intensity"), found, expected, 0.15 * expected, "%"));
        if turning > 0.0 {
            let found = of(|level| level.direction_deg) - lowest;
            rows.push(row(name("turning from 27 m"), found, turning, 1.0, "°"));
        }
    }
    let found = steepest(&result.profile);
    rows.push(row(
        "height of the steepest temperature".to_owned(),
        found,
        INVERSION,
        0.1 * INVERSION,
        "m",
    ));
    rows
}

/// What `of` tells at `height` (m), linear between the levels of `profile`.
fn at(profile: &[ProfileRow], height: f64, of: fn(&ProfileRow) -> f64) -> f64 {
    let next = profile.partition_point(|level| level.height < height);
    let (Some(above), Some(below)) = (profile.get(next), next.checked_sub(1)) else {
        return f64::NAN;
    };
    let below = &profile[below];
    let weight = (height - below.height) / (above.height - below.height);
    of(below) + weight * (of(above) - of(below))
}

/// Height between the two levels of `profile` of which the upper one is warmer by most (m).
fn steepest(profile: &[ProfileRow]) -> f64 {
    let rise = |pair: &&[ProfileRow]| pair[1].temperature - pair[0].temperature;
    let pair = profile.windows(2).max_by(|a, b| rise(a).total_cmp(&rise(b)));
    pair.map_or(f64::NAN, |pair| 0.5 * (pair[0].height + pair[1].height))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(height: f64, speed: f64, temperature: f64) -> ProfileRow {
        ProfileRow {
            height,
            speed,
            direction_deg: 250.0,
            turbulence_intensity: 0.1,
            stress: 0.0,
            temperature,
            heat_flux: 0.0,
        }
    }

    #[test]
    fn profiles_are_read_between_their_levels() {
        let profile = [level(10.0, 3.0, 290.0), level(30.0, 4.0, 290.1), level(50.0, 4.5, 290.5)];
        assert_eq!(at(&profile, 25.0, |level| level.speed), 3.75);
        assert!(at(&profile, 5.0, |level| level.speed).is_nan());
        assert!(at(&profile, 55.0, |level| level.speed).is_nan());
        assert_eq!(steepest(&profile), 40.0);
    }
}
