//! Recorded validations: each compares the program with a closed form, a published figure or another program.
//!
//! `wakemix validate NAME` repeats one and prints measured against expected; `docs/validation/` keeps the record.

pub mod actuator_line;
pub mod aeroelastic;
mod axisymmetric;
pub mod blade_element;
pub mod flow;
pub mod helix;
pub mod inflow;
mod least_squares;
pub mod meandering;
pub mod memory;
pub mod phase_estimator;
pub mod resume;
pub mod row;
pub mod structure;
mod studies;

pub use report::ReportError;
pub use row::Row;
use std::path::Path;

/// A validation that can be repeated by name.
pub struct Validation {
    /// Name on the command line.
    pub name: &'static str,
    /// What is compared with what.
    pub about: &'static str,
    /// Roughly how long it takes on two cores (minutes).
    pub minutes: &'static str,
    /// Makes the comparison.
    pub run: fn() -> Vec<Row>,
    /// Draws it into a folder and gives the figures' names; none where there is nothing but rows.
    pub pictures: Option<Pictures>,
}

/// Draws a validation into a folder; gives the figures' names.
pub type Pictures = fn(&Path) -> Result<Vec<String>, ReportError>;

/// All of them.
pub const VALIDATIONS: &[Validation] = &[
    Validation {
        name: "blade-element",
        about: "power, thrust and blade loads by blade-element momentum, beside published tables and AeroDyn",
        minutes: "under 1",
        run: blade_element::blade_element,
        pictures: None,
    },
    Validation {
        name: "actuator-line",
        about: "power and thrust of three rotors on 16, 24 and 32 cells per diameter against blade-element momentum, and against blade elements in axisymmetric flow",
        minutes: "28",
        run: actuator_line::actuator_line,
        pictures: None,
    },
    Validation {
        name: "actuator-line-coarse",
        about: "the same on 16 cells per diameter alone",
        minutes: "3",
        run: actuator_line::actuator_line_coarse,
        pictures: None,
    },
    Validation {
        name: "actuator-line-fine",
        about: "the same on 32 cells per diameter alone",
        minutes: "18",
        run: actuator_line::actuator_line_fine,
        pictures: None,
    },
    Validation {
        name: "actuator-line-flat",
        about: "the same on 16 and 24 cells per diameter of rotors without tilt, precone and prebend",
        minutes: "6",
        run: actuator_line::actuator_line_flat,
        pictures: None,
    },
    Validation {
        name: "flow",
        about: "the lattice against closed forms: Taylor-Green, free stream, mass, outlet, a disc in momentum theory",
        minutes: "1",
        run: flow::flow,
        pictures: None,
    },
    Validation {
        name: "log-profile",
        about: "turbulent wind over a rough ground against the logarithmic law",
        minutes: "2",
        run: flow::log_profile,
        pictures: None,
    },
    Validation {
        name: "isotropy",
        about: "19 directions against 27 in round, deflected and helical wakes",
        minutes: "3",
        run: flow::isotropy,
        pictures: None,
    },
    Validation {
        name: "helix",
        about: "power of two turbines against amplitude and sense of the helix, beside published large-eddy figures",
        minutes: "38",
        run: helix::helix,
        pictures: None,
    },
    Validation {
        name: "helix-pitch",
        about: "what a helix commands: no bit changed without amplitude, one line at 1P ± f_e with it",
        minutes: "1",
        run: helix::helix_pitch,
        pictures: None,
    },
    Validation {
        name: "centre-line",
        about: "recovery of the wake without and with a helix, beside published large-eddy figures",
        minutes: "5",
        run: helix::centre_line,
        pictures: None,
    },
    Validation {
        name: "structure",
        about: "natural frequencies beside published ones, energy of free motion, loads of a spinning rotor in closed form",
        minutes: "under 1",
        run: structure::structure,
        pictures: None,
    },
    Validation {
        name: "openfast-steady",
        about: "the flexible turbine in steady prescribed wind against OpenFAST: power, thrust, mean loads, deflection, tower",
        minutes: "under 1",
        run: aeroelastic::openfast_steady,
        pictures: None,
    },
    Validation {
        name: "openfast-helix",
        about: "changes of power and loads by a helix of 1 to 4° in steady prescribed wind against OpenFAST",
        minutes: "under 1",
        run: aeroelastic::openfast_helix,
        pictures: None,
    },
    Validation {
        name: "openfast-turbulence",
        about: "the flexible turbine in Kaimal turbulence: deviations and equivalent loads beside a record of OpenFAST",
        minutes: "under 1",
        run: aeroelastic::openfast_turbulence,
        pictures: None,
    },
    Validation {
        name: "meandering-loops",
        about: "phase-locked loops on tones, ramps and steps, against closed forms and the published claims",
        minutes: "under 1",
        run: meandering::loops,
        pictures: None,
    },
    Validation {
        name: "meandering-bench",
        about: "loops closed around three masses on springs: steps, ramp, offset, noise, attenuation, beside the source",
        minutes: "under 1",
        run: meandering::bench,
        pictures: Some(meandering::pictures),
    },
    Validation {
        name: "meandering-disk",
        about: "the flexible turbine in a rotating disk, in its middle and aside, loads amplified and attenuated, beside published tables",
        minutes: "4",
        run: meandering::disk,
        pictures: None,
    },
    Validation {
        name: "meandering-wake",
        about: "the flexible turbine in the recorded wake of a helix, loads amplified and attenuated, beside a published table",
        minutes: "12",
        run: meandering::wake,
        pictures: None,
    },
    Validation {
        name: "phase-estimator",
        about: "the helix's phase from blade moments: on the estimator's own model, and on an aeroelastic turbine in turbulence",
        minutes: "3",
        run: phase_estimator::phase_estimator,
        pictures: None,
    },
    Validation {
        name: "estimators",
        about: "the Kalman filter and the phase-locked loops on the same blade moments: error, settling, noise, cost",
        minutes: "1",
        run: phase_estimator::estimators,
        pictures: None,
    },
    Validation {
        name: "resume",
        about: "20 kills at random moments, each followed by --resume: same bits",
        minutes: "5",
        run: resume::resume,
        pictures: None,
    },
    Validation {
        name: "memory",
        about: "memory of one flexible turbine in turbulence, ten minutes, an hour and three, each in a process of its own",
        minutes: "under 1",
        run: memory::memory,
        pictures: None,
    },
    Validation {
        name: "kaimal",
        about: "IEC turbulence: spectra, deviations, coherence against the standard's, and beside a record of TurbSim",
        minutes: "under 1",
        run: inflow::kaimal::kaimal,
        pictures: None,
    },
    Validation {
        name: "inflow",
        about: "Mann's turbulence: spectra, coherence, intensity and length scale against the tensor's integrals",
        minutes: "1",
        run: inflow::inflow,
        pictures: None,
    },
];
