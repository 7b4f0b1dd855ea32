//! What the lidar's loop gives beyond a larger helix: the closed loop beside an open one of as much pitch.

use crate::Row;
use crate::four_winds::{
    AllChanges, CLOSED, Farm, FarmWind, OPEN, WINDS, all_changes, analysed, print_changes,
    records_of, series_of, together,
};
use crate::row::Tolerance::AtLeast;
use analysis::statistics::mean;
use std::path::Path;

/// Where the expected sign comes from: the closed loop is to gain by where the wake stands. The source has
/// +0.2 and +0.4 %, over a helix of 3° alone.
const OWN: &str = "this program's claim: the source compares with a helix of 3° alone";
/// Pitch of the first turbine's blades as it is commanded: actuators follow both loops alike.
const PITCH: [&str; 3] = ["T1.PitchCmd1", "T1.PitchCmd2", "T1.PitchCmd3"];
/// How far the open loop may be from what it is to pitch (–).
const AS_MUCH: f64 = 0.005;

/// The closed loops of `farm` in turbulence with `seeds`, each beside an open loop whose pitch varies as much
/// in the mean square; prints the changes, and gives those of the power of both turbines as rows.
pub(crate) fn beyond_amplitude(farm: &Farm, seeds: &[u64]) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for wind in WINDS.into_iter().filter(|wind| wind.has_seeds()) {
        let of_seeds: Result<Vec<AllChanges>, String> =
            seeds.iter().map(|&seed| of_seed(farm, wind, seed)).collect();
        let all = together(&of_seeds?)?;
        let FarmWind { number, shear, intensity } = wind;
        print_changes(
            &format!("CL{number} over an open loop that pitches as much, all seeds"),
            &all,
        );
        rows.push(Row {
            what: format!(
                "CL{number} (shear {shear}, intensity {intensity}), resolved flow, mean of {} seeds: change of power of both turbines over an open loop that pitches as much",
                seeds.len()
            ),
            measured: all[0][2].mean,
            expected: 0.0,
            tolerance: AtLeast,
            unit: "%",
            source: OWN,
        });
    }
    Ok(rows)
}

fn of_seed(farm: &Farm, wind: FarmWind, seed: u64) -> Result<AllChanges, String> {
    let folder = farm.folder(seed, &[OPEN, CLOSED])?;
    let amplitude = amplitude(&folder, wind, CLOSED)?;
    let other = farm.open_of(wind, seed, amplitude)?;
    let found = self::amplitude(&other, wind, OPEN)?;
    let number = wind.number;
    tell!(
        "CL{number}, seed {seed}: a helix of {amplitude:.2}° by its mean square, the open loop beside it {found:.2}°"
    );
    if (found / amplitude - 1.0).abs() > AS_MUCH {
        let far = format!("the open loop pitches {found:.3}°, not {amplitude:.3}°");
        return Err(format!("CL{number}, seed {seed}: {far}"));
    }
    let changes = all_changes(&series_of(&folder, wind, CLOSED)?, &series_of(&other, wind, OPEN)?)?;
    print_changes(
        &format!("CL{number} over an open loop that pitches as much, seed {seed}"),
        &changes,
    );
    Ok(changes)
}

/// Amplitude (°) of a steady helix whose blades pitch as much as those of `run`, in the mean square and about
/// what they all do.
fn amplitude(folder: &Path, wind: FarmWind, run: &str) -> Result<f64, String> {
    let series = analysed(&records_of(folder, wind, run)?, &PITCH.map(str::to_owned))?;
    let column = |name| series.column(name).ok_or_else(|| format!("{run}: there is no {name}"));
    let pitch = [column(PITCH[0])?, column(PITCH[1])?, column(PITCH[2])?];
    let mean_square = |row: usize| {
        let pitch = pitch.map(|column| column[row]);
        let all = pitch.iter().sum::<f64>() / 3.0;
        pitch.map(|one| (one - all).powi(2)).iter().sum::<f64>() / 3.0
    };
    let squares: Vec<f64> = (0..pitch[0].len()).map(mean_square).collect();
    Ok((2.0 * mean(&squares)).sqrt().to_degrees())
}
