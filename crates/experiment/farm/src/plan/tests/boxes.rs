//! Boxes of finer cells in a plan: where they lie, what they cost, and what is refused.

use super::*;
use basis::keys::{Value, Values};
use proptest::prelude::*;

/// A box around `around`, with what `keys` say.
fn asked(around: &[&str], keys: &[(&'static str, f64)]) -> Values {
    let mut values = Values::none();
    if !around.is_empty() {
        let names = around.iter().map(|name| (*name).to_owned()).collect();
        values.set("around", Value::Names(names));
    }
    keys.iter().for_each(|(key, value)| values.set(key, *value));
    values
}

/// Turbines at `positions` with these boxes around them.
fn boxed(positions: &[[f64; 2]], boxes: &[Values]) -> Case {
    let mut case = case(positions);
    case.flow.values.set("refinement", Value::Tables(boxes.to_vec()));
    case
}

fn error(case: &Case) -> PlanError {
    plan(case, &footprints()).unwrap_err()
}

#[test]
fn a_box_follows_the_layout() {
    let case = boxed(&[[0.0, 0.0], [5.0, 1.0]], &[asked(&[], &[("downstream_diameters", 2.25)])]);
    let plan = plan(&case, &footprints()).unwrap();
    // Cells of 15 m: 1 + 5 + 2.25 D along, 2 + 1 D across, 2 D up, in cells of 7.5 m.
    let [domain, one] = plan.grids().try_into().unwrap();
    assert_eq!((domain.n_cells, domain.spacing), (plan.n_cells, 15.0));
    assert_eq!((one.n_cells, one.spacing), ([264, 96, 64], 7.5));
    assert_eq!(one.origin, [-240.0, -240.0, 0.0]);
    assert_eq!((plan.levels.as_slice(), plan.spacing_at(1)), (&[1, 1][..], 7.5));
    assert_eq!(plan.cells(), domain.cells() + one.cells());
    // The domain's cells make a step in two.
    let updates = 0.5 * domain.cells() as f64 + one.cells() as f64;
    assert_eq!((plan.updates_of_step(), plan.base_interval()), (updates, 2.0 * plan.interval));
    // Steps of the fine cells are those of a grid of such cells everywhere, a minute is whole steps of both.
    let mut fine = case.clone();
    fine.flow.values = Values::none();
    fine.flow.values.set("cells_per_diameter", 32.0);
    let fine = super::plan(&fine, &footprints()).unwrap();
    assert!((plan.interval / fine.interval - 1.0).abs() < 0.01);
    assert!(plan.interval <= fine.interval);
    let per_minute = 60.0 / plan.base_interval();
    assert!((per_minute - per_minute.round()).abs() < 1e-9);
    assert_eq!((plan.n_steps % 2, plan.n_spin_up_steps % 2), (0, 0));
    assert!((plan.n_steps as f64 * plan.interval - 1500.0).abs() < plan.base_interval());
    // Alone, a turbine stands in cells like its own.
    let alone = plan.alone(0);
    assert_eq!((alone.spacing, alone.spacing_at(0), alone.depth()), (7.5, 7.5, 0));
    assert_eq!(alone.interval, plan.interval);
}

#[test]
fn a_box_within_a_box_halves_again() {
    let outer =
        [("downstream_diameters", 4.0), ("width_diameters", 4.0), ("height_diameters", 3.0)];
    let outer = asked(&[], &outer);
    let inner = asked(&["T2"], &[("downstream_diameters", 1.0)]);
    // In whichever order they stand.
    for boxes in [[outer.clone(), inner.clone()], [inner.clone(), outer.clone()]] {
        let plan = plan(&boxed(&[[0.0, 0.0], [5.0, 0.0]], &boxes), &footprints());
        // The outer one's end is too close to the outlet.
        assert!(matches!(plan, Err(PlanError::BoxOutside { .. })), "{plan:?}");
        let mut case = boxed(&[[0.0, 0.0], [5.0, 0.0]], &boxes);
        case.flow.values.set("downstream_diameters", 7.0);
        let plan = super::plan(&case, &footprints()).unwrap();
        assert_eq!((plan.depth(), plan.levels.as_slice()), (2, &[1, 2][..]));
        assert_eq!([0, 1].map(|index| plan.spacing_at(index)), [7.5, 3.75]);
        assert_eq!((plan.boxes.len(), plan.boxes[0].within.len()), (1, 1));
        let levels: Vec<u32> = plan.grids().iter().map(|grid| grid.level).collect();
        assert_eq!(levels, [0, 1, 2]);
        let [domain, outer, inner] = plan.grids().try_into().unwrap();
        let updates = 0.25 * domain.cells() as f64 + 0.5 * outer.cells() as f64;
        assert_eq!(plan.updates_of_step(), updates + inner.cells() as f64);
    }
}

#[test]
fn boxes_in_an_atmosphere_and_between_open_sides_keep_off() {
    let row = [[0.0, 0.0], [5.0, 0.0]];
    // A cell of 15 m more than in air without temperature.
    let close = |upstream| boxed(&row, &[asked(&[], &[("upstream_diameters", upstream)])]);
    let mut case = close(3.0 - 2.0 / 16.0);
    assert!(plan(&case, &footprints()).is_ok());
    case.wind.precursor = Some("layer".to_owned());
    let words = error(&case).to_string();
    assert!(words.contains("has room from -675 to"), "{words}");
    assert!(words.contains("3 cells before its sides"), "{words}");
    let mut case = close(3.0 - 3.0 / 16.0);
    case.wind.precursor = Some("layer".to_owned());
    assert!(plan(&case, &footprints()).is_ok());

    let mut filled = boxed(&row, &[asked(&[], &[("width_diameters", 6.0)])]);
    assert!(plan(&filled, &footprints()).is_ok());
    filled.flow.values.set("sides", Value::Text("open".into()));
    let words = error(&filled).to_string();
    assert!(words.contains("spans y") && words.contains("lower its width_diameters"), "{words}");
}

#[test]
fn boxes_in_an_atmosphere_meet_earlier() {
    let row = [[0.0, 0.0], [5.0, 0.0]];
    let short = |downstream| {
        let of = [("upstream_diameters", 1.0), ("downstream_diameters", downstream)];
        [asked(&["T1"], &of), asked(&["T2"], &[of[0], ("downstream_diameters", 1.0)])]
    };
    // From one to the other 4 D less what the first one takes, in cells of 15 m: two, and three.
    let mut case = boxed(&row, &short(4.0 - 2.0 / 16.0));
    assert!(plan(&case, &footprints()).is_ok());
    case.wind.precursor = Some("layer".to_owned());
    let near = error(&case);
    assert_eq!(near.key(), ["flow", "refinement", "1"]);
    assert!(near.to_string().contains("less than 3 cells apart"), "{near}");
    let mut case = boxed(&row, &short(4.0 - 3.0 / 16.0));
    case.wind.precursor = Some("layer".to_owned());
    assert!(plan(&case, &footprints()).is_ok());

    // One in the other, in cells of 7.5 m.
    let nested = |room: f64| {
        let outer = [("upstream_diameters", 1.5), ("height_diameters", 3.0)];
        let inner = [("upstream_diameters", 1.5 - room / 32.0), ("downstream_diameters", 1.0)];
        let mut case = boxed(
            &[[0.0, 0.0]],
            &[asked(&[], &[outer[0], outer[1], ("width_diameters", 3.0)]), asked(&[], &inner)],
        );
        case.wind.precursor = Some("layer".to_owned());
        case
    };
    let near = error(&nested(2.0));
    assert_eq!(near.key(), ["flow", "refinement", "1", "upstream_diameters"]);
    assert!(near.to_string().contains("in flow.refinement.0: 3 cells"), "{near}");
    assert!(plan(&nested(3.0), &footprints()).is_ok());
}

#[test]
fn a_box_in_an_atmosphere_reaches_the_top_or_keeps_off() {
    // The domain is 4 D high, 64 cells.
    let high = |height| {
        let of = [("height_diameters", height), ("downstream_diameters", 2.0)];
        let mut case = boxed(&[[0.0, 0.0], [5.0, 0.0]], &[asked(&[], &of)]);
        case.wind.precursor = Some("layer".to_owned());
        case
    };
    let close = error(&high(4.0 - 2.0 / 16.0));
    assert_eq!(close.key(), ["flow", "refinement", "0", "height_diameters"]);
    let words = close.to_string();
    assert!(
        words.contains("lower its height_diameters, or raise flow.height_diameters"),
        "{words}"
    );
    assert!(words.contains("or make it reach them"), "{words}");
    assert!(plan(&high(4.0 - 3.0 / 16.0), &footprints()).is_ok());
    assert_eq!(plan(&high(4.0), &footprints()).unwrap().boxes[0].n_cells[2], 64);
}

#[test]
fn a_ground_too_rough_for_the_cells_on_it_is_refused_early() {
    // The middle of the lowest cells, 7.5 m and in the box 3.75 m high, over e.
    let rough = |length: f64, boxes: &[Values]| {
        let mut case = boxed(&[[0.0, 0.0], [5.0, 0.0]], boxes);
        let mut ground = Values::none();
        ground.set("roughness_length", length);
        case.flow.values.set("ground", Value::Table(ground));
        case
    };
    let fits = |case: &Case| plan(case, &footprints()).is_ok();
    let one = asked(&[], &[("downstream_diameters", 2.25)]);
    assert!(fits(&rough(2.7, &[])) && fits(&rough(1.37, std::slice::from_ref(&one))));

    let domain = error(&rough(2.8, std::slice::from_ref(&one)));
    assert_eq!(domain.key(), ["flow", "ground", "roughness_length"]);
    let words = domain.to_string();
    assert!(words.contains("of flow bear 2.759 m") && words.contains("lower it, or"), "{words}");

    let boxed = error(&rough(1.4, &[one]));
    let words = boxed.to_string();
    assert!(words.contains("of flow.refinement bear 1.379 m"), "{words}");
    assert!(words.contains("or leave out a box"), "{words}");
    assert_eq!(
        PlanError::Cells { place: "flow.refinement", reason: "x".into() }.key(),
        ["flow", "refinement"]
    );
}

#[test]
fn what_boxes_cannot_do_is_named_with_its_fix() {
    let row = [[0.0, 0.0], [5.0, 0.0]];
    let one = |keys: &[(&'static str, f64)]| boxed(&row, &[asked(&[], keys)]);

    // The domain begins 3 D before the first turbine, at −720 m.
    let before = error(&one(&[("upstream_diameters", 3.0)]));
    assert_eq!(before.key(), ["flow", "refinement", "0", "upstream_diameters"]);
    let words = before.to_string();
    assert!(words.contains("spans x = -720 to 1680 m, and has room from -690 to"), "{words}");
    assert!(words.contains("or raise flow.upstream_diameters"), "{words}");

    // A tenth of the 192 cells before the outlet at 2160 m, and two of them.
    let behind = error(&one(&[("downstream_diameters", 3.5)]));
    assert!(behind.to_string().contains("to 1845 m in the domain"), "{behind}");
    assert!(behind.to_string().contains("lower its downstream_diameters"), "{behind}");

    let wide = error(&one(&[("width_diameters", 5.8), ("downstream_diameters", 2.0)]));
    assert!(wide.to_string().contains("or make it reach them"), "{wide}");
    let filled = one(&[("width_diameters", 6.0), ("downstream_diameters", 2.0)]);
    let filled = plan(&filled, &footprints()).unwrap();
    assert_eq!(filled.boxes[0].n_cells[1], filled.n_cells[1]);

    let narrow = error(&one(&[("width_diameters", 1.2), ("downstream_diameters", 2.0)]));
    assert_eq!(narrow.key(), ["flow", "refinement", "0", "width_diameters"]);
    // 120 m of rotor and 6 cells of 7.5 m, where 144 m and what was rounded up are.
    assert!(narrow.to_string().contains("turbine T1 stands neither in"), "{narrow}");
    assert!(narrow.to_string().contains("raise its width_diameters by 0.13"), "{narrow}");

    let low = error(&one(&[("height_diameters", 1.2), ("downstream_diameters", 2.0)]));
    assert!(low.to_string().contains("m beyond it upwards"), "{low}");

    let short = [("upstream_diameters", 1.0), ("downstream_diameters", 2.0)];
    let around = |name| asked(&[name], &short);
    let meet = boxed(&[[0.0, 0.0], [2.5, 0.0]], &[around("T1"), around("T2")]);
    let meet = error(&meet);
    assert!(meet.to_string().contains("lay one box around the turbines of both"), "{meet}");
    assert_eq!(meet.key(), ["flow", "refinement", "1"]);
    let apart = boxed(&row, &[around("T1"), around("T2")]);
    assert_eq!(plan(&apart, &footprints()).unwrap().boxes.len(), 2);

    // T2 stands in the box around T1 with one half of its rotor.
    let pokes = error(&boxed(&[[0.0, 0.0], [2.0, 0.0]], &[around("T1")]));
    assert!(pokes.to_string().contains("turbine T2 stands neither in"), "{pokes}");
    assert!(pokes.to_string().contains("beyond it downstream"), "{pokes}");

    // The outer box of two that are alike leaves the inner one no room.
    let twice = error(&boxed(&row, &[around("T1"), around("T1")]));
    assert!(twice.to_string().contains("in flow.refinement.0: 2 cells"), "{twice}");
    assert!(twice.to_string().contains("or raise flow.refinement.0.upstream_d"), "{twice}");

    let nested: Vec<Values> = (0..5)
        .map(|level| {
            let room = 2.5 - 0.3 * f64::from(level);
            let [before, after] = [("upstream_diameters", room), ("downstream_diameters", room)];
            asked(
                &["T1"],
                &[before, after, ("width_diameters", 2.0 * room), ("height_diameters", room + 0.6)],
            )
        })
        .collect();
    let deep = error(&boxed(&row, &nested));
    assert_eq!(deep, PlanError::TooManyLevels { depth: 5 });
    assert!(plan(&boxed(&row, &nested[..4]), &footprints()).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Whatever a case asks for, boxes of a plan are such as the lattice takes, and rotors have their room.
    #[test]
    fn what_is_laid_out_can_be_built(
        sizes in prop::collection::vec((0.8..3.0_f64, 0.8..4.0_f64, 1.4..6.5_f64, 1.3..4.5_f64), 1..4),
        around in prop::collection::vec(0..3_usize, 3),
        place in (1.5..6.0_f64, -1.0..1.0_f64),
        is_warm in any::<bool>(),
    ) {
        let names = [&[][..], &["T1"], &["T2"]];
        let boxes: Vec<Values> = sizes
            .iter()
            .zip(around)
            .map(|((before, after, width, height), which)| {
                asked(names[which], &[
                    ("upstream_diameters", *before),
                    ("downstream_diameters", *after),
                    ("width_diameters", *width),
                    ("height_diameters", *height),
                ])
            })
            .collect();
        let mut case = boxed(&[[0.0, 0.0], [place.0, place.1]], &boxes);
        case.flow.values.set("cells_per_diameter", 8.0);
        case.wind.precursor = is_warm.then(|| "layer".to_owned());
        let found = plan(&case, &footprints());
        // Whatever the lattice would refuse is refused before, with the key that decides.
        prop_assert!(!matches!(found, Err(PlanError::Cells { .. })), "{:?}", found);
        let Ok(plan) = found else { return Ok(()) };
        let mut settings = settings_of(&case, &plan);
        settings.atmosphere = is_warm.then(|| flow::lattice::atmosphere::Atmosphere::new(290.0));
        prop_assert_eq!(flow::lattice::refinement::check(&settings, &plan.boxes), Ok(()));
        for (foot, level) in plan.positions.iter().zip(&plan.levels) {
            let hub = [foot.x, foot.y, 150.0];
            let inside = plan.grids().into_iter().filter(|grid| (0..3).all(|axis| {
                let reach = 120.0 + 6.0 * grid.spacing;
                let end = grid.origin[axis] + grid.n_cells[axis] as f64 * grid.spacing;
                let low = axis == 2 || hub[axis] - reach > grid.origin[axis] - 1e-3;
                let fills = axis == 1 && grid.n_cells[1] as f64 * grid.spacing >= 1440.0;
                fills || (low && hub[axis] + reach < end + 1e-3)
                    || (axis == 2 && end >= 960.0)
            }));
            prop_assert_eq!(inside.map(|grid| grid.level).max(), Some(*level));
        }
    }
}
