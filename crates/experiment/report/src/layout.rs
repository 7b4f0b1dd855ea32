//! Where the rotors of a study stand, how large they are, and which of them stand in one line along the wind.

use crate::StudyRecords;
use basis::records::{Plane, PlaneAxes, Summary};

/// Rotors whose hubs are nearer to a line along the wind than this stand in it (diameters of the first).
const IN_LINE: f64 = 0.05;

/// A rotor in its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rotor {
    /// Name of its turbine.
    pub(crate) name: String,
    /// Its hub (m, farm frame).
    pub(crate) hub: [f64; 3],
    /// Its diameter (m).
    pub(crate) diameter: f64,
    /// Turn of its nacelle from facing the wind, counter-clockwise seen from above (rad).
    pub(crate) yaw: f64,
}

impl Rotor {
    /// Half of what a plane along the wind `distance` (m) to the left of the hub cuts out of the disc (m);
    /// none where it passes by.
    pub(crate) fn half_chord(&self, distance: f64) -> Option<f64> {
        let (radius, distance) = (0.5 * self.diameter, distance / self.yaw.cos());
        (distance.abs() < radius).then(|| (radius * radius - distance * distance).sqrt())
    }

    /// How far downwind of the hub such a plane cuts the disc (m).
    pub(crate) fn downwind(&self, distance: f64) -> f64 {
        -distance * self.yaw.tan()
    }
}

/// Rotors in one line along the wind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lane {
    /// How far left of the origin the line lies (m).
    pub(crate) y: f64,
    /// Their places among the rotors.
    pub(crate) rotors: Vec<usize>,
}

/// The rotors of all runs, in the case file's order: from the summaries, or, where one does not tell, from
/// the case file, as large and as high as the first; empty where nothing tells.
pub(crate) fn rotors(records: &StudyRecords) -> Vec<Rotor> {
    let places = places(&records.case_text);
    let mut rotors = Vec::new();
    let turbines = records.runs.iter().flat_map(|run| &run.summary.turbines);
    for turbine in turbines {
        if rotors.iter().any(|rotor: &Rotor| rotor.name == turbine.name) {
            continue;
        }
        match turbine.rotor {
            Some(rotor) if rotor.diameter > 0.0 => rotors.push(Rotor {
                name: turbine.name.clone(),
                hub: rotor.hub,
                diameter: rotor.diameter,
                yaw: rotor.yaw_deg.to_radians(),
            }),
            _ => return of_the_case(&places, records),
        }
    }
    let order = |rotor: &Rotor| places.iter().position(|(name, _)| *name == rotor.name);
    rotors.sort_by_key(|rotor| order(rotor).unwrap_or(usize::MAX));
    rotors
}

/// Rotors as large and as high as the first at `places` (diameters).
fn of_the_case(places: &[(String, [f64; 2])], records: &StudyRecords) -> Vec<Rotor> {
    let Some(first) = records.runs.first() else { return Vec::new() };
    let diameter = diameter(&first.summary);
    let hub_height = hub_height(records).unwrap_or(diameter);
    let rotor = |(name, [x, y]): &(String, [f64; 2])| Rotor {
        name: name.clone(),
        hub: [x * diameter, y * diameter, hub_height],
        diameter,
        yaw: 0.0,
    };
    places.iter().map(rotor).collect()
}

/// Diameter of the first turbine's rotor (m); 1 where the record holds none.
pub(crate) fn diameter(summary: &Summary) -> f64 {
    let diameter = summary.conditions.rotor_diameter;
    if diameter > 0.0 { diameter } else { 1.0 }
}

/// Height of the hub-height planes (m).
fn hub_height(records: &StudyRecords) -> Option<f64> {
    let planes =
        records.runs.iter().flat_map(|run| run.mean_planes.iter().chain(&run.instant_planes));
    let mut horizontal = planes.filter(|plane: &&Plane| plane.axes == PlaneAxes::Horizontal);
    horizontal.next().map(|plane| plane.origin[2])
}

/// The lines along the wind in which `rotors` stand, that of the first one first, the others from right to
/// left.
pub(crate) fn lanes(rotors: &[Rotor]) -> Vec<Lane> {
    let Some(first) = rotors.first() else { return Vec::new() };
    let near = IN_LINE * first.diameter;
    let mut lanes: Vec<Lane> = Vec::new();
    for (index, rotor) in rotors.iter().enumerate() {
        match lanes.iter_mut().find(|lane| (lane.y - rotor.hub[1]).abs() < near) {
            Some(lane) => lane.rotors.push(index),
            None => lanes.push(Lane { y: rotor.hub[1], rotors: vec![index] }),
        }
    }
    lanes[1..].sort_by(|a, b| a.y.total_cmp(&b.y));
    lanes
}

/// Where the case file puts the turbines, which is in diameters of the first and in wind from the west in all
/// records whose summaries do not tell; empty when it does not tell of all.
fn places(case_text: &str) -> Vec<(String, [f64; 2])> {
    let Ok(case) = case_text.parse::<toml::Table>() else { return Vec::new() };
    let turbines = case.get("turbine").and_then(toml::Value::as_array);
    let place = |turbine: &toml::Value| {
        let pair = turbine.get("position_diameters").or_else(|| turbine.get("position"));
        let pair = pair?.as_array()?;
        let value = |index: usize| {
            let value: &toml::Value = pair.get(index)?;
            value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64))
        };
        let name = turbine.get("name")?.as_str()?.to_owned();
        Some((name, [value(0)?, value(1)?]))
    };
    turbines
        .and_then(|turbines| turbines.iter().map(place).collect::<Option<Vec<_>>>())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RunRecords;
    use basis::records::{self, Series, examples};

    #[test]
    fn the_places_come_from_the_case_file() {
        let text = "[[turbine]]\nname = 'A'\nposition_diameters = [0, 0.0]\n\
                    [[turbine]]\nname = 'B'\nposition_diameters = [5.0, -1]\n";
        let positions: Vec<[f64; 2]> = places(text).into_iter().map(|place| place.1).collect();
        assert_eq!(positions, [[0.0, 0.0], [5.0, -1.0]]);
        assert!(places("name = 3").is_empty() && places("not toml at all [").is_empty());
        assert!(places("[[turbine]]\nposition_diameters = [1]\n").is_empty());
    }

    fn study(rotors: [Option<records::Rotor>; 2]) -> StudyRecords {
        let turbines = ["A", "B"]
            .into_iter()
            .zip(rotors)
            .map(|(name, rotor)| records::TurbineSummary { rotor, ..examples::turbine(name, 1e6) });
        let run = RunRecords {
            summary: examples::summary("baseline", turbines.collect()),
            series: Series::default(),
            mean_planes: Vec::new(),
            instant_planes: Vec::new(),
            filaments: None,
        };
        StudyRecords {
            case_name: "case".into(),
            description: None,
            case_text: "[[turbine]]\nname = 'A'\nposition_diameters = [0, 0]\n\
                        [[turbine]]\nname = 'B'\nposition_diameters = [5.0, 1]\n"
                .into(),
            runs: vec![run],
            incomplete: Vec::new(),
            synchronisation: Vec::new(),
            signals: Vec::new(),
            version: "0".into(),
        }
    }

    #[test]
    fn each_rotor_has_its_own_size_and_older_records_that_of_the_first() {
        let of =
            |diameter: f64, hub: [f64; 3]| Some(records::Rotor { diameter, hub, yaw_deg: 0.0 });
        let own = rotors(&study([of(240.0, [0.0, 0.0, 150.0]), of(126.0, [1200.0, 240.0, 90.0])]));
        assert_eq!((own[1].diameter, own[1].hub), (126.0, [1200.0, 240.0, 90.0]));
        let older = rotors(&study([of(240.0, [0.0, 0.0, 150.0]), None]));
        assert_eq!((older[1].diameter, older[1].hub), (240.0, [1200.0, 240.0, 240.0]));
        // A plane at 3/5 of the radius cuts 4/5 of the diameter out of the disc.
        assert_eq!(own[0].half_chord(72.0), Some(96.0));
        assert_eq!(own[0].half_chord(-120.0), None);
        // Turned by 60° it is half as wide, and cut where it has come to.
        let turned = Rotor { yaw: 60_f64.to_radians(), ..own[0].clone() };
        assert!((turned.half_chord(36.0).unwrap() - 96.0).abs() < 1e-9);
        assert!(turned.half_chord(61.0).is_none());
        assert!((turned.downwind(36.0) + 36.0 * 3_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn rotors_in_line_share_a_lane() {
        let rotor =
            |y: f64| Rotor { name: String::new(), hub: [0.0, y, 100.0], diameter: 100.0, yaw: 0.0 };
        let found = lanes(&[rotor(0.0), rotor(100.0), rotor(4.0), rotor(-100.0), rotor(96.0)]);
        let places: Vec<(f64, &[usize])> =
            found.iter().map(|lane| (lane.y, lane.rotors.as_slice())).collect();
        assert_eq!(places, [(0.0, &[0, 2][..]), (-100.0, &[3][..]), (100.0, &[1, 4][..])]);
    }
}
