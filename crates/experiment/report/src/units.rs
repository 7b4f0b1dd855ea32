//! In what a reader is told powers and thrusts: megawatts, kilonewtons; watts, newtons of tunnel models.

use basis::records::Summary;

/// Turbines of which none makes more than this are models (W).
const MODEL_POWER: f64 = 1e3;

/// A unit that has a name and a size in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As readers are told.
    pub name: &'static str,
    /// What one of it is (W, N).
    pub size: f64,
}

/// What suits the turbines of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Of powers.
    pub power: Unit,
    /// Of thrusts.
    pub thrust: Unit,
}

impl Units {
    const OF_TURBINES: Self =
        Self { power: Unit { name: "MW", size: 1e6 }, thrust: Unit { name: "kN", size: 1e3 } };
    const OF_MODELS: Self =
        Self { power: Unit { name: "W", size: 1.0 }, thrust: Unit { name: "N", size: 1.0 } };

    /// For turbines whose mean `powers` (W) these are.
    pub fn of(powers: impl IntoIterator<Item = f64>) -> Self {
        if are_of_models(powers) { Self::OF_MODELS } else { Self::OF_TURBINES }
    }

    /// For those of `summaries`.
    pub(crate) fn of_all<'a>(summaries: impl IntoIterator<Item = &'a Summary>) -> Self {
        let turbines = summaries.into_iter().flat_map(|summary| &summary.turbines);
        Self::of(turbines.map(|turbine| turbine.power.mean))
    }
}

/// Whether mean `powers` (W) are those of models in a wind tunnel: there is power, and none makes a kilowatt.
pub fn are_of_models(powers: impl IntoIterator<Item = f64>) -> bool {
    let most = powers.into_iter().map(f64::abs).fold(0.0, f64::max);
    most > 0.0 && most < MODEL_POWER
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kilowatt_parts_models_from_turbines() {
        assert_eq!(Units::of([5.3, -0.1]).power.name, "W");
        assert_eq!(Units::of([5.3, 2.1e6]).power.name, "MW");
        // Nothing tells of a rotor that stands still.
        assert_eq!(Units::of([0.0]).thrust.name, "kN");
    }
}
