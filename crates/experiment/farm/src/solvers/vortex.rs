//! `vortex`: lifting lines shed free vortices into the wind.

mod remarks;
mod shear;

use super::prescribed::{planes_objections, turbulence_objections, uniform_objections};
use super::{Alone, Objection, PRESCRIBED, SolverError, SolverKind, Start, WindSource};
use crate::air::Air;
use crate::case::{Case, Flow, Wind};
use crate::plan::{self, Layout, Plan, PlanError, Turning};
use crate::self_check::Tunnel;
use crate::wind;
use basis::Vector3;
use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Key, Values, above, from, key};
use flow::inflow::{MeanProfile, Planes, PrescribedWind};
use flow::vortex::{
    Accuracy, BodyWakes, Cores, FreeWake, MeanShear, Points, Resolution, WakeSettings,
};
use std::sync::Arc;

/// Speed at which a wake is carried at least, over the wind's (–): rows are there for so slow a wake.
const SLOWEST: f64 = 0.4;
/// Usual speed of a wake over the wind's (–).
const USUAL: f64 = 0.65;
/// Longest wake of the check before a study (diameters).
const LONGEST_CHECKED: f64 = 1.0;
/// Greatest thrust coefficient for which a wake is followed by momentum theory (–).
const MOST_THRUST: f64 = 0.96;
/// Radius of a hub over the rotor's diameter, at least (–): rings of nacelles follow one another at half of
/// it, and come closer in their own wake.
const SMALLEST_HUB: f64 = 0.01;
const CLOSEST_RINGS: f64 = 0.5 / 3.0;
/// Blades of a turbine, before turbines are known (–).
const N_BLADES: usize = 3;

/// What a free wake cannot show.
const LIMITS: &str = "Free vortices know no eddies smaller than themselves: the wind carries a wake about, but it neither breaks down in ambient turbulence \
                      nor mixes with the air around it as a wake does beyond some 4 diameters, where its deficit lasts too long. Take the far wake, and the power of \
                      turbines in it, from flow.solver = “lattice”. The shear of the mean wind is felt by blades, not by wakes, whose rotors do not bend it (flow.wake_shear).";

/// Keys of `[flow]` for a free wake.
static KEYS: [Key; 15] = [
    key(
        "steps_per_turn",
        from(8.0, 720.0),
        "–",
        Value("60"),
        "Steps to a turn of the fastest rotor, where `step` is left out.",
    ),
    key(
        "wake_length_diameters",
        above(0.0, 40.0),
        "D",
        Value("6"),
        "Length of the wake behind each rotor; its last 15 % fade. Time grows a little faster than it.",
    ),
    key(
        "wake_beyond_last_diameters",
        from(0.5, 40.0),
        "D",
        Otherwise("as far as `wake_length_diameters`"),
        "All blades' wakes end so far behind the last rotor, however long they would be: the last one's then needs no more of it than its own rotor feels. An endless wake induces more: at a thrust coefficient of 0.75 the last rotor has 2.6 % too much power with 2, 1.7 % with 2.5, 0.7 % with 4.",
    ),
    key(
        "near_wake_diameters",
        above(0.0, 40.0),
        "D",
        Value("0.25"),
        "Length of wake that keeps every step and every blade element.",
    ),
    key(
        "far_wake_filaments",
        Holds::Whole { least: 2, most: 33 },
        "–",
        Value("9"),
        "Trailing vortices of each blade further down.",
    ),
    key(
        "far_wake_steps",
        Holds::Whole { least: 1, most: 8 },
        "–",
        Value("2"),
        "Steps to a segment further down.",
    ),
    key(
        "core_widths",
        above(0.0, 5.0),
        "–",
        Value("0.23"),
        "Radius of a vortex' core where it leaves the blade, over the width of the blade elements there. Wider ones hide from a blade what leaves it close by (0.3: 1 % too much power), narrower ones are single vortices where a sheet is meant.",
    ),
    key(
        "core_growth",
        from(0.0, 0.1),
        "–",
        Value("0.0001"),
        "Squire's constant a₁: cores grow as √(4 α (ν + a₁ |Γ|) t). Bhagwat and Leishman found 0.00006 to 0.0002.",
    ),
    key(
        "core_strain",
        Holds::Choice(&["volume", "none"]),
        "",
        Value("\"volume\""),
        "What stretching does to cores. `volume`: they keep it, and become thinner where their vortex is stretched. `none`: nothing.",
    ),
    key(
        "nacelle_wake_diameters",
        from(0.0, 40.0),
        "D",
        Value("2"),
        "Length of the wake of each hub and nacelle, whose drag leaves vortex rings behind; its last 15 % fade. 0: they leave none.",
    ),
    key(
        "ground_effect",
        Holds::Choice(&["image", "none"]),
        "",
        Value("\"image\""),
        "`image`: the air does not pass the ground, every vortex has an image below it. `none`: there is no ground.",
    ),
    key(
        "wake_shear",
        Holds::Choice(&["carried", "left-out"]),
        "",
        Value("\"left-out\""),
        "What the shear and veer of the mean wind do to wakes. `left-out`: wakes are carried by the wind less the difference of its mean at their height from that at their own hub's. `carried`: by the wind where they are, faster above than below; they then lean and rise by half a diameter in four, which wakes in air do not, where a rotor bends the vorticity of the shear. The mean is that of `wind.speed`, `wind.shear_exponent` or `wind.roughness_length`, and `wind.veer_deg_per_m`; of wind from a file it is the file's own: that of each row of points of `wind.planes` over record and width, for which the file is read once more, and that of `wind.table` over the run.",
    ),
    key(
        "tree_degree",
        Holds::Whole { least: 2, most: 6 },
        "–",
        Value("4"),
        "Degree of the harmonics by which vortices are felt from afar.",
    ),
    key(
        "tree_opening",
        from(0.0, 0.9),
        "–",
        Value("0.5"),
        "A box of vortices is far where its radius is less than this share of its distance; 0 sums them one by one.",
    ),
    key(
        "points_per_diameter",
        from(4.0, 200.0),
        "–",
        Value("16"),
        "Points of planes and volumes across the first rotor. They show the wake; nothing is computed on them.",
    ),
];

/// Lifting lines that shed free vortices.
pub static VORTEX: SolverKind = SolverKind {
    name: "vortex",
    about: "free-vortex wakes of lifting lines in prescribed wind of any kind; turbines are in each other's wakes",
    limits: LIMITS,
    keys: &KEYS,
    wind: WindSource::Any,
    stands_in_atmosphere: false,
    resolves_induction: true,
    has_wakes: true,
    uses_bound_vortices: true,
    most_filaments: Some(|case, plan| of_all(case, plan).most_segments() as u64),
    needs_self_check: true,
    tunnel,
    equivalent_speed: with_an_end,
    objections,
    warnings: remarks::warnings,
    plan: laid_out,
    reach: |case, plan| beyond_last(&case.flow.values) * plan.diameter,
    memory: |case, plan| FreeWake::memory_of(&of_all(case, plan)),
    less_memory: "flow.wake_length_diameters, flow.wake_beyond_last_diameters, flow.near_wake_diameters, flow.far_wake_filaments or flow.steps_per_turn",
    steadier: "a shorter flow.step (or a greater flow.steps_per_turn), wider cores (flow.core_widths, flow.core_growth, or flow.core_strain = \"none\", with which \
               stretching does not thin them) or a finer far wake (flow.far_wake_filaments higher, flow.far_wake_steps lower) may carry it, and nothing does where the wind itself is faster than any",
    begin,
    begin_alone,
    ..PRESCRIBED
};

fn laid_out(case: &Case, layout: &Layout) -> Result<Plan, PlanError> {
    plan::by_turns(case, layout, &turning(case))
}

fn turning(case: &Case) -> Turning {
    let values = &case.flow.values;
    Turning {
        steps_per_turn: values.number("steps_per_turn"),
        points_per_diameter: values.number("points_per_diameter"),
        length: values.number("wake_length_diameters"),
        beyond_last: beyond_last(values),
        wake_speed: USUAL * case.wind.speed,
    }
}

/// How far wakes reach behind the last rotor (diameters).
fn beyond_last(values: &Values) -> f64 {
    let length = values.number("wake_length_diameters");
    values.optional_number("wake_beyond_last_diameters").map_or(length, |end| end.min(length))
}

/// Settings of the wakes of turbines with `n_blades` each.
fn settings(case: &Case, plan: &Plan, n_blades: &[usize]) -> WakeSettings {
    let shown = Points {
        first: plan.origin + Vector3::splat(0.5 * plan.spacing),
        spacing: plan.spacing,
        n: plan.n_points,
    };
    let resolved = Resolved {
        diameter: plan.diameter,
        interval: plan.interval,
        places: plan.positions.iter().map(|position| position.x).collect(),
        n_blades: n_blades.to_vec(),
        n_nacelles: case.turbines.len(),
    };
    WakeSettings { shown, ..resolved.settings(&case.flow, &case.wind) }
}

/// The same of all turbines of `case`, before they are known.
fn of_all(case: &Case, plan: &Plan) -> WakeSettings {
    settings(case, plan, &vec![N_BLADES; case.turbines.len()])
}

/// What wakes are resolved for.
struct Resolved {
    /// Diameter that lengths are given in (m).
    diameter: f64,
    /// Step (s).
    interval: f64,
    /// Where turbines stand along x (m), and the blades of each (–).
    places: Vec<f64>,
    n_blades: Vec<usize>,
    /// Nacelles that leave a wake.
    n_nacelles: usize,
}

impl Resolved {
    /// What `flow` says of wakes in `wind`; nothing is shown of them.
    fn settings(&self, flow: &Flow, wind: &Wind) -> WakeSettings {
        let mut values = Values::defaults(&KEYS);
        values.extend(flow.values.iter().map(|(key, value)| (key, value.clone())));
        let count = |name: &str| values.number(name) as usize;
        let metres = |name: &str| values.number(name) * self.diameter;
        let rows = |length: f64, share: f64| length / (share * wind.speed * self.interval);
        let (near, stride) = (metres("near_wake_diameters"), count("far_wake_steps"));
        let far_rows = |length: f64| {
            (rows((length - near).max(0.0), SLOWEST) / stride as f64).ceil() as usize + 2
        };
        let (length, end) = (metres("wake_length_diameters"), self.end(&values));
        let far_rows_in_all = self
            .places
            .iter()
            .zip(&self.n_blades)
            .map(|(place, n_blades)| n_blades * far_rows(length.min(end - place)))
            .sum();
        WakeSettings {
            interval: self.interval,
            resolution: Resolution {
                near_rows: rows(near, USUAL).ceil() as usize,
                far_stride: stride,
                far_filaments: count("far_wake_filaments"),
                length,
                end,
                far_rows: far_rows(length),
            },
            cores: Cores {
                initial_widths: values.number("core_widths"),
                kinematic_viscosity: wind.kinematic_viscosity,
                eddy_constant: values.number("core_growth"),
                strain: values.word("core_strain") == "volume",
            },
            bodies: self.bodies(values.number("nacelle_wake_diameters")),
            air_density: wind.air_density,
            accuracy: Accuracy {
                degree: count("tree_degree"),
                opening: values.number("tree_opening"),
            },
            // There is none in even wind, and `begin` knows that of a case.
            shear: MeanShear::Carries,
            ground: values.word("ground_effect") == "image",
            shown: Points::NONE,
            n_blades: self.n_blades.iter().sum(),
            far_rows_in_all,
            n_elements: turbine::N_ELEMENTS,
            threads: flow.threads,
        }
    }

    /// Where wakes end along x that would be longer (m).
    fn end(&self, values: &Values) -> f64 {
        let last = self.places.iter().copied().reduce(f64::max);
        let beyond = values.optional_number("wake_beyond_last_diameters");
        let place = |(last, beyond): (f64, f64)| last + beyond * self.diameter;
        last.zip(beyond).map_or(f64::INFINITY, place)
    }

    /// Wakes of nacelles that are `diameters` long.
    fn bodies(&self, diameters: f64) -> BodyWakes {
        let most_rings = (diameters / (CLOSEST_RINGS * SMALLEST_HUB)).ceil() as usize;
        BodyWakes { length: diameters * self.diameter, n_bodies: self.n_nacelles, most_rings }
    }
}

fn begin(start: Start) -> Result<Air, SolverError> {
    let Start { site, inflow, mut planes, progress } = start;
    if site.case.wind_source() == WindSource::Planes && planes.is_none() {
        return Err(SolverError::NoPlanes { solver: VORTEX.name });
    }
    let (case, plan) = (site.case, site.plan);
    let n_blades: Vec<usize> = site.models.iter().map(|model| model.definition.n_blades).collect();
    let of_file = planes.as_mut().map(|planes| &mut **planes as &mut dyn Planes);
    let shear = shear::of(case, plan, &*inflow, of_file, progress)?;
    let settings = WakeSettings { shear, ..settings(case, plan, &n_blades) };
    let wind = wind::prescribed(&site, inflow, planes, progress)?;
    Ok(Box::new(FreeWake::new(settings, wind)?))
}

/// As the case has it, but in even wind without a ground, and the wake no longer than the tunnel is.
fn begin_alone(alone: &Alone) -> Result<Air, SolverError> {
    let Alone { tunnel, wind, diameter, flow } = *alone;
    let profile = MeanProfile::Uniform { speed: wind.speed };
    let air = PrescribedWind::everywhere(Arc::new(profile));
    let resolved = Resolved {
        diameter,
        interval: tunnel.interval,
        places: vec![0.0],
        n_blades: vec![N_BLADES],
        n_nacelles: 0,
    };
    let mut settings = WakeSettings { ground: false, ..resolved.settings(flow, wind) };
    let length = &mut settings.resolution.length;
    *length = length.min(tunnel.downstream * diameter);
    Ok(Box::new(FreeWake::new(settings, air)?))
}

/// The tunnel of the check: a wake so short that the check is quick, and so long that what is missing of it
/// follows a closed form.
fn tunnel(plan: &Plan, flow: &Flow) -> Tunnel {
    let downstream = beyond_last(&flow.values).min(LONGEST_CHECKED);
    // Until what was shed at the start has passed the end, and the wake there is that of a steady rotor.
    let settling = downstream / USUAL + 1.0;
    Tunnel { downstream, settling, averaging: 0.5, ..Tunnel::of_study(plan) }
}

/// What the check's own wake, shorter than the case's, does to its rotor: of the case's own end nothing is
/// taken off, so that the check finds what it does to power and thrust.
fn with_an_end(tunnel: &Tunnel, flow: &Flow, _: f64, thrust_coefficient: f64) -> f64 {
    let of_case = beyond_last(&flow.values);
    in_faster_air(tunnel.downstream, thrust_coefficient)
        / in_faster_air(of_case, thrust_coefficient)
}

/// A wake of `length` (diameters) induces less at its rotor than an endless one; the rotor is then in the
/// state of one in faster air (speed over that of the wind, –).
///
/// With s for its [share](flow::vortex::share_of_endless) of what an endless one induces, u = 1 − s a for the
/// wind at the disc and C_T = 4 a (1 − a), momentum theory has the same u and the same thrust in the wind
/// u + C_T/4u.
fn in_faster_air(length: f64, thrust_coefficient: f64) -> f64 {
    let induction = 0.5 * (1.0 - (1.0 - thrust_coefficient.clamp(0.0, MOST_THRUST)).sqrt());
    let share = flow::vortex::share_of_endless(2.0 * length, induction);
    let at_disc = 1.0 - share * induction;
    at_disc + induction * (1.0 - induction) / at_disc
}

fn objections(wind: &Wind, flow: &Flow) -> Vec<Objection> {
    match WindSource::Any.of(wind) {
        WindSource::Planes => planes_objections(wind, flow),
        WindSource::AroundRotors => turbulence_objections(wind, flow),
        _ => uniform_objections(wind, flow),
    }
}
