//! Lidars that cannot be.

use super::keys::MOST_POINTS;
use super::optics::Optics;
use super::pattern::whole_grids;
use crate::sensor::Mount;
use basis::Vector3;
use basis::keys::{Objection, Values};
use std::f64::consts::TAU;

/// Azimuths at which the beams of a hub are looked at (–).
const N_AZIMUTHS: usize = 72;

fn objection(key: &'static str, message: String, label: &'static str, fix: &str) -> Objection {
    Objection { key: Some(key), message, label, fix: fix.to_owned() }
}

/// What about `values` cannot be on any machine.
pub(super) fn of_values(values: &Values) -> Vec<Objection> {
    [of_scan(values), of_ranges(values), of_carrier(values), of_probe(values)].concat()
}

fn of_scan(values: &Values) -> Vec<Objection> {
    let (scan, n_points) = (values.word("scan"), values.number("n_points") as usize);
    let mut objections = Vec::new();
    for (key, needed) in [("rings", "rings"), ("petals", "rosette")] {
        if values.has(key) && scan != needed {
            let message = format!(
                "has no effect here: it applies only with scan = \"{needed}\", not \"{scan}\""
            );
            objections.push(objection(key, message, "no effect", "leave it out"));
        }
    }
    let [below, above] = whole_grids(n_points);
    if scan == "plane" && below != above.min(n_points) {
        let message = format!("= {n_points} points do not fill the disc of a plane evenly");
        let fix = if n_points < below {
            format!("take {below}")
        } else {
            format!("take {below} or {above}, or another scan")
        };
        objections.push(objection("n_points", message, "fills no disc", &fix));
    }
    objections
}

fn of_ranges(values: &Values) -> Vec<Objection> {
    let n_gates = values.numbers("ranges_diameters").len();
    let mut objections = Vec::new();
    if values.has("ranges_diameters") && values.has("focal_distance_diameters") {
        let message =
            "is that of a continuous wave, and ranges_diameters those of pulses".to_owned();
        let fix = "leave one of them out";
        objections.push(objection("focal_distance_diameters", message, "beside ranges", fix));
    }
    if values.has("ranges_diameters") && n_gates == 0 {
        let message = "is empty: a pulsed lidar measures at one range or more".to_owned();
        let fix = "give ranges, or leave it out for a continuous wave";
        objections.push(objection("ranges_diameters", message, "no range", fix));
    }
    let n_points = values.number("n_points") * n_gates as f64;
    if n_points > MOST_POINTS as f64 {
        let message = format!("make {n_points} points of the scan; {MOST_POINTS} are the most");
        let fix = "take fewer ranges, or fewer n_points";
        objections.push(objection("ranges_diameters", message, "too many", fix));
    }
    objections
}

fn of_carrier(values: &Values) -> Vec<Objection> {
    let is_upwind = values.word("looks") == "upwind";
    let mut objections = Vec::new();
    if values.word("mount") == "hub" {
        if !is_upwind {
            let message = "= \"downwind\" from a hub is into its own nacelle".to_owned();
            let fix = "take looks = \"upwind\", or mount = \"nacelle\"";
            objections.push(objection("looks", message, "into the nacelle", fix));
        }
        if values.number("tilt_deg") != 0.0 {
            let message = "turns with the hub: its axis is the shaft".to_owned();
            let fix = "leave it out, or take mount = \"nacelle\"";
            objections.push(objection("tilt_deg", message, "turns with the hub", fix));
        }
        if values.number("downwind") > 0.0 {
            let message = "is inside the nacelle for a lidar in the hub".to_owned();
            let fix = "take 0, or less for the tip of the spinner";
            objections.push(objection("downwind", message, "in the nacelle", fix));
        }
    } else if is_upwind && values.number("downwind") <= 0.0 {
        let message = "must be above 0 for a lidar on the nacelle that looks upwind: it stands behind the rotor, and sees between the blades".to_owned();
        let fix = "give its distance behind the rotor, or take mount = \"hub\"";
        objections.push(objection("downwind", message, "not on the nacelle", fix));
    } else if !is_upwind && values.number("downwind") < 0.0 {
        let message = "is before the rotor for a lidar that looks downwind: it would see its wake through the blades".to_owned();
        let fix = "take 0 or more, behind the rotor's centre";
        objections.push(objection("downwind", message, "looks through its rotor", fix));
    }
    objections
}

fn of_probe(values: &Values) -> Vec<Objection> {
    let probe = values.word("probe");
    match (probe, values.has("probe_length")) {
        ("none", true) => {
            let message = "has no effect here: probe is \"none\"".to_owned();
            let fix = "leave it out, or take a probe";
            vec![objection("probe_length", message, "no effect", fix)]
        }
        ("lorentzian" | "gaussian", false) => {
            let message = "is missing".to_owned();
            let fix = format!("give the length of a {probe} probe, in m");
            vec![objection("probe_length", message, "should stand in here", &fix)]
        }
        _ => Vec::new(),
    }
}

/// What about `values` cannot be at `mount`.
pub(super) fn at_mount(values: &Values, mount: &Mount) -> Vec<Objection> {
    let optics = Optics::of(values, mount);
    [of_rate(values, mount), at_ground(&optics, mount), at_hub(&optics, mount)]
        .into_iter()
        .flatten()
        .collect()
}

/// A scan that would be measured twice in the same air.
fn of_rate(values: &Values, mount: &Mount) -> Option<Objection> {
    let (rate, n_points) = (values.number("rate_hz"), values.number("n_points"));
    let at_once = values.word("order") != "in-turn";
    let most = if at_once { 1.0 } else { n_points } / mount.interval;
    (rate > most * (1.0 + 1e-9)).then(|| {
        let message = format!(
            "= {rate} Hz is too fast: the air is known every {} s, so that a scan can be measured at {most:.3} Hz at most",
            mount.interval
        );
        objection("rate_hz", message, "too fast", "take a lower rate, or shorter control intervals")
    })
}

/// A point that lies below the ground.
fn at_ground(optics: &Optics, mount: &Mount) -> Option<Objection> {
    let azimuths = (0..N_AZIMUTHS).map(|index| TAU * index as f64 / N_AZIMUTHS as f64);
    let lowest = azimuths
        .flat_map(|azimuth| {
            let pose = optics.pose_at_rest(mount.definition, azimuth);
            let height = move |(index, distance): (usize, &f64)| {
                let beam: Vector3 = pose.axes * optics.beams[index / optics.n_gates];
                (pose.place + beam * *distance).z - optics.foot.z
            };
            optics.distances.iter().enumerate().map(height)
        })
        .fold(f64::INFINITY, f64::min);
    (lowest <= 0.0).then(|| {
        let message =
            format!("leads a beam into the ground: its lowest point lies at {lowest:.1} m");
        let fix = "make it smaller, raise tilt_deg, or look less far";
        objection("radius_diameters", message, "meets the ground", fix)
    })
}

/// A beam that its own hub always blocks.
fn at_hub(optics: &Optics, mount: &Mount) -> Option<Objection> {
    if !optics.passes_rotor() {
        return None;
    }
    let pose = optics.pose_at_rest(mount.definition, 0.0);
    let hub_radius = mount.definition.rotor.hub_radius;
    let nearest = optics.beams.iter().map(|beam| pose.crossing(pose.axes * *beam).0);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    (nearest < hub_radius).then(|| {
        let message = format!(
            "leads a beam into its own hub: it passes the rotor {nearest:.2} m from the centre of a hub of {hub_radius:.2} m"
        );
        let fix = "put the lidar higher above the nacelle, or take mount = \"hub\"";
        objection("above", message, "looks into its hub", fix)
    })
}
