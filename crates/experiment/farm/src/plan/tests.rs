//! Domains that fit, steps that tips do not outrun, and errors that name what does not fit.

mod boxes;

use super::step::FASTEST_TIP;
use super::*;
use crate::case::{
    Control, DynamicInflow, FROM_WEST, Flow, Instruments, Output, Placement, Position, Run, Shear,
    Solver, Time, TowerInfluence, TurbulenceModel, Wind,
};
use flow::lattice::{Stencil, Subgrid, SubgridModel};

fn case(positions: &[[f64; 2]]) -> Case {
    let placement = |(index, &position): (usize, &[f64; 2])| Placement {
        name: format!("T{}", index + 1),
        model: "model".to_owned(),
        discon: None,
        torque_gain: None,
        position: Position::Diameters(position),
        yaw: 0.0,
        pitch_misalignment: Vec::new(),
        flexible: true,
        structure_step: None,
        dynamic_stall: false,
        dynamic_inflow: DynamicInflow::default(),
        tower_influence: TowerInfluence::None,
        instruments: Instruments::default(),
        sensors: Vec::new(),
    };
    Case {
        name: "test".to_owned(),
        description: None,
        wind: Wind {
            speed: 9.0,
            direction: FROM_WEST,
            turbulence_intensity: 0.05,
            shear: Shear::PowerLaw { exponent: 0.1 },
            length_scale: None,
            anisotropy: 3.9,
            seed: 1,
            air_density: 1.225,
            kinematic_viscosity: 1.5e-5,
            turbulence_model: TurbulenceModel::Mann,
            grid: None,
            planes: None,
            precursor: None,
            precursor_beside: false,
            beyond_planes: None,
            cut: None,
            table: None,
            veer: 0.0,
            event: None,
        },
        flow: Flow {
            solver: Solver::LATTICE,
            values: basis::keys::Values::default(),
            step: None,
            threads: None,
        },
        time: Time { spin_up: 300.0, duration: 1500.0, block: 600.0 },
        turbines: positions.iter().enumerate().map(placement).collect(),
        runs: vec![Run {
            name: "baseline".to_owned(),
            compare_with: None,
            control: vec![Control::baseline(); positions.len()],
        }],
        output: Output {
            interval: None,
            plane_interval: None,
            lines_at: Vec::new(),
            inflow_at: Vec::new(),
            helix_phases: None,
            crosswind_diameters: Vec::new(),
            volume_interval: None,
            filament_interval: None,
            keeps_scans: true,
            volume_stride: 2,
            checkpoint_interval: 60.0,
            keeps_checkpoint: true,
            further: Vec::new(),
        },
    }
}

fn settings_of(case: &Case, plan: &Plan) -> LatticeSettings {
    let site = crate::wind::Site { case, plan, models: &[], surroundings: None };
    crate::assemble::lattice_settings(&site)
}

fn footprints() -> BTreeMap<String, Footprint> {
    let footprint =
        Footprint { diameter: 240.0, hub_height: 150.0, tip_speed: 81.0, rated_tip_speed: 95.0 };
    BTreeMap::from([("model".to_owned(), footprint)])
}

#[test]
fn the_domain_follows_the_layout() {
    let plan = plan(&case(&[[0.0, 0.0], [5.0, 1.0]]), &footprints()).unwrap();
    assert_eq!(plan.spacing, 15.0);
    // 3 + 5 + 4 D along, 6 + 1 D across, 4 D up.
    assert_eq!(plan.n_cells, [192, 112, 64]);
    assert_eq!(plan.origin, Vector3::new(-720.0, -720.0, 0.0));
    assert_eq!(plan.positions[1], Vector3::new(1200.0, 240.0, 0.0));
    let blockage = std::f64::consts::PI / 4.0 / 28.0;
    assert!((plan.blockage - blockage).abs() < 1e-12);
}

#[test]
fn the_domain_follows_the_wind() {
    // From the north T2, 5 D east of T1, stands 5 D to the left of it; T3, south of T1, downwind.
    let mut case = case(&[[0.0, 0.0], [5.0, 0.0], [0.0, -4.0]]);
    case.wind.direction = 0.0;
    let plan = plan(&case, &footprints()).unwrap();
    assert_eq!(plan.positions[1], Vector3::new(0.0, 1200.0, 0.0));
    assert_eq!(plan.positions[2], Vector3::new(960.0, 0.0, 0.0));
    // 3 + 4 + 4 D along, 6 + 5 D across.
    assert_eq!(plan.n_cells, [176, 176, 64]);
    assert_eq!(plan.origin, Vector3::new(-720.0, -720.0, 0.0));
    // From the south T3 is the foremost, and planes behind T1 reach its wake no more.
    case.wind.direction = std::f64::consts::PI;
    case.output.crosswind_diameters = vec![5.0];
    let beyond = super::plan(&case, &footprints()).unwrap_err().to_string();
    assert!(beyond.contains("5 diameters behind"), "{beyond}");
}

#[test]
fn metres_and_diameters_are_told_apart() {
    let mut case = case(&[[0.0, 0.0], [5.0, 1.0]]);
    assert_eq!(case.feet(240.0), [[0.0, 0.0], [1200.0, 240.0]]);
    assert_eq!(case.places_in_diameters(240.0), case.places());
    case.turbines[0].position = Position::Metres([4e5, 5e6]);
    case.turbines[1].position = Position::Metres([4e5 + 1200.0, 5e6]);
    assert_eq!(case.feet(240.0), [[0.0, 0.0], [1200.0, 0.0]]);
    assert_eq!(case.places_in_diameters(240.0)[1], [5.0, 0.0]);
}

#[test]
fn the_step_keeps_tips_and_wind_slow_and_minutes_whole() {
    let plan = plan(&case(&[[0.0, 0.0]]), &footprints()).unwrap();
    let tip = 81.0 * plan.interval / plan.spacing;
    assert!(tip <= FASTEST_TIP && tip > 0.98 * FASTEST_TIP, "{tip} cells a step");
    assert!(plan.lattice_speed <= MAXIMUM_LATTICE_SPEED);
    let per_minute = 60.0 / plan.interval;
    assert!((per_minute - per_minute.round()).abs() < 1e-9);
    assert_eq!(plan.n_steps as f64 * plan.interval, 1500.0);
}

#[test]
fn the_lattice_is_computed_as_the_case_asks() {
    let settings_and_memory = |case: &Case| {
        let plan = plan(case, &footprints()).unwrap();
        let settings = settings_of(case, &plan);
        ((settings.stencil, settings.subgrid), (case.flow.solver.memory)(case, &plan))
    };
    let plain = case(&[[0.0, 0.0]]);
    let (method, memory) = settings_and_memory(&plain);
    assert_eq!(method, (Stencil::D3Q19, Subgrid::smagorinsky(0.12)));

    let mut asked = plain.clone();
    asked.flow.values.set("velocity_set", "d3q27");
    let (method, more) = settings_and_memory(&asked);
    assert_eq!(method, (Stencil::D3Q27, Subgrid::smagorinsky(0.12)));
    assert_eq!(more * 80, memory * 112, "27 and 19 populations of four bytes, and four more");

    asked.flow.values.set("smagorinsky_constant", 0.1);
    assert_eq!(settings_and_memory(&asked).0, (Stencil::D3Q27, Subgrid::smagorinsky(0.1)));

    let mut asked = plain.clone();
    asked.flow.values.set("subgrid", "vreman");
    let (method, more) = settings_and_memory(&asked);
    assert_eq!(method, (Stencil::D3Q19, Subgrid::new(SubgridModel::Vreman)));
    assert_eq!(more * 80, memory * 100, "four values more, and what lies beyond the rows' ends");
    asked.flow.values.set("subgrid_constant", 0.05);
    let vreman = Subgrid { model: SubgridModel::Vreman, constant: 0.05 };
    assert_eq!(settings_and_memory(&asked).0, (Stencil::D3Q19, vreman));
}

#[test]
fn what_does_not_fit_is_named_with_its_fix() {
    let error = |case: &Case| plan(case, &footprints()).unwrap_err().to_string();

    let overlapping = error(&case(&[[0.0, 0.0], [0.5, 0.5]]));
    assert!(overlapping.contains("T1 and T2 overlap"), "{overlapping}");

    let mut low = case(&[[0.0, 0.0]]);
    low.flow.values.set("height_diameters", 1.0);
    let outside = error(&low);
    assert!(
        outside.contains("z = 30 to 270 m") && outside.contains("height_diameters"),
        "{outside}"
    );

    let mut coarse = case(&[[0.0, 0.0]]);
    coarse.flow.values.set("cells_per_diameter", 6.0);
    assert!(error(&coarse).contains("at least 8"), "{}", error(&coarse));

    let mut long = case(&[[0.0, 0.0]]);
    long.flow.step = Some(0.15);
    let outrun = error(&long);
    assert!(outrun.contains("0.81 cells a step") && outrun.contains("0.1069 s"), "{outrun}");

    let mut fast = case(&[[0.0, 0.0]]);
    fast.flow.step = Some(0.1);
    fast.wind.speed = 24.0;
    assert!(error(&fast).contains("the wind moves 0.16 cells"), "{}", error(&fast));

    // A hundredth of the longest step, at which the tip moves with the sound.
    let mut short = case(&[[0.0, 0.0]]);
    short.flow.step = Some(0.00106);
    assert!(error(&short).contains("at least 1.07e-3 s"), "{}", error(&short));
    short.flow.step = Some(0.00108);
    assert!(plan(&short, &footprints()).is_ok());

    let mut rough = case(&[[0.0, 0.0]]);
    rough.wind.shear = Shear::LogLaw { roughness_length: 16.0 };
    assert!(error(&rough).contains("wind.roughness_length = 16 m is too much for a hub at 150 m"));
    rough.flow.solver = Solver::UNIFORM;
    assert!(error(&rough).contains("15.0 m, a tenth of it, is the maximum"), "{}", error(&rough));
    rough.wind.shear = Shear::LogLaw { roughness_length: 15.0 };
    assert!(plan(&rough, &footprints()).is_ok());

    // 810 m from the hub to the top.
    let mut veering = case(&[[0.0, 0.0]]);
    veering.wind.veer = 0.1_f64.to_radians();
    let turned = error(&veering);
    assert!(turned.contains("by 81° within the domain, which is 960 m high"), "{turned}");
    assert!(turned.contains("the maximum is 60°; use at most 0.0740, or lower"), "{turned}");
    veering.wind.veer = 0.07_f64.to_radians();
    assert!(plan(&veering, &footprints()).is_ok());

    let mut other = case(&[[0.0, 0.0]]);
    other.turbines[0].model = "iea-10mw".to_owned();
    assert!(error(&other).contains("`iea-10mw`"));
}

#[test]
fn prescribed_wind_needs_no_cells_and_thins_its_rows() {
    let mut case = case(&[[0.0, 0.0]]);
    case.flow.solver = Solver::TURBULENCE;
    let plan = plan(&case, &footprints()).unwrap();
    assert_eq!((plan.cells(), plan.n_steps, plan.row_stride), (0, 75_000, 5));
    assert!((plan.row_interval() - PRESCRIBED_ROW).abs() < 1e-12);
    case.flow.step = Some(0.01);
    case.output.interval = Some(0.05);
    let finer = super::plan(&case, &footprints()).unwrap();
    assert_eq!((finer.n_steps, finer.row_stride), (150_000, 5));
}

#[test]
fn rotors_that_turn_fast_take_shorter_steps_in_prescribed_wind() {
    let mut case = case(&[[0.0, 0.0]]);
    case.flow.solver = Solver::UNIFORM;
    // A model of 0.58 m at tip-speed ratio 5 in 5 m/s: 86 rad/s.
    let footprint =
        Footprint { diameter: 0.58, hub_height: 1.425, tip_speed: 25.0, rated_tip_speed: 25.0 };
    let small = plan(&case, &BTreeMap::from([("model".to_owned(), footprint)])).unwrap();
    assert!((small.interval * 25.0 / 0.29 - FARTHEST_PRESCRIBED_TURN).abs() < 1e-12);
    assert!((small.row_interval() / small.interval - 5.0).abs() < 1e-9);
    case.flow.step = Some(1e-3);
    let asked = plan(&case, &BTreeMap::from([("model".to_owned(), footprint)])).unwrap();
    assert_eq!(asked.interval, 1e-3);
}

#[test]
fn a_free_wake_is_laid_out_for_the_fastest_that_the_wind_may_turn_its_rotor() {
    let mut case = case(&[[0.0, 0.0]]);
    case.flow.solver = Solver::named("vortex").expect("a solver");
    case.flow.values = basis::keys::Values::defaults(case.flow.solver.keys);
    let laid_out = |case: &Case| plan(case, &footprints());
    // 81 m/s at 120 m: 0.675 rad/s, and 0.79 at rated speed; 45° take 1.16 s and 0.99 s.
    case.flow.step = Some(1.1);
    let refused = laid_out(&case).expect_err("turbulence may bring it to rated speed").to_string();
    assert_eq!(
        refused,
        "flow.step = 1.1 s is too long: T1 turns by 50° in a step at its rated speed, which this wind may bring it to, the maximum is 45°; use at most 0.9920 s, or leave the key out"
    );
    case.wind.turbulence_intensity = 0.0;
    let turn = laid_out(&case).expect("no wind brings it there").turn;
    assert!((turn - 1.1 * 81.0 / 120.0).abs() < 1e-12, "{turn}");
    case.wind.table = Some("u.csv".to_owned());
    assert!(laid_out(&case).is_err());
    case.flow.step = None;
    case.flow.values.set("steps_per_turn", 8.0);
    let refused = laid_out(&case).expect_err("52.8° at rated speed");
    assert_eq!(refused.key(), ["flow", "steps_per_turn"]);
    assert!(refused.to_string().ends_with("the maximum is 45°; use 10 or more"), "{refused}");
    case.flow.values.set("steps_per_turn", 10.0);
    assert!(laid_out(&case).is_ok());
}
