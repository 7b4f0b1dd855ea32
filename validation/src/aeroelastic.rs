//! The flexible turbine in prescribed wind against OpenFAST 5.0.0 with ROSCO 2.10.1 on the same definitions.
//!
//! Reference: own runs of OpenFAST (commit 2895884): BEM_Mod 1, Pitt/Peters skew, DBEMT_Mod 3 with the time
//! constants below, UA_Mod 3, tower influence off except where stated, clamped tower, steps of 0.02 s (IEA 15
//! MW) and 0.0125 s (NREL 5 MW).

mod rig;
mod tower;
mod turbulence;

use crate::Row;
use crate::row::Tolerance::Within;
use rig::{CHANNELS, Conditions, Run, Speed, run};
use turbine::structure::{GRAVITY, Projection};
pub use turbulence::openfast_turbulence;

/// Where the expected values come from.
const OPENFAST: &str = "OpenFAST 5.0.0 with ROSCO 2.10.1";
const PUBLISHED_SOURCE: &str = "NREL/TP-500-38060 (2009), figs. 9-1 and 9-2";

/// Accepted distance of means from the reference (–).
const TOLERANCE: f64 = 0.02;
/// Accepted distance of a change by the helix, or by the tower, from the reference's, over that change (–):
/// no change at all is never accepted.
const CHANGE_SHARE: f64 = 0.15;

/// A steady state of the reference: under a controller that tracks the tip-speed ratio, from a table of its
/// own.
struct Steady {
    model: &'static str,
    /// Wind (m/s).
    wind: f64,
    /// Slow time constant of dynamic inflow (s).
    slow_constant: f64,
    /// Rotor speed (rpm).
    rotor_speed: f64,
    /// Generator power (MW).
    generator_power: f64,
    /// Power (MW) and thrust (MN) of the air, means of RootMyc1, TwrBsMyt, YawBrMyp, YawBrMzp and LSSTipMys
    /// (MN m), OoPDefl1 (m).
    means: [f64; 8],
}

const STEADY: [Steady; 5] = [
    Steady {
        model: "iea-15mw",
        wind: 7.0,
        slow_constant: 29.03,
        rotor_speed: 5.02859,
        generator_power: 4.485_06,
        means: [4.684_78, 1.105_31, 31.1727, 78.6998, -64.1342, -0.312_679, -3.992_62, 7.61],
    },
    Steady {
        model: "iea-15mw",
        wind: 8.0,
        slow_constant: 29.03,
        rotor_speed: 5.74254,
        generator_power: 6.684_39,
        means: [6.982_32, 1.448_21, 39.9668, 125.897, -62.5722, -0.565_018, -4.017_31, 9.817_03],
    },
    Steady {
        model: "iea-15mw",
        wind: 9.0,
        slow_constant: 29.03,
        rotor_speed: 6.44866,
        generator_power: 9.467_19,
        means: [9.889_42, 1.824_03, 49.4302, 177.584, -60.8927, -0.940_679, -4.083_61, 12.1842],
    },
    Steady {
        model: "iea-15mw",
        wind: 10.0,
        slow_constant: 29.03,
        rotor_speed: 7.1418,
        generator_power: 12.8625,
        means: [13.4364, 2.231_03, 59.4771, 233.542, -59.0895, -1.428_97, -4.178_63, 14.6958],
    },
    Steady {
        model: "nrel-5mw",
        wind: 9.0,
        slow_constant: 12.6,
        rotor_speed: 10.0934,
        generator_power: 2.352_77,
        means: [
            2.493_21, 0.451_639, 6.715_48, 39.9603, -0.503_159, -0.211_082, -0.533_646, 3.805_65,
        ],
    },
];

/// Figures of the helix: mean power (MW) and thrust (MN) of the air, the 1-Hz damage-equivalent load (m = 10)
/// of RootMxc1, standard deviations and equivalent loads (m = 10) of RootMyc1, (m = 4) of TwrBsMyt, YawBrMyp,
/// YawBrMzp and LSSTipMys (MN m).
const HELIX_FIGURES: [&str; 10] = [
    "mean power of the air",
    "mean thrust",
    "equivalent load of RootMxc1 (m = 10)",
    "standard deviation of RootMyc1",
    "equivalent load of RootMyc1 (m = 10)",
    "standard deviation of TwrBsMyt",
    "equivalent load of TwrBsMyt (m = 4)",
    "equivalent load of YawBrMyp (m = 4)",
    "equivalent load of YawBrMzp (m = 4)",
    "equivalent load of LSSTipMys (m = 4)",
];
/// Those that are large without a helix, and whose changes are given as shares; gravity loads RootMxc1.
const SHARES: usize = 3;
/// IEA 15 MW at 9 m/s under a ccw helix of 0 to 4° ([`HELIX_FIGURES`]).
const HELIX: [(f64, [f64; 10]); 5] = [
    (0.0, [9.889_42, 1.824_03, 29.6649, 0.922_378, 2.104, 0.192, 0.441, 0.059, 0.180, 0.052]),
    (
        1.0,
        [
            9.828_55, 1.815_65, 29.7441, 2.942_36, 7.5122, 3.476_99, 3.349_93, 3.729_62, 3.747_85,
            3.883_85,
        ],
    ),
    (
        2.0,
        [
            9.677_76, 1.795_36, 29.8831, 5.605_78, 13.4275, 6.981_99, 6.641_81, 7.410_86, 7.252_96,
            7.714_95,
        ],
    ),
    (
        3.0,
        [
            9.490_56, 1.769_06, 30.0525, 8.233_51, 19.343, 10.4934, 10.1047, 10.9984, 10.7849,
            11.4308,
        ],
    ),
    (
        4.0,
        [
            9.286_41, 1.739_14, 30.3164, 10.8051, 25.1243, 13.9591, 13.7299, 14.5075, 14.2093,
            15.0715,
        ],
    ),
];

/// Those of [`CHANNELS`] whose means hang on how sections of a blade are seen that bends in both directions:
/// YawBrMzp and LSSTipMys.
const TURNED: [usize; 2] = [3, 4];

/// Steady wind: means at the reference's rotor speed, those of [`TURNED`] again with blades seen as the
/// reference does, then speed and power under the turbine's own control, last what the tower changes where
/// its wind is felt.
pub fn openfast_steady() -> Vec<Row> {
    let mut rows = Vec::new();
    for steady in STEADY {
        let Steady { model, wind, slow_constant, rotor_speed, generator_power, means } = steady;
        let mut add = |what: String, measured: f64, expected: f64, unit| {
            rows.push(Row {
                what: format!("{model}, {wind} m/s, {what}"),
                measured,
                expected,
                tolerance: Within(TOLERANCE * expected.abs()),
                unit,
                source: OPENFAST,
            });
        };
        let conditions = |speed| Conditions {
            model,
            wind,
            slow_constant,
            rotor_speed,
            speed,
            ..Conditions::in_nine_metres_a_second()
        };
        let held = run(&conditions(Speed::Held));
        let moments = (0..6).map(|channel| held.mean(channel));
        let measured = [held.power, held.thrust].into_iter().chain(moments);
        let names = ["power of the air", "thrust"].into_iter().chain(CHANNELS);
        let units = ["MW", "MN", "MN m", "MN m", "MN m", "MN m", "MN m", "m"];
        for (((name, unit), measured), expected) in names.zip(units).zip(measured).zip(means) {
            add(format!("{rotor_speed} rpm: mean {name}"), measured, expected, unit);
        }
        let annular =
            run(&Conditions { projection: Projection::Annular, ..conditions(Speed::Held) });
        for channel in TURNED {
            let what = format!("sections seen as there: mean {}", CHANNELS[channel]);
            add(what, annular.mean(channel), means[2 + channel], "MN m");
        }
        let tracked = run(&conditions(Speed::Tracked));
        add("own control: rotor speed".to_owned(), tracked.rotor_speed, rotor_speed, "rpm");
        let power = tracked.generator_power;
        add("own control: generator power".to_owned(), power, generator_power, "MW");
    }
    rows.extend(published_steady_states());
    rows.extend(tower::changes());
    rows
}

/// NREL 5 MW as its authors published it: wind (m/s), generator power (kW), and thrust (kN) with the rotor's
/// weight along the shaft.
///
/// Source: Jonkman, Butterfield, Musial, Scott, NREL/TP-500-38060 (2009), figs. 9-1 and 9-2, by FAST with
/// AeroDyn's blade-element momentum of then and the torque law k ω²; figures from NREL's archive of turbine
/// models, "NREL_5MW_126_RWT".
const PUBLISHED: [[f64; 3]; 4] =
    [[7.0, 1187.2, 398.6], [8.0, 1771.1, 478.0], [9.0, 2518.6, 579.2], [10.0, 3448.41, 691.496]];

/// Power and thrust of NREL 5 MW under its own torque law beside [`PUBLISHED`].
fn published_steady_states() -> Vec<Row> {
    let definition = formats::library::load("nrel-5mw")
        .expect("the library's own turbines are readable")
        .definition;
    let blade = &definition.blade_structure.sections;
    let blade_mass: f64 = blade
        .windows(2)
        .map(|ends| 0.5 * (ends[0].mass + ends[1].mass) * (ends[1].span - ends[0].span))
        .sum();
    let mass = definition.hub.mass + definition.n_blades as f64 * blade_mass;
    let weight = 1e-6 * mass * GRAVITY * definition.rotor.shaft_tilt.sin();
    let mut rows = Vec::new();
    for [wind, power, thrust] in PUBLISHED {
        let run = run(&Conditions {
            model: "nrel-5mw",
            wind,
            slow_constant: 12.6,
            rotor_speed: 10.0934 * wind / 9.0,
            speed: Speed::Square,
            ..Conditions::in_nine_metres_a_second()
        });
        let mut add = |what: &str, measured: f64, expected: f64, unit| {
            rows.push(Row {
                what: format!("nrel-5mw, {wind} m/s, as published: {what}"),
                measured,
                expected,
                tolerance: Within(TOLERANCE * expected),
                unit,
                source: PUBLISHED_SOURCE,
            });
        };
        add("generator power", run.generator_power, 1e-3 * power, "MW");
        add("thrust and weight along the shaft", run.thrust + weight, 1e-3 * thrust, "MN");
    }
    rows
}

/// The helix on IEA 15 MW in 9 m/s: changes against no helix.
pub fn openfast_helix() -> Vec<Row> {
    let runs = HELIX.map(|(amplitude, _)| {
        let window = if amplitude == 0.0 { [500.0, 600.0] } else { [280.0, 600.0] };
        let speed = Speed::Square;
        run(&Conditions { speed, amplitude, window, ..Conditions::in_nine_metres_a_second() })
    });
    let numbers = |run: &Run| {
        [
            run.power,
            run.thrust,
            run.equivalent(6, 10.0),
            run.deviation(0),
            run.equivalent(0, 10.0),
            run.deviation(1),
            run.equivalent(1, 4.0),
            run.equivalent(2, 4.0),
            run.equivalent(3, 4.0),
            run.equivalent(4, 4.0),
        ]
    };
    let mut rows = Vec::new();
    for (run, (amplitude, reference)) in runs.iter().zip(HELIX).skip(1) {
        let (measured, without) = (numbers(run), numbers(&runs[0]));
        for index in 0..HELIX_FIGURES.len() {
            // Most loads without a helix are next to nothing in a steady wind: their changes are given as
            // such.
            let (measured, expected, unit) = if index < SHARES {
                let change = |now: f64, before: f64| now / before - 1.0;
                let expected = change(reference[index], HELIX[0].1[index]);
                (change(measured[index], without[index]), expected, "–")
            } else {
                let expected = reference[index] - HELIX[0].1[index];
                (measured[index] - without[index], expected, "MN m")
            };
            rows.push(Row {
                what: format!("helix ccw {amplitude}°, change of {}", HELIX_FIGURES[index]),
                measured,
                expected,
                tolerance: Within(CHANGE_SHARE * expected.abs()),
                unit,
                source: OPENFAST,
            });
        }
    }
    rows
}
