//! Systems put together: series, parallel, feedback, linear fractional transformation.

use super::dense::{blocks, identity, inverse, part};
use super::{MatrixError, StateSpace};
use faer::Mat;

/// `second` after `first`: y = second(first(u)).
pub fn series(first: &StateSpace, second: &StateSpace) -> Result<StateSpace, MatrixError> {
    let interval = common_interval(first, second)?;
    fits("outputs of the first of two systems in series", first.outputs(), second.inputs())?;
    let a = blocks(&[
        &[&first.a, &Mat::zeros(first.order(), second.order())],
        &[&(&second.b * &first.c), &second.a],
    ]);
    let b = blocks(&[&[&first.b], &[&(&second.b * &first.d)]]);
    let c = blocks(&[&[&(&second.d * &first.c), &second.c]]);
    Ok(StateSpace::new(a, b, c, &second.d * &first.d, interval))
}

/// The sum of two systems' outputs for one input.
pub fn parallel(first: &StateSpace, second: &StateSpace) -> Result<StateSpace, MatrixError> {
    let interval = common_interval(first, second)?;
    fits("inputs of the first of two systems in parallel", first.inputs(), second.inputs())?;
    fits("outputs of the first of two systems in parallel", first.outputs(), second.outputs())?;
    let a = diagonal(&first.a, &second.a);
    let b = blocks(&[&[&first.b], &[&second.b]]);
    let c = blocks(&[&[&first.c, &second.c]]);
    Ok(StateSpace::new(a, b, c, &first.d + &second.d, interval))
}

/// Systems beside each other, each with its own inputs and outputs (block diagonal).
pub fn append(systems: &[&StateSpace]) -> Result<StateSpace, MatrixError> {
    let Some((first, others)) = systems.split_first() else {
        return Err(MatrixError::Size { what: "systems to append", found: 0, expected: 1 });
    };
    others.iter().try_fold((*first).clone(), |whole, next| {
        let interval = common_interval(&whole, next)?;
        Ok(StateSpace::new(
            diagonal(&whole.a, &next.a),
            diagonal(&whole.b, &next.b),
            diagonal(&whole.c, &next.c),
            diagonal(&whole.d, &next.d),
            interval,
        ))
    })
}

/// Negative feedback: y = forward(r − back(y)), from r to y.
pub fn feedback(forward: &StateSpace, back: &StateSpace) -> Result<StateSpace, MatrixError> {
    let (b, c, d) = (&forward.b, &forward.c, &forward.d);
    let doubled = StateSpace::new(
        forward.a.clone(),
        blocks(&[&[b, b]]),
        blocks(&[&[c], &[c]]),
        blocks(&[&[d, d], &[d, d]]),
        forward.interval,
    );
    fits("outputs of what is fed back", back.outputs(), forward.inputs())?;
    fits("inputs of what is fed back", back.inputs(), forward.outputs())?;
    lower_fractional(&doubled, &back.scaled(-1.0))
}

/// Lower linear fractional transformation: the plant's last outputs go through `controller` to its last
/// inputs.
///
/// Source: Zhou, Doyle and Glover, "Robust and Optimal Control", 1996, §10.1.
pub fn lower_fractional(
    plant: &StateSpace,
    controller: &StateSpace,
) -> Result<StateSpace, MatrixError> {
    let interval = common_interval(plant, controller)?;
    let (n, n_y, n_u) = (plant.order(), controller.inputs(), controller.outputs());
    if n_u > plant.inputs() || n_y > plant.outputs() {
        let found = if n_u > plant.inputs() { plant.inputs() } else { plant.outputs() };
        let what = "signals of a plant in a loop";
        return Err(MatrixError::Size { what, found, expected: n_u.max(n_y) });
    }
    let (n_w, n_z) = (plant.inputs() - n_u, plant.outputs() - n_y);
    let (b1, b2) = (part(&plant.b, 0, 0, n, n_w), part(&plant.b, 0, n_w, n, n_u));
    let (c1, c2) = (part(&plant.c, 0, 0, n_z, n), part(&plant.c, n_z, 0, n_y, n));
    let d11 = part(&plant.d, 0, 0, n_z, n_w);
    let d12 = part(&plant.d, 0, n_w, n_z, n_u);
    let d21 = part(&plant.d, n_z, 0, n_y, n_w);
    let d22 = part(&plant.d, n_z, n_w, n_y, n_u);
    // u = R (C_K x_K + D_K (C2 x + D21 w)) with R = (I − D_K D22)⁻¹.
    let loop_matrix = identity(n_u) - &controller.d * &d22;
    let solved = inverse(&loop_matrix).ok_or(MatrixError::IllPosedLoop)?;
    let of_states = &solved * &controller.c;
    let of_measurement = &solved * &controller.d;
    let (of_plant, of_inputs) = (&of_measurement * &c2, &of_measurement * &d21);
    let a = blocks(&[
        &[&(&plant.a + &b2 * &of_plant), &(&b2 * &of_states)],
        &[
            &(&controller.b * (&c2 + &d22 * &of_plant)),
            &(&controller.a + &controller.b * (&d22 * &of_states)),
        ],
    ]);
    let b =
        blocks(&[&[&(&b1 + &b2 * &of_inputs)], &[&(&controller.b * (&d21 + &d22 * &of_inputs))]]);
    let c = blocks(&[&[&(&c1 + &d12 * &of_plant), &(&d12 * &of_states)]]);
    Ok(StateSpace::new(a, b, c, &d11 + &d12 * &of_inputs, interval))
}

impl StateSpace {
    /// The outputs times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { c: factor * &self.c, d: factor * &self.d, ..self.clone() }
    }

    /// The `outputs` and `inputs` with these numbers, in this order.
    pub fn selected(&self, outputs: &[usize], inputs: &[usize]) -> Result<Self, MatrixError> {
        for (what, wanted, most) in
            [("output", outputs, self.outputs()), ("input", inputs, self.inputs())]
        {
            if let Some(&found) = wanted.iter().find(|&&index| index >= most) {
                return Err(MatrixError::Size { what, found, expected: most.saturating_sub(1) });
            }
        }
        let n = self.order();
        Ok(Self::new(
            self.a.clone(),
            Mat::from_fn(n, inputs.len(), |i, j| self.b[(i, inputs[j])]),
            Mat::from_fn(outputs.len(), n, |i, j| self.c[(outputs[i], j)]),
            Mat::from_fn(outputs.len(), inputs.len(), |i, j| self.d[(outputs[i], inputs[j])]),
            self.interval,
        ))
    }

    /// The same system with inputs and outputs exchanged: Aᵀ, Cᵀ, Bᵀ, Dᵀ.
    pub fn dual(&self) -> Self {
        let turned = |matrix: &Mat<f64>| matrix.transpose().to_owned();
        Self::new(turned(&self.a), turned(&self.c), turned(&self.b), turned(&self.d), self.interval)
    }

    /// `copies` of the system beside each other.
    pub fn repeated(&self, copies: usize) -> Result<Self, MatrixError> {
        append(&vec![self; copies])
    }
}

/// Two matrices on the diagonal of one.
fn diagonal(first: &Mat<f64>, second: &Mat<f64>) -> Mat<f64> {
    blocks(&[
        &[first, &Mat::zeros(first.nrows(), second.ncols())],
        &[&Mat::zeros(second.nrows(), first.ncols()), second],
    ])
}

/// The sample time of both systems.
fn common_interval(first: &StateSpace, second: &StateSpace) -> Result<Option<f64>, MatrixError> {
    if first.interval == second.interval {
        Ok(first.interval)
    } else {
        Err(MatrixError::SampleTimes { first: first.interval, second: second.interval })
    }
}

/// Whether a number of signals is as it should be.
fn fits(what: &'static str, found: usize, expected: usize) -> Result<(), MatrixError> {
    if found == expected { Ok(()) } else { Err(MatrixError::Size { what, found, expected }) }
}
