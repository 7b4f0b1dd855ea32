//! A kind of flow solver from outside: even wind with wakes that follow the rotors' thrust, in this file
//! alone.

mod small;

use basis::{Commands, PointForce, Truth, Vector3};
use farm::case::{Case, Solver};
use farm::solvers::{PRESCRIBED, SolverError, SolverKind, Start};
use farm::{Air, Farm, FarmFlow, Plan, Recorder, assemble};
use flow::{FlowError, FlowSolver, Inflow, WindField};
use small::{NREL_5MW, case, laid_out};
use std::collections::BTreeMap;
use std::io::{Read, Result, Write};
use std::sync::Arc;

/// Growth of a wake's radius over distance (–).
const EXPANSION: f64 = 0.05;

/// Even wind with wakes after Jensen (1983), Risø-M-2411.
static WAKES: SolverKind = SolverKind {
    name: "wakes",
    about: "prescribed wind with a wake behind each rotor that follows its thrust",
    has_wakes: true,
    begin: |start: Start| -> std::result::Result<Air, SolverError> {
        let Start { site, inflow, .. } = start;
        let disc = |(model, foot): (&assemble::Model, &Vector3)| Disc {
            hub: *foot + Vector3::Z * model.definition.rotor.hub_height,
            radius: model.definition.rotor_radius(),
            deficit: 0.0,
        };
        let discs = site.models.iter().zip(&site.plan.positions).map(disc).collect();
        let (speed, density) = (site.case.wind.speed, site.case.wind.air_density);
        Ok(Box::new(Wakes { inflow, discs, speed, density, time: 0.0 }))
    },
    ..PRESCRIBED
};

struct Wakes {
    inflow: Arc<dyn Inflow>,
    discs: Vec<Disc>,
    speed: f64,
    density: f64,
    time: f64,
}

struct Disc {
    hub: Vector3,
    radius: f64,
    /// Share of the wind that is missing where the wake begins (–).
    deficit: f64,
}

impl WindField for Wakes {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.inflow.sample(self.time, positions, velocities);
        for (position, velocity) in positions.iter().zip(velocities) {
            for disc in &self.discs {
                let from = *position - disc.hub;
                let radius = disc.radius + EXPANSION * from.x;
                if from.x > 2.0 * disc.radius && from.y.hypot(from.z) < radius {
                    velocity.x -= self.speed * disc.deficit * (disc.radius / radius).powi(2);
                }
            }
        }
    }
}

impl FlowSolver for Wakes {
    fn advance(
        &mut self,
        duration: f64,
        forces: &[PointForce],
    ) -> std::result::Result<(), FlowError> {
        for (index, disc) in self.discs.iter_mut().enumerate() {
            let of_blades = forces.iter().filter(|f| f.turbine == index && f.bound.is_some());
            let thrust: f64 = of_blades.map(|force| -force.force.x).sum();
            let area = std::f64::consts::PI * disc.radius.powi(2);
            let coefficient = thrust / (0.5 * self.density * area * self.speed.powi(2));
            disc.deficit = 1.0 - (1.0 - coefficient.clamp(0.0, 0.96)).sqrt();
        }
        self.time += duration;
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        false
    }
}

impl FarmFlow for Wakes {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        for value in self.discs.iter().map(|disc| disc.deficit).chain([self.time]) {
            writer.write_all(&value.to_le_bytes())?;
        }
        Ok(())
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let places = self.discs.iter_mut().map(|disc| &mut disc.deficit).chain([&mut self.time]);
        for place in places {
            let mut bytes = [0; 8];
            reader.read_exact(&mut bytes)?;
            *place = f64::from_le_bytes(bytes);
        }
        Ok(())
    }
}

/// Two turbines, five diameters apart, in the air of `solver`.
fn farm_in(solver: Solver) -> (Case, Plan, Farm<Air>) {
    let text = case("wakes", "", [1.0, 60.0], &[NREL_5MW; 2], "[[run]]\nname = \"baseline\"\n");
    let (mut case, _, model) = laid_out(&text, &[], "nrel-5mw");
    case.flow.solver = solver;
    let footprints = BTreeMap::from([("nrel-5mw".to_owned(), model.footprint(case.wind.speed))]);
    let plan = farm::plan(&case, &footprints).expect("the layout fits");
    let models = vec![model.clone(), model];
    let site = farm::wind::Site { case: &case, plan: &plan, models: &models };
    let inflow = farm::wind::without_turbulence(&case, &plan).expect("a plain wind");
    let air = (solver.begin)(Start { site, inflow, planes: None }).expect("such air can be");
    let farm = assemble::farm(&case, &case.runs[0], &plan, &models, air).expect("a farm");
    (case, plan, farm)
}

/// Keeps what the turbines last met.
#[derive(Default)]
struct Last([f64; 2]);

impl Recorder for Last {
    fn record(&mut self, turbine: usize, truth: &Truth, _: &Commands) {
        self.0[turbine] = truth.rotor_wind_speed;
    }
}

fn advanced(farm: &mut Farm<Air>, n_steps: usize) -> [f64; 2] {
    let mut last = Last::default();
    for _ in 0..n_steps {
        farm.advance(&mut last).expect("nothing can fail");
    }
    last.0
}

#[test]
fn a_kind_from_outside_moves_the_air_of_a_farm() {
    let solver = Solver(&WAKES);
    let (case, plan, mut farm) = farm_in(solver);
    assert_eq!((plan.cells(), (case.flow.solver.memory)(&plan)), (0, 0));
    assert!(farm.flow().fields().is_none() && case.flow.solver == solver);
    let [first, second] = advanced(&mut farm, 200);
    let [alone, unwaked] = advanced(&mut farm_in(Solver::UNIFORM).2, 200);
    assert!((first / alone - 1.0).abs() < 1e-9, "nobody stands upstream of the first");
    // Rotors below rated take a thrust coefficient of 0.7 to 0.9: 1 − √(1 − C_T) is 0.45 to 0.68 where the
    // wake begins. Five diameters on the wake is (1 + 10 · 0.05)² as wide.
    let missing = 1.0 - second / unwaked;
    assert!((0.45 / 2.25..0.68 / 2.25).contains(&missing), "{missing}");
}

#[test]
fn its_own_state_goes_through_a_checkpoint() {
    let (.., mut farm) = farm_in(Solver(&WAKES));
    advanced(&mut farm, 50);
    let mut bytes = Vec::new();
    farm.flow_mut().write_state(&mut bytes).expect("a sound state");
    let (.., mut other) = farm_in(Solver(&WAKES));
    other.flow_mut().read_state(&mut bytes.as_slice()).expect("what was written");
    let wind = |farm: &Farm<Air>| {
        let mut wind = [Vector3::ZERO];
        farm.flow().sample(&[Vector3::new(500.0, 0.0, 90.0)], &mut wind);
        wind[0]
    };
    assert_eq!(wind(&other), wind(&farm));
    assert!(wind(&farm).x < 8.0, "the probe stands in a wake: {}", wind(&farm));
}

#[test]
#[should_panic(expected = "NoPlanes { solver: \"planes\" }")]
fn planes_that_nobody_opened_are_refused() {
    farm_in(Solver::PLANES);
}

#[test]
#[should_panic(expected = "disagree on whether the wind contains the rotors' induction")]
fn air_that_contradicts_its_descriptor_is_refused() {
    static LIAR: SolverKind =
        SolverKind { name: "liar", resolves_induction: true, begin: WAKES.begin, ..PRESCRIBED };
    farm_in(Solver(&LIAR));
}
