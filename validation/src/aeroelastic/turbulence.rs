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
    /// Standard deviation and 1-Hz damage-equivalent load (MN m).
    deviation: f64,
    equivalent: f64,
}

/// OpenFAST in the record that TurbSim made of [`kaimal::settings`] with its seed 20260101, power law 0.14;
/// 60 to 600 s at 10 Hz.
const REFERENCE: [Reference; 6] = [
    Reference { channel: 0, slope: 10.0, deviation: 3.058_64, equivalent: 8.711_7 },
    Reference { channel: 6, slope: 10.0, deviation: 13.3627, equivalent: 30.4277 },
    Reference { channel: 1, slope: 4.0, deviation: 14.7962, equivalent: 19.6884 },
    Reference { channel: 2, slope: 4.0, deviation: 1.655_45, equivalent: 3.207_09 },
    Reference { channel: 3, slope: 4.0, deviation: 1.6936, equivalent: 3.109_36 },
    Reference { channel: 4, slope: 4.0, deviation: 1.703_28, equivalent: 3.341_24 },
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
        rows.push(beside(
            &format!("standard deviation of {name}"),
            &runs.iter().map(|run| run.deviation(channel)).collect::<Vec<_>>(),
            deviation,
            DEVIATION_AIM,
        ));
        rows.push(beside(
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

/// The mean of `measured`, one value a record of ours (MN m), beside the `reference`'s (MN m).
///
/// Two programs that agree give two single records that differ by chance. So accepted is the larger of the
/// share `aim` (–) of the reference and the half width within which 95 % of further records of ours lie of
/// the mean of those made: t s √(1 + 1/n). The row says which it was.
fn beside(what: &str, measured: &[f64], reference: f64, aim: f64) -> Row {
    let n = measured.len() as f64;
    let (mean, standard_error) = mean_of(measured.iter().copied());
    let scatter = student_97_5(measured.len() - 1) * standard_error * (n + 1.0).sqrt();
    let aimed = aim * reference;
    let accepted = if scatter > aimed { "by chance" } else { "by aim" };
    tell!("{what}: one record scatters by ±{:.1} %", 100.0 * scatter / mean);
    Row {
        what: format!("{what}, mean of {n}, {accepted}"),
        measured: mean,
        expected: reference,
        tolerance: Within(scatter.max(aimed)),
        unit: "MN m",
        source: SOURCE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chance_is_accepted_where_it_is_wider_than_the_aim() {
        // t(0.975, 2) = 4.302653, s = 1, √(1 + 1/3) = 1.154701.
        let row = beside("load", &[9.0, 10.0, 11.0], 12.0, 0.1);
        let Within(tolerance) = row.tolerance else { panic!("{row:?}") };
        assert!((tolerance - 4.302653 * 1.154701).abs() < 1e-5, "{tolerance}");
        assert_eq!(row.measured, 10.0);
        assert!(row.passes() && row.what.ends_with("by chance"), "{}", row.what);
        let row = beside("load", &[9.99, 10.0, 10.01], 12.0, 0.1);
        assert_eq!(row.tolerance, Within(0.1 * 12.0));
        assert!(!row.passes());
        assert!(row.what.ends_with("by aim"), "{}", row.what);
    }
}
