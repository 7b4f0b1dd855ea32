//! Frequency responses of the generators, in closed form.

use super::complex::Complex;
use super::generator::Kind;

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
/// Source: van Veldhoven (2024), Eqs. 2-7, 2-11, 2-15 with, in which s² + k ω̂ + ω̂² is to be read with k ω̂ s. The
/// mixed generator's offset is v_dc / k, so that a constant passes with gain one.
pub fn transfer(kind: Kind, damping: f64, ratio: f64) -> Transfer {
    let k = damping;
    let s = Complex::new(0.0, ratio);
    let one = Complex::real(1.0);
    let square = s * s;
    let second = square + k * s + one;
    let [in_phase, quadrature, offset] = match kind {
        Kind::Second => [(k * s) / second, Complex::real(k) / second, Complex::real(0.0)],
        Kind::Extended { dc_gain } => {
            let third = square * s + (k + dc_gain) * square + s + Complex::real(dc_gain);
            let notch = dc_gain * (square + one);
            [(k * square) / third, (k * s) / third, notch / third]
        }
        Kind::Mixed => {
            let third = (s + one) * second;
            [(k * s) / second, (k * s * (one - s)) / third, (square + one) / third]
        }
    };
    let response = |value: Complex| Response { gain: value.norm(), phase: value.argument() };
    Transfer {
        in_phase: response(in_phase),
        quadrature: response(quadrature),
        offset: response(offset),
    }
}
