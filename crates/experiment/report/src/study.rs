//! A study seen as its reader sees it: which run is the measure, what was done, where things stand.

use crate::{ReportError, RunRecords, StudyRecords};
use basis::Sense;
use basis::records::{DeliveredPitch, Plane, PlaneAxes, TurbineSummary};

/// How a turbine was excited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ExcitationKind {
    /// Helix, blades pitch at rotor minus excitation frequency.
    Clockwise,
    /// Helix, blades pitch at rotor plus excitation frequency.
    CounterClockwise,
    /// Collective pitch.
    Pulse,
    /// Known only by the controller's own description.
    Other,
}

/// One excited turbine of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excitation<'a> {
    /// The turbine.
    pub(crate) turbine: &'a TurbineSummary,
    /// How it was excited.
    pub(crate) kind: ExcitationKind,
    /// What the actuators delivered.
    pub(crate) pitch: DeliveredPitch,
    /// f D / U with the target wind speed and the first turbine's diameter (–).
    pub(crate) strouhal: f64,
}

impl Excitation<'_> {
    /// The phase offset in words, "90°", where it is synchronised with an incoming helix.
    pub(crate) fn synchronised_at(&self) -> Option<String> {
        let offset = self.turbine.control.excitation?.phase_offset_deg?;
        Some(format!("{offset:.0}°"))
    }
}

/// Where a turbine stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// Name of the turbine.
    pub(crate) name: String,
    /// Downwind and to the left (diameters of the first turbine).
    pub(crate) position: [f64; 2],
}

/// The study, digested.
pub(crate) struct Study<'a> {
    /// The records behind it.
    pub(crate) records: &'a StudyRecords,
    /// Where the turbines stand; empty when the case file does not tell.
    pub(crate) layout: Vec<Place>,
    /// Colour index of each run: 0 is kept for the run that others compare with.
    pub(crate) colours: Vec<usize>,
}

impl<'a> Study<'a> {
    /// Looks at `records`.
    ///
    /// # Errors
    /// [`ReportError::NoRuns`] when there are none.
    pub(crate) fn new(records: &'a StudyRecords) -> Result<Self, ReportError> {
        if records.runs.is_empty() {
            return Err(ReportError::NoRuns { case: records.case_name.clone() });
        }
        let reference = records
            .runs
            .iter()
            .find_map(|run| run.summary.compare_with.as_deref())
            .and_then(|name| records.runs.iter().position(|run| run.summary.run == name))
            .unwrap_or(0);
        let colours = (0..records.runs.len())
            .map(|run| match run {
                run if run == reference => 0,
                run if run < reference => run + 1,
                run => run,
            })
            .collect();
        Ok(Self { records, layout: layout_of(&records.case_text), colours })
    }

    /// The runs.
    pub(crate) fn runs(&self) -> &'a [RunRecords] {
        &self.records.runs
    }

    /// Runs with their colours and names, for legends.
    pub(crate) fn names(&self) -> Vec<(usize, &'a str)> {
        let names = self.runs().iter().map(|run| run.summary.run.as_str());
        self.colours.iter().copied().zip(names).collect()
    }

    /// Names of all turbines; one that is absent in a run may be there in another.
    pub(crate) fn turbines(&self) -> Vec<&'a str> {
        let mut names = Vec::new();
        for turbine in self.runs().iter().flat_map(|run| &run.summary.turbines) {
            if !names.contains(&turbine.name.as_str()) {
                names.push(turbine.name.as_str());
            }
        }
        names
    }

    /// How far left of the origin the first turbine stands (diameters).
    pub(crate) fn side(&self) -> f64 {
        self.layout.first().map_or(0.0, |place| place.position[1])
    }

    /// Diameter of the first turbine's rotor (m).
    pub(crate) fn diameter(&self) -> f64 {
        let diameter = self.runs()[0].summary.conditions.rotor_diameter;
        if diameter > 0.0 { diameter } else { 1.0 }
    }

    /// Speed that velocities are shown relative to: the target at hub height (m/s).
    pub(crate) fn free_stream(&self) -> f64 {
        let speed = self.runs()[0].summary.conditions.target_wind_speed;
        if speed > 0.0 { speed } else { 1.0 }
    }

    /// Hub height, from the hub-height plane (m).
    pub(crate) fn hub_height(&self) -> Option<f64> {
        self.runs().iter().find_map(|run| {
            let planes = run.mean_planes.iter().chain(&run.instant_planes);
            let mut horizontal = planes.filter(|plane| plane.axes == PlaneAxes::Horizontal);
            horizontal.next().map(|plane| plane.origin[2])
        })
    }

    /// Run with the largest gain of the array.
    pub(crate) fn best(&self) -> Option<&'a RunRecords> {
        self.runs()
            .iter()
            .filter_map(|run| Some((run, gain_of(run)?)))
            .max_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(run, _)| run)
    }

    /// The excited turbines of `run`.
    pub(crate) fn excitations(&self, run: &'a RunRecords) -> Vec<Excitation<'a>> {
        let conditions = &run.summary.conditions;
        run.summary
            .turbines
            .iter()
            .filter_map(|turbine| {
                let pitch = turbine.delivered_pitch?;
                let strouhal = pitch.excitation_frequency_hz.abs() * conditions.rotor_diameter
                    / conditions.target_wind_speed;
                Some(Excitation { turbine, kind: kind_of(turbine), pitch, strouhal })
            })
            .filter(|excitation| excitation.pitch.commanded_amplitude_deg > 0.0)
            .collect()
    }

    /// Those of them that the run which `run` is compared with did not have; all where that tells nothing
    /// apart.
    pub(crate) fn changed_excitations(&self, run: &'a RunRecords) -> Vec<Excitation<'a>> {
        let measure = run.summary.compare_with.as_deref();
        let before = self.runs().iter().find(|other| Some(other.summary.run.as_str()) == measure);
        let same = |excitation: &Excitation| {
            before.is_some_and(|before| {
                before.summary.turbines.iter().any(|turbine| {
                    turbine.name == excitation.turbine.name
                        && turbine.control.is_set_as(&excitation.turbine.control)
                })
            })
        };
        let all = self.excitations(run);
        let changed: Vec<Excitation> = all.iter().filter(|now| !same(now)).copied().collect();
        if changed.is_empty() { all } else { changed }
    }

    /// Distances between neighbours along the row (diameters).
    pub(crate) fn spacings(&self) -> Vec<f64> {
        self.layout
            .windows(2)
            .map(|pair| {
                let [from, to] = [pair[0].position, pair[1].position];
                (to[0] - from[0]).hypot(to[1] - from[1])
            })
            .collect()
    }
}

/// The plane called `name`.
pub(crate) fn plane<'p>(planes: &'p [Plane], name: &str) -> Option<&'p Plane> {
    planes.iter().find(|plane| plane.name == name && is_whole(plane))
}

/// Whether a plane holds as many values as it says, and more than a line of them.
pub(crate) fn is_whole(plane: &Plane) -> bool {
    let [n_first, n_second] = plane.n_points;
    n_first > 1
        && n_second > 1
        && plane.spacing.iter().all(|spacing| *spacing > 0.0)
        && plane.velocity[0].len() == n_first * n_second
}

/// Streamwise velocity at (`first`, `second`) along the plane's axes (farm frame, m), between its
/// points linear; absent outside.
pub(crate) fn sample(plane: &Plane, first: f64, second: f64) -> Option<f64> {
    let start = match plane.axes {
        PlaneAxes::Horizontal => [plane.origin[0], plane.origin[1]],
        PlaneAxes::Streamwise => [plane.origin[0], plane.origin[2]],
        PlaneAxes::Crosswind => [plane.origin[1], plane.origin[2]],
    };
    let mut cell = [0; 2];
    let mut share = [0.0; 2];
    for (axis, value) in [first, second].into_iter().enumerate() {
        let index = (value - start[axis]) / plane.spacing[axis];
        let last = (plane.n_points[axis] - 1) as f64;
        if !(-1e-6..=last + 1e-6).contains(&index) {
            return None;
        }
        cell[axis] = (index.max(0.0) as usize).min(plane.n_points[axis] - 2);
        share[axis] = (index - cell[axis] as f64).clamp(0.0, 1.0);
    }
    let at = |i: usize, j: usize| {
        f64::from(plane.velocity[0][(cell[1] + j) * plane.n_points[0] + cell[0] + i])
    };
    let lower = at(0, 0) + share[0] * (at(1, 0) - at(0, 0));
    let upper = at(0, 1) + share[0] * (at(1, 1) - at(0, 1));
    Some(lower + share[1] * (upper - lower))
}

/// Gain of the array in a run.
pub(crate) fn gain_of(run: &RunRecords) -> Option<f64> {
    run.summary.array_power_gain.map(|gain| gain.mean).filter(|gain| gain.is_finite())
}

/// How `turbine` was set to be excited.
fn kind_of(turbine: &TurbineSummary) -> ExcitationKind {
    match turbine.control.excitation.map(|set| set.sense) {
        Some(Some(Sense::CounterClockwise)) => ExcitationKind::CounterClockwise,
        Some(Some(Sense::Clockwise)) => ExcitationKind::Clockwise,
        Some(None) => ExcitationKind::Pulse,
        None => ExcitationKind::Other,
    }
}

/// Where the case file puts the turbines; empty when it does not tell of all.
fn layout_of(case_text: &str) -> Vec<Place> {
    let Ok(case) = case_text.parse::<toml::Table>() else { return Vec::new() };
    let turbines = case.get("turbine").and_then(toml::Value::as_array);
    let place = |turbine: &toml::Value| {
        let pair = turbine.get("position_diameters")?.as_array()?;
        let value = |index: usize| {
            let value: &toml::Value = pair.get(index)?;
            value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64))
        };
        let name = turbine.get("name")?.as_str()?.to_owned();
        Some(Place { name, position: [value(0)?, value(1)?] })
    };
    turbines
        .and_then(|turbines| turbines.iter().map(place).collect::<Option<Vec<_>>>())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_comes_from_the_case_file() {
        let text = "[[turbine]]\nname = 'A'\nposition_diameters = [0, 0.0]\n\
                    [[turbine]]\nname = 'B'\nposition_diameters = [5.0, -1]\n";
        let positions: Vec<[f64; 2]> = layout_of(text).iter().map(|place| place.position).collect();
        assert_eq!(positions, [[0.0, 0.0], [5.0, -1.0]]);
        assert!(layout_of("name = 3").is_empty() && layout_of("not toml at all [").is_empty());
        assert!(layout_of("[[turbine]]\nposition_diameters = [1]\n").is_empty());
    }

    #[test]
    fn a_plane_is_linear_between_its_points() {
        let plane = Plane {
            name: "hub-height".into(),
            axes: PlaneAxes::Horizontal,
            origin: [-10.0, -4.0, 90.0],
            spacing: [5.0, 2.0],
            n_points: [3, 2],
            time: 0.0,
            averaged: 0.0,
            velocity: [vec![0.0, 1.0, 2.0, 10.0, 11.0, 12.0], vec![0.0; 6], vec![0.0; 6]],
        };
        assert_eq!(sample(&plane, -7.5, -3.0), Some(5.5));
        assert_eq!(sample(&plane, 0.0, -2.0), Some(12.0));
        assert_eq!(sample(&plane, 0.1, -2.0), None);
    }
}
