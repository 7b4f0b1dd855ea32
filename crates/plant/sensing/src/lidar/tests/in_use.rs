//! Its clock, noise, state and refusals.

use super::*;

#[test]
fn beams_in_turn_are_measured_one_by_one_and_kept_until_their_next_turn() {
    let turbine = turbine(0.0, false);
    let in_turn = [
        ("scan", word("beams")),
        ("n_points", 4_u64.into()),
        ("order", word("in-turn")),
        ("rate_hz", 5.0.into()),
    ];
    let mut sensing = sensing(&turbine, &in_turn);
    for step in 0..20 {
        let wind = Wind { mean: Vector3::new(10.0 + f64::from(step), 0.0, 0.0), ..EVEN };
        let reading = read(&mut sensing, &turbine, &wind, step);
        let scan = Scan::of(&reading).expect("a scan");
        let n = step / 2 + 1;
        assert_eq!(scan.n_instants(), f64::from(n));
        assert_eq!(scan.n_valid(), n.min(4) as usize);
        for (point, (speed, time)) in scan.speeds().iter().zip(scan.times()).enumerate() {
            // The last measuring instant of this beam, each 0.2 s.
            let Some(last) = (0..n).rev().find(|instant| *instant as usize % 4 == point) else {
                assert!(speed.is_nan() && time.is_nan());
                continue;
            };
            assert!((time - 0.2 * f64::from(last)).abs() < 1e-9);
            let wind = 10.0 + 2.0 * f64::from(last);
            assert!((speed - wind * 120.0 / 120.0_f64.hypot(60.0)).abs() < 1e-9);
        }
    }
}

#[test]
fn noise_and_lost_beams_have_their_share_and_nothing_lost_is_a_zero() {
    let turbine = turbine(0.0, false);
    let noisy = [("noise", 0.4.into()), ("dropout", 0.3.into())];
    let mut sensing = sensing(&turbine, &noisy);
    let (mut n_lost, mut squares, mut n) = (0, 0.0, 0);
    for step in 0..100 {
        let reading = read(&mut sensing, &turbine, &EVEN, step);
        let scan = Scan::of(&reading).expect("a scan");
        assert!((reading[1] - scan.n_valid() as f64 / 80.0).abs() < 1e-12);
        for point in 0..80 {
            let (y, z, speed) = (scan.left()[point], scan.up()[point], scan.speeds()[point]);
            n += 1;
            if speed.is_nan() {
                n_lost += 1;
            } else {
                let length = (120.0_f64.powi(2) + y * y + z * z).sqrt();
                squares += (speed - 1200.0 / length).powi(2);
            }
        }
    }
    let n = f64::from(n);
    let share = f64::from(n_lost) / n;
    assert!((share - 0.3).abs() < 4.0 * (0.21 / n).sqrt(), "{share}");
    let deviation = (squares / (n * (1.0 - share))).sqrt();
    assert!((deviation / 0.4 - 1.0).abs() < 4.0 / (2.0 * 0.7 * n).sqrt(), "{deviation}");
}

#[test]
fn stored_and_restored_it_goes_on_with_the_same_bits_and_series_keep_its_speeds() {
    let turbine = turbine(0.0, false);
    let changes = [
        ("noise", 0.4.into()),
        ("dropout", 0.3.into()),
        ("order", word("in-turn")),
        ("rate_hz", 73.0.into()),
    ];
    let bits = |reading: Vec<f64>| reading.into_iter().map(f64::to_bits).collect::<Vec<u64>>();
    let mut one = sensing(&turbine, &changes);
    for step in 0..17 {
        read(&mut one, &turbine, &EVEN, step);
    }
    let stored = postcard::to_stdvec(&one.state()).expect("plain data serialises");
    let mut other = sensing(&turbine, &changes);
    other
        .restore(postcard::from_bytes(&stored).expect("what was written is read"))
        .expect("a lidar's state");
    for step in 17..40 {
        let both = [&mut one, &mut other].map(|sensing| bits(read(sensing, &turbine, &EVEN, step)));
        assert_eq!(both[0], both[1]);
    }
    let mut fewer = sensing(&turbine, &[("n_points", 4_u64.into())]);
    assert!(fewer.restore(postcard::from_bytes(&stored).expect("it is read")).is_err());
    let recorded: Vec<&[f64]> = one.recorded().collect();
    assert_eq!((recorded[0].len(), one.channels().len()), (82, 82));
    assert_eq!(one.channels()[2].name, "Eye.Los001");
    let another = first(&turbine, &EVEN, &[("noise", 0.4.into()), ("seed", 1_u64.into())]);
    assert_ne!(bits(another), bits(first(&turbine, &EVEN, &[("noise", 0.4.into())])));
}

#[test]
fn its_lines_of_sight_and_ranges_lead_to_the_places_of_its_scan() {
    let turbine = turbine(0.3, false);
    let gates = ("ranges_diameters", vec![0.5, 1.0].into());
    let rings =
        [("scan", word("rings")), ("n_points", 12_u64.into()), ("above", 3.0.into()), gates];
    for (changes, n_ranges) in [(&[][..], 1), (&rings[..], 2)] {
        let mut one = sensing(&turbine, changes);
        let reading = read(&mut one, &turbine, &EVEN, 0);
        let scan = Scan::of(&reading).expect("a scan");
        let layouts = one.sensors().map(|(name, sensor)| (name, sensor.scan_layout()));
        let (name, layout) = layouts.last().expect("a sensor");
        let layout = layout.expect("its readings are scans");
        assert_eq!((name, layout.n_ranges, layout.rate), ("Eye", n_ranges, 10.0));
        assert_eq!(layout.ranges.len(), scan.n_points());
        let above = Vector3::Z * if n_ranges > 1 { 3.0 } else { 0.0 };
        for (point, (line, range)) in layout.directions.iter().zip(&layout.ranges).enumerate() {
            let place = Vector3::new(scan.downwind()[point], scan.left()[point], scan.up()[point]);
            let expected = above + *range * Vector3::from_array(*line);
            assert!((place - expected).length() < 1e-9, "point {point}: {place} {expected}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused_at_its_key_with_a_way_out() {
    let kind = SENSORS.find("lidar").expect("it is one of the kinds");
    let definition = definition();
    let mount = Mount { definition: &definition, foot: FOOT, interval: INTERVAL, seed: 3 };
    let refused = |changes: &[(&'static str, Value)]| {
        let values = values(changes);
        let objections = [kind.check(&values), kind.check_at(&values, &mount)].concat();
        let said = objections.iter().map(|one| (one.key.unwrap_or(""), one.message.clone()));
        assert!(objections.iter().all(|one| !one.fix.is_empty()));
        said.collect::<Vec<(&str, String)>>()
    };
    assert!(refused(&[]).is_empty());
    let only = |changes: &[(&'static str, Value)], key: &str| {
        let found = refused(changes);
        assert!(found.len() == 1 && found[0].0 == key, "{key}: {found:?}");
    };
    let (up, hub) = (("looks", word("upwind")), ("mount", word("hub")));
    only(&[("n_points", 79_u64.into())], "n_points");
    only(&[("rings", 3_u64.into())], "rings");
    only(&[("rate_hz", 20.0.into())], "rate_hz");
    only(&[("rate_hz", 900.0.into()), ("order", word("in-turn"))], "rate_hz");
    only(&[("probe", word("gaussian"))], "probe_length");
    only(&[("probe_length", 3.0.into())], "probe_length");
    only(&[("radius_diameters", 0.9.into())], "radius_diameters");
    only(&[("tilt_deg", (-20.0).into())], "radius_diameters");
    only(std::slice::from_ref(&hub), "looks");
    only(&[hub.clone(), up.clone(), ("tilt_deg", 2.0.into())], "tilt_deg");
    only(&[hub, up.clone(), ("downwind", 2.0.into())], "downwind");
    only(&[up.clone(), ("above", 9.0.into())], "downwind");
    only(&[up, ("downwind", 8.0.into())], "above");
    let gates = ("ranges_diameters", vec![1.0, 2.0].into());
    only(
        &[gates, ("focal_distance_diameters", 1.0.into()), ("radius_diameters", 0.3.into())],
        "focal_distance_diameters",
    );
    only(
        &[("ranges_diameters", vec![0.5; 13].into()), ("radius_diameters", 0.3.into())],
        "ranges_diameters",
    );
}
