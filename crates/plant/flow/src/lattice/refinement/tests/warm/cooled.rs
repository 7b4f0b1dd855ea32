//! Boxes on a ground that cools the air, and up to a top below which waves are damped.

use super::*;

/// Air of 200 m × 160 m × 120 m over a rough ground with `heating`, periodic, in cells of 10 m.
fn over_ground(heating: Heating) -> LatticeSettings {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [20, 16, 12], 0.1, 8.0);
    (settings.ends, settings.sides) = (Ends::Periodic, Sides::Periodic);
    settings.ground = Ground::WallStress { roughness_length: 0.1 };
    settings.atmosphere = Some(Atmosphere {
        heating,
        driving: Driving::Geostrophic([8.0, 0.0]),
        damping: Some(Damping { from: 80.0, rate: 0.02 }),
        ..Atmosphere::new(290.0)
    });
    settings
}

fn blowing(settings: LatticeSettings, boxes: &[Refinement]) -> Refined {
    refined(settings, boxes, |_, x| Vector3::new(8.0, 0.02 * x.z.sin(), 0.0))
}

/// One box on the ground, and one in it, up to the height of a level.
fn on_ground(height: usize) -> Refinement {
    let mut place = cells([4, 4, 0], [10, 8, height]);
    place.within.push(cells([4, 4, 0], [10, 8, if height == 12 { 24 } else { 5 }]));
    place
}

#[test]
fn a_ground_takes_its_heat_from_boxes_up_to_the_top_too() {
    let flux = -0.05;
    for height in [5, 12] {
        let mut air = blowing(over_ground(Heating::Flux(flux)), &[on_ground(height)]);
        let before = mean(&air);
        air.advance(40.0, &[]).expect("no divergence");
        let (lost, expected) = (before - mean(&air), -flux * 40.0 / 120.0);
        println!("{height} levels: lost {lost} K of {expected} K");
        // No cold air has come up to where temperature is damped.
        assert!((lost / expected - 1.0).abs() < 1e-3, "{height}: {lost} K for {expected} K");
    }
}

#[test]
fn a_cold_ground_takes_as_much_in_a_box_as_on_such_cells_everywhere() {
    let heating = Heating::Ground { temperature: 286.0, rate: -1e-2 };
    let lost = |settings: LatticeSettings, boxes: &[Refinement]| {
        let mut air = blowing(settings, boxes);
        let before = mean(&air);
        air.advance(40.0, &[]).expect("no divergence");
        before - mean(&air)
    };
    let around = over_ground(heating);
    let (coarse, within) = (lost(around.clone(), &[]), lost(fine(&around), &[]));
    // A quarter of the ground.
    let expected = 0.75 * coarse + 0.25 * within;
    for height in [5, 12] {
        let found = lost(around.clone(), &[cells([4, 4, 0], [10, 8, height])]);
        println!("{height}: {found} K; {coarse} K coarse, {within} K fine, {expected} K expected");
        // A quarter of the box's air is blown off it meanwhile, or on to it, over ground that takes half as
        // much more from it on small cells: measured 0.9 %.
        assert!((found / expected - 1.0).abs() < 0.02, "{height}: {found} K for {expected} K");
    }
}

#[test]
fn damped_air_is_at_rest_in_a_box_up_to_the_top() {
    let mut settings = over_ground(Heating::None);
    settings.ground = Ground::Slip;
    if let Some(atmosphere) = &mut settings.atmosphere {
        atmosphere.temperature = vec![[0.0, 290.0], [55.0, 290.5], [88.0, 294.0], [120.0, 295.0]];
    }
    let wind = Vector3::X * 8.0;
    let mut air = refined(settings, &[on_ground(12)], move |_, _| wind);
    let before = warm_cells(&air);
    air.advance(60.0, &[]).expect("no divergence");
    let pairs = warm_cells(&air).into_iter().zip(&before);
    let warmed = pairs.map(|(a, b)| (a.temperature - b.temperature).abs()).fold(0.0, f64::max);
    let off = all_cells(&air).into_iter().map(|(_, v, _)| (v - wind).length()).fold(0.0, f64::max);
    println!("{warmed:e} K, {off:e} m/s");
    // As below the top: what the air conducts, and rounding.
    assert!(warmed < 3e-4, "{warmed} K");
    assert!(off < 3e-5, "{off} m/s");
}
