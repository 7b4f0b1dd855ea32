//! Linear models and controllers as files: JSON with the matrices' rows, which Python, MATLAB and Julia read
//! as they are.

use crate::FileError;
use crate::atomic;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A linear time-invariant system: x(k+1) = A x(k) + B u(k) + K e(k), y(k) = C x(k) + D u(k) + e(k),
/// deviations from [means](LinearModel::input_means); in continuous time likewise with dx/dt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearModel {
    /// What the file is, with the version of its form.
    #[serde(rename = "format")]
    pub role: Role,
    /// What it is, in a line.
    pub description: String,
    /// Time between samples (s); none in continuous time.
    pub interval_s: Option<f64>,
    /// Names and units of the inputs, in the order of B's columns.
    pub inputs: Vec<Port>,
    /// Names and units of the outputs, in the order of C's rows.
    pub outputs: Vec<Port>,
    /// Order × order, row by row.
    #[serde(rename = "A")]
    pub a: Vec<Vec<f64>>,
    /// Order × inputs.
    #[serde(rename = "B")]
    pub b: Vec<Vec<f64>>,
    /// Outputs × order.
    #[serde(rename = "C")]
    pub c: Vec<Vec<f64>>,
    /// Outputs × inputs.
    #[serde(rename = "D")]
    pub d: Vec<Vec<f64>>,
    /// Kalman gain, order × outputs; none of a system without noise.
    #[serde(rename = "K", default, skip_serializing_if = "Option::is_none")]
    pub k: Option<Vec<Vec<f64>>>,
    /// Time by which the outputs come later than the matrices say (s).
    #[serde(default)]
    pub output_delay_s: f64,
    /// What the inputs are where u = 0, in their units; 0 where left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub input_means: Vec<f64>,
    /// What the outputs are where y = 0, in their units; 0 where left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub output_means: Vec<f64>,
}

/// What a linear system is used as; in a file the value of `format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// A model of what answers.
    #[serde(rename = "wakemix linear model 1")]
    Model,
    /// A controller, from errors to controls.
    #[serde(rename = "wakemix linear controller 1")]
    Controller,
}

/// An input or output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Port {
    /// Its name.
    pub name: String,
    /// Its unit; empty where it has none.
    #[serde(default)]
    pub unit: String,
}

impl Role {
    /// It, in words.
    fn what(self) -> &'static str {
        match self {
            Self::Model => "a linear model",
            Self::Controller => "a control law",
        }
    }
}

impl LinearModel {
    /// A system of its matrices' rows, without noise, delay or means.
    pub fn new(
        role: Role,
        description: String,
        interval_s: Option<f64>,
        [inputs, outputs]: [Vec<Port>; 2],
        [a, b, c, d]: [Vec<Vec<f64>>; 4],
    ) -> Self {
        Self {
            role,
            description,
            interval_s,
            inputs,
            outputs,
            a,
            b,
            c,
            d,
            k: None,
            output_delay_s: 0.0,
            input_means: Vec::new(),
            output_means: Vec::new(),
        }
    }

    /// Reads the file at `path`, which is to hold a system of this `role`.
    ///
    /// # Errors
    /// [`FileError::System`] where it cannot be read, [`FileError::Content`] with the place where it is none,
    /// or one of another role.
    pub fn read(path: &Path, role: Role) -> Result<Self, FileError> {
        Self::parse(path, &atomic::read_text(path, role.what())?, role)
    }

    /// The system of this `role` in `text`, which stands at `path`.
    ///
    /// # Errors
    /// [`FileError::Content`] as for [`read`](Self::read).
    pub fn parse(path: &Path, text: &str, role: Role) -> Result<Self, FileError> {
        let fix = match role {
            Role::Model => "write it with `wakemix identify`, or as docs/control-design.md says",
            Role::Controller => {
                "write it with `wakemix synthesize`, or as docs/control-design.md says"
            }
        };
        let refused = |problem: String| FileError::content(role.what(), path, problem, fix);
        let model: Self = serde_json::from_str(text).map_err(|error| refused(error.to_string()))?;
        if model.role != role {
            let [found, wanted] = [model.role, role].map(Role::what);
            return Err(refused(format!("it holds {found}, not {wanted}, as its `format` says")));
        }
        model.check().map_err(refused)?;
        Ok(model)
    }

    /// What its file holds.
    pub fn to_text(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain numbers and texts") + "\n"
    }

    /// Writes the file at `path`, whole or not at all.
    ///
    /// # Errors
    /// [`FileError::System`] where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        atomic::write(path, self.role.what(), self.to_text().as_bytes())
    }

    /// Samples by which the outputs come later than the matrices say (–); 0 in continuous time.
    pub fn delay_samples(&self) -> usize {
        self.interval_s.map_or(0, |interval| (self.output_delay_s / interval).round() as usize)
    }

    /// # Errors
    /// What of it does not fit, in words.
    fn check(&self) -> Result<(), String> {
        let (order, inputs, outputs) = (self.a.len(), self.inputs.len(), self.outputs.len());
        let matrices = [
            ("A", &self.a, [order, order]),
            ("B", &self.b, [order, inputs]),
            ("C", &self.c, [outputs, order]),
            ("D", &self.d, [outputs, inputs]),
        ];
        let gain = self.k.as_ref().map(|k| ("K", k, [order, outputs]));
        for (name, rows, [height, width]) in matrices.into_iter().chain(gain) {
            if rows.len() != height || rows.iter().any(|row| row.len() != width) {
                return Err(format!(
                    "`{name}` is not {height} × {width}, as A's rows, `inputs` and `outputs` ask for"
                ));
            }
            if rows.iter().flatten().any(|value| !value.is_finite()) {
                return Err(format!("`{name}` holds what is not a finite number"));
            }
        }
        for (name, values, n) in [
            ("input_means", &self.input_means, inputs),
            ("output_means", &self.output_means, outputs),
        ] {
            if !values.is_empty() && values.len() != n {
                return Err(format!("`{name}` has {} values where {n} are expected", values.len()));
            }
        }
        if self.interval_s.is_some_and(|interval| !interval.is_finite() || interval <= 0.0) {
            return Err("`interval_s` is not above 0".to_owned());
        }
        if !self.output_delay_s.is_finite() || self.output_delay_s < 0.0 {
            return Err("`output_delay_s` is below 0".to_owned());
        }
        if self.interval_s.is_none() && self.output_delay_s > 0.0 {
            return Err(format!(
                "`output_delay_s` = {} stands beside no `interval_s`: a delay is counted in samples; sample the model, or put Padé's approximant of the delay into the matrices",
                self.output_delay_s
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn sample() -> LinearModel {
        let port = |name: &str, unit: &str| Port { name: name.to_owned(), unit: unit.to_owned() };
        LinearModel {
            k: Some(vec![vec![0.1]]),
            output_delay_s: 11.2,
            ..LinearModel::new(
                Role::Model,
                "a lag".to_owned(),
                Some(0.1),
                [vec![port("tilt", "deg")], vec![port("z", "m")]],
                [vec![vec![0.9]], vec![vec![0.1]], vec![vec![1.0 / 3.0]], vec![vec![0.0]]],
            )
        }
    }

    #[test]
    fn what_is_written_is_read_again_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        sample().write(&path).unwrap();
        assert_eq!(LinearModel::read(&path, Role::Model).unwrap(), sample());
        assert_eq!(sample().delay_samples(), 112);
    }

    #[test]
    fn what_does_not_fit_is_told_with_its_key() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        let mut wrong = sample();
        wrong.b = vec![vec![0.1, 0.2]];
        wrong.write(&path).unwrap();
        let said = LinearModel::read(&path, Role::Model).unwrap_err().to_string();
        assert!(said.contains("model.json") && said.contains("`B` is not 1 × 1"), "{said}");
        sample().write(&path).unwrap();
        let said = LinearModel::read(&path, Role::Controller).unwrap_err().to_string();
        assert!(said.contains("it holds a linear model, not a control law"), "{said}");
        fs::write(&path, "{\n\"format\": 3}").unwrap();
        let said = LinearModel::read(&path, Role::Model).unwrap_err().to_string();
        assert!(said.contains("line 2"), "{said}");
        let continuous = LinearModel { interval_s: None, ..sample() };
        continuous.write(&path).unwrap();
        let said = LinearModel::read(&path, Role::Model).unwrap_err().to_string();
        assert!(said.contains("`output_delay_s` = 11.2 stands beside no `interval_s`"), "{said}");
        let missing = LinearModel::read(&folder.path().join("none.json"), Role::Model)
            .unwrap_err()
            .to_string();
        assert!(missing.contains("none.json"), "{missing}");
    }
}
