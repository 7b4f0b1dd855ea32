//! A lidar in winds with known answers.

use crate::{Mount, SENSORS, Scene, Sensing};
use basis::keys::{Value, Values};
use basis::scan::Scan;
use basis::{Commands, PerBlade, Vector3};
use flow::WindField;
use std::f64::consts::PI;
use std::sync::Arc;
use turbine::definition::{BladeStructure, Mode, Tower, TowerSection};
use turbine::{Definition, Induction, Turbine, TurbineSettings, sample};

const FOOT: Vector3 = Vector3::new(30.0, -7.0, 0.0);
const INTERVAL: f64 = 0.1;

/// Wind u + gradient z + a wave along x.
#[derive(Clone, Copy)]
struct Wind {
    mean: Vector3,
    /// Of the wind along x, upwards (1/s).
    shear: f64,
    /// Length of the wave (m), of 1 m/s.
    wave: Option<f64>,
}

const EVEN: Wind = Wind { mean: Vector3::new(10.0, 0.0, 0.0), shear: 0.0, wave: None };

impl WindField for Wind {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            assert!(position.z > 0.0, "nobody looks below the ground");
            let wave = self.wave.map_or(0.0, |length| (2.0 * PI * position.x / length).cos());
            *velocity = self.mean + Vector3::X * (self.shear * position.z + wave);
        }
    }
}

/// The sample turbine on a tower that bends.
fn definition() -> Definition {
    let base = sample::definition();
    let section = |height: f64| TowerSection {
        height,
        mass: 4e3,
        fore_aft_stiffness: 5e11,
        side_to_side_stiffness: 5e11,
    };
    let first = Mode { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], damping_ratio: 0.01 };
    let second = Mode { coefficients: [-3.0, 4.0, 0.0, 0.0, 0.0], ..first };
    let tower = Tower {
        sections: vec![section(0.0), section(88.0)],
        fore_aft_modes: [first, second],
        side_to_side_modes: [first, second],
        ..base.tower
    };
    let blade_structure = BladeStructure { flap_modes: [first, second], ..base.blade_structure };
    Definition { tower, blade_structure, ..base }
}

fn turbine(yaw: f64, flexible: bool) -> Turbine {
    let settings = TurbineSettings {
        induction: Induction::ByFlow {
            smearing_length: 8.0,
            sample_spacing: 0.0,
            dynamic_stall: false,
        },
        flexible,
        air_density: 1.225,
        yaw: 0.0,
        rotor_speed: 1.0,
        azimuth: 0.0,
        pitch: 0.0,
    };
    Turbine::new(Arc::new(definition()), FOOT, TurbineSettings { yaw, ..settings })
        .expect("a turbine")
}

/// The values of a lidar with `changes` to its defaults.
fn values(changes: &[(&'static str, Value)]) -> Values {
    let kind = SENSORS.find("lidar").expect("it is one of the kinds");
    let mut values = Values::defaults(kind.table().keys);
    values.extend(changes.iter().cloned());
    values
}

fn sensing(turbine: &Turbine, changes: &[(&'static str, Value)]) -> Sensing {
    let kind = SENSORS.find("lidar").expect("it is one of the kinds");
    let definition = turbine.definition();
    let mount = Mount { definition, foot: FOOT, interval: INTERVAL, seed: 3 };
    let values = values(changes);
    let objections = [kind.check(&values), kind.check_at(&values, &mount)].concat();
    assert!(objections.is_empty(), "{objections:?}");
    Sensing::perfect().with_sensor("Eye", kind.build(&values, &mount))
}

/// The reading at instant number `step`.
fn read(sensing: &mut Sensing, turbine: &Turbine, wind: &Wind, step: u32) -> Vec<f64> {
    let truth = turbine.truth(f64::from(step) * INTERVAL, INTERVAL);
    let scene = Scene { truth: &truth, turbine, wind };
    sensing.read(&scene).reading("Eye").expect("there is an eye").to_vec()
}

fn first(turbine: &Turbine, wind: &Wind, changes: &[(&'static str, Value)]) -> Vec<f64> {
    read(&mut sensing(turbine, changes), turbine, wind, 0)
}

fn word(text: &str) -> Value {
    text.into()
}

/// Eq. A1 of the source: the wind along the normalised vector to the point.
#[test]
fn the_lidar_of_the_source_shows_the_wind_along_its_beams() {
    let (turbine, wind) =
        (turbine(0.0, false), Wind { mean: Vector3::new(9.0, 1.0, -0.5), shear: 0.02, ..EVEN });
    let reading = first(&turbine, &wind, &[]);
    let scan = Scan::of(&reading).expect("a scan");
    assert_eq!((scan.n_points(), scan.n_valid()), (80, 80));
    for point in 0..80 {
        let place = Vector3::new(scan.downwind()[point], scan.left()[point], scan.up()[point]);
        assert!((place.x - 120.0).abs() < 1e-9, "a diameter downwind");
        assert!(place.y.hypot(place.z) < 60.0, "over the rotor's disc");
        let height = place.z + 90.0;
        let blows = wind.mean + Vector3::X * wind.shear * height;
        assert!((scan.speeds()[point] - blows.dot(place) / place.length()).abs() < 1e-9);
        assert_eq!(scan.times()[point], 0.0);
    }
}

#[test]
fn one_that_looks_upwind_shows_the_wind_against_it_from_hub_and_nacelle() {
    let turbine = turbine(0.0, false);
    let hub = [
        ("looks", word("upwind")),
        ("mount", word("hub")),
        ("scan", word("beams")),
        ("n_points", 4_u64.into()),
    ];
    let reading = first(&turbine, &EVEN, &hub);
    let scan = Scan::of(&reading).expect("a scan");
    assert!(scan.downwind().iter().all(|x| (x + 120.0).abs() < 1e-9));
    let expected = -10.0 * 120.0 / 120.0_f64.hypot(60.0);
    assert!(scan.speeds().iter().all(|speed| (speed - expected).abs() < 1e-9));
}

#[test]
fn the_beams_of_a_hub_turn_with_the_rotor() {
    let mut turbine = turbine(0.0, false).at_held_speed();
    let hub = [
        ("looks", word("upwind")),
        ("mount", word("hub")),
        ("scan", word("beams")),
        ("n_points", 1_u64.into()),
    ];
    let mut sensing = sensing(&turbine, &hub);
    let still = Commands { pitch: PerBlade::splat(3, 0.0), generator_torque: 0.0, yaw_rate: 0.0 };
    let winds = vec![Vector3::ZERO; turbine.stations().len()];
    for step in 0..9 {
        let reading = read(&mut sensing, &turbine, &EVEN, step);
        let scan = Scan::of(&reading).expect("a scan");
        // The only beam starts down, at an angle of half a turn, and the rotor makes a radian a second.
        let angle = PI + turbine.structure().azimuth();
        assert!((scan.left()[0] + 60.0 * angle.sin()).abs() < 1e-6, "{step}");
        assert!((scan.up()[0] - 60.0 * angle.cos()).abs() < 1e-6, "{step}");
        turbine.advance(INTERVAL, &winds, &still);
    }
}

#[test]
fn it_turns_with_the_nacelle_and_points_have_its_axes() {
    let yaw = 0.35;
    let reading = first(&turbine(yaw, false), &EVEN, &[("above", 3.0.into())]);
    let scan = Scan::of(&reading).expect("a scan");
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    assert!((mean(scan.downwind()) - 120.0).abs() < 1e-9 && mean(scan.left()).abs() < 1e-9);
    assert!((mean(scan.up()) - 3.0).abs() < 1e-9);
    // The axis is turned from the wind, and each pair of opposite beams shows its cosine on average.
    for point in 0..80 {
        let (y, z) = (scan.left()[point], scan.up()[point] - 3.0);
        let length = (120.0_f64.powi(2) + y * y + z * z).sqrt();
        let expected = 10.0 * (120.0 * yaw.cos() - y * yaw.sin()) / length;
        assert!((scan.speeds()[point] - expected).abs() < 1e-9);
    }
}

#[test]
fn a_nacelle_that_sways_moves_with_the_wind_and_shows_less_of_it() {
    let mut turbine = turbine(0.0, true);
    let beam =
        [("scan", word("beams")), ("n_points", 4_u64.into()), ("radius_diameters", 0.001.into())];
    let mut sensing = sensing(&turbine, &beam);
    let winds = vec![Vector3::X * 10.0; turbine.stations().len()];
    let still = Commands { pitch: PerBlade::splat(3, 0.0), generator_torque: 0.0, yaw_rate: 0.0 };
    let mut fastest = 0.0_f64;
    let mut before = turbine.structure().frame(0.0).hub;
    for step in 0..40 {
        turbine.advance(INTERVAL, &winds, &still);
        let reading = read(&mut sensing, &turbine, &EVEN, step);
        let scan = Scan::of(&reading).expect("a scan");
        let shown = 10.0 - scan.speeds().iter().sum::<f64>() / 4.0;
        let velocity =
            (turbine.structure().frame(1e-4).hub - turbine.structure().frame(-1e-4).hub).x / 2e-4;
        assert!((shown - velocity).abs() < 2e-3, "{shown} {velocity}");
        fastest = fastest.max(velocity.abs());
        before = turbine.structure().frame(0.0).hub.max(before);
    }
    assert!(fastest > 0.01, "the tower does sway: {fastest}");
}

#[test]
fn a_turning_nacelle_carries_its_lidar_along() {
    let mut turbine = turbine(0.0, false);
    let beam = [
        ("scan", word("beams")),
        ("n_points", 4_u64.into()),
        ("radius_diameters", 0.5.into()),
        ("downwind", 10.0.into()),
    ];
    let mut sensing = sensing(&turbine, &beam);
    let winds = vec![Vector3::X * 8.0; turbine.stations().len()];
    let still = Commands { pitch: PerBlade::splat(3, 0.0), generator_torque: 0.0, yaw_rate: 0.02 };
    for _ in 0..100 {
        turbine.advance(INTERVAL, &winds, &still);
    }
    let calm = Wind { mean: Vector3::ZERO, ..EVEN };
    let reading = read(&mut sensing, &turbine, &calm, 0);
    let scan = Scan::of(&reading).expect("a scan");
    // 5 m behind the yaw axis: it moves to the left by rate times arm, towards beams on the left.
    let rate = turbine.structure().state().yaw.rate;
    for point in 0..4 {
        let y = scan.left()[point];
        let expected = -rate * 5.0 * y / 120.0_f64.hypot(60.0);
        assert!((scan.speeds()[point] - expected).abs() < 1e-6, "{}", scan.speeds()[point]);
    }
    assert!(rate > 0.015);
}

#[test]
fn a_probe_volume_dampens_a_wave_along_its_beams() {
    let turbine = turbine(0.0, false);
    let wind = Wind { mean: Vector3::ZERO, wave: Some(100.0), ..EVEN };
    let thin =
        [("scan", word("beams")), ("n_points", 4_u64.into()), ("radius_diameters", 0.01.into())];
    let with = |probe: &str, length: f64| {
        let probe = [("probe", word(probe)), ("probe_length", length.into())];
        let reading = first(&turbine, &wind, &[thin.to_vec(), probe.to_vec()].concat());
        Scan::of(&reading).expect("a scan").speeds()[0]
    };
    let sharp = Scan::of(&first(&turbine, &wind, &thin)).expect("a scan").speeds()[0];
    let k = 2.0 * PI / 100.0;
    let deviation = 30.0 / (8.0 * 2.0_f64.ln()).sqrt();
    assert!((with("gaussian", 30.0) / sharp - (-0.5 * (k * deviation).powi(2)).exp()).abs() < 2e-3);
    assert!((with("lorentzian", 5.0) / sharp - (-k * 5.0).exp()).abs() < 0.06);
}

#[test]
fn ranges_are_distances_along_every_beam() {
    let turbine = turbine(0.0, false);
    let pulsed = [
        ("scan", word("beams")),
        ("n_points", 4_u64.into()),
        ("ranges_diameters", vec![0.5, 1.0, 2.0].into()),
    ];
    let mut sensing = sensing(&turbine, &pulsed);
    assert_eq!(sensing.channels().len(), 2 + 12);
    let reading = read(&mut sensing, &turbine, &EVEN, 0);
    let scan = Scan::of(&reading).expect("a scan");
    for (gate, range) in [60.0, 120.0, 240.0].into_iter().enumerate() {
        for point in 4 * gate..4 * gate + 4 {
            let place = Vector3::new(scan.downwind()[point], scan.left()[point], scan.up()[point]);
            assert!((place.length() - range).abs() < 1e-9);
            // Opened so that the furthest range has the pattern's radius for a flat distance of 2 D.
            assert!((place.y.hypot(place.z) / place.x - 60.0 / 240.0).abs() < 1e-9);
        }
    }
}

#[test]
fn blades_block_the_beams_of_a_nacelle_that_look_upwind() {
    let mut turbine = turbine(0.0, false).at_held_speed();
    let upwind = [
        ("looks", word("upwind")),
        ("downwind", 8.0.into()),
        ("above", 4.0.into()),
        ("scan", word("beams")),
        ("n_points", 1_u64.into()),
        ("tilt_deg", 5.0.into()),
        ("radius_diameters", 0.02.into()),
    ];
    let mut sensing = sensing(&turbine, &upwind);
    let still = Commands { pitch: PerBlade::splat(3, 0.0), generator_torque: 0.0, yaw_rate: 0.0 };
    let winds = vec![Vector3::ZERO; turbine.stations().len()];
    let (mut n_lost, mut wrong) = (0, 0);
    for step in 0..200 {
        let reading = read(&mut sensing, &turbine, &EVEN, step);
        let is_lost = Scan::of(&reading).expect("a scan").speeds()[0].is_nan();
        n_lost += i32::from(is_lost);
        // The beam passes 4 to 5 m above the hub: near the top a blade of 3 to 4 m is in its way.
        let azimuth = turbine.structure().azimuth();
        let nearest = (0..3)
            .map(|blade| {
                basis::angle::wrap_to_half_turn(azimuth + 2.0 * PI / 3.0 * f64::from(blade)).abs()
            })
            .fold(PI, f64::min);
        wrong += i32::from(is_lost && nearest > 0.6 || !is_lost && nearest < 0.1);
        turbine.advance(INTERVAL, &winds, &still);
    }
    assert_eq!(wrong, 0);
    assert!((10..150).contains(&n_lost), "{n_lost}");
}

mod in_use;
