//! Mode shapes along a beam: curvature in the principal axes, integrated to slope, deflection and shortening.
#![expect(
    clippy::needless_range_loop,
    reason = "rows and columns by index, as the equations have them"
)]

use super::quadrature::GAUSS;
use crate::definition::Mode;
use basis::Vector3;

/// Intervals of the table of integrals (–).
const N_INTERVALS: usize = 1000;

/// A structural section of a beam.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// Distance from the clamped end (m).
    pub(super) position: f64,
    /// Turn of the principal axes about the beam, against the right hand (rad).
    pub(super) twist: f64,
    /// Mass per length (kg/m).
    pub(super) mass: f64,
    /// Stiffness against bending along the first and the second principal axis (N m²).
    pub(super) stiffness: [f64; 2],
}

/// One mode of a beam: its shape in one of the two principal axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrincipalMode {
    /// 0: bends along the first principal axis, 1: along the second.
    pub(super) axis: usize,
    pub(super) mode: Mode,
}

/// A material point of a beam with N modes: where it is for any modal coordinates q, in the frame of the
/// clamped end.
///
/// ```text
/// p(q) = rest + Σ shapeᵢ qᵢ − ½ Σ qᵢ shorteningᵢⱼ qⱼ ẑ,      turn of the section θ(q) = Σ turnᵢ qᵢ
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<const N: usize> {
    pub(super) rest: Vector3,
    pub(super) shape: [Vector3; N],
    pub(super) turn: [Vector3; N],
    pub(super) shortening: [[f64; N]; N],
}

impl<const N: usize> Place<N> {
    /// Position (m) and its derivatives by the modal coordinates (–) at `q`.
    #[inline(always)]
    pub(super) fn at(&self, q: &[f64; N]) -> (Vector3, [Vector3; N]) {
        let (mut position, mut partials) = (self.rest, self.shape);
        for i in 0..N {
            let mut pull = 0.0;
            for j in 0..N {
                pull += self.shortening[i][j] * q[j];
            }
            position += self.shape[i] * q[i];
            position.z -= 0.5 * pull * q[i];
            partials[i].z -= pull;
        }
        (position, partials)
    }

    /// Acceleration along the beam (m/s²) due to the rates `v` alone: −Σ vᵢ shorteningᵢⱼ vⱼ.
    #[inline(always)]
    pub(super) fn own_acceleration(&self, v: &[f64; N]) -> f64 {
        let mut sum = 0.0;
        for i in 0..N {
            for j in 0..N {
                sum -= v[i] * self.shortening[i][j] * v[j];
            }
        }
        sum
    }

    /// Turn of the section at `q` (rad), a small rotation.
    #[inline(always)]
    pub(super) fn turn(&self, q: &[f64; N]) -> Vector3 {
        weighted(&self.turn, q)
    }

    /// The point of the same section that lies `offset` (m) from this one.
    pub(super) fn offset_by(mut self, offset: Vector3) -> Self {
        self.rest += offset;
        for (shape, turn) in self.shape.iter_mut().zip(&self.turn) {
            *shape += turn.cross(offset);
        }
        self
    }
}

/// Σ `vectors` × `weights`.
#[inline(always)]
pub(super) fn weighted<const N: usize>(vectors: &[Vector3; N], weights: &[f64; N]) -> Vector3 {
    let mut sum = Vector3::ZERO;
    for i in 0..N {
        sum += vectors[i] * weights[i];
    }
    sum
}

/// The modes of a beam tabulated from the clamped to the free end.
pub(super) struct Shapes<const N: usize> {
    length: f64,
    rows: Vec<Row<N>>,
}

#[derive(Clone, Copy)]
struct Row<const N: usize> {
    deflection: [[f64; 2]; N],
    slope: [[f64; 2]; N],
    shortening: [[f64; N]; N],
}

impl<const N: usize> Shapes<N> {
    /// Modes of a beam of `length` (m): the curvature of each lies in a principal axis, which `sections` turn
    /// along the beam.
    ///
    /// Source: Jonkman, FAST user's guide and theory (NREL/EL-500-38230, 2005), twisted mode shapes.
    pub(super) fn new(length: f64, sections: &[Section], modes: &[PrincipalMode; N]) -> Self {
        let step = length / N_INTERVALS as f64;
        let mut row =
            Row { deflection: [[0.0; 2]; N], slope: [[0.0; 2]; N], shortening: [[0.0; N]; N] };
        let mut rows = vec![row];
        for interval in 0..N_INTERVALS {
            let middle = (interval as f64 + 0.5) * step;
            let (sine, cosine) = section_at(sections, middle).twist.sin_cos();
            let before = row.slope;
            for (i, mode) in modes.iter().enumerate() {
                let bend = step * curvature(&mode.mode, middle / length) / (length * length);
                let axes = [[cosine, -sine], [sine, cosine]];
                for direction in 0..2 {
                    let turned = bend * axes[mode.axis][direction];
                    row.deflection[i][direction] += step * (row.slope[i][direction] + 0.5 * turned);
                    row.slope[i][direction] += turned;
                }
            }
            for i in 0..N {
                for j in 0..N {
                    let product = |slope: &[[f64; 2]; N]| {
                        slope[i][0] * slope[j][0] + slope[i][1] * slope[j][1]
                    };
                    row.shortening[i][j] += 0.5 * step * (product(&before) + product(&row.slope));
                }
            }
            rows.push(row);
        }
        Self { length, rows }
    }

    /// The point of the beam's axis at `position` (m) from the clamped end, `start` (m) of it ahead of the
    /// frame's origin.
    pub(super) fn place(&self, position: f64, start: f64) -> Place<N> {
        let at = (position / self.length).clamp(0.0, 1.0) * N_INTERVALS as f64;
        let index = (at as usize).min(N_INTERVALS - 1);
        let share = at - index as f64;
        let (low, high) = (&self.rows[index], &self.rows[index + 1]);
        let between = |from: f64, to: f64| from + share * (to - from);
        let pair =
            |low: &[f64; 2], high: &[f64; 2]| [between(low[0], high[0]), between(low[1], high[1])];
        let mut place = Place {
            rest: Vector3::Z * (start + position),
            shape: [Vector3::ZERO; N],
            turn: [Vector3::ZERO; N],
            shortening: [[0.0; N]; N],
        };
        for i in 0..N {
            let [x, y] = pair(&low.deflection[i], &high.deflection[i]);
            place.shape[i] = Vector3::new(x, y, 0.0);
            let [x, y] = pair(&low.slope[i], &high.slope[i]);
            place.turn[i] = Vector3::new(-y, x, 0.0);
            for j in 0..N {
                place.shortening[i][j] = between(low.shortening[i][j], high.shortening[i][j]);
            }
        }
        place
    }
}

/// Generalised stiffness ∫ EI φᵢ″ φⱼ″ (N/m) of `modes`; modes in different axes do not couple.
pub(super) fn stiffness<const N: usize>(
    length: f64,
    sections: &[Section],
    modes: &[PrincipalMode; N],
) -> [[f64; N]; N] {
    let mut sum = [[0.0; N]; N];
    integrate(length, |position, width| {
        let section = section_at(sections, position);
        for i in 0..N {
            for j in 0..N {
                if modes[i].axis == modes[j].axis {
                    let bend =
                        |k: usize| curvature(&modes[k].mode, position / length) / (length * length);
                    sum[i][j] += width * section.stiffness[modes[i].axis] * bend(i) * bend(j);
                }
            }
        }
    });
    sum
}

/// Generalised mass ∫ mass φ² (kg) of `mode` on the bare beam.
pub(super) fn modal_mass(length: f64, sections: &[Section], mode: &Mode) -> f64 {
    let mut sum = 0.0;
    integrate(length, |position, width| {
        let shape = mode.shape(position / length);
        sum += width * section_at(sections, position).mass * shape * shape;
    });
    sum
}

/// Calls `term(position, width)` for each point of a fine quadrature over `length`.
fn integrate(length: f64, mut term: impl FnMut(f64, f64)) {
    let step = length / N_INTERVALS as f64;
    for interval in 0..N_INTERVALS {
        for (abscissa, weight) in GAUSS {
            term((interval as f64 + 0.5 + 0.5 * abscissa) * step, 0.5 * weight * step);
        }
    }
}

/// Second derivative of a mode's shape by the share of the length (–).
fn curvature(mode: &Mode, share: f64) -> f64 {
    let mut power = 1.0;
    let mut sum = 0.0;
    for (index, coefficient) in mode.coefficients.iter().enumerate() {
        let exponent = index as f64 + 2.0;
        sum += coefficient * exponent * (exponent - 1.0) * power;
        power *= share;
    }
    sum
}

/// The section at `position` (m), linear between `sections`.
pub(super) fn section_at(sections: &[Section], position: f64) -> Section {
    let next = sections
        .partition_point(|section| section.position <= position)
        .clamp(1, sections.len() - 1);
    let (low, high) = (&sections[next - 1], &sections[next]);
    let share = ((position - low.position) / (high.position - low.position)).clamp(0.0, 1.0);
    let between = |from: f64, to: f64| from + share * (to - from);
    Section {
        position,
        twist: between(low.twist, high.twist),
        mass: between(low.mass, high.mass),
        stiffness: [
            between(low.stiffness[0], high.stiffness[0]),
            between(low.stiffness[1], high.stiffness[1]),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARABOLA: Mode = Mode { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], damping_ratio: 0.0 };

    fn sections(twist: f64) -> [Section; 2] {
        [0.0, 10.0].map(|position| Section { position, twist, mass: 2.0, stiffness: [6.0, 7.0] })
    }

    #[test]
    fn a_parabola_has_its_closed_forms() {
        let modes = [PrincipalMode { axis: 0, mode: PARABOLA }];
        let shapes = Shapes::new(10.0, &sections(0.0), &modes);
        let place = shapes.place(5.0, 1.0);
        assert!((place.rest - Vector3::new(0.0, 0.0, 6.0)).length() < 1e-12);
        assert!((place.shape[0] - Vector3::new(0.25, 0.0, 0.0)).length() < 1e-9);
        // Slope 2 x / L²; the bend turns the axis from z towards x, about +y.
        assert!((place.turn[0] - Vector3::new(0.0, 0.1, 0.0)).length() < 1e-12);
        // ∫ (2 x / L²)² over 5 m: 4 · 5³ / (3 L⁴).
        assert!((place.shortening[0][0] - 4.0 * 125.0 / 3e4).abs() < 1e-7);
        // EI (2 / L²)² L, and ∫ m (x / L)⁴.
        assert!((stiffness(10.0, &sections(0.0), &modes)[0][0] - 6.0 * 4.0 / 1e3).abs() < 1e-12);
        assert!((modal_mass(10.0, &sections(0.0), &PARABOLA) - 4.0).abs() < 1e-9);
    }

    #[test]
    fn positive_twist_turns_flapwise_bending_towards_the_leading_edge() {
        let modes = [0, 1].map(|axis| PrincipalMode { axis, mode: PARABOLA });
        let shapes = Shapes::new(10.0, &sections(0.5), &modes);
        let tip = shapes.place(10.0, 0.0);
        let (sine, cosine) = 0.5_f64.sin_cos();
        assert!((tip.shape[0] - Vector3::new(cosine, -sine, 0.0)).length() < 1e-9);
        assert!((tip.shape[1] - Vector3::new(sine, cosine, 0.0)).length() < 1e-9);
        assert!(tip.shortening[0][1].abs() < 1e-12);
    }

    #[test]
    fn offsets_turn_with_their_section() {
        let modes = [PrincipalMode { axis: 0, mode: PARABOLA }];
        let place = Shapes::new(10.0, &sections(0.0), &modes).place(10.0, 0.0);
        let ahead = place.offset_by(Vector3::new(-2.0, 0.0, 0.0));
        // The tip turns downwind about +y; what is upwind of the axis rises.
        let (position, _) = ahead.at(&[0.1]);
        assert!(position.z > place.at(&[0.1]).0.z);
    }
}
