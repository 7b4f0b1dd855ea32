//! Frequency responses of the generators, in closed form.

use super::generator::GeneratorKind;
use lti::Complex64;

/// Gain and phase at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Amplitude out over amplitude in (–).
    pub gain: f64,
    /// Lead of the output (rad, [−π, π]).
    pub phase: f64,
}

/// Frequency responses of a generator's three outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    /// To the in-phase signal.
    pub in_phase: Response,
    /// To the quadrature signal.
    pub quadrature: Response,
    /// To the offset; no gain in the second-order generator.
    pub offset: Response,
}

/// Transfer functions of a generator of `kind` with `damping` k (–) at `ratio` (–) times its centre rate.
///
/// Source: van Veldhoven (2024), Eqs. 2-7, 2-11, 2-15 with, in which s² + k ω̂ + ω̂² is to be
/// read with k ω̂ s. The mixed generator's offset is v_dc / k, so that a constant passes with gain one.
pub fn transfer(kind: GeneratorKind, damping: f64, ratio: f64) -> Transfer {
    let k = damping;
    let s = Complex64::new(0.0, ratio);
    let square = s * s;
    let second = square + k * s + 1.0;
    let [in_phase, quadrature, offset] = match kind {
        GeneratorKind::Second => [(k * s) / second, k / second, Complex64::default()],
        GeneratorKind::Extended { dc_gain } => {
            let third = square * s + (k + dc_gain) * square + s + dc_gain;
            let notch = dc_gain * (square + 1.0);
            [(k * square) / third, (k * s) / third, notch / third]
        }
        GeneratorKind::Mixed => {
            let third = (s + 1.0) * second;
            [(k * s) / second, (k * s * (1.0 - s)) / third, (square + 1.0) / third]
        }
    };
    let response = |value: Complex64| Response { gain: value.norm(), phase: value.arg() };
    Transfer {
        in_phase: response(in_phase),
        quadrature: response(quadrature),
        offset: response(offset),
    }
}
