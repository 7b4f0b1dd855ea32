//! What about the laws and the sensors of a lidar loop cannot be.

use super::family::Schedule;
use crate::kind::Place;
use crate::library::ANEMOMETER;
use basis::keys::{Objection, Values};

fn objection(key: &'static str, message: String, label: &'static str, fix: String) -> Objection {
    Objection { key: Some(key), message, label, fix }
}

/// What about the one law in `values` cannot be.
pub(super) fn of_one_law(values: &Values) -> Vec<Objection> {
    let mut objections = Vec::new();
    if values.has("wind_filter_time") {
        let message = "has no effect here: one law alone is blended with none".to_owned();
        let fix = "leave it out, or give a family of laws".to_owned();
        objections.push(objection("wind_filter_time", message, "no effect", fix));
    }
    if let [member] = values.tables("controller") {
        let message =
            "is a family of one law, which is blended with none: its `wind_speed` has no effect"
                .to_owned();
        let file = member.word("file");
        let fix = format!("give controller = \"{file}\", or a law of another wind speed too");
        objections.push(objection("controller", message, "one law", fix));
    }
    objections
}

/// What about laws in the files `members`, blended as `schedule` says, cannot be at `place`.
pub(super) fn of_family(schedule: &Schedule, members: &[String], place: &Place) -> Vec<Objection> {
    let Schedule { speeds, anemometer, .. } = schedule;
    let mut objections = Vec::new();
    for (index, pair) in speeds.windows(2).enumerate() {
        let [first, second] = [&members[index], &members[index + 1]];
        let [slower, faster] = [pair[0], pair[1]];
        if slower == faster {
            let message = format!("has two laws for {slower} m/s, {first} and {second}");
            let fix = "leave one of them out, or make it at another wind speed".to_owned();
            objections.push(objection("controller", message, "one wind speed twice", fix));
        } else if slower > faster {
            let message = format!(
                "is not in ascending order of wind speed: {first} of {slower} m/s stands before {second} of {faster} m/s"
            );
            let fix = "sort the laws by `wind_speed`".to_owned();
            objections.push(objection("controller", message, "not ascending", fix));
        }
    }
    objections.extend(no_wind(anemometer, place));
    objections
}

/// Why the lidar that `values` name shows no wake at `place`, where it does not.
pub(crate) fn no_lidar(values: &Values, place: &Place) -> Option<Objection> {
    let (name, turbine) = (values.word("lidar"), place.turbine);
    let (message, label, fix) = match place.sensor(name).filter(|sensor| sensor.kind == "lidar") {
        None => (
            format!("= \"{name}\" names no lidar of {turbine}"),
            "no such lidar",
            format!("add sensors.{name} = {{ kind = \"lidar\" }} to its [[turbine]]"),
        ),
        Some(lidar) if lidar.values.word("looks") == "upwind" => (
            format!("= \"{name}\" looks upwind, and the own wake is downwind"),
            "looks upwind",
            format!("leave out `looks` of sensors.{name} of {turbine}, or name another lidar"),
        ),
        Some(lidar) if lidar.values.numbers("ranges_diameters").len() > 1 => (
            format!(
                "= \"{name}\" measures at {} ranges, and a controller follows the hub vortex in one plane",
                lidar.values.numbers("ranges_diameters").len()
            ),
            "several ranges",
            format!(
                "give sensors.{name} of {turbine} one range, such as ranges_diameters = [1.0], or name another lidar"
            ),
        ),
        Some(_) => return None,
    };
    Some(Objection { key: Some("lidar"), message, label, fix })
}

/// Why the sensor called `anemometer` at `place` shows no wind to blend a family by, where it does not.
fn no_wind(anemometer: &str, place: &Place) -> Option<Objection> {
    let turbine = place.turbine;
    let add = |name: &str| {
        format!("add sensors.{name} = {{ kind = \"anemometer\" }} to the [[turbine]] {turbine}")
    };
    let message = "is a family that is blended by the measured wind";
    let (message, fix) = match place.sensor(anemometer) {
        // To a library that means no wind, whatever sensors are called.
        _ if anemometer == "none" => (
            format!("{message}, and `anemometer` is `none`"),
            format!("leave it out, or name an anemometer of {turbine} in it"),
        ),
        None => (
            format!("{message}, and {turbine} has no sensor `{anemometer}`"),
            format!("{}, or name its anemometer in `anemometer`", add(anemometer)),
        ),
        Some(sensor) if sensor.kind == "lidar" => (
            format!(
                "{message}, and `{anemometer}` of {turbine} is a lidar, whose first value is no wind speed"
            ),
            format!("{}, and name it in `anemometer`", add(ANEMOMETER)),
        ),
        Some(_) => return None,
    };
    Some(Objection { key: Some("controller"), message, label: "no wind", fix })
}
