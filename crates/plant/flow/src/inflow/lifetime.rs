//! How long shear acts on an eddy before it breaks up.

/// Terms after which every series here has converged in double precision.
const MAXIMUM_TERMS: usize = 400;

/// ₂F₁(1/3, 17/6; 4/3; −x) for x ≥ 0, to about 1e-14 of its value.
///
/// Since 4/3 = 1/3 + 1 it equals ∫₀¹ (1 + x s³)^(−17/6) ds. For x ≤ 4 Pfaff's transformation gives
/// (1+x)^(−1/3) ₂F₁(1/3, −3/2; 4/3; x/(1+x)), whose terms fall at least as 0.8ⁿ n^(−7/2); beyond, the
/// integral to infinity, Γ(4/3) Γ(5/2) / Γ(17/6) x^(−1/3), less the tail's binomial series in 1/x.
/// Source: Abramowitz & Stegun 15.3.1, 15.3.4.
pub fn hypergeometric(x: f64) -> f64 {
    const A: f64 = 1.0 / 3.0;
    const B: f64 = 17.0 / 6.0;
    if x <= 4.0 {
        let ratio = x / (1.0 + x);
        let (mut power, mut sum) = (1.0, 1.0);
        for n in 0..MAXIMUM_TERMS {
            let n = n as f64;
            // (−3/2)ₙ / n! ratioⁿ; the factor (1/3)ₙ / (4/3)ₙ is (1/3) / (1/3 + n).
            power *= (n - 1.5) / (n + 1.0) * ratio;
            let term = power * A / (A + n + 1.0);
            sum += term;
            if term.abs() < 1e-17 * sum.abs() {
                break;
            }
        }
        (1.0 + x).powf(-A) * sum
    } else {
        // Γ(4/3) Γ(5/2) / Γ(17/6)
        const WHOLE: f64 = 0.688_343_942_614_314_3;
        let (mut power, mut tail) = (1.0, 1.0 / (3.0 * B - 1.0));
        for n in 0..MAXIMUM_TERMS {
            let n = n as f64;
            power *= -(B + n) / ((n + 1.0) * x);
            let term = power / (3.0 * (B + n + 1.0) - 1.0);
            tail += term;
            if term.abs() < 1e-17 * tail.abs() {
                break;
            }
        }
        WHOLE * x.powf(-A) - x.powf(-B) * tail
    }
}

/// Mann's eddy lifetime, times the mean shear: how far an eddy of wave number k is sheared, β(k) (–).
///
/// β = Γ (kL)^(−2/3) / √₂F₁(1/3, 17/6; 4/3; −(kL)^(−2)). Source: [Mann1998, eq. 11 and below].
/// Looked up in a table in ln(kL), within 1e-6 of the exact value; tested.
#[derive(Clone, Debug)]
pub struct EddyLifetime {
    anisotropy: f64,
    length_scale: f64,
    /// ln(β/Γ) at equal steps of ln(kL).
    table: Vec<f64>,
}

/// Least ln(kL) of the table.
const LOWEST: f64 = -9.0;
/// Greatest ln(kL) of the table.
const HIGHEST: f64 = 9.0;
/// Intervals of the table.
const INTERVALS: usize = 4096;

impl EddyLifetime {
    /// For anisotropy Γ (–) and length scale L (m).
    pub fn new(anisotropy: f64, length_scale: f64) -> Self {
        let step = (HIGHEST - LOWEST) / INTERVALS as f64;
        let table = (0..=INTERVALS)
            .map(|index| exact((LOWEST + index as f64 * step).exp(), 1.0).ln())
            .collect();
        Self { anisotropy, length_scale, table }
    }

    /// β (–) at wave number `wave_number` (rad/m), positive.
    pub fn at(&self, wave_number: f64) -> f64 {
        if self.anisotropy == 0.0 {
            return 0.0;
        }
        let scaled = wave_number * self.length_scale;
        let place = (scaled.ln() - LOWEST) * (INTERVALS as f64 / (HIGHEST - LOWEST));
        if !(0.0..INTERVALS as f64).contains(&place) {
            return exact(scaled, self.anisotropy);
        }
        let index = place as usize;
        let weight = place - index as f64;
        let logarithm = self.table[index] + weight * (self.table[index + 1] - self.table[index]);
        self.anisotropy * logarithm.exp()
    }
}

/// β (–) at kL = `scaled` for anisotropy Γ, without the table.
pub fn exact(scaled: f64, anisotropy: f64) -> f64 {
    anisotropy * scaled.powf(-2.0 / 3.0) / hypergeometric(scaled.powi(-2)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// ∫₀¹ (1 + x s³)^(−17/6) ds by Gauss-Legendre panels that shrink towards s = 0.
    fn by_quadrature(x: f64) -> f64 {
        const NODES: [(f64, f64); 5] = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ];
        let edges: Vec<f64> = (0..=900).rev().map(|n| 0.98_f64.powi(n)).collect();
        let mut sum = edges[0]; // the integrand is 1 there to double precision
        for pair in edges.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            for (node, weight) in NODES {
                let s = middle + half * node;
                sum += half * weight * (1.0 + x * s.powi(3)).powf(-17.0 / 6.0);
            }
        }
        sum
    }

    #[test]
    fn hypergeometric_equals_its_integral() {
        for x in [0.0, 1e-6, 0.01, 0.3, 1.0, 2.7, 3.999, 4.0, 4.001, 9.0, 100.0, 1e4, 1e8] {
            let (value, reference) = (hypergeometric(x), by_quadrature(x));
            assert!((value / reference - 1.0).abs() < 1e-11, "x {x}: {value} {reference}");
        }
    }

    #[test]
    fn both_series_meet() {
        let (below, above) = (hypergeometric(4.0), hypergeometric(4.0 + 1e-13));
        assert!((below / above - 1.0).abs() < 1e-12);
    }

    /// Small eddies: β → Γ (kL)^(−2/3); large ones: (kL)^(−1) with the constant of the integral.
    #[test]
    fn has_the_limits_of_the_theory() {
        assert!((exact(1e4, 3.9) * 1e4_f64.powf(2.0 / 3.0) / 3.9 - 1.0).abs() < 1e-7);
        let large_eddies = exact(1e-4, 3.9) * 1e-4 / 3.9;
        assert!((large_eddies * 0.688_343_942_614_314_3_f64.sqrt() - 1.0).abs() < 1e-5);
    }

    proptest! {
        #[test]
        fn the_table_is_exact_to_a_millionth(logarithm in -12.0..12.0_f64) {
            let lifetime = EddyLifetime::new(3.9, 33.6);
            let exact = exact(logarithm.exp(), 3.9);
            prop_assert!((lifetime.at(logarithm.exp() / 33.6) / exact - 1.0).abs() < 1e-6);
        }
    }
}
