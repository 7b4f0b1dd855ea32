//! Wind over time from a table: speed, direction, shears and gust, the same at all places along the wind.

use super::{InflowError, MeanProfile, positive};
use crate::Inflow;
use basis::Vector3;

/// The wind at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindRow {
    /// Time since the run's start (s).
    pub time: f64,
    /// Speed at hub height, without the gust (m/s).
    pub speed: f64,
    /// Direction of the horizontal wind from x, counter-clockwise seen from above (rad).
    pub direction: f64,
    /// Vertical wind, up (m/s).
    pub vertical: f64,
    /// Change of speed over one length to the left, looking downwind, over the speed (–).
    pub horizontal_shear: f64,
    /// Exponent of the power law of height (–); the wind's own profile where absent.
    pub exponent: Option<f64>,
    /// Change of speed over one length upwards, over the speed (–).
    pub vertical_shear: f64,
    /// Speed added everywhere (m/s).
    pub gust: f64,
}

/// Wind that follows a table, linear between its rows; OpenFAST's uniform wind (InflowWind manual, "Uniform
/// wind").
///
/// Before the first row and behind the last one it stays as it is there. Rows of equal time are a step.
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedWind {
    profile: MeanProfile,
    hub: Vector3,
    length: f64,
    rows: Vec<WindRow>,
}

impl TabulatedWind {
    /// `rows` about `hub` (m, farm frame), their shears over `length` (m), with heights of `profile` where
    /// rows have no exponent.
    ///
    /// # Errors
    /// [`InflowError::Setting`] for no rows, for times that fall, and for a height or length that cannot be.
    pub fn new(
        profile: MeanProfile,
        hub: Vector3,
        length: f64,
        rows: Vec<WindRow>,
    ) -> Result<Self, InflowError> {
        profile.check()?;
        positive("hub height (m)", hub.z)?;
        positive("length of the shears (m)", length)?;
        if rows.is_empty() {
            let expected = "one row or more";
            return Err(InflowError::Setting { name: "rows (–)", value: 0.0, expected });
        }
        if let Some(pair) = rows.windows(2).find(|pair| pair[1].time < pair[0].time) {
            let (name, value) = ("time of a row (s)", pair[1].time);
            return Err(InflowError::Setting { name, value, expected: "times that do not fall" });
        }
        Ok(Self { profile, hub, length, rows })
    }

    /// The wind at `time` (s), as a row.
    pub fn row(&self, time: f64) -> WindRow {
        let high = self.rows.partition_point(|row| row.time <= time);
        let (Some(low), high) = (high.checked_sub(1), self.rows.get(high)) else {
            return self.rows[0];
        };
        let low = self.rows[low];
        let Some(high) = high else { return low };
        let share = (time - low.time) / (high.time - low.time);
        let between = |of: fn(&WindRow) -> f64| of(&low) + share * (of(high) - of(&low));
        WindRow {
            time,
            speed: between(|row| row.speed),
            direction: between(|row| row.direction),
            vertical: between(|row| row.vertical),
            horizontal_shear: between(|row| row.horizontal_shear),
            exponent: low.exponent.zip(high.exponent).map(|(low, high)| low + share * (high - low)),
            vertical_shear: between(|row| row.vertical_shear),
            gust: between(|row| row.gust),
        }
    }

    /// Mean of speed and gust at hub height from time 0 to `duration` (m/s), to a thousandth of that time.
    pub fn mean_speed(&self, duration: f64) -> f64 {
        const N: u32 = 1000;
        let at = |step: u32| {
            let row = self.row((f64::from(step) + 0.5) * duration / f64::from(N));
            row.speed + row.gust
        };
        (0..N).map(at).sum::<f64>() / f64::from(N)
    }

    /// Time of the last row (s).
    pub fn end(&self) -> f64 {
        self.rows[self.rows.len() - 1].time
    }

    fn at(&self, row: &WindRow, [cosine, sine]: [f64; 2], position: Vector3) -> Vector3 {
        let from_hub = position - self.hub;
        let shape = match row.exponent {
            Some(exponent) => (position.z.max(0.0) / self.hub.z).powf(exponent),
            None => self.profile.speed(position.z) / self.profile.hub_speed(),
        };
        let left = from_hub.y * cosine - from_hub.x * sine;
        let shear = (row.horizontal_shear * left + row.vertical_shear * from_hub.z) / self.length;
        let speed = row.speed * (shape + shear) + row.gust;
        Vector3::new(speed * cosine, speed * sine, row.vertical)
    }
}

impl Inflow for TabulatedWind {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let row = self.row(time);
        let (sine, cosine) = row.direction.sin_cos();
        for (position, velocity) in positions.iter().zip(velocities) {
            *velocity = self.at(&row, [cosine, sine], *position);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: WindRow = WindRow {
        time: 0.0,
        speed: 10.0,
        direction: 0.0,
        vertical: 0.0,
        horizontal_shear: 0.0,
        exponent: None,
        vertical_shear: 0.0,
        gust: 0.0,
    };

    fn wind(rows: &[WindRow]) -> TabulatedWind {
        let profile = MeanProfile::PowerLaw { hub_height: 100.0, speed: 8.0, exponent: 0.5 };
        let hub = Vector3::new(50.0, -20.0, 100.0);
        TabulatedWind::new(profile, hub, 200.0, rows.to_vec()).expect("a sound table")
    }

    fn at(wind: &TabulatedWind, time: f64, from_hub: [f64; 3]) -> Vector3 {
        let mut found = [Vector3::ZERO];
        let place = Vector3::new(50.0, -20.0, 100.0) + Vector3::from_array(from_hub);
        wind.sample(time, &[place], &mut found);
        found[0]
    }

    #[test]
    fn rows_are_joined_by_lines_and_steps() {
        let rows = [
            STILL,
            WindRow { time: 10.0, speed: 12.0, ..STILL },
            WindRow { time: 10.0, speed: 6.0, gust: 1.0, ..STILL },
        ];
        let wind = wind(&rows);
        for (time, speed) in [(-5.0, 10.0), (0.0, 10.0), (5.0, 11.0), (10.0, 7.0), (99.0, 7.0)] {
            assert!((at(&wind, time, [0.0; 3]).x - speed).abs() < 1e-12, "{time} s");
        }
        assert!((wind.mean_speed(20.0) - 0.5 * (11.0 + 7.0)).abs() < 0.01);
    }

    #[test]
    fn shears_turn_with_the_wind() {
        // Blowing to the left: the left of the wind is then towards −x.
        let turned = WindRow {
            direction: std::f64::consts::FRAC_PI_2,
            horizontal_shear: 0.1,
            vertical_shear: 0.2,
            vertical: 0.5,
            exponent: Some(0.0),
            ..STILL
        };
        let found = at(&wind(&[turned]), 0.0, [-100.0, 0.0, 100.0]);
        // 10 (1 + (0.1 · 100 + 0.2 · 100) / 200) = 11.5.
        assert!((found - Vector3::new(0.0, 11.5, 0.5)).length() < 1e-12, "{found}");
    }

    #[test]
    fn heights_are_those_of_the_table_or_of_the_case() {
        let own = at(&wind(&[WindRow { exponent: Some(1.0), ..STILL }]), 0.0, [0.0, 0.0, -50.0]);
        assert!((own.x - 5.0).abs() < 1e-12);
        let case = at(&wind(&[STILL]), 0.0, [0.0, 0.0, -50.0]);
        assert!((case.x - 10.0 * 0.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn no_rows_and_times_that_fall_are_refused() {
        let profile = MeanProfile::Uniform { speed: 8.0 };
        let refused = |rows: Vec<WindRow>| {
            TabulatedWind::new(profile, Vector3::Z * 90.0, 126.0, rows).expect_err("no table")
        };
        assert!(refused(Vec::new()).to_string().contains("one row or more"));
        let falling = vec![WindRow { time: 1.0, ..STILL }, STILL];
        assert!(refused(falling).to_string().contains("times that do not fall"));
    }
}
