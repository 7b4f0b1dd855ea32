//! Made-up summaries for tests and examples, so that each needs to write down only what it is about.

use super::{
    BearingLoad, Conditions, ControlSetting, ControlSummary, Cost, DeliveredPitch, Finding,
    FlowSummary, GridSummary, Load, LoadKind, MeanderingAxis, MeanderingSummary, PitchDuty,
    PitchExcitation, PitchResponse, Rotor, SCHEMA_VERSION, Sector, SettingValue, Statistic,
    Summary, TurbineSummary, Warning, WarningKind,
};
use crate::Sense;

/// A mean without interval.
pub fn statistic(mean: f64) -> Statistic {
    Statistic { mean, standard_deviation: 0.0, half_width_95: None, n_blocks: 1 }
}

/// A turbine called `name` at baseline that makes `power` (W), and of which nothing more is known.
pub fn turbine(name: &str, power: f64) -> TurbineSummary {
    TurbineSummary {
        name: name.to_owned(),
        model: "iea-15mw".to_owned(),
        rotor: None,
        control: ControlSummary::plain("baseline", "baseline"),
        power: statistic(power),
        thrust: statistic(1.9e6),
        rotor_speed: statistic(0.7),
        pitch: statistic(0.0),
        sectors: Vec::new(),
        yaw_misalignment_deg: None,
        delivered_pitch: None,
        power_gain: None,
        pitch_response: None,
        individual_pitch_offset: None,
        meandering: None,
        loads: Vec::new(),
        pitch_duty: None,
    }
}

/// A mean with an interval of a fiftieth of it, from three blocks.
fn with_interval(mean: f64) -> Statistic {
    let half_width_95 = Some(0.02 * mean);
    Statistic { mean, standard_deviation: 0.06 * mean, half_width_95, n_blocks: 3 }
}

/// A run called `run` of `turbines`, in a wind of 9 m/s on the lattice, that compares with none.
pub fn summary(run: &str, turbines: Vec<TurbineSummary>) -> Summary {
    Summary {
        schema_version: SCHEMA_VERSION,
        case: "row".to_owned(),
        run: run.to_owned(),
        compare_with: None,
        conditions: conditions(),
        flow: None,
        array_power: statistic(turbines.iter().map(|turbine| turbine.power.mean).sum()),
        turbines,
        array_power_gain: None,
        cost: Cost::default(),
        warnings: Vec::new(),
    }
}

fn conditions() -> Conditions {
    Conditions {
        target_wind_speed: 9.0,
        direction_deg: 270.0,
        target_turbulence_intensity: 0.05,
        turbulence_length_scale: Some(75.0),
        realised_wind_speed: 8.9,
        realised_turbulence_intensity: 0.046,
        shear_exponent: Some(0.1),
        roughness_length: None,
        seed: 1,
        rotor_diameter: 240.0,
        cells_per_diameter: Some(16.0),
        interval: 0.125,
        spin_up: 300.0,
        duration: 900.0,
    }
}

/// Standard deviation or damage-equivalent load of `channel`, `value` (kN m), compared with nothing.
pub fn load(channel: &str, kind: LoadKind, value: f64) -> Load {
    Load { channel: channel.to_owned(), unit: "kN m".to_owned(), kind, value, change: None }
}

/// 1-Hz damage-equivalent load of `slope` (–).
pub fn damage_equivalent(slope: f64) -> LoadKind {
    LoadKind::DamageEquivalent { slope, reference_frequency_hz: 1.0 }
}

/// A helix of sense `sense` and `amplitude_deg` (deg) at a Strouhal number of 0.25.
pub fn helix(sense: Sense, amplitude_deg: f64) -> ControlSummary {
    let excitation = PitchExcitation {
        sense: Some(sense),
        amplitude_deg,
        strouhal: 0.25,
        phase_offset_deg: None,
        start: 0.0,
        stop: None,
    };
    let description = format!("helix {sense} {amplitude_deg:.1}° St 0.25");
    ControlSummary { excitation: Some(excitation), ..ControlSummary::plain("helix", &description) }
}

/// A run in which every field is filled, and each form that one can take is there once.
pub fn full() -> Summary {
    let gain = with_interval(0.05);
    let responses = [
        PitchResponse::Estimator {
            gain: 1.04,
            azimuth_offset: 0.01,
            before: 0.12,
            after: 0.02,
            transformation_offset: Some(0.6),
        },
        PitchResponse::Transformation { azimuth_offset: 0.6 },
        PitchResponse::IndividualPitch { azimuth_offset: 0.2 },
        PitchResponse::Loads { azimuth_offset: 0.25, delay: 3.5, gain: 1.6e8 },
    ];
    let turbines = responses.into_iter().zip(["T1", "T2", "T3", "T4"]);
    let turbines = turbines.map(|(response, name)| TurbineSummary {
        pitch_response: Some(response),
        ..full_turbine(name, gain)
    });
    let kinds = [
        WarningKind::Setup,
        WarningKind::PitchHeldBack,
        WarningKind::Controller,
        WarningKind::TipSpeed,
        WarningKind::Overspeed,
        WarningKind::VortexCores,
        WarningKind::GainUndefined,
        WarningKind::MixedRuns,
    ];
    let warnings = kinds.map(|kind| Warning {
        kind,
        turbine: Some("T1".to_owned()),
        message: "a warning".to_owned(),
    });
    Summary {
        compare_with: Some("baseline".to_owned()),
        conditions: Conditions { roughness_length: Some(0.01), ..conditions() },
        flow: Some(flow()),
        array_power: with_interval(4e7),
        array_power_gain: Some(gain),
        cost: Cost {
            wall_time: 82.4,
            n_cells: 1_258_291,
            n_steps: 19_200,
            updates_per_second: 293e6,
            n_threads: 2,
            memory: 119_537_664,
            peak_memory: Some(297_800_000),
        },
        warnings: warnings.to_vec(),
        ..summary("full", turbines.collect())
    }
}

fn flow() -> FlowSummary {
    let size = [1920.0, 1440.0, 960.0];
    let domain =
        GridSummary { origin: [-720.0, -720.0, 0.0], size, spacing: 15.0, n_cells: 786_432 };
    FlowSummary {
        solver: "lattice".to_owned(),
        has_wakes: true,
        limits: "What it cannot show.".to_owned(),
        grids: vec![domain],
    }
}

fn bearing_loads() -> Vec<BearingLoad> {
    let positions = (0..360).step_by(10).map(f64::from);
    positions.map(|at| BearingLoad { position_deg: at, load_kn_m: 1e4 }).collect()
}

fn sectors() -> Vec<Sector> {
    let sector =
        |name: &str| Sector { name: name.to_owned(), wind_speed: 7.9, turbulence_intensity: 0.08 };
    ["up", "right", "down", "left"].map(sector).to_vec()
}

/// The excitation `set` with an offset, and until 800 s.
fn late(set: PitchExcitation) -> PitchExcitation {
    PitchExcitation { phase_offset_deg: Some(90.0), stop: Some(800.0), ..set }
}

fn full_turbine(name: &str, gain: Statistic) -> TurbineSummary {
    let axis = MeanderingAxis { amplitude: 7.5e6, reference: Some(5e6), factor: Some(1.5) };
    let plain = helix(Sense::CounterClockwise, 4.0);
    let excitation = plain.excitation.map(late);
    let loads = [LoadKind::Deviation, damage_equivalent(10.0)]
        .map(|kind| Load { change: Some(gain), ..load("RootMyb1", kind, 12_340.0) });
    TurbineSummary {
        rotor: Some(Rotor { diameter: 240.0, hub: [0.0, 0.0, 150.0], yaw_deg: 0.0 }),
        sectors: sectors(),
        yaw_misalignment_deg: Some(-2.5),
        control: ControlSummary {
            settings: Some(vec![ControlSetting {
                key: "amplitude_deg".to_owned(),
                value: SettingValue::Number(4.0),
            }]),
            excitation,
            findings: vec![Finding {
                name: "locked-share".to_owned(),
                value: Some(0.9),
                unit: "–".to_owned(),
                about: "share of the time in which the loop was locked".to_owned(),
            }],
            ..plain
        },
        power: with_interval(1e7),
        thrust: with_interval(1.9e6),
        rotor_speed: with_interval(0.7),
        pitch: with_interval(0.02),
        delivered_pitch: Some(DeliveredPitch {
            commanded_amplitude_deg: 4.0,
            delivered_amplitude_deg: 3.9,
            frequency_hz: 0.12,
            excitation_frequency_hz: 0.009_375,
            clipped_share: 0.0,
        }),
        power_gain: Some(gain),
        individual_pitch_offset: Some(0.2),
        meandering: Some(MeanderingSummary {
            locked_share: 0.9,
            frequency_hz: Some(0.0075),
            tilt: Some(axis),
            yaw: Some(axis),
        }),
        loads: loads.to_vec(),
        pitch_duty: Some(PitchDuty {
            travel_deg: 1200.0,
            travel_in_ten_minutes_deg: 1200.0,
            maximum_rate_deg_s: 2.0,
            moving_share: 1.0,
            n_reversals: 12,
            bearing_slope: 3.0,
            bearing_loads: bearing_loads(),
            sample_interval: 0.125,
        }),
        ..turbine(name, 1e7)
    }
}
