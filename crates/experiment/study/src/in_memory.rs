//! Runs as values: series, planes and summary in memory, no file read or written.

use crate::columns::Columns;
use crate::gains;
use crate::outputs::series::{self, Rows};
use crate::outputs::{mean_planes, slices};
use crate::ready::Ready;
use crate::simulate::{cost, left};
use crate::summarise::summarise;
use crate::{Prepared, StudyError};
use basis::records::{Plane, Series, Summary};
use farm::case::Run;
use farm::{Air, Farm, FarmError, Unrecorded};
use flow::fields::PlaneAverage;
use std::time::Instant;

/// What one run left.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResult {
    /// Its channels over time, spin-up included.
    pub series: Series,
    /// Its numbers over the analysed time.
    pub summary: Summary,
    /// The wind on planes, averaged over the analysed time; none in prescribed wind.
    pub mean_planes: Vec<Plane>,
    /// The same at the last instant.
    pub last_planes: Vec<Plane>,
}

impl Ready {
    /// Makes all runs of the case, in its order, each with its gains over the run that it compares with.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn run_all(&self) -> Result<Vec<RunResult>, StudyError> {
        let runs = &self.prepared.case.runs;
        let mut results = Vec::with_capacity(runs.len());
        for run in runs {
            results.push(self.make(run)?);
        }
        for index in 0..runs.len() {
            let Some(other) = gains::compared(&self.prepared, index) else { continue };
            let columns = |series: &Series| Columns::of_series(series.clone(), &self.prepared);
            let (mut own, mut there) =
                (columns(&results[index].series), columns(&results[other].series));
            let summary = &mut results[index].summary;
            gains::add(summary, (&runs[index], &mut own), (&runs[other], &mut there))?;
        }
        Ok(results)
    }

    /// Makes the run called `name`; it has no gains over another.
    ///
    /// # Errors
    /// [`StudyError::UnknownRun`], and what ends a run.
    pub fn run(&self, name: &str) -> Result<RunResult, StudyError> {
        let runs = &self.prepared.case.runs;
        let run = runs.iter().find(|run| run.name == name).ok_or_else(|| {
            let known = runs.iter().map(|run| run.name.clone()).collect();
            StudyError::UnknownRun { name: name.to_owned(), known }
        })?;
        self.make(run)
    }

    fn make(&self, run: &Run) -> Result<RunResult, StudyError> {
        let started = Instant::now();
        let prepared = &self.prepared;
        let mut farm = self.farm(run)?;
        let mut kept = Kept::new(prepared, run, &farm);
        while farm.step() < prepared.plan.n_steps {
            kept.advance(&mut farm).map_err(|source| StudyError::Diverged {
                run: run.name.clone(),
                source: Box::new(source),
                steadier: prepared.case.flow.solver.steadier,
                checkpoint: None,
                series: None,
            })?;
        }
        let (series, mean_planes) = kept.complete();
        let peak_memory = formats::machine::peak_memory();
        let cost = cost(&prepared.plan, &farm, started.elapsed().as_secs_f64(), peak_memory);
        let mut columns = Columns::of_series(series, prepared);
        let summary = summarise(prepared, run, &mut columns, &left(&farm), cost)?;
        let last_planes = match farm.flow().fields() {
            Some(fields) => slices::of(prepared).iter().map(|slice| slice.plane(fields)).collect(),
            None => Vec::new(),
        };
        Ok(RunResult { series: columns.into_series(), summary, mean_planes, last_planes })
    }
}

/// What is kept of a run under way.
struct Kept<'a> {
    prepared: &'a Prepared,
    rows: Rows,
    series: Series,
    averages: Vec<PlaneAverage>,
}

impl<'a> Kept<'a> {
    fn new(prepared: &'a Prepared, run: &Run, farm: &Farm<Air>) -> Self {
        let rows = Rows::new(prepared, run, farm);
        let n_rows = (prepared.plan.n_steps / prepared.plan.row_stride) as usize;
        let channels = rows.channels().iter();
        let names: Vec<String> =
            channels.map(|channel| channel.name.clone().into_owned()).collect();
        let columns = vec![Vec::with_capacity(n_rows); names.len()];
        let fields = farm.flow().fields();
        let averages = fields.map_or(Vec::new(), |fields| mean_planes::averages(prepared, fields));
        Self { prepared, rows, series: Series { names, columns }, averages }
    }

    /// One step of `farm`.
    fn advance(&mut self, farm: &mut Farm<Air>) -> Result<(), FarmError> {
        let step = farm.step() + 1;
        if series::schedule(self.prepared).is_due(step) {
            self.rows.start(farm);
            farm.advance(&mut self.rows)?;
            let row = self.rows.complete(farm);
            for (column, value) in self.series.columns.iter_mut().zip(row) {
                column.push(*value);
            }
        } else {
            farm.advance(&mut Unrecorded)?;
        }
        if let Some(fields) = farm.flow().fields()
            && mean_planes::schedule(self.prepared).is_due(step)
        {
            self.averages.iter_mut().for_each(|average| average.add(fields));
        }
        Ok(())
    }

    /// Series and mean planes.
    fn complete(self) -> (Series, Vec<Plane>) {
        let averages = self.averages.iter().filter(|average| average.n_instants() > 0);
        (self.series, averages.map(PlaneAverage::mean).collect())
    }
}
