//! The flexible turbine in Kaimal turbulence: deviations and equivalent loads of our own records beside the
//! reference's one.

use super::rig::{CHANNELS, Conditions, Run, Speed, run};
use crate::Row;
use crate::inflow::{kaimal, mean_of};
use crate::row::Tolerance::Within;
use analysis::statistics::student_97_5;
use flow::inflow::MeanProfile;
use flow::inflow::planes::BoxPlanes;
use std::sync::Arc;

/// Where the expected values come from.
const SOURCE: &str = "OpenFAST 5.0.0, one record of ten minutes";

/// Records of ours.
const SEEDS: u64 = 6;
/// Aims: distance from the reference of standard deviations and of equivalent loads (–).
const DEVIATION_AIM: f64 = 0.08;
const EQUIVALENT_AIM: f64 = 0.10;

/// What one record of the reference gave of a channel.
struct Reference {
    /// Place in [`CHANNELS`].
    channel: usize,
    /// Wöhler's exponent (–).
    slope: f64,
    /// Standard deviation and 1-Hz damage-equivalent load (MN m), and what is accepted around them.
    deviation: (f64, Accepted),
    equivalent: (f64, Accepted),
}

/// How far the mean of our records may lie from the reference's one.
#[derive(Clone, Copy)]
enum Accepted {
    /// By the aim.
    Aim,
    /// By so much (MN m): two programs that agree give two single records that differ by chance, and here by
    /// more than the aim. The half width within which 95 % of further records of ours lay of the mean of
    /// those made, t s √(1 + 1/n), as it was recorded on 2026-11-22; frozen, so that records that scatter
    /// more are no easier to meet.
    Chance(f64),
    /// By whatever it is: that half width is more than half of the reference's figure, and what lies within
    /// it says nothing.
    NoClaim,
}
use Accepted::{Aim, Chance, NoClaim};

/// OpenFAST in the record that TurbSim made of [`kaimal::settings`] with its seed 20260101, power law 0.14;
/// 60 to 600 s at 10 Hz.
const REFERENCE: [Reference; 6] = [
    Reference {
        channel: 0,
        slope: 10.0,
        deviation: (3.058_64, NoClaim),
        equivalent: (8.711_7, Chance(4.29)),
    },
    Reference { channel: 6, slope: 10.0, deviation: (13.3627, Aim), equivalent: (30.4277, Aim) },
    Reference {
        channel: 1,
        slope: 4.0,
        deviation: (14.7962, NoClaim),
        equivalent: (19.6884, NoClaim),
    },
    Reference {
        channel: 2,
        slope: 4.0,
        deviation: (1.655_45, Chance(0.649)),
        equivalent: (3.207_09, Aim),
    },
    Reference {
        channel: 3,
        slope: 4.0,
        deviation: (1.6936, Chance(0.349)),
        equivalent: (3.109_36, Aim),
    },
    Reference {
        channel: 4,
        slope: 4.0,
        deviation: (1.703_28, NoClaim),
        equivalent: (3.341_24, Chance(0.345)),
    },
];

/// Means over the records of ours, each beside the reference's one record.
///
/// # Panics
/// When a box cannot be made, which only a lack of memory (110 MB) causes.
pub fn openfast_turbulence() -> Vec<Row> {
    let runs: Vec<Run> = (1..=SEEDS).map(in_turbulence).collect();
    let mut rows = Vec::new();
    for Reference { channel, slope, deviation, equivalent } in REFERENCE {
        let name = CHANNELS[channel];
        rows.extend(beside(
            &format!("standard deviation of {name}"),
            &runs.iter().map(|run| run.deviation(channel)).collect::<Vec<_>>(),
            deviation,
            DEVIATION_AIM,
        ));
        rows.extend(beside(
            &format!("equivalent load of {name} (m = {slope})"),
            &runs.iter().map(|run| run.equivalent(channel, slope)).collect::<Vec<_>>(),
            equivalent,
            EQUIVALENT_AIM,
        ));
    }
    rows
}

/// The turbine in turbulence of `seed`, under its own control, read as the reference was.
fn in_turbulence(seed: u64) -> Run {
    let settings = kaimal::settings(seed);
    let profile = MeanProfile::PowerLaw {
        hub_height: settings.hub_height,
        speed: settings.hub_speed,
        exponent: 0.14,
    };
    let turbulence = Arc::new(kaimal::made(&settings));
    let planes = BoxPlanes::new(turbulence, &profile, settings.lowest_height)
        .expect("the speed is positive");
    run(&Conditions {
        planes: Some(planes),
        speed: Speed::Tracked,
        window: [60.0, 600.0],
        steps_per_sample: 5,
        ..Conditions::in_nine_metres_a_second()
    })
}

/// The claim that the mean of `measured`, one value a record of ours (MN m), is within what is `accepted` of
/// the `reference`'s (MN m), the share `aim` of it (–) or what was frozen; none where nothing is claimed.
/// Mean and scatter are printed.
fn beside(
    what: &str,
    measured: &[f64],
    (reference, accepted): (f64, Accepted),
    aim: f64,
) -> Option<Row> {
    let n = measured.len() as f64;
    let (mean, standard_error) = mean_of(measured.iter().copied());
    let scatter = student_97_5(measured.len() - 1) * standard_error * (n + 1.0).sqrt();
    tell!(
        "{what}: mean {mean:.3} MN m beside {reference:.3} MN m; one record scatters by ±{:.1} %",
        100.0 * scatter / mean
    );
    let accepted = match accepted {
        Aim => aim * reference,
        Chance(frozen) => frozen,
        NoClaim => return None,
    };
    Some(Row {
        what: format!("{what}, mean of {n}"),
        measured: mean,
        expected: reference,
        tolerance: Within(accepted),
        unit: "MN m",
        source: SOURCE,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_accepted_and_what_a_row_is_called_do_not_follow_the_scatter() {
        let (calm, wild) = ([9.9, 10.0, 10.1], [5.0, 10.0, 15.0]);
        for (accepted, tolerance) in [(Aim, 1.2), (Chance(0.5), 0.5)] {
            let [calm, wild] =
                [calm, wild].map(|values| beside("load", &values, (12.0, accepted), 0.1).unwrap());
            assert_eq!(calm, wild);
            let Within(most) = calm.tolerance else { panic!("{calm:?}") };
            assert!((most - tolerance).abs() < 1e-12 && !calm.passes(), "{calm:?}");
            assert_eq!(calm.what, "load, mean of 3");
        }
        assert_eq!(beside("load", &calm, (12.0, NoClaim), 0.1), None);
    }

    #[test]
    fn no_claim_accepts_more_than_half_of_what_is_expected() {
        for Reference { deviation, equivalent, .. } in REFERENCE {
            for (reference, accepted) in [deviation, equivalent] {
                assert!(!matches!(accepted, Chance(most) if most > 0.5 * reference));
            }
        }
    }
}
