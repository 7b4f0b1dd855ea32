//! Outer shape and polars of a windIO file: airfoils at a few places, blended by relative thickness between
//! them.

use super::node::{Curve, Node};
use crate::turbine_file::{Airfoils, Blade, PolarTable, TurbineFileError};
use std::f64::consts::PI;

/// How far a polar of the file may end from ±180° (rad); it is extended to there.
const END_GAP: f64 = 0.02;

/// Stations of a blade and points of a polar at most (–): each station gets a polar with the points of two
/// airfoils, and more of both would fill the memory.
const MOST_STATIONS: usize = 500;
const MOST_ANGLES: usize = 2000;

/// Which polar of an airfoil to take; the first of those that fit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolarChoice {
    /// Words in its `configuration`, such as `fully turbulent`; any where absent.
    pub configuration: Option<String>,
    /// Reynolds number to which its own comes nearest (–); any where absent.
    pub reynolds_number: Option<f64>,
}

/// What the file says of a blade.
pub(super) struct BladeShape {
    pub(super) shape: Blade,
    pub(super) airfoils: Airfoils,
    /// Root to tip along the pitch axis (m).
    pub(super) length: f64,
}

/// An airfoil of the file with the polar that is taken.
struct Airfoil {
    name: String,
    /// Which polar it is; none where there is but one.
    taken: Option<String>,
    thickness: f64,
    center: f64,
    reynolds_number: f64,
    lift: Curve,
    drag: Curve,
    moment: Curve,
}

pub(super) fn read(
    shape: &Node,
    airfoils: &Node,
    source: &str,
    choice: &PolarChoice,
    notes: &mut Vec<String>,
) -> Result<BladeShape, TurbineFileError> {
    let curve = |key: &str| Curve::read(&shape.get(key)?);
    let (chord, twist, pitch_axis) = (curve("chord")?, curve("twist")?, curve("pitch_axis")?);
    if chord.grid().len() > MOST_STATIONS {
        let expected = format!("at most {MOST_STATIONS} points");
        return Err(shape.get("chord")?.error(&expected, "fewer points"));
    }
    let axis = shape.get("reference_axis")?;
    let axis = |key: &str| Curve::read(&axis.get(key)?);
    let (x, y, z) = (axis("x")?, axis("y")?, axis("z")?);
    let positions = shape.get("airfoil_position")?;
    let grid = positions.get("grid")?.numbers()?;
    let labels = positions.get("labels")?.items()?;
    let placed: Vec<Airfoil> =
        labels.iter().map(|label| airfoil(label, airfoils, choice)).collect::<Result<_, _>>()?;
    notes.extend(choices(&placed));
    if grid.len() != placed.len() || grid.is_empty() {
        return Err(positions.error("as many labels as grid points", "one label per grid point"));
    }
    let thickness = match shape.optional("rthick") {
        Some(node) => Some(Curve::read(&node)?),
        None => None,
    };
    let mut stations = Vec::new();
    let mut polars = Vec::new();
    for (number, place) in chord.grid().iter().enumerate() {
        let blend = blend_at(*place, &grid, &placed, thickness.as_ref());
        let name = format!("station-{:02}", number + 1);
        let (low, high) = (&placed[blend.low], &placed[blend.high]);
        let center = low.center + blend.share * (high.center - low.center);
        // Aerodynamic centre off the pitch axis, along the chord towards the trailing edge.
        let offset = (center - pitch_axis.at(*place)) * chord.at(*place);
        let (sine, cosine) = twist.at(*place).sin_cos();
        stations.push((
            z.at(*place) - z.at(0.0),
            chord.at(*place),
            twist.at(*place).to_degrees(),
            -(x.at(*place) + offset * sine),
            y.at(*place) + offset * cosine,
            name.clone(),
        ));
        polars.push(polar(name, low, high, blend.share));
    }
    let length = z.last() - z.at(0.0);
    Ok(BladeShape {
        shape: Blade { source: source.to_owned(), stations },
        airfoils: Airfoils {
            source: format!("{source}, blended by relative thickness at each station"),
            polar: polars,
        },
        length,
    })
}

struct Blend {
    low: usize,
    high: usize,
    share: f64,
}

/// The two airfoils around `place` and the share of the second.
fn blend_at(place: f64, grid: &[f64], placed: &[Airfoil], thickness: Option<&Curve>) -> Blend {
    let high = grid.partition_point(|point| *point < place).clamp(1, grid.len().max(2) - 1);
    let (low, high) = (high - 1, high.min(grid.len() - 1));
    let along =
        if grid[high] > grid[low] { (place - grid[low]) / (grid[high] - grid[low]) } else { 0.0 };
    let (thick, thin) = (placed[low].thickness, placed[high].thickness);
    let share = match thickness {
        Some(curve) if (thin - thick).abs() > 1e-9 => (curve.at(place) - thick) / (thin - thick),
        _ => along,
    };
    Blend { low, high, share: share.clamp(0.0, 1.0) }
}

fn airfoil(
    label: &Node,
    airfoils: &Node,
    choice: &PolarChoice,
) -> Result<Airfoil, TurbineFileError> {
    let name = label.text()?;
    let items = airfoils.items()?;
    let known =
        |item: &&Node| item.optional("name").is_some_and(|node| node.text().ok() == Some(name));
    let item = items
        .iter()
        .find(known)
        .ok_or_else(|| label.error("the name of an airfoil", "a name of the list airfoils"))?;
    let polars = item.get("polars")?;
    let list = polars.items()?;
    let polar = chosen(&polars, &list, choice)?;
    let configuration = configuration(polar);
    let taken = (list.len() > 1).then(|| {
        let re = polar.number("re")?;
        Ok::<_, TurbineFileError>(format!("\"{configuration}\" at Re {re:.3e} (of {})", list.len()))
    });
    Ok(Airfoil {
        name: name.to_owned(),
        taken: taken.transpose()?,
        thickness: item.number("relative_thickness")?,
        center: item.number("aerodynamic_center")?,
        reynolds_number: polar.number("re")?,
        lift: full_turn(&polar.get("c_l")?)?,
        drag: full_turn(&polar.get("c_d")?)?,
        moment: full_turn(&polar.get("c_m")?)?,
    })
}

/// What a polar says of its flow; empty where it says nothing.
fn configuration(polar: &Node) -> String {
    let node = polar.optional("configuration");
    node.and_then(|node| node.text().ok().map(str::to_owned)).unwrap_or_default()
}

/// The one of the polars in `list` that `choice` takes; of a single one, that one.
fn chosen<'a, 'n>(
    polars: &Node,
    list: &'a [Node<'n>],
    choice: &PolarChoice,
) -> Result<&'a Node<'n>, TurbineFileError> {
    let words = choice.configuration.as_ref().map(|words| words.to_lowercase());
    let fits = |polar: &&Node| {
        let own = configuration(polar).to_lowercase();
        list.len() == 1 || words.as_ref().is_none_or(|words| own.contains(words.as_str()))
    };
    let fitting: Vec<&Node> = list.iter().filter(fits).collect();
    let Some(&first) = fitting.first() else {
        let known: Vec<String> =
            list.iter().map(|polar| format!("\"{}\"", configuration(polar))).collect();
        let expected = match &words {
            Some(words) => format!(
                "a polar whose configuration has \"{words}\"; there are {}",
                known.join(", ")
            ),
            None => "at least one polar".to_owned(),
        };
        return Err(polars.error(&expected, "a polar, or take another with --polars"));
    };
    let Some(wanted) = choice.reynolds_number else { return Ok(first) };
    let mut nearest = (f64::INFINITY, first);
    for polar in fitting {
        let distance = (polar.number("re")? / wanted).ln().abs();
        if distance < nearest.0 {
            nearest = (distance, polar);
        }
    }
    Ok(nearest.1)
}

/// Which polars were taken of the airfoils `placed` that have several: a sentence for each kind.
fn choices(placed: &[Airfoil]) -> Vec<String> {
    let mut kinds: Vec<(&str, Vec<&str>)> = Vec::new();
    for airfoil in placed {
        let Some(taken) = airfoil.taken.as_deref() else { continue };
        match kinds.iter_mut().find(|(known, _)| *known == taken) {
            Some((_, names)) if names.contains(&airfoil.name.as_str()) => {}
            Some((_, names)) => names.push(&airfoil.name),
            None => kinds.push((taken, vec![&airfoil.name])),
        }
    }
    let told = |(taken, names): (&str, Vec<&str>)| {
        format!("polars: {taken} of {}; --polars and --reynolds take others", names.join(", "))
    };
    kinds.into_iter().map(told).collect()
}

/// A curve over the full turn; published ones may end a hair before it.
fn full_turn(node: &Node) -> Result<Curve, TurbineFileError> {
    let curve = Curve::read(node)?;
    let grid = curve.grid();
    if grid.len() > MOST_ANGLES {
        let expected = format!("at most {MOST_ANGLES} angles");
        return Err(node.get("grid")?.error(&expected, "fewer angles"));
    }
    let (first, last) = (grid[0], grid[grid.len() - 1]);
    if first > -PI + END_GAP || last < PI - END_GAP {
        return Err(node
            .get("grid")?
            .error("angles from -3.1416 to 3.1416 rad", "a polar over the full turn"));
    }
    Ok(curve)
}

/// Polar with `share` of `high` in it, at all angles that either has.
fn polar(name: String, low: &Airfoil, high: &Airfoil, share: f64) -> PolarTable {
    let mut angles: Vec<f64> = [low, high]
        .iter()
        .flat_map(|airfoil| [&airfoil.lift, &airfoil.drag, &airfoil.moment])
        .flat_map(|curve| curve.grid().iter().copied())
        .filter(|angle| angle.abs() < PI - END_GAP)
        .chain([-PI, 0.0, PI])
        .collect();
    angles.sort_by(f64::total_cmp);
    // Printed to four decimals of a degree, closer angles would fall together.
    angles.dedup_by(|next, before| *next - *before < 1e-4);
    let blend = |curve: fn(&Airfoil) -> &Curve, angle: f64| {
        let (from, to) = (curve(low).at(angle), curve(high).at(angle));
        from + share * (to - from)
    };
    let row = |angle: f64| {
        [
            angle.to_degrees(),
            blend(|airfoil| &airfoil.lift, angle),
            blend(|airfoil| &airfoil.drag, angle),
            blend(|airfoil| &airfoil.moment, angle),
        ]
    };
    let reynolds = low.reynolds_number + share * (high.reynolds_number - low.reynolds_number);
    PolarTable {
        name,
        reynolds_number: Some(reynolds),
        unsteady: None,
        table: angles.into_iter().map(row).collect(),
    }
}
