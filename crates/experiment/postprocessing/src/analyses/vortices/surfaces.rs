//! Isosurfaces of Q, or of λ₂, of volumes, bin by bin.

use super::{BEYOND, CRITERION, Found, LEVEL, SURFACES};
use crate::PostprocessingError;
use crate::analyses::Request;
use crate::wake_fields::{conditions, refused, settings};
use analysis::grids::widened;
use analysis::isosurface::{Isosurface, isosurface};
use analysis::vortices::{gradients, lambda_2, q_criterion, vorticity};
use basis::records::Grid;
use formats::vtk::write_surface;
use report::{SurfaceFigure, SurfacePanel};
use std::path::Path;

/// Share of the greatest value whose surface is drawn where none is asked for (–).
const SHARE: f64 = 0.05;
/// Surfaces that are drawn (–).
const N_DRAWN: usize = 4;

/// What tells vortices from shear.
#[derive(Clone, Copy, PartialEq)]
enum Criterion {
    Q,
    /// −λ₂, so that it is positive in vortices.
    Lambda2,
}

impl Criterion {
    fn of(request: &Request) -> Self {
        match request.text(CRITERION.name) {
            Some("lambda2") => Self::Lambda2,
            _ => Self::Q,
        }
    }

    /// Its name in texts, and in names of files.
    fn names(self) -> [&'static str; 2] {
        match self {
            Self::Q => ["Q", "q"],
            Self::Lambda2 => ["−λ₂", "lambda2"],
        }
    }
}

/// The criterion (1/s²), size of the vorticity (1/s) and velocity downwind (m/s) of a bin.
struct Turning {
    criterion: Vec<f64>,
    vorticity: Vec<f64>,
    u: Vec<f64>,
}

impl Turning {
    fn of(found: &Found, index: usize, by: Criterion) -> Result<Self, PostprocessingError> {
        let mean = found.averaged.bin(index)?.mean;
        let velocity = mean.each_ref().map(|values| widened(values));
        let gradients = gradients(found.averaged.grid(), &velocity);
        let size = |gradient| vorticity(gradient).iter().map(|w| w * w).sum::<f64>().sqrt();
        let [u, ..] = velocity;
        Ok(Self {
            criterion: match by {
                Criterion::Q => gradients.iter().map(q_criterion).collect(),
                Criterion::Lambda2 => gradients.iter().map(|one| -lambda_2(one)).collect(),
            },
            vorticity: gradients.iter().map(size).collect(),
            u,
        })
    }
}

/// Writes the surfaces that `request` asks for; gives the figure of some of them where it is `drawn`, and
/// what must be said.
///
/// # Errors
/// [`PostprocessingError`].
pub(crate) fn made(
    request: &Request,
    found: &Found,
    drawn: bool,
) -> Result<(Option<SurfaceFigure>, Option<String>), PostprocessingError> {
    let folder = request.text(SURFACES.name).map(Path::new);
    let is_volume = found.averaged.grid().spanned().len() == 3;
    if !is_volume && folder.is_some() {
        let fix = "name a volume, such as `--field volumes` of a run with output.volume_interval";
        return Err(refused(
            &found.averaged.path,
            "spans no volume, of which surfaces are made",
            fix,
        ));
    }
    if !is_volume || folder.is_none() && !drawn {
        return Ok((None, None));
    }
    let by = Criterion::of(request);
    let level = level(request, found, by)?;
    let n = found.frames.len();
    let (mut panels, mut n_triangles) = (Vec::new(), 0);
    for index in 0..n {
        let is_drawn = index % n.div_ceil(N_DRAWN).max(1) == 0;
        if !is_drawn && folder.is_none() {
            continue;
        }
        let turning = Turning::of(found, index, by)?;
        let surface = isosurface(found.averaged.grid(), &turning.criterion, level);
        if let Some(folder) = folder {
            let values = [
                ("u", &surface.values(&turning.u)[..]),
                ("vorticity", &surface.values(&turning.vorticity)),
            ];
            let path = folder.join(format!("{}-{index:03}.vtp", by.names()[1]));
            write_surface(&path, &surface.points, &surface.triangles, &values, None)?;
            n_triangles += surface.triangles.len();
        }
        if is_drawn {
            panels.push(panel(found, index, surface));
        }
    }
    let scale = found.averaged.setting.diameter / found.averaged.setting.wind_speed;
    let told = folder.map(|folder| {
        format!(
            "{n} isosurfaces of {} = {:.3} (U/D)² with {n_triangles} triangles written to {}",
            by.names()[0],
            level * scale * scale,
            folder.display()
        )
    });
    Ok((Some(figure(found, by, level * scale * scale, panels)), told))
}

/// The criterion on the surfaces (1/s²).
fn level(request: &Request, found: &Found, by: Criterion) -> Result<f64, PostprocessingError> {
    let setting = &found.averaged.setting;
    let unit = (setting.wind_speed / setting.diameter).powi(2);
    if request.text(LEVEL.name).is_some() {
        let level = settings::positive(request, &LEVEL, 1.0)? * unit;
        let most = greatest(found, by, f64::NEG_INFINITY, level)?;
        if level < most {
            return Ok(level);
        }
        let [name, _] = by.names();
        let problem = format!(
            "has no place where {name} is more than {} (U/D)²: the greatest is {:.3}",
            level / unit,
            most / unit
        );
        return Err(refused(&found.averaged.path, problem, "give a smaller value with --level"));
    }
    let most = greatest(found, by, setting.hub[0] + BEYOND * setting.diameter, f64::INFINITY)?;
    if most > 0.0 {
        return Ok(SHARE * most);
    }
    let fix = "give a value for the surfaces with --level";
    Err(refused(&found.averaged.path, "has no place where turning outweighs straining", fix))
}

/// The greatest criterion of all bins from `x` (m) on (1/s²), at least zero; of the bins up to the first that
/// has more than `enough`.
fn greatest(found: &Found, by: Criterion, x: f64, enough: f64) -> Result<f64, PostprocessingError> {
    let grid = found.averaged.grid();
    let mut greatest = 0.0_f64;
    for index in 0..found.frames.len() {
        let all = Turning::of(found, index, by)?.criterion;
        let beyond = |place: usize| grid.coordinate(0, grid.place(place)[0]) >= x;
        let places = (0..all.len()).filter(|place| beyond(*place) && all[*place].is_finite());
        greatest = places.fold(greatest, |most, place| most.max(all[place]));
        if greatest > enough {
            break;
        }
    }
    Ok(greatest)
}

fn panel(found: &Found, index: usize, surface: Isosurface) -> SurfacePanel {
    let setting = &found.averaged.setting;
    let over = |point: [f64; 3]| {
        std::array::from_fn(|axis| (point[axis] - setting.hub[axis]) / setting.diameter)
    };
    SurfacePanel {
        title: found.averaged.name_of_bin(index),
        points: surface.points.into_iter().map(over).collect(),
        triangles: surface.triangles,
    }
}

fn figure(found: &Found, by: Criterion, level: f64, panels: Vec<SurfacePanel>) -> SurfaceFigure {
    let (setting, grid): (_, &Grid) = (&found.averaged.setting, found.averaged.grid());
    let end = |axis: usize, step: usize| {
        (grid.coordinate(axis, step) - setting.hub[axis]) / setting.diameter
    };
    SurfaceFigure {
        name: "vortices-surfaces".to_owned(),
        title: "Where turning outweighs straining".to_owned(),
        caption: format!(
            "Isosurfaces of {} = {level:.3} (U/D)². {}; {}.",
            by.names()[0],
            conditions(setting),
            found.averaged.samples()
        ),
        along: ["x/D", "y/D", "z/D"].map(str::to_owned),
        bounds: [0, 1, 2].map(|axis| [end(axis, 0), end(axis, grid.n_points[axis] - 1)]),
        panels,
    }
}
