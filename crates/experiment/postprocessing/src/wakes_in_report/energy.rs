//! The energy that enters wakes, and the power that they leave for a rotor: runs beside each other.

use super::kept::{Kept, Run};
use crate::PostprocessingError;
use crate::analyses::entrainment::figures::{
    DISTANCE, POWER, UNIT, disc_line, flux_line, flux_map, phase_figure, phase_panel,
};
use crate::analyses::entrainment::found::{DiscRow, Energy, PARTS, Through, discs};
use crate::wake_fields::conditions;
use basis::records::FieldSetting;
use report::{CurveFigure, CurvePanel, MapFigure, Signals, TrackFigure, TrackLine, TrackRow};

/// What was found run by run.
#[derive(Default)]
pub(super) struct Energies {
    maps: Vec<MapFigure>,
    /// What crosses lines or a tube, of each field.
    fluxes: Vec<(String, Vec<OfRun<Energy>>)>,
    /// Discs, of each output that has planes across the wind, and of each volume.
    discs: Vec<(String, Vec<OfRun<Discs>>)>,
    /// What must be said.
    pub(super) notes: Vec<String>,
}

/// Something of a run.
struct OfRun<T> {
    name: String,
    colour: usize,
    what: T,
}

/// Power in discs.
struct Discs {
    setting: FieldSetting,
    samples: String,
    rows: Vec<DiscRow>,
}

impl Energies {
    /// Takes what `kept` tells of energy.
    pub(super) fn add(&mut self, run: &Run, kept: &Kept) {
        let n_points = kept.averaged.grid().n_points;
        let is_along = n_points[0] > 1;
        let is_across = n_points[1] > 1 && n_points[2] > 1;
        let flux = if is_along { self.add_flux(run, kept) } else { Ok(()) };
        let discs = if is_across { self.add_discs(run, kept) } else { Ok(()) };
        let told = [flux, discs].into_iter().filter_map(Result::err);
        self.notes.extend(told.map(|error| run.told(&error)));
    }

    fn add_flux(&mut self, run: &Run, kept: &Kept) -> Result<(), PostprocessingError> {
        let Kept { field, request, averaged, .. } = kept;
        let parts = averaged.decomposition()?;
        let energy = Energy::of(request, averaged, &parts)?;
        let mut map = flux_map(averaged, &parts);
        map.title = format!("{}: {}, {field}", map.title, run.name());
        map.name = format!("{}-{field}-{}", map.name, run.name());
        // Of a volume there is none.
        self.maps.extend((!map.panels.is_empty()).then_some(map));
        if energy.fluxes.is_empty() {
            self.notes.push(format!(
                "No line along the wind at the rotor's edge lies on {field} of {}.",
                run.name()
            ));
            return Ok(());
        }
        among(&mut self.fluxes, field).push(OfRun::new(run, energy));
        Ok(())
    }

    fn add_discs(&mut self, run: &Run, kept: &Kept) -> Result<(), PostprocessingError> {
        let Kept { output, field, averaged, .. } = kept;
        let is_plane = averaged.grid().n_points[0] == 1;
        let of = among(&mut self.discs, if is_plane { output } else { field });
        let (rows, why) = discs(averaged)?;
        let told = |why| format!("{}, {field}: {why}", run.name());
        self.notes.extend(why.map(told));
        match of.iter_mut().find(|other| other.name == run.name()) {
            Some(other) => {
                other.what.rows.extend(rows);
                other.what.rows.sort_by(|a, b| a.x.total_cmp(&b.x));
            }
            None => {
                let (setting, samples) = (averaged.setting.clone(), averaged.samples());
                of.push(OfRun::new(run, Discs { setting, samples, rows }));
            }
        }
        Ok(())
    }

    /// The part of the page.
    pub(super) fn signals(mut self) -> Signals {
        let powers: Vec<TrackFigure> =
            self.discs.iter().filter_map(|(of, runs)| power(of, runs, &mut self.notes)).collect();
        let fluxes = self.fluxes.iter().map(|(field, runs)| flux(field, runs));
        let curves = self.discs.iter().filter_map(|(of, runs)| by_phase(of, runs)).collect();
        Signals {
            title: "Energy that enters the wake".to_owned(),
            lead: format!(
                "Mean kinetic energy that fluctuations carry into the wake, −⟨u'v'⟩ū with v inward, in {UNIT}: all of it, what is periodic with rotor and helix, and what is random. Positive is recovery."
            ),
            maps: self.maps,
            tracks: powers.into_iter().chain(fluxes).collect(),
            curves,
            notes: self.notes,
            ..Signals::default()
        }
    }
}

impl<T> OfRun<T> {
    fn new(run: &Run, what: T) -> Self {
        Self { name: run.name().to_owned(), colour: run.colour, what }
    }
}

/// The runs that `lists` has under `name`.
fn among<'l, T>(lists: &'l mut Vec<(String, Vec<T>)>, name: &str) -> &'l mut Vec<T> {
    let known = lists.iter().position(|(other, _)| other == name);
    let place = known.unwrap_or_else(|| {
        lists.push((name.to_owned(), Vec::new()));
        lists.len() - 1
    });
    &mut lists[place].1
}

/// A run, and what crosses one line or a tube in it.
type Crossing<'r> = (&'r OfRun<Energy>, &'r Through);

/// What crosses the lines or the tube of `field` over the distance, runs beside each other.
fn flux(field: &str, runs: &[OfRun<Energy>]) -> TrackFigure {
    let mut places: Vec<(String, Vec<Crossing>)> = Vec::new();
    for run in runs {
        for one in &run.what.fluxes {
            among(&mut places, one.name).push((run, one));
        }
    }
    let (mut rows, mut told) = (Vec::new(), Vec::new());
    for (place, here) in &places {
        for part in PARTS {
            let line =
                |(run, one): &Crossing| flux_line(&run.what, one, part, (&run.name, run.colour));
            let lines = here.iter().map(line).collect();
            rows.push(TrackRow { label: format!("{place}, {}", part.0), is_angle: false, lines });
        }
        let turn = |(run, one): &Crossing| match run.what.turns_at(one) {
            Some(x) => format!("{} at {:.2} D", run.name, run.what.distance(x)),
            None => format!("{} nowhere", run.name),
        };
        let turns: Vec<String> = here.iter().map(turn).collect();
        told.push(format!("{place}: {}", turns.join(", ")));
    }
    let over = |of: fn(&Energy) -> f64| {
        runs.first().map_or(0.0, |run| of(&run.what) / run.what.setting.diameter)
    };
    TrackFigure {
        along: DISTANCE,
        name: format!("entrainment-flux-over-distance-{field}"),
        title: format!("Energy that enters the wake: {field}"),
        caption: format!(
            "Flux of mean kinetic energy ({UNIT}) through lines or a tube {:.2} D from the hub, positive into the wake. All of it, smoothed over {:.2} D, turns from leaving to entering – {}. {}",
            over(|energy| energy.radius),
            over(|energy| energy.smoothing),
            told.join("; "),
            samples(runs, |energy| (&energy.setting, &energy.samples))
        ),
        rows,
        mark: None,
    }
}

/// Power in discs over the distance, runs beside each other; none, with a note, where no run has two.
fn power(of: &str, runs: &[OfRun<Discs>], notes: &mut Vec<String>) -> Option<TrackFigure> {
    let (drawn, bare): (Vec<_>, Vec<_>) = runs.iter().partition(|run| run.what.rows.len() > 1);
    notes.extend(bare.iter().map(|run| {
        format!("{}: {of} of fewer than two distances make no line of available power.", run.name)
    }));
    let line =
        |run: &&OfRun<Discs>| disc_line(&run.what.setting, &run.what.rows, &run.name, run.colour);
    let lines: Vec<TrackLine> = drawn.iter().map(line).collect();
    (!lines.is_empty()).then(|| TrackFigure {
        along: DISTANCE,
        name: format!("available-power-over-distance-{of}"),
        title: format!("Fraction of available power: {of}"),
        caption: format!(
            "Mean of (u/U)³ over a disc as large as the rotor, behind its hub, of the velocity of each bin; \
             mean over the bins, ± 2σ over them. {}",
            samples(runs, |discs| (&discs.setting, &discs.samples))
        ),
        rows: vec![TrackRow { label: POWER.to_owned(), is_angle: false, lines }],
        mark: None,
    })
}

/// Power in the furthest disc over the azimuth of the helix, runs with one beside each other; none where no
/// run has one.
fn by_phase(of: &str, runs: &[OfRun<Discs>]) -> Option<CurveFigure> {
    let panel = |run: &OfRun<Discs>| {
        phase_panel(&run.what.setting, run.what.rows.last()?, run.name.clone())
    };
    let panels: Vec<CurvePanel> = runs.iter().filter_map(panel).collect();
    let told = || samples(runs, |discs| (&discs.setting, &discs.samples));
    (!panels.is_empty()).then(|| phase_figure(panels, of, &told()))
}

/// Conditions and samples of all `runs`.
fn samples<T>(runs: &[OfRun<T>], of: impl Fn(&T) -> (&FieldSetting, &String)) -> String {
    let one = |run: &OfRun<T>| {
        let (setting, samples) = of(&run.what);
        format!("{}; {samples}.", conditions(setting))
    };
    runs.iter().map(one).collect::<Vec<_>>().join(" ")
}
