//! The keys of one weight, and the system that they make.

use super::WeightProblem;
use faer::Mat;
use lti::matrices::{StateSpace, TransferFunction};
use serde::Deserialize;
use synthesis::{control_weight, performance_weight};

/// Distance from the imaginary axis, in parts of the norm of A, below which a pole is on it (–).
const ON_AXIS: f64 = 1e-9;

/// What a table may hold. Continuous time, rad/s.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, or one for each channel")]
pub(super) struct Keys {
    /// The channel that it is of.
    pub(super) channel: Option<String>,
    /// (s/M + ω)/(s + A ω): ω, M and A.
    bandwidth: Option<f64>,
    peak: Option<f64>,
    attenuation: Option<f64>,
    /// scale B² (s² + √2 ω s + ω²)/(s² + √2 B ω s + (B ω)²): ω, B.
    corner: Option<f64>,
    ratio: Option<f64>,
    scale: Option<f64>,
    /// Coefficients, highest power first.
    numerator: Option<Vec<f64>>,
    denominator: Option<Vec<f64>>,
    /// Rows of dx/dt = A x + B u, y = C x + D u.
    #[serde(rename = "A")]
    a: Option<Vec<Vec<f64>>>,
    #[serde(rename = "B")]
    b: Option<Vec<Vec<f64>>>,
    #[serde(rename = "C")]
    c: Option<Vec<Vec<f64>>>,
    #[serde(rename = "D")]
    d: Option<Vec<Vec<f64>>>,
}

impl Keys {
    /// The stable system that the keys make.
    ///
    /// # Errors
    /// [`WeightProblem`] naming the key.
    pub(super) fn system(&self) -> Result<StateSpace, WeightProblem> {
        self.one_form()?;
        let system = match self {
            Self {
                bandwidth: Some(bandwidth), peak: Some(peak), attenuation: Some(low), ..
            } => {
                positive([("bandwidth", *bandwidth), ("peak", *peak), ("attenuation", *low)])?;
                performance_weight(*bandwidth, *peak, *low)?
            }
            Self { corner: Some(corner), ratio: Some(ratio), scale: Some(scale), .. } => {
                positive([("corner", *corner), ("ratio", *ratio), ("scale", *scale)])?;
                control_weight(*corner, *ratio, *scale)?
            }
            Self { numerator: Some(numerator), denominator: Some(denominator), .. } => {
                rational(numerator, denominator)?
            }
            Self { d: Some(d), .. } => self.matrices(d)?,
            _ => return Err(WeightProblem::NoForm),
        };
        stable(system)
    }

    /// Whether the keys are those of one form, all of them.
    fn one_form(&self) -> Result<(), WeightProblem> {
        let has_states = self.a.is_some() || self.b.is_some() || self.c.is_some();
        let forms: [&[(&'static str, bool)]; 4] = [
            &[
                ("bandwidth", self.bandwidth.is_some()),
                ("peak", self.peak.is_some()),
                ("attenuation", self.attenuation.is_some()),
            ],
            &[
                ("corner", self.corner.is_some()),
                ("ratio", self.ratio.is_some()),
                ("scale", self.scale.is_some()),
            ],
            &[("numerator", self.numerator.is_some()), ("denominator", self.denominator.is_some())],
            &[
                // A gain without states is D alone.
                ("A", self.a.is_some() || !has_states),
                ("B", self.b.is_some() || !has_states),
                ("C", self.c.is_some() || !has_states),
                ("D", self.d.is_some()),
            ],
        ];
        let begun = [
            forms[0].iter().any(|(_, given)| *given),
            forms[1].iter().any(|(_, given)| *given),
            forms[2].iter().any(|(_, given)| *given),
            has_states || self.d.is_some(),
        ];
        let mut chosen = forms.into_iter().zip(begun).filter(|(_, begun)| *begun);
        let (form, _) = chosen.next().ok_or(WeightProblem::NoForm)?;
        if let Some((other, _)) = chosen.next() {
            let first = |keys: &[(&'static str, bool)]| {
                keys.iter().rev().find(|(_, given)| *given).map_or("", |(key, _)| key)
            };
            return Err(WeightProblem::TwoForms { keys: [first(form), first(other)] });
        }
        match form.iter().find(|(_, given)| !given) {
            Some((key, _)) => Err(WeightProblem::Lacks { key }),
            None => Ok(()),
        }
    }

    /// The system of the matrices' rows.
    fn matrices(&self, d: &[Vec<f64>]) -> Result<StateSpace, WeightProblem> {
        let none = Vec::new();
        let [a, b, c] = [&self.a, &self.b, &self.c].map(|rows| rows.as_ref().unwrap_or(&none));
        let (order, outputs, inputs) = (a.len(), d.len(), d.first().map_or(0, Vec::len));
        if inputs == 0 {
            return Err(WeightProblem::NoSignals);
        }
        // Without states there is no row of A and B, and C's have nothing in them.
        let empty = vec![Vec::new(); outputs];
        let c = if order == 0 && c.is_empty() { &empty } else { c };
        Ok(StateSpace::new(
            matrix("A", a, order, order)?,
            matrix("B", b, order, inputs)?,
            matrix("C", c, outputs, order)?,
            matrix("D", d, outputs, inputs)?,
            None,
        ))
    }
}

/// Whether all `values` are above zero and finite.
fn positive(values: [(&'static str, f64); 3]) -> Result<(), WeightProblem> {
    match values.into_iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
        Some((key, value)) => Err(WeightProblem::OutOfRange { key, value }),
        None => Ok(()),
    }
}

/// The system of a transfer function.
fn rational(numerator: &[f64], denominator: &[f64]) -> Result<StateSpace, WeightProblem> {
    for (key, coefficients) in [("numerator", numerator), ("denominator", denominator)] {
        if coefficients.iter().any(|value| !value.is_finite()) {
            return Err(WeightProblem::NotFinite { key });
        }
        if coefficients.iter().all(|value| *value == 0.0) {
            return Err(WeightProblem::Zero { key });
        }
    }
    let degree = |coefficients: &[f64]| {
        let leading = coefficients.iter().position(|value| *value != 0.0).unwrap_or(0);
        coefficients.len() - 1 - leading
    };
    let degrees = [degree(numerator), degree(denominator)];
    if degrees[0] > degrees[1] {
        return Err(WeightProblem::Improper { degrees });
    }
    let function = TransferFunction {
        numerator: numerator.to_vec(),
        denominator: denominator.to_vec(),
        interval: None,
    };
    Ok(function.state_space()?)
}

/// The matrix of `rows`, which is to be `height` × `width`.
fn matrix(
    key: &'static str,
    rows: &[Vec<f64>],
    height: usize,
    width: usize,
) -> Result<Mat<f64>, WeightProblem> {
    let other = rows.iter().map(Vec::len).find(|found| *found != width);
    if rows.len() != height || other.is_some() {
        let found = [rows.len(), other.unwrap_or(width)];
        return Err(WeightProblem::Shape { key, found, expected: [height, width] });
    }
    if rows.iter().flatten().any(|value| !value.is_finite()) {
        return Err(WeightProblem::NotFinite { key });
    }
    Ok(Mat::from_fn(height, width, |row, column| rows[row][column]))
}

/// The `system`, whose poles all lie to the left of the imaginary axis.
fn stable(system: StateSpace) -> Result<StateSpace, WeightProblem> {
    let Some(pole) = system.least_stable_pole()? else { return Ok(system) };
    if pole.re.abs() <= ON_AXIS * system.prescaled().a.norm_l2() {
        return Err(WeightProblem::OnAxis { frequency: pole.im.abs() });
    }
    if pole.re > 0.0 {
        return Err(WeightProblem::Unstable { pole });
    }
    Ok(system)
}
