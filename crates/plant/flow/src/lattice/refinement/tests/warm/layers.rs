//! Layered air, and the heat of stirred air.

use super::*;

/// Two boxes in one another on slippery ground, in air of layers that blows with `wind`.
fn layered(wind: Vector3, reference: Reference) -> Refined {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [18, 14, 16], 0.1, 8.0);
    (settings.ends, settings.sides) = (Ends::Periodic, Sides::Periodic);
    settings.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 290.0], [55.0, 290.5], [88.0, 294.0], [160.0, 295.0]],
        driving: Driving::Geostrophic([wind.x, wind.y]),
        damping: Some(Damping { from: 110.0, rate: 0.01 }),
        reference,
        ..Atmosphere::new(290.0)
    });
    let mut place = cells([4, 3, 0], [10, 8, 11]);
    place.within.push(cells([4, 4, 4], [10, 8, 9]));
    refined(settings, &[place], move |_, _| wind)
}

#[test]
fn layers_stay_as_they_are() {
    for reference in [Reference::Mean, Reference::Start] {
        for wind in [Vector3::ZERO, Vector3::new(6.0, 3.0, 0.0)] {
            let mut air = layered(wind, reference);
            let before = warm_cells(&air);
            air.advance(60.0, &[]).expect("no divergence");
            let pairs = warm_cells(&air).into_iter().zip(&before);
            let warmed = pairs.map(|(a, b)| (a.temperature - b.temperature).abs());
            let warmed = warmed.fold(0.0, f64::max);
            let off = all_cells(&air).into_iter().map(|(_, v, _)| (v - wind).length());
            let off = off.fold(0.0, f64::max);
            println!("{reference:?}, {wind}: {warmed:e} K, {off:e} m/s");
            // In a minute the air conducts 1e-4 K at the foot of the inversion.
            assert!(warmed < 3e-4, "{reference:?}, {wind}: {warmed} K");
            assert!(off < 3e-5, "{reference:?}, {wind}: {off} m/s");
        }
    }
}

/// Air in disorder between slippery ground and top, over which temperature rises by `steep` (K) at an
/// inversion, boxes in it and on the ground.
fn stirred(stencil: Stencil, steep: f64) -> Refined {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [24, 20, 16], 0.2, 5.0);
    (settings.ends, settings.sides) = (Ends::Periodic, Sides::Periodic);
    settings.stencil = stencil;
    settings.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 291.0], [60.0, 291.0], [100.0, 291.0 + steep]],
        perturbation: Some(Perturbation { below: 160.0, amplitude: 1.0, seed: 5 }),
        ..Atmosphere::new(290.0)
    });
    if let Some(atmosphere) = &mut settings.atmosphere {
        atmosphere.temperature.push([160.0, 291.0 + steep]);
    }
    let mut place = cells([4, 4, 0], [10, 12, 8]);
    place.within.push(cells([4, 5, 3], [9, 8, 8]));
    let other = cells([17, 4, 4], [4, 5, 7]);
    refined(settings, &[place, other], |_, x| {
        let swirl = |a: f64, b: f64| (0.05 * a + 0.09 * b).sin() * (0.13 * b - 0.04 * a).cos();
        Vector3::new(3.0, 1.0, 0.0)
            + 2.0 * Vector3::new(swirl(x.y, x.z), swirl(x.z, x.x), swirl(x.x, x.y))
    })
}

#[test]
fn heat_is_kept() {
    // Where levels differ it is kept as well as the mass of each level, as it is without boxes: sound comes
    // and goes through the upper side of a box.
    for (stencil, steep, most) in
        [(Stencil::D3Q19, 0.0, 2e-5), (Stencil::D3Q27, 0.0, 2e-5), (Stencil::D3Q19, 3.0, 3e-4)]
    {
        let mut air = stirred(stencil, steep);
        let before = mean(&air);
        for _ in 0..4 {
            air.advance(20.0, &[]).expect("no divergence");
            let gained = mean(&air) - before;
            println!("{stencil:?}, inversion of {steep} K: {gained:e} K");
            assert!(gained.abs() < most, "{stencil:?}, inversion of {steep} K: {gained} K");
        }
    }
}

#[test]
fn the_ground_gives_its_heat_within_a_box_and_without() {
    let flux = 0.05;
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [20, 16, 12], 0.1, 8.0);
    (settings.ends, settings.threads) = (Ends::Periodic, Some(1));
    settings.ground = Ground::WallStress { roughness_length: 0.1 };
    settings.atmosphere =
        Some(Atmosphere { heating: Heating::Flux(flux), ..Atmosphere::new(290.0) });
    let mut place = cells([4, 4, 0], [10, 8, 5]);
    place.within.push(cells([4, 4, 0], [10, 8, 5]));
    let mut air = refined(settings, &[place], |_, x| Vector3::new(8.0, 0.02 * x.z.sin(), 0.0));
    let before = mean(&air);
    air.advance(40.0, &[]).expect("no divergence");
    let gained = mean(&air) - before;
    let expected = flux * 40.0 / 120.0;
    println!("gained {gained} K, given {expected} K");
    assert!((gained / expected - 1.0).abs() < 1e-3, "{gained} K for {expected} K");
}

#[test]
fn levels_of_a_box_are_damped_as_high_as_they_lie() {
    // A box whose upper half lies in the damped layer; the top is that of all air.
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [16, 14, 20], 0.1, 8.0);
    (settings.ends, settings.sides, settings.threads) = (Ends::Periodic, Sides::Periodic, Some(1));
    settings.subgrid = Subgrid::smagorinsky(0.0);
    let (from, rate) = (100.0, 0.02);
    settings.atmosphere = Some(Atmosphere {
        driving: Driving::Geostrophic([2.0, 0.0]),
        damping: Some(Damping { from, rate }),
        ..Atmosphere::new(290.0)
    });
    let mut air =
        refined(settings, &[cells([4, 4, 5], [8, 6, 11])], |_, _| Vector3::new(6.0, 0.0, 0.0));
    air.advance(30.0, &[]).expect("no divergence");
    for (centre, velocity, _) in all_cells(&air) {
        let share = ((centre.z - from) / (200.0 - from)).max(0.0);
        let damping = rate * (0.25 * TAU * share).sin().powi(2);
        let expected = 2.0 + 4.0 * (-30.0 * damping).exp();
        let off = (velocity - Vector3::X * expected).length();
        // Levels of the box differ less from one another than those around.
        assert!(off < 0.03, "{centre}: {velocity} for {expected}");
    }
}
