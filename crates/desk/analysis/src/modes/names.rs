//! Frequencies of a helix and its rotor, by which modes are named.

/// Multiples of the excitation frequency that have a name (–).
const MULTIPLES: usize = 3;

/// A frequency with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFrequency {
    /// Its name, such as `2 f_e`.
    pub name: String,
    /// Its value (Hz).
    pub frequency: f64,
}

/// The frequencies that have names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrequencyNames {
    /// In ascending order.
    pub all: Vec<NamedFrequency>,
}

impl FrequencyNames {
    /// Those of a helix of frequency `excitation` (Hz) behind a rotor that turns at `rotor` (Hz) with
    /// `n_blades` blades: f_e and its multiples, f_r, the blades' passing, and f_r ± f_e, at which blades
    /// pitch.
    pub fn new(excitation: Option<f64>, rotor: Option<f64>, n_blades: usize) -> Self {
        let mut all = Vec::new();
        let mut add = |name: String, frequency: f64| {
            if frequency.is_finite() && frequency > 0.0 {
                all.push(NamedFrequency { name, frequency });
            }
        };
        if let Some(excitation) = excitation {
            add("f_e".to_owned(), excitation);
            for multiple in 2..=MULTIPLES {
                add(format!("{multiple} f_e"), multiple as f64 * excitation);
            }
        }
        if let Some(rotor) = rotor {
            add("f_r".to_owned(), rotor);
            add(format!("{n_blades} f_r"), n_blades as f64 * rotor);
        }
        if let (Some(excitation), Some(rotor)) = (excitation, rotor) {
            add("f_r − f_e".to_owned(), rotor - excitation);
            add("f_r + f_e".to_owned(), rotor + excitation);
        }
        all.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        Self { all }
    }

    /// Names of what lies within `half_step` (Hz) of `frequency` (Hz), the nearest first; none where nothing
    /// does.
    pub fn of(&self, frequency: f64, half_step: f64) -> Option<String> {
        let away = |one: &&NamedFrequency| (one.frequency - frequency).abs();
        let mut near: Vec<_> = self.all.iter().filter(|one| away(one) <= half_step).collect();
        near.sort_by(|a, b| away(a).total_cmp(&away(b)));
        let names: Vec<&str> = near.into_iter().map(|one| one.name.as_str()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_in_a_step_of_frequency_has_its_name() {
        let names = FrequencyNames::new(Some(0.3), Some(1.4), 3);
        assert_eq!(names.of(0.31, 0.05).as_deref(), Some("f_e"));
        assert_eq!(names.of(0.6, 0.01).as_deref(), Some("2 f_e"));
        assert_eq!(names.of(1.2, 0.15).as_deref(), Some("f_r − f_e"));
        // Two in one step: the nearer one first.
        assert_eq!(names.of(0.95, 0.2).as_deref(), Some("3 f_e, f_r − f_e"));
        assert_eq!((names.of(0.45, 0.05), names.of(9.0, 0.5)), (None, None));
        assert!(FrequencyNames::new(None, None, 3).all.is_empty());
    }
}
