//! Comparisons that are recorded but made by other means.

use crate::Elsewhere;

/// Comparisons that `cargo test`, a script or a study repeats; their records are kept by hand.
pub const ELSEWHERE: &[Elsewhere] = &[
    Elsewhere {
        name: "fatigue",
        about: "cycles and 1-Hz damage-equivalent loads against rainflow, fatpack and OpenFAST runs",
        repeat: "validation/scripts/rainflow_against_fatpack.py",
        page: "fatigue",
        recorded: include_str!("../../recorded/fatigue.toml"),
    },
    Elsewhere {
        name: "surrogate",
        about: "Gaussian processes against scikit-learn",
        repeat: "cargo test -p wakemix-surrogate scikit_learn",
        page: "surrogate",
        recorded: include_str!("../../recorded/surrogate.toml"),
    },
    Elsewhere {
        name: "synchronised-helix",
        about: "a helix that the second turbine joins with a phase offset, three turbines, beside published large-eddy figures",
        repeat: "wakemix run cases/synchronised-helix.toml --run bl-helix --run offset-090 --run offset-270 --set run.offset-090.control.T2.azimuth_offset_deg=0 --set run.offset-270.control.T2.azimuth_offset_deg=0 --set wind.seed=1",
        page: "synchronised-helix",
        recorded: include_str!("../../recorded/synchronised-helix.toml"),
    },
];
