//! Kernels as sums of products, and their hyperparameters in a row.

use crate::{Shape, SurrogateError};

/// One factor of a product: a shape over some of the inputs, with a length for each of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Covariance function.
    pub shape: Shape,
    /// Inputs that it looks at, the first is 0.
    pub inputs: Vec<usize>,
    /// Length for each of them (unit of that input; – for the periodic shape).
    pub lengths: Vec<f64>,
}

/// A product of parts, with its variance.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Variance (unit of the values, squared).
    pub variance: f64,
    /// The factors.
    pub parts: Vec<Part>,
}

/// A sum of products: every kernel that is put together by sums and products can be written so.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// The summands.
    pub terms: Vec<Term>,
}

/// Hyperparameters, in the user's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// The kernel.
    pub kernel: Kernel,
    /// Estimated noise variance of each group, beyond what is known (unit of the values, squared).
    pub noise: Vec<f64>,
}

impl Kernel {
    /// `shape` over all of `n_dimensions` inputs, its hyperparameters still to be found.
    pub fn of(shape: Shape, n_dimensions: usize) -> Self {
        let lengths = vec![1.0; n_dimensions];
        let part = Part { shape, inputs: (0..n_dimensions).collect(), lengths };
        Self { terms: vec![Term { variance: 1.0, parts: vec![part] }] }
    }

    /// Variance of the curve at one input (unit of the values, squared).
    pub fn variance(&self) -> f64 {
        self.terms.iter().map(|term| term.variance).sum()
    }

    /// Whether it can be worked out over `n_dimensions` inputs.
    ///
    /// # Errors
    /// [`SurrogateError::NotPositive`] or [`SurrogateError::Lengths`] for what is wrong with it.
    pub fn check(&self, n_dimensions: usize) -> Result<(), SurrogateError> {
        let positive = |what, value: f64| {
            let is_good = value > 0.0 && value.is_finite();
            is_good.then_some(()).ok_or(SurrogateError::NotPositive { what, value })
        };
        let some = |what, n: usize| {
            let found = SurrogateError::Lengths { what, found: n, needed: 1 };
            (n > 0).then_some(()).ok_or(found)
        };
        some("a kernel's sum", self.terms.len())?;
        for term in &self.terms {
            positive("a term's variance", term.variance)?;
            some("a kernel's product", term.parts.len())?;
            for part in &term.parts {
                part.shape.check()?;
                some("a part's list of inputs", part.inputs.len())?;
                if part.lengths.len() != part.inputs.len() {
                    let (found, needed) = (part.lengths.len(), part.inputs.len());
                    return Err(SurrogateError::Lengths {
                        what: "a part's lengths",
                        found,
                        needed,
                    });
                }
                if let Some(input) = part.inputs.iter().find(|input| **input >= n_dimensions) {
                    let (what, found) = ("the inputs that the kernel asks for", n_dimensions);
                    return Err(SurrogateError::Lengths { what, found, needed: input + 1 });
                }
                part.lengths.iter().try_for_each(|length| positive("a length", *length))?;
            }
        }
        Ok(())
    }

    /// Logarithms of all hyperparameters: of each term its variance, then of each part its lengths and its
    /// exponent. Periods are given, not estimated.
    pub(crate) fn logarithms(&self) -> Vec<f64> {
        let mut values = Vec::new();
        for term in &self.terms {
            values.push(term.variance.ln());
            for part in &term.parts {
                values.extend(part.lengths.iter().map(|length| length.ln()));
                if let Shape::RationalQuadratic { exponent } = part.shape {
                    values.push(exponent.ln());
                }
            }
        }
        values
    }

    /// The kernel with other [`logarithms`](Self::logarithms); gives what is left of them.
    pub(crate) fn with<'a>(&self, mut values: &'a [f64]) -> (Self, &'a [f64]) {
        let mut next = || {
            let (first, rest) = values.split_first().unwrap_or((&0.0, &[]));
            values = rest;
            first.exp()
        };
        let mut kernel = self.clone();
        for term in &mut kernel.terms {
            term.variance = next();
            for part in &mut term.parts {
                part.lengths.iter_mut().for_each(|length| *length = next());
                if let Shape::RationalQuadratic { exponent } = &mut part.shape {
                    *exponent = next();
                }
            }
        }
        (kernel, values)
    }

    /// The kernel where inputs and values are counted in other units: lengths and periods over `inputs`,
    /// variances over the square of `value`.
    pub(crate) fn in_units(&self, inputs: &[f64], value: f64) -> Self {
        let mut kernel = self.clone();
        for term in &mut kernel.terms {
            term.variance /= value * value;
            for part in &mut term.parts {
                if let Shape::Periodic { period } = &mut part.shape {
                    // Such a part has one input, or inputs of one unit; see `is_scalable`.
                    *period /= inputs[part.inputs[0]];
                } else {
                    for (length, input) in part.lengths.iter_mut().zip(&part.inputs) {
                        *length /= inputs[*input];
                    }
                }
            }
        }
        kernel
    }

    /// Whether input `input` has to keep its own unit because one period counts for several inputs.
    pub(crate) fn keeps_unit(&self, input: usize) -> bool {
        let parts = self.terms.iter().flat_map(|term| &term.parts);
        parts.into_iter().any(|part| {
            let is_periodic = matches!(part.shape, Shape::Periodic { .. });
            is_periodic && part.inputs.len() > 1 && part.inputs.contains(&input)
        })
    }
}
