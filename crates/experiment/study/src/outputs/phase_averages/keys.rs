//! Keys of `kind = "phase-averages"`, and what they ask for in a run.

use super::super::output::OwnKeys;
use crate::prepared::Prepared;
use analysis::phases::{Bins, PhaseError};
use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Objection, Range, Table, Values, above, from, key};
use control::excitation_rate;
use farm::case::Run;
use std::f64::consts::TAU;

const EVERYWHERE: Range = Range { low: -500.0, open: false, high: 500.0 };
/// Instants that fall into a bin of rotor azimuth each time that the rotor passes it, unless the case says
/// otherwise (–).
const INSTANTS_OF_A_PASS: f64 = 3.0;

pub(super) static OWN: OwnKeys = OwnKeys {
    table: Table {
        heading: "output.further.NAME = { kind = \"phase-averages\", … }",
        about: "Velocity averaged by rotor azimuth and, with a helix, by helix azimuth while the run goes on, with counts and stresses in each bin: `RUN/averages-NAME-PLACE.nc`. Of planes and of a volume, as many as memory carries; `--dry-run` tells it.",
        keys: &[
            key(
                "crosswind_diameters",
                Holds::Numbers(EVERYWHERE),
                "D",
                Value("[]"),
                "Planes across the wind, at these distances behind the first turbine.",
            ),
            key(
                "beside_diameters",
                Holds::Numbers(EVERYWHERE),
                "D",
                Value("[]"),
                "Upright planes along the wind, at these distances to the left of the first turbine; 0 goes through its tower.",
            ),
            key(
                "height_diameters",
                Holds::Numbers(EVERYWHERE),
                "D",
                Value("[]"),
                "Level planes, at these heights above the hub of the first turbine; 0 is at hub height.",
            ),
            key(
                "volume_stride",
                Holds::Whole { least: 1, most: 16 },
                "–",
                Otherwise("no volume"),
                "A volume of every so many cells along each axis.",
            ),
            key(
                "x_diameters",
                Holds::Pair(EVERYWHERE),
                "D",
                Otherwise("the whole domain"),
                "What of planes and volume is kept along the wind, from the first turbine.",
            ),
            key(
                "y_diameters",
                Holds::Pair(EVERYWHERE),
                "D",
                Otherwise("the whole domain"),
                "The same to the left.",
            ),
            key(
                "z_diameters",
                Holds::Pair(EVERYWHERE),
                "D",
                Otherwise("the whole domain"),
                "The same upwards, from the hub of the first turbine.",
            ),
            key(
                "turbine",
                Holds::Name,
                "",
                Otherwise("the first one with a helix, or else the first one"),
                "Turbine whose rotor and helix azimuth count.",
            ),
            key(
                "azimuth_bins",
                Holds::Whole { least: 1, most: 360 },
                "–",
                Value("12"),
                "Bins of rotor azimuth a revolution; 12 are of 30°.",
            ),
            key(
                "helix_cycles",
                Holds::Whole { least: 0, most: 60 },
                "–",
                Value("3"),
                "Cycles of the helix over which bins go: their number is rotor over excitation frequency times this, rounded, times `azimuth_bins`. 0 leaves the helix aside.",
            ),
            key(
                "helix_width_deg",
                above(0.0, 360.0),
                "deg",
                Value("40"),
                "Width of the window of helix azimuth about each bin; wider ones overlap, and fill sooner.",
            ),
            key(
                "interval",
                from(0.0, 1e3),
                "s",
                Otherwise("three instants in a bin each time that the rotor passes it"),
                "Time between instants, rounded to whole steps, one at least.",
            ),
        ],
    },
    check,
};

fn check(values: &Values) -> Vec<Objection> {
    let planes = ["crosswind_diameters", "beside_diameters", "height_diameters"];
    let mut found = Vec::new();
    if planes.iter().all(|key| values.numbers(key).is_empty()) && !values.has("volume_stride") {
        found.push(Objection {
            key: None,
            message: "asks for no plane and no volume".to_owned(),
            label: "of nothing",
            fix: "add planes, such as height_diameters = [0.0], or volume_stride".to_owned(),
        });
    }
    for key in ["x_diameters", "y_diameters", "z_diameters"] {
        if let [low, high] = *values.numbers(key)
            && low >= high
        {
            found.push(Objection {
                key: Some(key),
                message: format!("= [{low}, {high}] holds nothing"),
                label: "empty",
                fix: "give the lower end first".to_owned(),
            });
        }
    }
    found
}

/// What is asked for in one run.
pub(super) struct Wanted {
    /// Machine of the run whose azimuths count.
    pub(super) machine: usize,
    pub(super) bins: Result<Bins, PhaseError>,
    /// Time between instants (s).
    pub(super) interval: f64,
}

impl Wanted {
    /// What `values` ask for in `run` of `setup`; none where the turbine that they name is not there.
    pub(super) fn of(setup: &Prepared, run: &Run, values: &Values) -> Option<Self> {
        let name = values.word("turbine");
        let is_named = |index: &usize| setup.case.turbines[*index].name == name;
        let has_helix = |index: &usize| run.control[*index].helix().is_some();
        let index = match name {
            "" => run.present().find(has_helix).or_else(|| run.present().next())?,
            _ => run.present().find(is_named)?,
        };
        let (whole, case) = (|key: &str| values.number(key) as usize, &setup.case);
        let (n_azimuths, n_cycles) = (whole("azimuth_bins"), whole("helix_cycles"));
        let speed = setup.models[index].rotor_speed(case.wind.speed);
        let bins = match run.control[index].helix().filter(|_| n_cycles > 0) {
            None => Bins::of_rotor(n_azimuths),
            Some((sense, strouhal)) => {
                let rate = excitation_rate(strouhal, case.wind.speed, setup.plan.diameter);
                let width = values.angle("helix_width_deg");
                Bins::of_helix(n_azimuths, speed / rate, n_cycles, sense, width)
            }
        };
        let of_a_pass = TAU / (n_azimuths as f64 * speed * INSTANTS_OF_A_PASS);
        Some(Self {
            machine: run.present().position(|other| other == index)?,
            bins,
            interval: values.optional_number("interval").unwrap_or(of_a_pass),
        })
    }
}
