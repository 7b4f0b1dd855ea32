//! All validations, in the order in which they are listed; and comparisons that are recorded but made by
//! other means.

use crate::{Cost, Elsewhere, Validation};
use crate::{
    actuator_line, aeroelastic, atmosphere, blade_element, flow, free_vortex, helix, inflow,
    meandering, memory, phase_estimator, refined_rotor, resume, structure,
};

/// All that the program repeats.
pub const VALIDATIONS: &[Validation] = &[
    Validation {
        name: "blade-element",
        about: "power, thrust and blade loads by blade-element momentum, beside published tables and AeroDyn",
        cost: Cost::UnderAMinute,
        run: blade_element::blade_element,
        pictures: None,
        page: "blade-element",
        recorded: include_str!("../recorded/blade-element.toml"),
    },
    Validation {
        name: "actuator-line",
        about: "power and thrust of three rotors on 16, 24 and 32 cells per diameter against blade-element momentum, and against blade elements in axisymmetric flow",
        cost: Cost::Minutes(28),
        run: actuator_line::actuator_line,
        pictures: None,
        page: "actuator-line",
        recorded: include_str!("../recorded/actuator-line.toml"),
    },
    Validation {
        name: "actuator-line-coarse",
        about: "the same on 16 cells per diameter alone",
        cost: Cost::Minutes(3),
        run: actuator_line::actuator_line_coarse,
        pictures: None,
        page: "actuator-line",
        recorded: include_str!("../recorded/actuator-line-coarse.toml"),
    },
    Validation {
        name: "actuator-line-fine",
        about: "the same on 32 cells per diameter alone",
        cost: Cost::Minutes(18),
        run: actuator_line::actuator_line_fine,
        pictures: None,
        page: "actuator-line",
        recorded: include_str!("../recorded/actuator-line-fine.toml"),
    },
    Validation {
        name: "actuator-line-flat",
        about: "the same on 16 and 24 cells per diameter of rotors without tilt, precone and prebend",
        cost: Cost::Minutes(6),
        run: actuator_line::actuator_line_flat,
        pictures: None,
        page: "actuator-line",
        recorded: include_str!("../recorded/actuator-line-flat.toml"),
    },
    Validation {
        name: "free-vortex",
        about: "free vortices against closed forms: rings, helices, an elliptic wing; boxes of them against their sum",
        cost: Cost::UnderAMinute,
        run: free_vortex::free_vortex,
        pictures: None,
        page: "free-vortex",
        recorded: include_str!("../recorded/free-vortex.toml"),
    },
    Validation {
        name: "free-vortex-rotor",
        about: "power and thrust of three rotors with free wakes against blade elements in axisymmetric flow, and blade-element momentum",
        cost: Cost::Minutes(5),
        run: free_vortex::free_vortex_rotor,
        pictures: None,
        page: "free-vortex",
        recorded: include_str!("../recorded/free-vortex-rotor.toml"),
    },
    Validation {
        name: "flow",
        about: "the lattice against closed forms: Taylor-Green, free stream, mass, outlet, a disc in momentum theory",
        cost: Cost::Minutes(1),
        run: flow::flow,
        pictures: None,
        page: "flow",
        recorded: include_str!("../recorded/flow.toml"),
    },
    Validation {
        name: "log-profile",
        about: "turbulent wind over a rough ground against the logarithmic law",
        cost: Cost::UnderAMinute,
        run: flow::log_profile,
        pictures: None,
        page: "flow",
        recorded: include_str!("../recorded/log-profile.toml"),
    },
    Validation {
        name: "isotropy",
        about: "19 directions against 27 in round, deflected and helical wakes",
        cost: Cost::Minutes(3),
        run: flow::isotropy,
        pictures: None,
        page: "flow",
        recorded: include_str!("../recorded/isotropy.toml"),
    },
    Validation {
        name: "refinement",
        about: "boxes of finer cells in the lattice: mass, momentum, a decaying vortex, one carried through, sound, beside uniform grids",
        cost: Cost::UnderAMinute,
        run: flow::refinement,
        pictures: None,
        page: "flow",
        recorded: include_str!("../recorded/refinement.toml"),
    },
    Validation {
        name: "refined-rotor",
        about: "power, thrust and wake of a turbine in a box of finer cells beside fine cells everywhere; time and memory",
        cost: Cost::Minutes(2),
        run: refined_rotor::refined_rotor,
        pictures: None,
        page: "flow",
        recorded: include_str!("../recorded/refined-rotor.toml"),
    },
    Validation {
        name: "atmosphere",
        about: "air with temperature on a turning earth against closed forms: conduction, inertial and internal waves, Ekman's layer, onset of convection",
        cost: Cost::UnderAMinute,
        run: atmosphere::atmosphere,
        pictures: None,
        page: "atmosphere",
        recorded: include_str!("../recorded/atmosphere.toml"),
    },
    Validation {
        name: "stable-boundary-layer",
        about: "the stable boundary layer of GABLS1 on cells of 6.25 m beside the published spread of simulations",
        cost: Cost::Minutes(25),
        run: atmosphere::stable_boundary_layer,
        pictures: None,
        page: "atmosphere",
        recorded: include_str!("../recorded/stable-boundary-layer.toml"),
    },
    Validation {
        name: "helix",
        about: "power of two turbines against amplitude and sense of the helix, beside published large-eddy figures",
        cost: Cost::Minutes(38),
        run: helix::helix,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/helix.toml"),
    },
    Validation {
        name: "helix-pitch",
        about: "what a helix commands: no bit changed without amplitude, one line at 1P ± f_e with it",
        cost: Cost::Minutes(1),
        run: helix::helix_pitch,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/helix-pitch.toml"),
    },
    Validation {
        name: "centre-line",
        about: "recovery of the wake without and with a helix, beside published large-eddy figures",
        cost: Cost::Minutes(5),
        run: helix::centre_line,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/centre-line.toml"),
    },
    Validation {
        name: "wake-profile",
        about: "the wind across a wake without and with a helix, in three winds, beside a published large-eddy simulation",
        cost: Cost::Minutes(14),
        run: helix::wake_profile,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/wake-profile.toml"),
    },
    Validation {
        name: "wake-trials",
        about: "what moves a wake: turbulence, veer, ground, inlet, box, subgrid constant, velocity set, one at a time",
        cost: Cost::Minutes(45),
        run: helix::wake_trials,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/wake-trials.toml"),
    },
    Validation {
        name: "wake-grid",
        about: "the wake on 16, 24 and 32 cells per diameter",
        cost: Cost::Minutes(10),
        run: helix::wake_grid,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/wake-grid.toml"),
    },
    Validation {
        name: "helix-in-atmosphere",
        about: "a precursor's wind, a wake and the gains of two turbines in it, beside Mann's wind and published large-eddy figures",
        cost: Cost::Minutes(40),
        run: helix::helix_in_atmosphere,
        pictures: None,
        page: "helix",
        recorded: include_str!("../recorded/helix-in-atmosphere.toml"),
    },
    Validation {
        name: "structure",
        about: "natural frequencies beside published ones, energy of free motion, loads of a spinning rotor in closed form",
        cost: Cost::UnderAMinute,
        run: structure::structure,
        pictures: None,
        page: "structure",
        recorded: include_str!("../recorded/structure.toml"),
    },
    Validation {
        name: "openfast-steady",
        about: "the flexible turbine in steady prescribed wind against OpenFAST: power, thrust, mean loads, deflection, tower",
        cost: Cost::UnderAMinute,
        run: aeroelastic::openfast_steady,
        pictures: None,
        page: "openfast",
        recorded: include_str!("../recorded/openfast-steady.toml"),
    },
    Validation {
        name: "openfast-helix",
        about: "changes of power and loads by a helix of 1 to 4° in steady prescribed wind against OpenFAST",
        cost: Cost::UnderAMinute,
        run: aeroelastic::openfast_helix,
        pictures: None,
        page: "openfast",
        recorded: include_str!("../recorded/openfast-helix.toml"),
    },
    Validation {
        name: "openfast-turbulence",
        about: "the flexible turbine in Kaimal turbulence: deviations and equivalent loads beside a record of OpenFAST",
        cost: Cost::UnderAMinute,
        run: aeroelastic::openfast_turbulence,
        pictures: None,
        page: "openfast",
        recorded: include_str!("../recorded/openfast-turbulence.toml"),
    },
    Validation {
        name: "meandering-loops",
        about: "phase-locked loops on tones, ramps and steps, against closed forms and the published claims",
        cost: Cost::UnderAMinute,
        run: meandering::loops,
        pictures: None,
        page: "meandering",
        recorded: include_str!("../recorded/meandering-loops.toml"),
    },
    Validation {
        name: "meandering-bench",
        about: "loops closed around three masses on springs: steps, ramp, offset, noise, attenuation, beside the source",
        cost: Cost::UnderAMinute,
        run: meandering::bench,
        pictures: Some(meandering::pictures),
        page: "meandering",
        recorded: include_str!("../recorded/meandering-bench.toml"),
    },
    Validation {
        name: "meandering-disk",
        about: "the flexible turbine in a rotating disk, in its middle and aside, loads amplified and attenuated, led by both moments and by tilt alone, beside published tables",
        cost: Cost::Minutes(6),
        run: meandering::disk,
        pictures: None,
        page: "meandering",
        recorded: include_str!("../recorded/meandering-disk.toml"),
    },
    Validation {
        name: "meandering-wake",
        about: "the flexible turbine in the recorded wake of a helix, of one frequency and of one that rises, loads amplified and attenuated, led by both moments and by tilt alone, beside a published table",
        cost: Cost::Minutes(20),
        run: meandering::wake,
        pictures: None,
        page: "meandering",
        recorded: include_str!("../recorded/meandering-wake.toml"),
    },
    Validation {
        name: "phase-estimator",
        about: "the helix's phase from blade moments: on the estimator's own model, and on an aeroelastic turbine in turbulence",
        cost: Cost::Minutes(3),
        run: phase_estimator::phase_estimator,
        pictures: None,
        page: "phase-estimator",
        recorded: include_str!("../recorded/phase-estimator.toml"),
    },
    Validation {
        name: "estimators",
        about: "the Kalman filter and the phase-locked loops on the same blade moments: error, settling, noise, cost",
        cost: Cost::Minutes(1),
        run: phase_estimator::estimators,
        pictures: None,
        page: "estimators",
        recorded: include_str!("../recorded/estimators.toml"),
    },
    Validation {
        name: "resume",
        about: "20 kills at random moments, each followed by --resume: same bits",
        cost: Cost::Minutes(5),
        run: resume::resume,
        pictures: None,
        page: "resume",
        recorded: include_str!("../recorded/resume.toml"),
    },
    Validation {
        name: "memory",
        about: "memory of one flexible turbine in turbulence, ten minutes, an hour and three, each in a process of its own",
        cost: Cost::Minutes(1),
        run: memory::memory,
        pictures: None,
        page: "memory",
        recorded: include_str!("../recorded/memory.toml"),
    },
    Validation {
        name: "kaimal",
        about: "IEC turbulence: spectra, deviations, coherence against the standard's, and beside a record of TurbSim",
        cost: Cost::UnderAMinute,
        run: inflow::kaimal::kaimal,
        pictures: None,
        page: "inflow",
        recorded: include_str!("../recorded/kaimal.toml"),
    },
    Validation {
        name: "inflow",
        about: "Mann's turbulence: spectra, coherence, intensity and length scale against the tensor's integrals",
        cost: Cost::UnderAMinute,
        run: inflow::inflow,
        pictures: None,
        page: "inflow",
        recorded: include_str!("../recorded/inflow.toml"),
    },
];

/// Comparisons that `cargo test`, a script or a study repeats; their records are kept by hand.
pub const ELSEWHERE: &[Elsewhere] = &[
    Elsewhere {
        name: "fatigue",
        about: "cycles and 1-Hz damage-equivalent loads against rainflow, fatpack and OpenFAST runs",
        repeat: "validation/scripts/rainflow_against_fatpack.py",
        page: "fatigue",
        recorded: include_str!("../recorded/fatigue.toml"),
    },
    Elsewhere {
        name: "surrogate",
        about: "Gaussian processes against scikit-learn",
        repeat: "cargo test -p wakemix-surrogate scikit_learn",
        page: "surrogate",
        recorded: include_str!("../recorded/surrogate.toml"),
    },
    Elsewhere {
        name: "synchronised-helix",
        about: "a helix that the second turbine joins with a phase offset, three turbines, beside published large-eddy figures",
        repeat: "wakemix run cases/synchronised-helix.toml --run bl-helix --run offset-090 --run offset-270 --set run.offset-090.control.T2.azimuth_offset_deg=0 --set run.offset-270.control.T2.azimuth_offset_deg=0 --set wind.seed=1",
        page: "synchronised-helix",
        recorded: include_str!("../recorded/synchronised-helix.toml"),
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Tolerance;
    use crate::record::{Record, Verdict};
    use std::collections::BTreeSet;

    fn records() -> impl Iterator<Item = (&'static str, Record)> {
        let own = VALIDATIONS.iter().map(|validation| (validation.name, validation.recorded));
        let others = ELSEWHERE.iter().map(|elsewhere| (elsewhere.name, elsewhere.recorded));
        own.chain(others).map(|(name, text)| {
            (name, Record::parse(text).unwrap_or_else(|error| panic!("{name}: {error}")))
        })
    }

    #[test]
    fn every_record_reads_and_names_its_rows_once() {
        for (name, record) in records() {
            let ids: BTreeSet<&str> = record.rows.iter().map(|row| row.id.as_str()).collect();
            assert!(!record.rows.is_empty() && ids.len() == record.rows.len(), "{name}");
            for row in &record.rows {
                // A figure that was not kept can only have been met.
                let met = row.measured.is_none_or(|m| row.tolerance.beyond(m, row.expected) == 0.0);
                let said = row.verdict == Verdict::Met;
                assert_eq!(met, said, "{name}, {}: figures and verdict differ", row.claim);
            }
        }
    }

    #[test]
    fn every_record_holds_finite_figures_and_says_where_they_are_rounded() {
        for (name, record) in records() {
            for row in &record.rows {
                let figures = [row.measured.unwrap_or(0.0), row.expected];
                assert!(figures.iter().all(|figure| figure.is_finite()), "{name}, {}", row.claim);
            }
            let copied = record.conditions.contains("figures from docs/validation");
            assert_eq!(record.rounded, copied, "{name}");
        }
    }

    #[test]
    fn no_effect_at_all_meets_no_claim_of_an_effect() {
        for (name, record) in records() {
            for row in &record.rows {
                let Tolerance::Within(most) = row.tolerance else { continue };
                // What is published as next to nothing is to be next to nothing here too: changes of a few
                // per cent within five points or one, and a hundredth of coherence.
                let small = match name {
                    "meandering-disk" | "meandering-wake" => row.unit == "%" && most <= 5.0,
                    "kaimal" => row.claim.contains("coherence") && row.expected.abs() < 0.01,
                    _ => false,
                };
                let decides = row.expected == 0.0 || most < row.expected.abs() || small;
                assert!(decides, "{name}, {}: {} ± {most}", row.claim, row.expected);
            }
        }
    }
}
