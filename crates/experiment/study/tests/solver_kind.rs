//! A kind of flow solver from outside: even wind with wakes that follow the rotors' thrust, its keys and all,
//! in this file alone; one line adds it to the list.

mod small;

use basis::keys::LeftOut::Value as Otherwise;
use basis::keys::{Key, Objection, Slip, above, from, key};
use basis::{Commands, PointForce, Truth, Vector3};
use farm::case::{Case, Solver};
use farm::solvers::{PRESCRIBED, SOLVERS, SolverError, SolverKind, Start};
use farm::{Air, Farm, FarmFlow, Plan, Recorder, assemble};
use flow::{FlowError, FlowSolver, Inflow, WindField};
use small::{NREL_5MW, case, laid_out};
use std::collections::BTreeMap;
use std::io::{Read, Result, Write};
use std::ops::ControlFlow;
use std::sync::Arc;

static KEYS: [Key; 2] = [
    key(
        "expansion",
        from(0.0, 0.2),
        "–",
        Otherwise("0.05"),
        "Growth of a wake's radius over distance.",
    )
    .mistaken(&[Slip { unit: "percent", factor: 0.01 }]),
    // The lattice has a key of this name, with another range and default.
    key(
        "width_diameters",
        above(0.0, 2.0),
        "D",
        Otherwise("1"),
        "Width of a wake where it begins.",
    ),
];

/// Even wind with wakes after Jensen (1983), Risø-M-2411.
static WAKES: SolverKind = SolverKind {
    name: "wakes",
    about: "prescribed wind with a wake behind each rotor that follows its thrust",
    keys: &KEYS,
    check: |values| {
        let still = values.number("expansion") == 0.0 && values.number("width_diameters") > 1.0;
        let objection = || Objection {
            key: Some("expansion"),
            message: "= 0 goes with wakes no wider than their rotors".to_owned(),
            label: "none",
            fix: "lower `width_diameters` to 1".to_owned(),
        };
        Vec::from_iter(still.then(objection))
    },
    uses_bound_vortices: true,
    has_wakes: true,
    begin: |start: Start| -> std::result::Result<Air, SolverError> {
        let Start { site, inflow, .. } = start;
        let values = &site.case.flow.values;
        let width = values.number("width_diameters");
        let disc = |(model, foot): (&assemble::TurbineModel, &Vector3)| Disc {
            hub: *foot + Vector3::Z * model.definition.rotor.hub_height,
            radius: width * model.definition.rotor_radius(),
            deficit: 0.0,
        };
        let discs = site.models.iter().zip(&site.plan.positions).map(disc).collect();
        let (speed, density) = (site.case.wind.speed, site.case.wind.air_density);
        let expansion = values.number("expansion");
        Ok(Box::new(Wakes { inflow, discs, expansion, speed, density, time: 0.0 }))
    },
    ..PRESCRIBED
};

struct Wakes {
    inflow: Arc<dyn Inflow>,
    discs: Vec<Disc>,
    /// Growth of a wake's radius over distance (–).
    expansion: f64,
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
                let radius = disc.radius + self.expansion * from.x;
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

/// All that is to be done beside the kind itself.
fn add() {
    static ADDED: std::sync::Once = std::sync::Once::new();
    ADDED.call_once(|| SOLVERS.add(&WAKES).expect("no kind is called so yet"));
}

/// A case of two turbines, five diameters apart, in the air of `flow`: the name of a solver in quotes, and
/// more keys on lines of their own.
fn text(flow: &str) -> String {
    let text = case("wakes", "", [1.0, 60.0], &[NREL_5MW; 2], "[[run]]\nname = \"baseline\"\n");
    text.replace("\"uniform\"", flow)
}

/// The farm of such a case.
fn farm_of(flow: &str) -> (Case, Plan, Farm<Air>) {
    add();
    farm_in(flow, None)
}

/// The same in the air of another `solver` that no list has.
fn farm_in(flow: &str, solver: Option<Solver>) -> (Case, Plan, Farm<Air>) {
    let (mut case, _, model) = laid_out(&text(flow), &[], "nrel-5mw");
    case.flow.solver = solver.unwrap_or(case.flow.solver);
    let solver = case.flow.solver;
    let footprints = BTreeMap::from([("nrel-5mw".to_owned(), model.footprint(case.wind.speed))]);
    let plan = farm::plan(&case, &footprints).expect("the layout fits");
    let models = vec![model.clone(), model];
    let site = farm::wind::Site { case: &case, plan: &plan, models: &models, surroundings: None };
    let inflow = farm::wind::without_turbulence(&case, &plan).expect("a plain wind");
    let start = Start { site, inflow, planes: None, progress: &|_| ControlFlow::Continue(()) };
    let air = (solver.begin)(start).expect("such air can be");
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
    let (case, plan, mut farm) = farm_of("\"wakes\"");
    assert_eq!((plan.cells(), (case.flow.solver.memory)(&case, &plan)), (0, 0));
    assert!(farm.flow().fields().is_none() && case.flow.solver == Solver(&WAKES));
    let [first, second] = advanced(&mut farm, 200);
    let [alone, unwaked] = advanced(&mut farm_of("\"uniform\"").2, 200);
    assert!((first / alone - 1.0).abs() < 1e-9, "nobody stands upstream of the first");
    // Rotors below rated take a thrust coefficient of 0.7 to 0.9: 1 − √(1 − C_T) is 0.45 to 0.68 where the
    // wake begins. Five diameters on the wake is (1 + 10 · 0.05)² as wide.
    let missing = 1.0 - second / unwaked;
    assert!((0.45 / 2.25..0.68 / 2.25).contains(&missing), "{missing}");
    // Without growth they come down as they began.
    let [_, second] = advanced(&mut farm_of("\"wakes\"\nexpansion = 0.0").2, 200);
    let missing = 1.0 - second / unwaked;
    assert!((0.45..0.68).contains(&missing), "{missing}");
}

#[test]
fn its_own_state_goes_through_a_checkpoint() {
    let (.., mut farm) = farm_of("\"wakes\"");
    advanced(&mut farm, 50);
    let mut bytes = Vec::new();
    farm.flow_mut().write_state(&mut bytes).expect("a sound state");
    let (.., mut other) = farm_of("\"wakes\"");
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
    farm_in("\"uniform\"", Some(Solver::PLANES));
}

#[test]
#[should_panic(expected = "disagree on whether the wind contains the rotors' induction")]
fn air_that_contradicts_its_descriptor_is_refused() {
    static LIAR: SolverKind =
        SolverKind { name: "liar", resolves_induction: true, begin: WAKES.begin, ..PRESCRIBED };
    farm_in("\"uniform\"", Some(Solver(&LIAR)));
}

#[test]
fn its_keys_are_checked_like_all_others_and_stand_in_the_reference() {
    add();
    let parse = |flow: &str| formats::case::parse("own.toml", &text(flow), &[]);
    let cases = [
        (
            "\"wakes\"\nexpansion = 5",
            "own.toml:8: `flow.expansion` = 5 is out of range: 0 <= expansion <= 0.2; did you mean 0.05? 5 percent would be that",
        ),
        (
            "\"wakes\"\nwidth_diameters = 3",
            "own.toml:8: `flow.width_diameters` = 3 is out of range: 0 < width_diameters <= 2 D; Width of a wake where it begins.",
        ),
        (
            "\"wakes\"\nexpanson = 0.1",
            "own.toml:8: there is no key `flow.expanson`; did you mean `expansion`?",
        ),
        (
            "\"wakes\"\nexpansion = 0\nwidth_diameters = 1.5",
            "own.toml:8: `flow.expansion` = 0 goes with wakes no wider than their rotors; lower `width_diameters` to 1",
        ),
        (
            "\"wake\"",
            "own.toml:7: `flow.solver` = \"wake\" is unknown; expected one of \"lattice\", \"uniform\", \"turbulence\", \"planes\", \"vortex\", \"wakes\"; did you mean \"wakes\"?",
        ),
        // Keys of other solvers may stand there, and are right or wrong whoever moves the air.
        ("\"uniform\"\nexpansion = 5", "own.toml:8: `flow.expansion` = 5 is out of range"),
        (
            "\"wakes\"\ncells_per_diameter = 1",
            "own.toml:8: `flow.cells_per_diameter` = 1 is out of range: 8 <= cells_per_diameter <= 200",
        ),
        (
            "\"uniform\"\nwidth_diameters = 1.5",
            "`flow.width_diameters` = 1.5 is out of range: 2 <= width_diameters <= 100 D",
        ),
    ];
    for (flow, expected) in cases {
        let lines = parse(flow).expect_err(flow).to_lines();
        assert!(
            lines.starts_with(expected) || !expected.starts_with("own") && lines.contains(expected),
            "{flow}\nexpected {expected}\nfound    {lines}"
        );
        assert_eq!(lines.lines().count(), 1, "{lines}");
    }
    let reference = formats::case::reference();
    for line in
        ["Growth of a wake's radius over distance.", "| no | `expansion`, `width_diameters` |"]
    {
        assert!(reference.contains(line), "{line}");
    }
    let schema = formats::case::schema();
    assert!(schema.contains("\"wakes\"") && schema.contains("\"expansion\""));
}

#[test]
fn what_its_keys_hold_is_written_and_read_back() {
    add();
    let parse = |flow: &str| formats::case::parse("own.toml", &text(flow), &[]).expect(flow);
    let case = parse("\"wakes\"\nexpansion = 0.1\ncells_per_diameter = 20");
    let values = &case.flow.values;
    assert_eq!((values.number("expansion"), values.number("width_diameters")), (0.1, 1.0));
    assert!(!values.has("cells_per_diameter"), "{values:?}");
    let written = formats::case::write(&case);
    let keys = "solver = \"wakes\"\nexpansion = 0.1\nwidth_diameters = 1.0\nstep = 0.2\n";
    assert!(written.contains(keys), "{written}");
    assert_eq!(formats::case::parse("again", &written, &[]).expect("it was written"), case);
    let of = |case: &Case| formats::case::fingerprint(&formats::case::write(case), "baseline");
    assert_ne!(of(&case), of(&parse("\"wakes\"\nexpansion = 0.11")));
    // What other solvers would use decides nothing.
    assert_eq!(of(&case), of(&parse("\"wakes\"\nexpansion = 0.1")));
    assert_eq!(of(&parse("\"uniform\"\nexpansion = 0.1")), of(&parse("\"uniform\"")));
}
