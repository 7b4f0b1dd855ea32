//! Wind of a file that enters a domain: what it must cover, and what it takes.

use super::at_inlet::TURBULENCE_MEMORY;
use super::{Site, inflow_share, profile};
use crate::case::{Beyond, Case};
use crate::plan::MAXIMUM_LATTICE_SPEED;
use crate::solvers::WindSource;
use flow::inflow::recorded::Entry;
use flow::inflow::{InflowError, PlaneGrid, Planes, RecordedInflow};
use std::ops::ControlFlow;
use thiserror::Error;

/// Mean speed of a file over `wind.speed`, less one, beyond which a reader must know (–).
const SPEED_TO_WARN: f64 = 0.05;
/// Room above the fastest free stream of a plan that a file's mean wind may take (–).
const SLACK: f64 = 0.02;

/// Planes of wind that a case takes in at its inlet, as far as they are known without being read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorded {
    /// Where the points are, and how the planes follow each other.
    pub grid: PlaneGrid,
    /// What blows beyond the grid; none where nothing does.
    pub beyond: Option<Beyond>,
    /// Memory of what the run needs of it (bytes).
    pub memory: u64,
}

/// Why the wind of a file cannot enter a domain.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ForeignWind {
    /// The domain is larger than the grid.
    #[error(
        "the file covers y {left:.1} to {right:.1} m and z up to {top:.1} m, the domain needs y {need_left:.1} to {need_right:.1} m and z \
         up to {need_top:.1} m: write wind.beyond_planes = \"repeat\" (Mann's boxes repeat to the sides and upwards), \"mean\" (the mean \
         wind blows there, without turbulence) or \"hold\" (the wind of the edge), make a wider file, or lower flow.width_diameters \
         and flow.height_diameters",
        left = across[0], right = across[1], need_left = needed_across[0], need_right = needed_across[1]
    )]
    Small {
        /// What the grid spans along y (m).
        across: [f64; 2],
        /// Its highest point (m).
        top: f64,
        /// What the domain needs along y (m).
        needed_across: [f64; 2],
        /// The highest point that it needs (m).
        need_top: f64,
    },
    /// The record is over before the run.
    #[error(
        "its record of {length:.1} s does not repeat, and the run needs {needed:.1} s of it: it lasts {duration:.1} s, and the \
         inlet is {upstream:.0} m upstream of where the record begins; make a longer file, or lower time.duration"
    )]
    Short {
        /// Length of the record (s).
        length: f64,
        /// Time into the record that is needed (s).
        needed: f64,
        /// Duration of the run (s).
        duration: f64,
        /// From the first plane at time zero to the inlet (m).
        upstream: f64,
    },
    /// It blows faster than the lattice carries.
    #[error(
        "it blows with {found:.2} m/s at hub height, {lattice:.3} cells per step, and {most} are the most: write wind.speed = {found:.2}, which \
         the step is made for, or lower flow.step"
    )]
    Fast {
        /// Mean speed at hub height (m/s).
        found: f64,
        /// The same in cells per step (–).
        lattice: f64,
        /// What the plan carries (–).
        most: f64,
    },
    /// What the run needs of it is too much.
    #[error(
        "the run needs {needed:.1} GiB of its planes in memory, and {most:.0} GiB are the most: take a coarser or narrower file, or lower \
         time.duration"
    )]
    Large {
        /// What is needed (GiB).
        needed: f64,
        /// What is allowed (GiB).
        most: f64,
    },
    /// Its grid makes no sense.
    #[error(transparent)]
    Grid(#[from] InflowError),
}

/// Whether the wind that enters the domain of `case` comes from recorded planes.
pub fn enters_from_file(case: &Case) -> bool {
    case.wind_source() == WindSource::AtInlet && case.wind.brings_planes()
}

impl Recorded {
    /// The file with `planes` as `site` takes it in.
    ///
    /// # Errors
    /// [`ForeignWind`] says what does not fit, and how to fix it.
    pub fn new(site: &Site, planes: &dyn Planes) -> Result<Self, ForeignWind> {
        let grid = planes.grid();
        grid.check()?;
        let beyond = beyond(site, planes);
        if beyond.is_none() && reaches_beyond(site, &grid) {
            let [needed_across, [_, need_top]] = needed(site);
            let (across, top) = (grid.across(), grid.up()[1]);
            return Err(ForeignWind::Small { across, top, needed_across, need_top });
        }
        let lattice = grid.speed * site.plan.base_interval() / site.plan.spacing;
        if lattice > MAXIMUM_LATTICE_SPEED * (1.0 + SLACK) {
            let most = MAXIMUM_LATTICE_SPEED;
            return Err(ForeignWind::Fast { found: grid.speed, lattice, most });
        }
        let entry = entry(site, &grid);
        let memory = entry.memory(&grid).map_err(|error| match error {
            InflowError::Ended { length, time } => {
                let duration = entry.duration;
                let upstream = entry.origin_x - entry.extent[0];
                ForeignWind::Short { length, needed: time, duration, upstream }
            }
            error => error.into(),
        })?;
        // A temperature beside three components.
        let memory = if site.surroundings.is_some() { memory / 3 * 4 } else { memory };
        if memory > TURBULENCE_MEMORY {
            let [needed, most] =
                [memory, TURBULENCE_MEMORY].map(|bytes| bytes as f64 / 2_f64.powi(30));
            return Err(ForeignWind::Large { needed, most });
        }
        Ok(Self { grid, beyond, memory })
    }

    /// What a reader of the numbers must know of it in the domain of `site`.
    pub fn warnings(&self, site: &Site) -> Vec<String> {
        let mut warnings = Vec::new();
        let key = if site.surroundings.is_some() { "precursor" } else { "planes" };
        let (found, speed) = (self.grid.speed, site.case.wind.speed);
        if (found / speed - 1.0).abs() > SPEED_TO_WARN {
            warnings.push(format!(
                "wind.{key} blows with {found:.2} m/s at hub height, and wind.speed = {speed} m/s: Strouhal numbers, the step and the rotors' \
                 first speeds are those of wind.speed"
            ));
        }
        let entry = entry(site, &self.grid);
        let (blown_out, spin_up) = (entry.blown_out(&self.grid), site.case.time.spin_up);
        if blown_out > spin_up {
            warnings.push(format!(
                "wind.{key} does not repeat: at the start the last {:.0} m of the domain, from x = {:.0} m on, hold its first plane alone, the same \
                 all along the wind; at the mean speed that air is blown out after {blown_out:.0} s, and time.spin_up = {spin_up} s is shorter: \
                 raise it to {:.0} s",
                entry.extent[1] - entry.origin_x,
                entry.origin_x,
                blown_out.ceil()
            ));
        }
        let is_chosen = site.case.wind.beyond_planes.is_some();
        if self.beyond == Some(Beyond::Repeat) && !is_chosen && reaches_beyond(site, &self.grid) {
            warnings.push(
                "the domain is larger than the box of wind.planes, which is repeated to the sides and upwards, as Mann's boxes are made for: \
                 write wind.beyond_planes where it shall not be"
                    .to_owned(),
            );
        }
        warnings
    }
}

/// The wind of `planes` as it enters the domain of `site`, all of it read now.
///
/// # Errors
/// [`InflowError`], [`InflowError::BrokenOff`] after a break of `progress`.
pub(super) fn entering(
    site: &Site,
    planes: Box<dyn Planes>,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<RecordedInflow, InflowError> {
    let entry = entry(site, &planes.grid());
    // Where nothing is chosen the grid covers all, up to the rounding of its places.
    let beyond = beyond(site, &*planes).unwrap_or(Beyond::Hold);
    let share = inflow_share(site.case, site.plan);
    let profile = match site.surroundings {
        Some(surroundings) => surroundings.profile_at_ground(site.case, site.plan),
        None => profile(site.case, site.plan),
    };
    let goes_on = |done: f64| progress(done).is_continue();
    let inflow = RecordedInflow::read(planes, entry, profile, beyond, &goes_on)?;
    let inflow = inflow.with_share_of_mean(share);
    Ok(match site.surroundings {
        Some(surroundings) => inflow.with_column_aloft(surroundings.column().clone()),
        None => inflow,
    })
}

/// What blows beyond the grid of `planes`: what the case says, or else what the file is made for, if
/// anything.
fn beyond(site: &Site, planes: &dyn Planes) -> Option<Beyond> {
    let made_for = planes.repeats_across().then_some(Beyond::Repeat);
    // What a precursor's air does above its planes is known, and beside them it is alike in the mean.
    let made_for = made_for.or(site.surroundings.map(|_| Beyond::Mean));
    site.case.wind.beyond_planes.or(made_for)
}

/// How the planes of `grid` lie in the domain of `site`: where prescribed wind would have them, so that the
/// first turbine meets them at the same time.
fn entry(site: &Site, grid: &PlaneGrid) -> Entry {
    let plan = site.plan;
    // The inlet stands before the first cell.
    let inlet = plan.origin.x - 0.5 * plan.spacing;
    let outlet = plan.origin.x + (plan.n_cells[0] as f64 + 0.5) * plan.spacing;
    let extent = [inlet, outlet];
    Entry { origin_x: grid.origin_x(), extent, duration: site.case.time.duration }
}

/// What the middles of the cells of `site` span along y and z (m).
fn needed(site: &Site) -> [[f64; 2]; 2] {
    let plan = site.plan;
    let span =
        |low: f64, n: usize| [low + 0.5 * plan.spacing, low + (n as f64 - 0.5) * plan.spacing];
    [span(plan.origin.y, plan.n_cells[1]), span(plan.origin.z, plan.n_cells[2])]
}

/// Whether the domain of `site` is wider or higher than `grid`.
fn reaches_beyond(site: &Site, grid: &PlaneGrid) -> bool {
    let [[left, right], [_, top]] = needed(site);
    let (across, up) = (grid.across(), grid.up());
    // Rounding of a grid stored in single precision is no gap.
    let slack = 1e-3 * grid.spacing[0].min(grid.spacing[1]);
    left < across[0] - slack || right > across[1] + slack || top > up[1] + slack
}
