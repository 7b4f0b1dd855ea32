//! Lift, drag and pitching moment of a blade section against the angle of attack.

use basis::angle::wrap_to_half_turn;
use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// Width of a bucket of the look-up (rad): a quarter of a degree, less than the spacing of published tables.
const BUCKET: f64 = PI / 720.0;
const N_BUCKETS: usize = 1440;
/// How far a table may end from ±180° (rad); rounding in published tables, no more.
const END_TOLERANCE: f64 = 1e-6;
/// Angles of two tables closer than this are the same (rad).
const SAME_ANGLE: f64 = 1e-9;

/// Coefficients of a section at one angle of attack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionCoefficients {
    /// Lift, across the relative wind (–).
    pub lift: f64,
    /// Drag, along the relative wind (–).
    pub drag: f64,
    /// Pitching moment about the quarter chord, nose up (–).
    pub moment: f64,
}

/// Constants of a section's unsteady and separated flow, as far as the source gives them.
///
/// Those of the Beddoes-Leishman model that a separation point taken from the polar itself needs.
/// Source: Damiani, Hayman, "The unsteady aerodynamics module for FAST 8", NREL/TP-5000-66347, 2019.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnsteadyConstants {
    /// Angle of attack without lift α₀ (rad).
    pub zero_lift_angle: f64,
    /// Angle of attack above α₀ at which the flow is separated over 30 % of the chord, α₁ (rad).
    pub upper_separation_angle: f64,
    /// The same below α₀, α₂ (rad).
    pub lower_separation_angle: f64,
    /// Slope of the normal force coefficient in attached flow C_nα (1/rad).
    pub normal_force_slope: f64,
    /// Normal force coefficient at which the leading edge separates, C_n1 (–).
    pub upper_critical_normal_force: f64,
    /// The same at negative angles, C_n2 (–).
    pub lower_critical_normal_force: f64,
    /// Drag coefficient without lift C_d0 (–).
    pub zero_lift_drag: f64,
    /// Moment coefficient without lift C_m0 (–).
    pub zero_lift_moment: f64,
    /// Time constants T_f0 (separation), T_V0 (vortex decay), T_p (leading-edge pressure), T_VL (vortex
    /// passage), in half chords travelled (–); absent where the source leaves them to the model's own values.
    pub time_constants: Option<[f64; 4]>,
    /// Amplitudes A₁, A₂, A₅ of the indicial response (–); absent likewise.
    pub indicial_amplitudes: Option<[f64; 3]>,
    /// Exponents b₁, b₂, b₅ of the indicial response (–); absent likewise.
    pub indicial_exponents: Option<[f64; 3]>,
}

/// Why a table cannot be a polar.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PolarError {
    /// Columns of different length, or hardly any rows.
    #[error(
        "polar \"{name}\" has {n_angles} angles, {n_lift} lift, {n_drag} drag and {n_moment} moment coefficients; expected one of each per angle, and at least 3 angles"
    )]
    Rows {
        /// Polar.
        name: String,
        /// Angles (–).
        n_angles: usize,
        /// Lift coefficients (–).
        n_lift: usize,
        /// Drag coefficients (–).
        n_drag: usize,
        /// Moment coefficients (–).
        n_moment: usize,
    },
    /// Angles that do not increase.
    #[error(
        "polar \"{name}\": angles of attack must increase from row to row, but row {row} holds {angle_deg}° after {before_deg}°"
    )]
    NotRising {
        /// Polar.
        name: String,
        /// Row, from 1 (–).
        row: usize,
        /// Its angle (deg).
        angle_deg: f64,
        /// The angle before it (deg).
        before_deg: f64,
    },
    /// A table that ends short of a full turn.
    #[error(
        "polar \"{name}\" covers {first_deg}° to {last_deg}°, expected -180° to 180°; extend it (for example after Viterna) before it is read"
    )]
    Span {
        /// Polar.
        name: String,
        /// First angle (deg).
        first_deg: f64,
        /// Last angle (deg).
        last_deg: f64,
    },
    /// A coefficient that is not a number, or drag that pushes.
    #[error("polar \"{name}\", row {row} ({angle_deg}°): {what}")]
    Value {
        /// Polar.
        name: String,
        /// Row, from 1 (–).
        row: usize,
        /// Its angle (deg).
        angle_deg: f64,
        /// What is wrong with it.
        what: &'static str,
    },
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    angle: f64,
    /// One over the angle to the next knot (1/rad); the last has none.
    per_width: f64,
    lift: f64,
    drag: f64,
    moment: f64,
}

/// Table of section coefficients over a full turn, linear between its angles.
///
/// The look-up finds its row through buckets of equal width, so that it costs the same for any angle and any
/// table, and gives the table's own numbers at the table's own angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Polar {
    /// Name, as the source calls it.
    pub name: String,
    /// Reynolds number of the table (–); absent where the source gives none.
    pub reynolds_number: Option<f64>,
    /// Constants of unsteady flow, where the source gives them.
    pub unsteady: Option<UnsteadyConstants>,
    knots: Vec<Knot>,
    /// Last knot at or before the start of each bucket; `N_BUCKETS + 1` of them.
    first_knots: Vec<u32>,
}

impl Polar {
    /// A polar from columns of one length: angles of attack (rad, rising, −π to π), lift, drag and moment
    /// coefficients (–).
    ///
    /// Where the coefficients at −π and π differ, which is the same flow, both take the mean.
    ///
    /// # Errors
    /// [`PolarError`] when the columns do not make a polar over the full turn.
    pub fn new(
        name: impl Into<String>,
        angles: &[f64],
        lift: &[f64],
        drag: &[f64],
        moment: &[f64],
    ) -> Result<Self, PolarError> {
        let name = name.into();
        check_columns(&name, angles, lift, drag, moment)?;
        let mut knots: Vec<Knot> = (0..angles.len())
            .map(|row| Knot {
                angle: angles[row],
                per_width: 0.0,
                lift: lift[row],
                drag: drag[row],
                moment: moment[row],
            })
            .collect();
        close_turn(&mut knots);
        Ok(Self::from_knots(name, knots))
    }

    /// With the buckets of the look-up over `knots`, which cover the turn.
    fn from_knots(name: String, mut knots: Vec<Knot>) -> Self {
        for row in 1..knots.len() {
            knots[row - 1].per_width = 1.0 / (knots[row].angle - knots[row - 1].angle);
        }
        let mut first_knots = Vec::with_capacity(N_BUCKETS + 1);
        let mut knot = 0;
        for bucket in 0..=N_BUCKETS {
            // A hair early: rounding in the bucket number must not skip a knot.
            let start = -PI + (bucket as f64 - 1e-6) * BUCKET;
            while knot + 2 < knots.len() && knots[knot + 1].angle <= start {
                knot += 1;
            }
            first_knots.push(knot as u32);
        }
        Self { name, reynolds_number: None, unsteady: None, knots, first_knots }
    }

    /// The polar that lies between `inner` and `outer`, with a share of `share` (–, 0 to 1) of the latter;
    /// without constants of unsteady flow.
    ///
    /// It has a row wherever one of the two has one, so that it is exactly their blend at every angle.
    pub fn between(inner: &Self, outer: &Self, share: f64) -> Self {
        let mut angles: Vec<f64> = inner.knots.iter().map(|knot| knot.angle).collect();
        angles.extend(outer.knots.iter().map(|knot| knot.angle));
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|next, kept| *next - *kept < SAME_ANGLE);
        let knots = angles
            .iter()
            .map(|&angle| {
                let (from, to) = (inner.at(angle), outer.at(angle));
                let blend = |from: f64, to: f64| from + share * (to - from);
                Knot {
                    angle,
                    per_width: 0.0,
                    lift: blend(from.lift, to.lift),
                    drag: blend(from.drag, to.drag),
                    moment: blend(from.moment, to.moment),
                }
            })
            .collect();
        Self::from_knots(format!("{} to {}", inner.name, outer.name), knots)
    }

    /// Coefficients at `angle_of_attack` (rad, any turn).
    pub fn at(&self, angle_of_attack: f64) -> SectionCoefficients {
        let (low, high, angle) = self.around(angle_of_attack);
        let share = (angle - low.angle) * low.per_width;
        SectionCoefficients {
            lift: low.lift + share * (high.lift - low.lift),
            drag: low.drag + share * (high.drag - low.drag),
            moment: low.moment + share * (high.moment - low.moment),
        }
    }

    /// Slopes of the coefficients over the angle of attack (1/rad) at `angle_of_attack` (rad, any turn):
    /// those of the straight line between the table's rows.
    pub fn slopes_at(&self, angle_of_attack: f64) -> SectionCoefficients {
        let (low, high, _) = self.around(angle_of_attack);
        SectionCoefficients {
            lift: (high.lift - low.lift) * low.per_width,
            drag: (high.drag - low.drag) * low.per_width,
            moment: (high.moment - low.moment) * low.per_width,
        }
    }

    /// Rows on either side of `angle_of_attack` (rad, any turn), and that angle within the table.
    fn around(&self, angle_of_attack: f64) -> (&Knot, &Knot, f64) {
        let angle = if (-PI..PI).contains(&angle_of_attack) {
            angle_of_attack
        } else {
            wrap_to_half_turn(angle_of_attack)
        };
        let bucket = ((angle + PI) * (1.0 / BUCKET)) as usize;
        let mut row = self.first_knots[bucket.min(N_BUCKETS)] as usize;
        while row + 2 < self.knots.len() && angle >= self.knots[row + 1].angle {
            row += 1;
        }
        (&self.knots[row], &self.knots[row + 1], angle)
    }

    /// The table, row by row: angle of attack (rad) and coefficients (–).
    pub fn rows(&self) -> impl ExactSizeIterator<Item = (f64, SectionCoefficients)> + '_ {
        self.knots.iter().map(|knot| {
            (
                knot.angle,
                SectionCoefficients { lift: knot.lift, drag: knot.drag, moment: knot.moment },
            )
        })
    }
}

fn check_columns(
    name: &str,
    angles: &[f64],
    lift: &[f64],
    drag: &[f64],
    moment: &[f64],
) -> Result<(), PolarError> {
    let n_angles = angles.len();
    if n_angles < 3 || [lift.len(), drag.len(), moment.len()] != [n_angles; 3] {
        return Err(PolarError::Rows {
            name: name.to_owned(),
            n_angles,
            n_lift: lift.len(),
            n_drag: drag.len(),
            n_moment: moment.len(),
        });
    }
    for row in 0..n_angles {
        let value_error = |what| PolarError::Value {
            name: name.to_owned(),
            row: row + 1,
            angle_deg: angles[row].to_degrees(),
            what,
        };
        if ![angles[row], lift[row], drag[row], moment[row]].iter().all(|value| value.is_finite()) {
            return Err(value_error("a value is not a finite number"));
        }
        // Computed polars dip below zero by a few counts near 0°; more is a sign or a column gone wrong.
        if drag[row] < -0.02 {
            return Err(value_error(
                "the drag coefficient is negative; check the order of the columns",
            ));
        }
        if row > 0 && angles[row] <= angles[row - 1] {
            return Err(PolarError::NotRising {
                name: name.to_owned(),
                row: row + 1,
                angle_deg: angles[row].to_degrees(),
                before_deg: angles[row - 1].to_degrees(),
            });
        }
    }
    let (first, last) = (angles[0], angles[n_angles - 1]);
    if (first + PI).abs() > END_TOLERANCE || (last - PI).abs() > END_TOLERANCE {
        return Err(PolarError::Span {
            name: name.to_owned(),
            first_deg: first.to_degrees(),
            last_deg: last.to_degrees(),
        });
    }
    Ok(())
}

/// On return the ends stand exactly a turn apart and hold the same coefficients.
fn close_turn(knots: &mut [Knot]) {
    let end = knots.len() - 1;
    knots[0].angle = -PI;
    knots[end].angle = -PI + TAU;
    let (first, last) = (knots[0], knots[end]);
    for knot in [0, end] {
        knots[knot].lift = 0.5 * (first.lift + last.lift);
        knots[knot].drag = 0.5 * (first.drag + last.drag);
        knots[knot].moment = 0.5 * (first.moment + last.moment);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uneven() -> Polar {
        let degrees = [-180.0, -91.3, -10.01, -10.0, -0.3, 0.0, 0.03, 0.05, 5.5, 90.0, 180.0];
        let angles: Vec<f64> = degrees.iter().map(|d: &f64| d.to_radians()).collect();
        let lift: Vec<f64> =
            (0..11).map(|k| if k == 10 { 0.0 } else { f64::from(k) * 0.1 }).collect();
        let drag: Vec<f64> = angles.iter().map(|a| 0.01 + a.sin().powi(2)).collect();
        let moment: Vec<f64> = angles.iter().map(|a| -0.1 * a.sin()).collect();
        Polar::new("uneven", &angles, &lift, &drag, &moment).unwrap()
    }

    #[test]
    fn the_tables_own_numbers_come_back_at_its_own_angles() {
        let polar = uneven();
        for (angle, expected) in polar.rows() {
            let got = polar.at(angle);
            assert!((got.lift - expected.lift).abs() < 1e-13, "{angle}: {got:?} {expected:?}");
            assert!((got.drag - expected.drag).abs() < 1e-13);
            assert!((got.moment - expected.moment).abs() < 1e-13);
        }
    }

    #[test]
    fn linear_between_and_the_same_a_turn_further() {
        let polar = uneven();
        let rows: Vec<_> = polar.rows().collect();
        for pair in rows.windows(2) {
            for share in [1e-9, 0.25, 0.5, 0.999] {
                let angle = pair[0].0 + share * (pair[1].0 - pair[0].0);
                let lift = pair[0].1.lift + share * (pair[1].1.lift - pair[0].1.lift);
                assert!((polar.at(angle).lift - lift).abs() < 1e-9);
                assert!((polar.at(angle + TAU).lift - lift).abs() < 1e-9);
                assert!((polar.at(angle - 3.0 * TAU).lift - lift).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn between_two_polars_lies_their_blend() {
        let (inner, rows) = (uneven(), [-PI, -0.2, 0.07, 0.4, PI]);
        let outer = Polar::new("few", &rows, &[0.0, -0.9, 0.3, 1.5, 0.0], &[0.02; 5], &[0.1; 5]);
        let outer = outer.unwrap();
        let blend = Polar::between(&inner, &outer, 0.3);
        for k in -4000..=4000 {
            let angle = f64::from(k) * 1e-3;
            let (from, to, got) = (inner.at(angle), outer.at(angle), blend.at(angle));
            assert!((got.lift - (0.7 * from.lift + 0.3 * to.lift)).abs() < 1e-12, "{angle}");
            assert!((got.drag - (0.7 * from.drag + 0.3 * to.drag)).abs() < 1e-12);
            assert!((got.moment - (0.7 * from.moment + 0.3 * to.moment)).abs() < 1e-12);
        }
        assert_eq!(blend.rows().len(), inner.rows().len() + 3);
    }

    #[test]
    fn bad_tables_say_what_is_wrong() {
        let angles: [f64; 4] = [-PI, 0.2, 0.1, PI];
        let zeros = [0.0; 4];
        let error = Polar::new("p", &angles, &zeros, &zeros, &zeros).unwrap_err();
        assert!(error.to_string().contains("row 3 holds 5.7"), "{error}");
        let error = Polar::new("p", &[-1.0, 0.0, PI], &zeros[1..], &zeros[1..], &zeros[1..]);
        assert!(matches!(error, Err(PolarError::Span { .. })));
        let error = Polar::new("p", &angles, &zeros[1..], &zeros, &zeros);
        assert!(matches!(error, Err(PolarError::Rows { n_lift: 3, .. })));
        let error = Polar::new("p", &[-PI, 0.0, PI], &[0.0; 3], &[0.1, -0.5, 0.1], &[0.0; 3]);
        assert!(matches!(error, Err(PolarError::Value { row: 2, .. })));
    }
}
