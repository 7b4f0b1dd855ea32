//! `tune`: noise for a phase estimator, from records.

use super::phase::{SETTINGS, question};
use super::{Analysis, Answer, Of, Request};
use crate::{PostprocessingError, tune};
use estimation::helix::tuning::Tuned;
use estimation::helix::{Form, Measurement};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "tune",
    about: "Noise for the phase estimator from the record of a run and the true wind of another, after Algorithm 1 of van Vondelen et al. (2025)",
    of: Of::Run("Folder of a run, such as runs/synchronised-helix/offset-150"),
    settings: SETTINGS,
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let tuned = tune(&question(request)?)?;
    Ok(Answer { text: text(&tuned), json: json(&tuned), remarks: Vec::new() })
}

/// Measurement noise, the root of its intensity, with its unit.
fn measurement(tuned: &Tuned) -> (f64, &'static str) {
    match tuned.options.noise.measurement {
        Measurement::Moment(density) => (density, "N m"),
        Measurement::Share(share) => (share, "of the mean moment"),
    }
}

/// What of `tuned` a case file takes: keys of `kind = "phase-sync"`, to four figures.
fn case_keys(tuned: &Tuned) -> String {
    let noise = &tuned.options.noise;
    let mut keys = Vec::new();
    if let Measurement::Moment(density) = noise.measurement {
        keys.push(("measurement_noise_1s_mnm", 1e-6 * density));
    }
    keys.push(("process_noise_mean_wind", noise.mean_wind));
    keys.push(("process_noise_amplitude", noise.amplitude));
    if tuned.options.form != Form::Quadrature {
        keys.push(("process_noise_phase", noise.phase));
    }
    let rounded = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
    let keys: Vec<String> =
        keys.into_iter().map(|(key, value)| format!("{key} = {:?}", rounded(value))).collect();
    keys.join(", ")
}

/// Name of the estimator that `tuned` is for.
fn estimator(tuned: &Tuned) -> &'static str {
    if tuned.options.form == Form::Quadrature {
        "robust"
    } else if tuned.options.rotor.pitch_azimuth_offset == 0.0 {
        "published"
    } else {
        "published-with-offset"
    }
}

fn text(tuned: &Tuned) -> String {
    let noise = &tuned.options.noise;
    let (density, unit) = measurement(tuned);
    format!(
        "R: {density:.4e} {unit} over a second, standard deviation of a blade's moment\n\
         Q: amplitude {:.3e} (m/s)²/s, phase {:.3e} rad²/s, mean wind {:.3e} (m/s)²/s; scaled by {:.3}\n\
         phase error {:.1}° on the second half of the record, on which the scale was chosen; {:.1}° there with the noise as given\n\
         phase error {:.1}° on the first half, to which the noise was fitted\n\
         for kind = \"phase-sync\" with estimator = \"{}\":\n{}\n",
        noise.amplitude,
        noise.phase,
        noise.mean_wind,
        tuned.scale,
        tuned.error.to_degrees(),
        tuned.untuned_error.to_degrees(),
        tuned.fitted_error.to_degrees(),
        estimator(tuned),
        case_keys(tuned),
    )
}

fn json(tuned: &Tuned) -> serde_json::Value {
    let noise = &tuned.options.noise;
    let (density, unit) = measurement(tuned);
    json!({
        "measurement_noise_1s": density,
        "measurement_unit": unit,
        "process_noise_amplitude_m2_s3": noise.amplitude,
        "process_noise_phase_rad2_s": noise.phase,
        "process_noise_mean_wind_m2_s3": noise.mean_wind,
        "scale": tuned.scale,
        "phase_error_deg": tuned.error.to_degrees(),
        "untuned_phase_error_deg": tuned.untuned_error.to_degrees(),
        "fitted_phase_error_deg": tuned.fitted_error.to_degrees(),
        "case_keys": case_keys(tuned),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use control::phase_sync::{PhaseNoise, PhaseSyncSettings};
    use estimation::helix::HelixOptions;

    /// The noise of T2 in a case whose control holds `estimator` and the last line of what is printed for
    /// `options`.
    fn pasted(options: HelixOptions, estimator: &str) -> PhaseNoise {
        let text = super::text(&Tuned {
            options,
            scale: 1.0,
            error: 0.2,
            fitted_error: 0.1,
            untuned_error: 0.3,
        });
        let (head, keys) = text.trim_end().rsplit_once('\n').expect("lines");
        assert!(head.ends_with(&format!("estimator = \"{estimator}\":")), "{text}");
        let case = format!(
            r#"
name = "tuned"
[wind]
speed = 9.0
turbulence_intensity = 0.05
[time]
spin_up = 300.0
duration = 900.0
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "joined"
control.T2 = {{ kind = "phase-sync", offset_deg = 90, amplitude_deg = 4, sense = "ccw", strouhal = 0.25, estimator = "{estimator}", {keys} }}
"#
        );
        let case = formats::case::parse("pasted", &case, &[]);
        let case = case.unwrap_or_else(|error| panic!("{keys}: {}", error.to_lines()));
        PhaseSyncSettings::of(&case.runs[0].control[0]).expect("phase-sync").noise
    }

    #[test]
    fn what_tuning_prints_can_be_pasted_into_a_case() {
        let with_noise = |mut options: HelixOptions| {
            options.noise.measurement = Measurement::Moment(314_159.0);
            options.noise.mean_wind = 3.5e-3;
            options.noise.amplitude = 7.654_32e-6;
            options.noise.phase = 2.5e-4;
            options
        };
        let robust = pasted(with_noise(HelixOptions::default()), "robust");
        let measurement = robust.measurement.expect("a number");
        assert!((measurement - 314_200.0).abs() < 1e-3, "{measurement}");
        assert_eq!(robust.process_noise_mean_wind, Some(3.5e-3));
        assert_eq!(
            (robust.process_noise_amplitude, robust.process_noise_phase),
            (Some(7.654e-6), None)
        );
        let published = pasted(with_noise(HelixOptions::published()), "published");
        assert_eq!(published.process_noise_phase, Some(2.5e-4));
        let with_offset = with_noise(HelixOptions::published().with_azimuth_offset(0.3));
        assert_eq!(pasted(with_offset, "published-with-offset").process_noise_phase, Some(2.5e-4));
    }
}
