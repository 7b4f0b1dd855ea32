//! A study seen as its reader sees it: which run is the measure, what was done, where things stand.

use crate::layout::{self, Lane, Rotor};
use crate::units::Units;
use crate::{ReportError, RunRecords, StudyRecords};
use basis::Sense;
use basis::records::{DeliveredPitch, Plane, PlaneAxes, Summary, TurbineSummary};

/// How a turbine was excited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ExcitationKind<'a> {
    /// Helix; its sense says whether blades pitch at rotor plus or minus excitation frequency.
    Helix(Sense),
    /// Helix of this sense, synchronised with the incoming one.
    Synchronised(Sense),
    /// Collective pitch.
    Pulse,
    /// Another periodic pitch, known by the name of its controller's kind.
    Named(&'a str),
}

/// One excited turbine of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excitation<'a> {
    /// The turbine.
    pub(crate) turbine: &'a TurbineSummary,
    /// How it was excited.
    pub(crate) kind: ExcitationKind<'a>,
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

/// The study, digested.
pub(crate) struct Study<'a> {
    /// The records behind it.
    pub(crate) records: &'a StudyRecords,
    /// The rotors in their places; empty where nothing tells.
    pub(crate) rotors: Vec<Rotor>,
    /// The lines along the wind in which they stand.
    pub(crate) lanes: Vec<Lane>,
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
        let summaries: Vec<&Summary> = records.runs.iter().map(|run| &run.summary).collect();
        let colours = colours(&summaries);
        let rotors = layout::rotors(records);
        Ok(Self { records, lanes: layout::lanes(&rotors), rotors, colours })
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

    /// In what powers and thrusts are told.
    pub(crate) fn units(&self) -> Units {
        Units::of_all(self.runs().iter().map(|run| &run.summary))
    }

    /// Diameter of the first turbine's rotor (m).
    pub(crate) fn diameter(&self) -> f64 {
        layout::diameter(&self.runs()[0].summary)
    }

    /// The rotors that are there in `run`, turned as they are in it.
    pub(crate) fn rotors_of(&self, run: &RunRecords) -> impl Iterator<Item = Rotor> {
        let turbines = &run.summary.turbines;
        self.rotors.iter().filter_map(|rotor| {
            let turbine = turbines.iter().find(|turbine| turbine.name == rotor.name)?;
            let yaw = turbine.rotor.map_or(0.0, |rotor| rotor.yaw_deg.to_radians());
            Some(Rotor { yaw, ..rotor.clone() })
        })
    }

    /// Names of the rotors in `lane`.
    pub(crate) fn names_in(&self, lane: &Lane) -> Vec<String> {
        lane.rotors.iter().map(|&index| self.rotors[index].name.clone()).collect()
    }

    /// Whether turbines feel one another's wakes, so that a sum over them means something.
    pub(crate) fn has_wakes(&self) -> bool {
        self.runs().iter().all(|run| run.summary.has_wakes())
    }

    /// Speed that velocities are shown relative to: the target at hub height (m/s).
    pub(crate) fn free_stream(&self) -> f64 {
        let speed = self.runs()[0].summary.conditions.target_wind_speed;
        if speed > 0.0 { speed } else { 1.0 }
    }

    /// Run with the largest gain.
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

    /// Distances between neighbours along the row (diameters); in a staggered one along the wind alone,
    /// between turbines that do not stand side by side.
    pub(crate) fn spacings(&self) -> Vec<f64> {
        /// Turbines nearer along the wind than this stand side by side (diameters).
        const SIDE_BY_SIDE: f64 = 0.5;
        let mut places: Vec<f64> =
            self.rotors.iter().map(|rotor| rotor.hub[0] / self.diameter()).collect();
        places.sort_by(f64::total_cmp);
        let distances = places.windows(2).map(|pair| pair[1] - pair[0]);
        distances.filter(|distance| *distance > SIDE_BY_SIDE).collect()
    }
}

/// Colour index of each run of a study, whose summaries are `runs`: 0 is kept for the run that others compare
/// with.
pub fn colours(runs: &[&Summary]) -> Vec<usize> {
    let measure = runs.iter().find_map(|run| run.compare_with.as_deref());
    let reference = measure.and_then(|name| runs.iter().position(|run| run.run == name));
    let reference = reference.unwrap_or(0);
    let colour = |run: usize| match run {
        run if run == reference => 0,
        run if run < reference => run + 1,
        run => run,
    };
    (0..runs.len()).map(colour).collect()
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

/// Gain of the array in a run (–); in wind without wakes, where there is no array, that of the turbine that
/// gained most.
pub(crate) fn gain_of(run: &RunRecords) -> Option<f64> {
    let summary = &run.summary;
    let gains = if summary.has_wakes() {
        Vec::from_iter(summary.array_power_gain)
    } else {
        summary.turbines.iter().filter_map(|turbine| turbine.power_gain).collect()
    };
    let gains = gains.into_iter().map(|gain| gain.mean).filter(|gain| gain.is_finite());
    gains.max_by(f64::total_cmp)
}

/// How `turbine` was set to be excited.
fn kind_of(turbine: &TurbineSummary) -> ExcitationKind<'_> {
    let control = &turbine.control;
    let sense = control.excitation.and_then(|set| set.sense);
    match (control.kind.as_str(), sense) {
        ("helix", Some(sense)) => ExcitationKind::Helix(sense),
        ("phase-sync", Some(sense)) => ExcitationKind::Synchronised(sense),
        ("pulse", None) => ExcitationKind::Pulse,
        (name, _) => ExcitationKind::Named(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
