//! Damage-equivalent loads of a run.

use crate::StudyError;
use crate::channels::LOADS;
use crate::summarise::Analysed;
use analysis::fatigue::LoadCounter;
use basis::records::Series;
use std::collections::BTreeMap;

/// Wöhler's exponent of composite blades (–).
const BLADE_SLOPE: f64 = 10.0;
/// Wöhler's exponent of steel: shaft, tower (–).
const STEEL_SLOPE: f64 = 4.0;

/// 1-Hz damage-equivalent load (range, peak to peak) of the moments of `turbine` in `series` that are kept of any
/// run, by channel with slope and unit.
///
/// Slopes as van der Hoek et al., section 2.4: 10 for the blade's composite, 4 for steel.
pub(crate) fn damage_equivalent(
    series: &Series,
    turbine: &str,
    analysed: &Analysed<'_>,
) -> Result<BTreeMap<String, f64>, StudyError> {
    let mut loads = BTreeMap::new();
    for name in &series.names {
        let Some(channel) = name
            .strip_prefix(turbine)
            .and_then(|rest| rest.strip_prefix('.'))
            .and_then(|rest| rest.strip_suffix("_kN-m"))
        else {
            continue;
        };
        let slope = if channel.starts_with("Root") { BLADE_SLOPE } else { STEEL_SLOPE };
        if !LOADS.contains(&channel) {
            continue;
        }
        let load = analysed.column(name)?;
        if load.len() < 2 {
            continue;
        }
        let mut counter = LoadCounter::new(&[slope])?;
        counter.extend(load)?;
        let duration = (load.len() - 1) as f64 * analysed.interval;
        let fatigue = counter.finish(duration)?;
        loads.insert(format!("{channel}, m = {slope} (kN m)"), fatigue.loads[0].load);
    }
    Ok(loads)
}
