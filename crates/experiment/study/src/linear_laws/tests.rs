//! Laws from files, and references that come and go with their runs.

use super::*;
use basis::records::{Finding, SettingValue, examples};
use formats::linear_model::Role;

/// A gain from errors to commands with these names and units.
fn gain(role: Role, inputs: [[&str; 2]; 2], outputs: [[&str; 2]; 2]) -> LinearModel {
    let ports = [inputs, outputs].map(|ports| {
        let port = |[name, unit]: [&str; 2]| Port { name: name.into(), unit: unit.into() };
        ports.map(port).to_vec()
    });
    let d = vec![vec![1.0, 2.0], vec![3.0, 4.0]];
    let of_order_none = [Vec::new(), Vec::new(), vec![Vec::new(); 2], d];
    LinearModel::new(role, "a gain".to_owned(), Some(1.0), ports, of_order_none)
}

fn read(model: &LinearModel) -> Result<LinearLaw, String> {
    let folder = tempfile::tempdir().unwrap();
    model.write(&folder.path().join("law.json")).unwrap();
    law("law.json", folder.path()).map(|(law, ..)| law).map_err(|error| error.to_string())
}

/// What is said of a family of laws with these intervals (s), which learn of limits or not.
fn read_family(members: &[(f64, bool)]) -> Result<(Vec<LinearLaw>, f64), String> {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<String> = (0..members.len()).map(|index| format!("law-{index}.json")).collect();
    for ((interval, learns), file) in members.iter().zip(&files) {
        let ports = [UP_RIGHT, TILT_YAW].map(|ports| {
            ports.map(|[name, unit]| Port { name: name.into(), unit: unit.into() }).to_vec()
        });
        let one = || vec![vec![0.5, 0.0], vec![0.0, 0.5]];
        let matrices = [one(), one(), one(), one()];
        let text = "a lag".to_owned();
        let model = LinearModel::new(Role::Controller, text, Some(*interval), ports, matrices);
        let model = LinearModel { k: learns.then(one), ..model };
        model.write(&folder.path().join(file)).unwrap();
    }
    family(&files, folder.path(), &mut LawDigests::new()).map_err(|error| error.to_string())
}

#[test]
fn a_family_samples_at_one_interval_and_learns_what_is_applied() {
    let (laws, interval) = read_family(&[(0.5, true), (0.5, true)]).unwrap();
    assert_eq!((laws.len(), interval), (2, 0.5));
    assert_eq!(laws[1].file, "law-1.json");
    let said = read_family(&[(0.5, true), (1.0, true)]).unwrap_err();
    assert!(
        said.contains("law-1.json")
            && said.contains("`interval_s` is 1, that of law-0.json is 0.5"),
        "{said}"
    );
    let said = read_family(&[(0.5, true), (0.5, false)]).unwrap_err();
    assert!(said.contains("law-1.json") && said.contains("it has no `K`"), "{said}");
    // One alone may do without.
    assert!(read_family(&[(0.5, false)]).is_ok());
}

const UP_RIGHT: [[&str; 2]; 2] = [["T1.HubVortexTilt", "m"], ["T1.HubVortexYaw", "m"]];
const TILT_YAW: [[&str; 2]; 2] = [["T1.HelixTilt", "deg"], ["T1.HelixYaw", "deg"]];

#[test]
fn tilt_and_yaw_are_found_by_their_names() {
    let [mut output, mut turned] = [[0.0; 2]; 2];
    let mut law = read(&gain(Role::Controller, UP_RIGHT, TILT_YAW)).unwrap();
    law.recursion.step(&[1.0, 10.0], &mut output);
    assert_eq!(output, [21.0, 43.0]);
    let [up, right] = UP_RIGHT;
    let [tilt, yaw] = TILT_YAW;
    let mut law = read(&gain(Role::Controller, [right, up], [yaw, tilt])).unwrap();
    law.recursion.step(&[1.0, 10.0], &mut turned);
    assert_eq!(turned, [34.0, 12.0]);
}

/// What was found to be `value` (m).
fn metres(name: &str, value: f64) -> Finding {
    Finding {
        name: name.to_owned(),
        value: Some(value),
        unit: "m".to_owned(),
        about: String::new(),
    }
}

#[test]
fn the_reference_is_the_mean_of_a_run_that_tells_of_the_hub_vortex() {
    let folder = tempfile::tempdir().unwrap();
    let run = RunFolder::new(folder.path(), "runs/open/helix");
    run.create().unwrap();
    let mut seen = examples::turbine("T1", 1e6);
    seen.control.findings = vec![metres("hub-vortex-tilt", 1.5), metres("hub-vortex-yaw", 13.0)];
    let unseen = examples::turbine("T2", 1e6);
    let summary = examples::summary("helix", vec![seen, unseen]);
    records::write_summary(&run, &summary).unwrap();
    let of = |turbine| mean_hub_vortex("runs/open/helix", folder.path(), (turbine, &[]));
    assert_eq!(of("T1").unwrap(), [1.5, 13.0]);
    let said = of("T2").unwrap_err().to_string();
    assert!(said.contains("summary.json") && said.contains("no hub vortex of T2"), "{said}");
    assert!(mean_hub_vortex("runs/none", folder.path(), ("T1", &[])).is_err());
    let mut summary = summary;
    let setting = |strouhal: f64| ControlSetting {
        key: "strouhal".to_owned(),
        value: SettingValue::Number(strouhal),
    };
    summary.turbines[0].control.settings = Some(vec![setting(0.3)]);
    records::write_summary(&run, &summary).unwrap();
    let beside =
        |own: f64| mean_hub_vortex("runs/open/helix", folder.path(), ("T1", &[setting(own)]));
    assert_eq!(beside(0.3).unwrap(), [1.5, 13.0]);
    let said = beside(0.25).unwrap_err().to_string();
    assert!(said.contains("`strouhal` of T1 was another there"), "{said}");
}

/// A case whose turbines, `n` of them, all take their reference from the run `open`.
fn closed(n: usize) -> Case {
    let mut text = "name = \"closed\"\n[wind]\nspeed = 9.0\nturbulence_intensity = 0.0\n\
         [flow]\nsolver = \"uniform\"\nstep = 0.2\n\
         [time]\nspin_up = 60.0\nduration = 90.0\n"
        .to_owned();
    let mut run = "[[run]]\nname = \"closed\"\n".to_owned();
    for number in 1..=n {
        text += &format!(
            "[[turbine]]\nname = \"T{number}\"\nmodel = \"nrel-5mw\"\n\
             position_diameters = [{}.0, 0.0]\nstructure = \"rigid\"\n\
             sensors.lidar = {{ kind = \"lidar\" }}\n",
            5 * number
        );
        run += &format!(
            "control.T{number} = {{ kind = \"lidar-loop\", sense = \"ccw\", amplitude_deg = 1.0, strouhal = 0.25, controller = \"law.json\", reference_run = \"open\" }}\n"
        );
    }
    formats::case::parse("closed.toml", &(text + &run), &[]).unwrap()
}

/// That case's run, whose turbines have this reference (m).
fn with_reference(case: &Case, reference: Option<[f64; 2]>) -> Run {
    let mut run = case.runs[0].clone();
    for control in &mut run.control {
        let laws = LinearLaws { laws: Vec::new(), interval: 1.0, reference };
        control.linear_laws = Some(Arc::new(laws));
    }
    run
}

fn references(run: &Run) -> Vec<Option<[f64; 2]>> {
    let of = |control: &Control| control.linear_laws.as_ref().unwrap().reference;
    run.control.iter().map(of).collect()
}

#[test]
fn a_reference_goes_with_its_run_and_comes_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let case = closed(1);
    let stale = with_reference(&case, Some([9.0, 9.0]));
    let without = referred(&stale, &case.turbines, folder.path()).unwrap();
    assert_eq!(references(&without), [None]);
    let open = RunFolder::new(folder.path(), "open");
    open.create().unwrap();
    let mut turbine = examples::turbine("T1", 1e6);
    turbine.control.findings = vec![metres("hub-vortex-tilt", 1.5), metres("hub-vortex-yaw", 13.0)];
    records::write_summary(&open, &examples::summary("open", vec![turbine])).unwrap();
    for before in [&stale, &without] {
        let now = referred(before, &case.turbines, folder.path()).unwrap();
        assert_eq!(references(&now), [Some([1.5, 13.0])]);
    }
}

#[test]
fn each_turbine_has_a_reference_of_its_own_in_one_run() {
    let case = closed(2);
    let mut run = with_reference(&case, Some([1.5, 13.0]));
    let laws = LinearLaws { laws: Vec::new(), interval: 1.0, reference: Some([2.0, -4.0]) };
    run.control[1].linear_laws = Some(Arc::new(laws));
    let digests = LawDigests::from([("law.json".to_owned(), "a digest".to_owned())]);
    let found = deciding(&run, &case.turbines, &digests);
    let found: Vec<(&str, &str)> = found.iter().map(|(name, of)| (&**name, &**of)).collect();
    let expected =
        [("law.json", "a digest"), ("open for T1", "1.5 m, 13 m"), ("open for T2", "2 m, -4 m")];
    assert_eq!(found, expected);
    assert_eq!(deciding(&with_reference(&case, None), &case.turbines, &digests), digests);
}

#[test]
fn what_is_no_law_of_two_errors_in_metres_is_told_with_its_file() {
    let said = read(&gain(Role::Model, UP_RIGHT, TILT_YAW)).unwrap_err();
    assert!(said.contains("law.json") && said.contains("a linear model"), "{said}");
    let said = read(&gain(Role::Controller, TILT_YAW, TILT_YAW)).unwrap_err();
    assert!(said.contains("`inputs` are T1.HelixTilt (deg), T1.HelixYaw (deg)"), "{said}");
    let said = read(&gain(Role::Controller, UP_RIGHT, [["a", "deg"], ["b", "deg"]])).unwrap_err();
    assert!(said.contains("`outputs` are a (deg), b (deg)"), "{said}");
}
