//! The azimuth offset with which tilt pitch answers in the tilt moment and yaw pitch in the yaw moment, of
//! any turbine.

use crate::StudyError;
use crate::models::turbine;
use crate::prepared::Prepared;
use control::excitation_rate;
use control::meandering::Decoupling;
use control::meandering::relative_gain;
use farm::assemble::TurbineModel;
use farm::pitch_response::answers;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Longest period of a helix that identifies a turbine (s): a record of a few of them stays in memory.
const LONGEST_PERIOD: f64 = 2e4;

/// A question about a turbine.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetQuestion {
    /// Name of the library, or path of a turbine file.
    pub model: String,
    /// Steady wind (m/s).
    pub wind_speed: f64,
    /// Strouhal number of the helices that identify it, with that wind and the turbine's own diameter (–).
    pub strouhal: f64,
    /// Whether blades and tower bend.
    pub flexible: bool,
}

/// The answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetAnswer {
    /// Offset, delay and gain.
    pub decoupling: Decoupling,
    /// Element of the relative gain array that pairs tilt with tilt, without the offset and with it (–).
    pub relative_gain: [f64; 2],
}

/// Finds the azimuth offset of a turbine alone in a steady wind, under its own control, from what a
/// counter-clockwise and a clockwise helix of a degree take off the moments of its blades.
///
/// The wind is prescribed, the turbine makes its own induction, and its individual pitch control, which would
/// work against the helices, is switched off.
///
/// # Errors
/// [`StudyError`] for a turbine that cannot be read, and for a wind or Strouhal number that a case file could
/// not have.
pub fn azimuth_offset(question: &OffsetQuestion) -> Result<OffsetAnswer, StudyError> {
    let (_, file) = turbine(&question.model, Path::new(""))?;
    let structure = if question.flexible { "flexible" } else { "rigid" };
    let text = format!(
        "name = \"azimuth-offset\"\n\
         [wind]\nspeed = {:?}\nturbulence_intensity = 0.0\n\
         [flow]\nsolver = \"uniform\"\n\
         [time]\nspin_up = 0.0\nduration = 600.0\n\
         [[turbine]]\nname = \"T1\"\nmodel = {:?}\nposition_diameters = [0.0, 0.0]\nstructure = \"{}\"\n\
         [[run]]\nname = \"probe\"\n\
         control.T1 = {{ kind = \"helix\", sense = \"ccw\", amplitude_deg = 1.0, strouhal = {:?} }}\n",
        question.wind_speed, question.model, structure, question.strouhal
    );
    let case = formats::case::parse("the question", &text, &[])?;
    let model = TurbineModel { definition: Arc::new(file.definition), constants: file.controller };
    let model = model.without_individual_pitch();
    let loaded = BTreeMap::from([(question.model.clone(), model)]);
    let Prepared { case, plan, models, .. } = Prepared::with_models(case, loaded)?;
    let rate = excitation_rate(question.strouhal, case.wind.speed, plan.diameter);
    let period = TAU / rate;
    if period > LONGEST_PERIOD {
        let OffsetQuestion { strouhal, wind_speed, .. } = *question;
        let most = LONGEST_PERIOD;
        return Err(StudyError::SlowHelix { strouhal, wind_speed, period, most });
    }
    let mut whole = |_| ControlFlow::Continue(());
    let [ccw, cw] = answers(&case, &plan, &models[0], 0, case.wind.speed, rate, &mut whole)?;
    let decoupling = Decoupling::from_senses(rate, ccw, cw);
    let relative_gain =
        [0.0, decoupling.azimuth_offset].map(|offset| relative_gain(ccw, cw, offset));
    Ok(OffsetAnswer { decoupling, relative_gain })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An isotropic rotor: some offset decouples tilt from yaw, and it belongs to the machine, not
    /// to the identification.
    #[test]
    fn the_offset_parts_the_axes_and_hardly_depends_on_the_frequency() {
        let question = OffsetQuestion {
            model: "iea-15mw".to_owned(),
            wind_speed: 9.0,
            strouhal: 0.25,
            flexible: false,
        };
        let slow = azimuth_offset(&question).unwrap();
        assert!((slow.relative_gain[1] - 1.0).abs() < 2e-3, "{slow:?}");
        assert!(slow.relative_gain[0] < 0.95, "{slow:?}");
        let fast = OffsetQuestion { strouhal: 0.4, ..question.clone() };
        let fast = azimuth_offset(&fast).unwrap();
        let apart = fast.decoupling.azimuth_offset - slow.decoupling.azimuth_offset;
        assert!(apart.abs() < 1f64.to_radians(), "{slow:?} {fast:?}");
        let slow = OffsetQuestion { strouhal: 1e-3, ..question.clone() };
        assert!(matches!(azimuth_offset(&slow), Err(StudyError::SlowHelix { .. })));
        let nobody = OffsetQuestion { model: "nobody".to_owned(), ..question };
        assert!(azimuth_offset(&nobody).is_err());
    }
}
