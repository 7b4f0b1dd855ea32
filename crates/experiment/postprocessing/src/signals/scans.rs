//! What lidars saw in the runs of a study, as a part of its report.

use super::control_of;
use crate::PostprocessingError;
use crate::hub_vortex::{HubVortexQuestion, Sampled, of_runs, seen};
use farm::case::Case;
use formats::records::{StudyRecords, scans_name};
use report::Signals;

/// A part for each lidar of which runs of `case` in `records` kept scans.
///
/// # Errors
/// [`PostprocessingError`] for a file that cannot be read.
pub(super) fn of_study(
    case: &Case,
    records: &StudyRecords,
) -> Result<Vec<Signals>, PostprocessingError> {
    let mut parts = Vec::new();
    for (index, turbine) in case.turbines.iter().enumerate() {
        for sensor in &turbine.sensors {
            let mut runs = Vec::new();
            let name = scans_name(&turbine.name, &sensor.name);
            for run in &records.runs {
                let path = run.scan_paths.iter().find(|path| path.ends_with(&name));
                let (Some(path), Some(control)) = (path, control_of(case, run).get(index)) else {
                    continue;
                };
                let question = HubVortexQuestion::default();
                match Sampled::read(path.clone(), control, case.time.spin_up, &question) {
                    Ok(sampled) => runs.push(seen(&run.summary.run, &sampled)),
                    // Too few scans are no reason to withhold the rest of a report.
                    Err(PostprocessingError::Scans { .. }) => {}
                    Err(error) => return Err(error),
                }
            }
            parts.extend(of_runs(runs));
        }
    }
    Ok(parts)
}
