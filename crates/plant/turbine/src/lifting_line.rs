//! Smearing correction of an actuator line: the induction lost by smearing, from the helical wake that the
//! blades trail.
//!
//! Spreading a blade's force over a Gaussian of width ε convolves its whole wake with that Gaussian: to first
//! order in the disturbance, the flow around the actuator line is the thin wake's flow, smeared. The velocity
//! to be added at the blade is thus known,
//!
//! ```text
//! correction(x) = Σ_filaments  γ/4π ∫ [q(d/ε_core) − q(d/ε)]  dl × d / |d|³,        d = x − filament point,
//! q(s) = erf(s) − 2 s exp(−s²)/√π,
//! ```
//!
//! with q the share of a vortex element's circulation within the distance s of a Gaussian blob. The bracket
//! decays as exp(−d²/ε²): only the wake within some 3 ε of the blade counts, with its helical shape and with
//! the filaments of other blades and earlier turns that pass within reach. The flow solver resolves the rest.
//! With ε at the core ε_core, the optimal width of a quarter chord, the correction is zero.
//!
//! Sources: the Gaussian-smeared line as a lifting line with a viscous core, Martínez-Tossas (2019) and
//! Meyer Forsting (2019); ε_core = c/4, Martínez-Tossas (2017); q is the radial integral of the Gaussian blob
//! exp(−r²/ε²)/(ε³ π^{3/2}) that `basis::PointForce` defines.
//! Limits: the near wake is a helix of constant radius and of one pitch for the whole rotor; circulation
//! changes slowly against the passage of a few ε; blades are straight and lie in the rotor plane (precone is
//! neglected here).

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

/// Optimal Gaussian width over chord (–), Martínez-Tossas (2017).
pub const OPTIMAL_WIDTH_OVER_CHORD: f64 = 0.25;
/// Helix pitches, advance per radian over rotor radius, for which influences are tabulated: the first of
/// them, …
const FIRST_PITCH: f64 = 0.03;
/// … the ratio of one to the one before, …
const PITCH_RATIO: f64 = 1.35;
/// … and how many there are: up to 0.45, a tip-speed ratio of 2.2 without induction.
const N_PITCHES: usize = 10;
/// Beyond this many smearing lengths a smeared vortex is a thin one to 1e-6.
const REACH: f64 = 4.0;

/// Where lifting-line elements lie along a blade, the same on every blade.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// Radii of the elements' borders, root to tip (m): one more than elements.
    pub borders: Vec<f64>,
    /// Radii of the elements' control points (m).
    pub centres: Vec<f64>,
    /// Widths of the cores that the trailing vortices at `borders` should have (m).
    pub cores: Vec<f64>,
}

/// Smearing correction: induced velocities lost by smearing, linear in the blades' circulations.
#[derive(Clone, Debug)]
pub struct SmearingCorrection {
    n_blades: usize,
    n_stations: usize,
    radius: f64,
    /// Axial and tangential influence, `N_PITCHES × n_blades × n_stations × n_stations`: of one unit of
    /// circulation on an element (last index) of the blade so many ahead (second) on a control point (third)
    /// (1/m).
    axial: Vec<f64>,
    tangential: Vec<f64>,
}

/// Two neighbouring tabulated helices and the share of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HelixShare {
    index: usize,
    share: f64,
}

impl SmearingCorrection {
    /// Tabulates the influences between the blades of a rotor whose forces are smeared over `smearing_length`
    /// (m).
    ///
    /// The rotor's radius is the last border of `span`. Takes a fraction of a second.
    pub fn new(n_blades: usize, span: &Span, smearing_length: f64) -> Self {
        let n_stations = span.centres.len();
        let radius = span.borders[n_stations];
        let size = N_PITCHES * n_blades * n_stations * n_stations;
        let mut correction = Self {
            n_blades,
            n_stations,
            radius,
            axial: vec![0.0; size],
            tangential: vec![0.0; size],
        };
        let mut slot = 0;
        for pitch_index in 0..N_PITCHES {
            let advance = radius * FIRST_PITCH * PITCH_RATIO.powi(pitch_index as i32);
            for ahead in 0..n_blades {
                let lead = TAU * ahead as f64 / n_blades as f64;
                for &centre in &span.centres {
                    for (border, (&trailing, &core)) in
                        span.borders.iter().zip(&span.cores).enumerate()
                    {
                        let helix = Helix { radius: trailing, advance, lead };
                        let (axial, tangential) =
                            helix.correction_influence(centre, core, smearing_length);
                        // A border trails what the inner element's circulation exceeds the outer's.
                        if border > 0 {
                            correction.axial[slot + border - 1] += axial;
                            correction.tangential[slot + border - 1] += tangential;
                        }
                        if border < n_stations {
                            correction.axial[slot + border] -= axial;
                            correction.tangential[slot + border] -= tangential;
                        }
                    }
                    slot += n_stations;
                }
            }
        }
        correction
    }

    /// The tabulated helices around one that advances by `advance` (m/rad), clamped to the table.
    pub fn helix(&self, advance: f64) -> HelixShare {
        let position = (advance / (self.radius * FIRST_PITCH)).max(1.0).ln() / PITCH_RATIO.ln();
        let position = position.min((N_PITCHES - 1) as f64);
        let index = (position as usize).min(N_PITCHES - 2);
        HelixShare { index, share: position - index as f64 }
    }

    /// Smearing correction at element `station` of `blade` (m/s): axial (downwind) and tangential (along the
    /// rotation).
    ///
    /// `circulations` (m²/s) holds `n_blades × n_stations` values, positive where the lift drives the rotor
    /// and pushes it downwind.
    pub fn velocity_correction(
        &self,
        helix: HelixShare,
        blade: usize,
        station: usize,
        circulations: &[f64],
    ) -> (f64, f64) {
        let n = self.n_stations;
        let (mut axial, mut tangential) = (0.0, 0.0);
        for ahead in 0..self.n_blades {
            let other = (blade + ahead) % self.n_blades;
            let circulation = &circulations[other * n..(other + 1) * n];
            for (index, share) in [(helix.index, 1.0 - helix.share), (helix.index + 1, helix.share)]
            {
                let start = ((index * self.n_blades + ahead) * n + station) * n;
                axial += share * dot(&self.axial[start..start + n], circulation);
                tangential += share * dot(&self.tangential[start..start + n], circulation);
            }
        }
        (axial, tangential)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A trailing vortex: a helix of `radius` (m) behind a blade `lead` (rad) ahead, downwind by `advance` (m)
/// per radian.
struct Helix {
    radius: f64,
    advance: f64,
    lead: f64,
}

impl Helix {
    /// Axial and tangential velocity (1/m, per unit circulation) lost at radius `r` (m) of the blade at
    /// azimuth zero by smearing over `smearing_length` (m) instead of `core` (m).
    fn correction_influence(&self, r: f64, core: f64, smearing_length: f64) -> (f64, f64) {
        let mut total = (0.0, 0.0);
        let reach = REACH * smearing_length;
        // The filament passes the blade's azimuth once a turn; each passage is integrated on either side, the
        // points gathered where it is nearest.
        let mut passage = self.lead;
        let oldest = reach / self.advance;
        while passage - PI < oldest {
            let nearest = (self.advance * passage).hypot(r - self.radius).max(1e-3 * core);
            let width = nearest / (self.radius * r).sqrt().max(nearest);
            for (from, to) in [(passage - PI, passage), (passage, passage + PI)] {
                let from = ((from.max(0.0) - passage) / width).asinh();
                let to = ((to.min(oldest) - passage) / width).asinh();
                let (axial, tangential) = integral(from, to, |u| {
                    let stretch = width * u.cosh();
                    let (axial, tangential) =
                        self.element(r, passage + width * u.sinh(), core, smearing_length);
                    (stretch * axial, stretch * tangential)
                });
                total.0 += axial;
                total.1 += tangential;
            }
            passage += TAU;
        }
        total
    }

    /// Integrand of [`Self::correction_influence`] at `theta` (rad) of wake age.
    fn element(&self, r: f64, theta: f64, core: f64, smearing_length: f64) -> (f64, f64) {
        // Symbols: axes are downwind, radial of the blade at azimuth zero, tangential along the rotation,
        // right-handed. Filament point (h θ, ρ cos α, ρ sin α) with α = lead − θ; d from it to (0, r, 0); l
        // its derivative to θ.
        let (rho, h) = (self.radius, self.advance);
        let (sine, cosine) = (self.lead - theta).sin_cos();
        let distance_squared =
            (h * theta).powi(2) + (r - rho * cosine).powi(2) + (rho * sine).powi(2);
        let d = distance_squared.sqrt();
        if d > REACH * smearing_length {
            return (0.0, 0.0);
        }
        let hidden = tabulated_share(d / core) - tabulated_share(d / smearing_length);
        let scale = hidden / (4.0 * PI * distance_squared * d);
        // l × d = axial ρ (r cos α − ρ), tangential h (r − ρ cos α) + h θ ρ sin α.
        (scale * rho * (r * cosine - rho), scale * h * (r - rho * cosine + theta * rho * sine))
    }
}

/// [`blob_share`] from a table, to 3e-7: it is evaluated millions of times.
fn tabulated_share(s: f64) -> f64 {
    const END: f64 = 5.0;
    const N: usize = 4096;
    static TABLE: LazyLock<Vec<f64>> =
        LazyLock::new(|| (0..=N).map(|i| blob_share(END * i as f64 / N as f64)).collect());
    let position = s * (N as f64 / END);
    let index = position as usize;
    match TABLE.get(index..index + 2) {
        Some(pair) => pair[0] + (position - index as f64) * (pair[1] - pair[0]),
        None => 1.0,
    }
}

/// Share of a Gaussian blob's vorticity within `s` widths (–): erf(s) − 2 s exp(−s²)/√π.
pub(crate) fn blob_share(s: f64) -> f64 {
    if s > 5.0 {
        return 1.0;
    }
    // 2/√π exp(−s²) Σ_{n≥1} 2ⁿ s^{2n+1} / (2n+1)!!, all terms positive: exact for small s, where erf would
    // cancel.
    let square = s * s;
    let mut term = 2.0 / PI.sqrt() * (-square).exp() * s;
    let mut sum = 0.0;
    let mut n = 1.0;
    loop {
        term *= 2.0 * square / (2.0 * n + 1.0);
        sum += term;
        n += 1.0;
        if term <= 1e-14 * sum || sum == 0.0 {
            return sum;
        }
    }
}

/// Nodes and weights of 6-point Gauss-Legendre quadrature on −1..1, by symmetry.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];
/// Longest panel of the quadrature, in the stretched coordinate.
const LONGEST_PANEL: f64 = 0.75;

/// Integral of a two-component `integrand` over `from..to`, in Gauss-Legendre panels.
fn integral(from: f64, to: f64, integrand: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    let mut sum = (0.0, 0.0);
    let n_panels = ((to - from) / LONGEST_PANEL).ceil().max(0.0) as usize;
    let half = 0.5 * (to - from) / n_panels.max(1) as f64;
    for panel in 0..n_panels {
        let middle = from + half * (2 * panel + 1) as f64;
        for (node, weight) in GAUSS {
            for at in [middle - half * node, middle + half * node] {
                let (first, second) = integrand(at);
                sum.0 += half * weight * first;
                sum.1 += half * weight * second;
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests;
