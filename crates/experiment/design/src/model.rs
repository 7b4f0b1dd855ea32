//! Between the model in a file and the system that is worked with.

use faer::Mat;
use formats::linear_model::{LinearModel, Port, Role};
use lti::matrices::StateSpace;

/// The system of `model`, delay and means aside.
pub(crate) fn system(model: &LinearModel) -> StateSpace {
    let (order, inputs, outputs) = (model.a.len(), model.inputs.len(), model.outputs.len());
    StateSpace::new(
        matrix(&model.a, order, order),
        matrix(&model.b, order, inputs),
        matrix(&model.c, outputs, order),
        matrix(&model.d, outputs, inputs),
        model.interval_s,
    )
}

/// What a file holds of `system`, a model or a controller, with its `ports`, inputs and outputs.
pub(crate) fn linear_model(
    role: Role,
    description: String,
    ports: [Vec<Port>; 2],
    system: &StateSpace,
) -> LinearModel {
    let StateSpace { a, b, c, d, interval } = system;
    LinearModel::new(role, description, *interval, ports, [a, b, c, d].map(rows))
}

/// The channel `name` without its turbine.
pub(crate) fn short(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, channel)| channel)
}

/// `value` to five digits, as a sentence tells it.
pub(crate) fn five_digits(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

/// A matrix row by row.
pub(crate) fn rows(matrix: &Mat<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

fn matrix(rows: &[Vec<f64>], height: usize, width: usize) -> Mat<f64> {
    Mat::from_fn(height, width, |row, column| rows[row][column])
}
