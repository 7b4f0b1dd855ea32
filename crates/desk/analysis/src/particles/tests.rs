//! Particles whose true field is known: linear, curved, waves, noise.

use super::*;
use basis::records::Grid;
use proptest::prelude::*;
use std::f64::consts::TAU;

const PLENTY: u64 = 1 << 30;

/// Numbers that look random, the same ones every time.
struct Numbers(u64);

impl Numbers {
    fn new(seed: u64) -> Self {
        Self(super::screen::mixed(seed))
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(1);
        let bits = super::screen::mixed(self.0.wrapping_mul(0xD134_2543_DE82_EF95)) >> 11;
        low + (high - low) * (bits as f64 / (1_u64 << 53) as f64)
    }

    fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.within(0.0, 1.0), self.within(0.0, TAU));
        (-2.0 * a.ln()).sqrt() * b.cos()
    }
}

/// `n` particles in `region` that move with `velocity`.
fn particles(
    seed: u64,
    n: usize,
    region: [[f64; 2]; 3],
    velocity: impl Fn([f64; 3]) -> [f64; 3],
) -> Vec<Particle> {
    let mut numbers = Numbers::new(seed);
    let one = |_| {
        let position = region.map(|[low, high]| numbers.within(low, high));
        Particle { position, velocity: velocity(position) }
    };
    (0..n).map(one).collect()
}

fn binned(settings: BinSettings, particles: &[Particle]) -> Binned {
    let mut binner = Binner::new(settings);
    for particle in particles {
        binner.add(particle);
    }
    binner.binned()
}

const CUBE: [[f64; 2]; 3] = [[0.0, 1.0], [-0.5, 0.5], [1.0, 2.0]];

fn bins(spacing: f64, order: Order) -> BinSettings {
    BinSettings::over(CUBE, [spacing; 3], 0.75, order, PLENTY).unwrap()
}

#[test]
fn a_bin_is_four_spacings_wide_where_three_quarters_overlap() {
    let settings = bins(0.1, Order::Linear);
    assert_eq!(settings.grid.n_points, [11, 11, 11]);
    assert!((settings.size[0] - 0.4).abs() < 1e-12);
    // A layer thinner than a bin is one bin thick, in its middle.
    let plane = [[0.0, 1.0], [0.0, 1.0], [0.2, 0.3]];
    let plane = BinSettings::over(plane, [0.1; 3], 0.75, Order::Linear, PLENTY).unwrap();
    assert_eq!(plane.grid.n_points, [11, 11, 1]);
    assert!((plane.grid.origin[2] - 0.25).abs() < 1e-12);
    // Each particle well inside falls into 4³ bins.
    let mut binner = Binner::new(settings);
    binner.add(&Particle { position: [0.512, 0.013, 1.487], velocity: [1.0; 3] });
    assert_eq!(binner.binned().moments.n_samples.iter().sum::<u32>(), 64);
}

#[test]
fn a_linear_field_comes_back_exactly_with_its_gradients() {
    let slopes = [[0.5, -1.0, 2.0], [4.0, 0.25, -0.5], [1.0, 8.0, -0.75]];
    let at = |x: [f64; 3]| {
        slopes.map(|row| 3.0 + row.iter().zip(x).map(|(slope, x)| slope * x).sum::<f64>())
    };
    let found = binned(bins(0.125, Order::Linear), &particles(1, 4000, CUBE, at));
    for index in 0..found.grid.len() {
        let expected = at(found.grid.position(found.grid.place(index)));
        assert_eq!(found.order[index], Some(Order::Linear), "{index}");
        for component in 0..3 {
            let mean = f64::from(found.moments.mean[component][index]);
            assert!((mean - expected[component]).abs() < 1e-5, "{mean}");
            for (axis, expected) in slopes[component].into_iter().enumerate() {
                let gradient = f64::from(found.gradient[component][axis][index]);
                assert!((gradient - expected).abs() < 1e-4, "{gradient}");
            }
            // Nothing is left for stresses: the gradient does not count as turbulence.
            assert!(found.moments.stress[component][index].abs() < 1e-8);
            assert!(found.error[component][index] < 1e-5);
        }
    }
    // A weighted mean alone takes the gradient for turbulence.
    let plain = binned(bins(0.125, Order::Constant), &particles(1, 4000, CUBE, at));
    let middle = plain.grid.index([4, 4, 4]);
    assert!(plain.moments.stress[1][middle] > 0.1);
    assert!(plain.gradient[0][0][middle].is_nan());
}

#[test]
fn a_curved_field_comes_back_exactly_by_the_quadratic_polynomial() {
    let at = |[x, y, z]: [f64; 3]| [x * x - 2.0 * x * y, y * z + 3.0 * z * z, 1.0 - x * z + y * y];
    let found = binned(bins(0.25, Order::Quadratic), &particles(2, 6000, CUBE, at));
    for index in 0..found.grid.len() {
        let [x, y, z] = found.grid.position(found.grid.place(index));
        let expected = at([x, y, z]);
        let gradient = [[2.0 * (x - y), -2.0 * x, 0.0], [0.0, z, y + 6.0 * z], [-z, 2.0 * y, -x]];
        for component in 0..3 {
            let mean = f64::from(found.moments.mean[component][index]);
            assert!((mean - expected[component]).abs() < 1e-5, "{mean} {expected:?}");
            for (axis, expected) in gradient[component].into_iter().enumerate() {
                let slope = f64::from(found.gradient[component][axis][index]);
                assert!((slope - expected).abs() < 1e-4);
            }
        }
    }
}

/// Error of u, of `sin (2π x)`, over u, at x = 0.24 m with bins `spacing` apart.
fn error_of(spacing: f64, order: Order) -> f64 {
    let wave = |[x, _, _]: [f64; 3]| [(TAU * x).sin(), 0.0, 0.0];
    // As even as a lattice: no scatter hides the bias.
    let even = |index: i32| {
        let position = [(f64::from(index) + 0.5) / 4000.0, 0.0, 1.5];
        Particle { position, velocity: wave(position) }
    };
    let line = [[0.0, 1.0], [0.0, 0.0], [1.5, 1.5]];
    let settings = BinSettings::over(line, [spacing; 3], 0.75, order, PLENTY).unwrap();
    let found = binned(settings, &(0..4000).map(even).collect::<Vec<_>>());
    let place = (0.24 / spacing).round() as usize;
    let expected = wave([found.grid.coordinate(0, place), 0.0, 0.0])[0];
    assert!((found.grid.coordinate(0, place) - 0.24).abs() < 1e-12);
    1.0 - f64::from(found.moments.mean[0][place]) / expected
}

#[test]
fn bias_falls_with_the_square_of_the_size_and_with_its_fourth_power_when_curved() {
    // Means and straight lines are off by the curvature: half of it times the variance of the weight, which
    // is 0.774 of the Gaussian's where that is cut at two deviations (1 − 2·2φ(2)/(2Φ(2) − 1)).
    for order in [Order::Constant, Order::Linear] {
        let [coarse, fine] = [0.04, 0.02].map(|spacing| error_of(spacing, order));
        assert!((coarse / fine - 4.0).abs() < 0.1, "{order:?}: {}", coarse / fine);
        let expected = 0.5 * TAU * TAU * 0.774 * 0.02 * 0.02;
        assert!((fine / expected - 1.0).abs() < 0.05, "{order:?}: {}", fine / expected);
    }
    let [coarse, fine] = [0.04, 0.02].map(|spacing| error_of(spacing, Order::Quadratic));
    assert!((coarse / fine - 16.0).abs() < 1.5, "{}", coarse / fine);
}

#[test]
fn the_standard_error_is_what_the_mean_scatters_by() {
    // 200 sets of noise of 0.5 m/s on a slope: the spread of the middle bin's mean over sets is known within
    // 1 / √400 = 5 %; three times that.
    let region = [[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]];
    for order in [Order::Constant, Order::Linear, Order::Quadratic] {
        let settings = BinSettings::over(region, [0.2; 3], 0.75, order, PLENTY).unwrap();
        let (mut sum, mut square, mut error, mut stress) = (0.0, 0.0, 0.0, 0.0);
        let n_sets = 200;
        for set in 0..n_sets {
            let mut noise = Numbers::new(1000 + set);
            let mut all = particles(set, 300, region, |_| [0.0; 3]);
            for particle in &mut all {
                particle.velocity = [4.0 + 0.5 * noise.normal(), 0.0, 0.0];
            }
            let found = binned(settings, &all);
            let middle = found.grid.index([2, 2, 2]);
            let mean = f64::from(found.moments.mean[0][middle]);
            sum += mean;
            square += mean * mean;
            error += f64::from(found.error[0][middle]).powi(2);
            stress += f64::from(found.moments.stress[0][middle]);
        }
        let n = n_sets as f64;
        let spread = (square / n - (sum / n).powi(2)).sqrt();
        let claimed = (error / n).sqrt();
        assert!((spread / claimed - 1.0).abs() < 0.15, "{order:?}: {spread} {claimed}");
        assert!((stress / n / 0.25 - 1.0).abs() < 0.05, "{order:?}: {}", stress / n);
        assert!((sum / n - 4.0).abs() < 4.0 * claimed / n.sqrt());
    }
}

#[test]
fn more_samples_make_means_better_by_the_root_of_their_number() {
    let mut noise = Numbers::new(5);
    let mut all = particles(6, 64_000, CUBE, |_| [0.0; 3]);
    for particle in &mut all {
        particle.velocity = [noise.normal(), noise.normal(), noise.normal()];
    }
    let mut binner = Binner::new(bins(0.125, Order::Linear));
    for (index, particle) in all.iter().enumerate() {
        if [4000, 16_000].contains(&index) {
            binner.keep_stage();
        }
        binner.add(particle);
    }
    let found = binner.binned();
    let [early, later, last] = found.convergence[..] else { panic!("three stages") };
    assert_eq!([early.n_taken, later.n_taken, last.n_taken], [4000, 16_000, 64_000]);
    for (one, four) in [(early, later), (later, last)] {
        assert!((one.error / four.error - 2.0).abs() < 0.2, "{} {}", one.error, four.error);
    }
    // Nested sets: σ² (1/n − 1/N).
    for stage in [early, later] {
        let share = stage.n_taken as f64 / last.n_taken as f64;
        let expected = stage.error * (1.0 - share).sqrt();
        assert!((stage.change / expected - 1.0).abs() < 0.15, "{} {expected}", stage.change);
    }
}

#[test]
fn bins_without_samples_enough_are_empty_and_counted() {
    let half = [[0.0, 0.3], [-0.5, 0.5], [1.0, 2.0]];
    let mut all = particles(7, 400, half, |_| [1.0, 2.0, 3.0]);
    all.push(Particle { position: [0.9, 0.4, 1.9], velocity: [1.0, 2.0, 3.0] });
    all.push(Particle { position: [0.2, f64::NAN, 1.5], velocity: [0.0; 3] });
    all.push(Particle { position: [0.2, 0.0, 1.5], velocity: [0.0, f64::INFINITY, 0.0] });
    all.push(Particle { position: [7.0, 0.0, 1.5], velocity: [0.0; 3] });
    let found = binned(bins(0.1, Order::Quadratic), &all);
    let Tally { n_taken, n_holes, n_outside, n_empty, n_thin, .. } = found.tally;
    assert_eq!((n_taken, n_holes, n_outside), (401, 2, 1));
    let n_sound = found.order.iter().flatten().count() as u64;
    assert_eq!(n_sound + n_empty + n_thin, found.grid.len() as u64);
    assert!(n_thin > 0 && n_empty > 0);
    let corner = found.grid.index([9, 9, 9]);
    assert_eq!((found.moments.n_samples[corner], found.order[corner]), (1, None));
    assert!(found.moments.mean[0][corner].is_nan());
    // Fewer samples than a curved fit needs give a straight one, and so on down.
    assert!(found.n_of(Order::Quadratic) > 0 && found.n_of(Order::Linear) > 0);
}

#[test]
fn a_sheet_of_particles_has_gradients_within_it() {
    let sheet = [[0.0, 1.0], [2.0, 2.0], [0.0, 1.0]];
    let at = |[x, _, z]: [f64; 3]| [2.0 * x - z, 1.0, 0.5 * x + z];
    let settings = BinSettings::over(sheet, [0.1; 3], 0.75, Order::Linear, PLENTY).unwrap();
    let found = binned(settings, &particles(8, 3000, sheet, at));
    let middle = found.grid.index([5, 0, 5]);
    assert!((found.gradient[0][0][middle] - 2.0).abs() < 1e-4);
    assert!((found.gradient[2][2][middle] - 1.0).abs() < 1e-4);
    assert!(found.gradient[0][1][middle].is_nan());
}

#[test]
fn outliers_are_told_from_scatter() {
    let mut noise = Numbers::new(9);
    let mut all = particles(10, 40_000, CUBE, |_| [0.0; 3]);
    for (index, particle) in all.iter_mut().enumerate() {
        particle.velocity = [5.0 + 0.3 * noise.normal(), 0.3 * noise.normal(), noise.normal()];
        if index % 50 == 0 {
            particle.velocity[1] += 9.0;
        }
    }
    let settings = bins(0.1, Order::Linear);
    let mut screen =
        Screen::new(&settings.grid, settings.size, ScreenSettings::usual(0.0)).unwrap();
    all.iter().for_each(|particle| screen.look(particle));
    let screened = screen.screened();
    // Bins of 0.4 m reach 0.2 m over each face of the cube: four cells along each axis, the last one outside.
    assert_eq!(screened.n_cells(), [27, 64]);
    let (mut found, mut wrong) = (0, 0);
    for (index, particle) in all.iter().enumerate() {
        let is_out = screened.is_outlier(particle);
        found += usize::from(is_out && index % 50 == 0);
        wrong += usize::from(is_out && index % 50 != 0);
    }
    assert_eq!(found, 800);
    // 5 median distances are 3.37 deviations: 7.5e-4 of each of three components. Medians of 128 samples
    // scatter by a tenth, which the tail feels: at most three times that.
    let expected = 39_200.0 * 3.0 * 7.5e-4;
    assert!((wrong as f64) < 3.0 * expected && wrong as f64 > expected / 3.0, "{wrong} {expected}");
    let none = ScreenSettings { limit: 0.0, ..ScreenSettings::usual(0.0) };
    assert!(Screen::new(&settings.grid, settings.size, none).is_err());
}

#[test]
fn a_vector_that_fits_no_neighbour_is_found_and_shear_is_not() {
    let grid = Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [6, 5, 4] };
    let u = |index: usize| 5.0 + 0.8 * grid.position(grid.place(index))[2];
    let mut velocity: [Vec<f64>; 3] = std::array::from_fn(|_| (0..grid.len()).map(u).collect());
    let test = MedianTest { threshold: MedianTest::THRESHOLD, noise: 0.05 };
    assert!(outliers(&grid, &velocity, &test).iter().all(|is| !is));
    velocity[1][37] += 4.0;
    velocity[0][80] = f64::NAN;
    let found = outliers(&grid, &velocity, &test);
    let places: Vec<usize> = (0..grid.len()).filter(|index| found[*index]).collect();
    assert_eq!(places, [37]);
}

#[test]
fn what_makes_no_bins_is_refused() {
    let over = |region, spacing: f64, overlap, memory| {
        BinSettings::over(region, [spacing; 3], overlap, Order::Linear, memory)
    };
    assert!(matches!(over(CUBE, 0.0, 0.75, PLENTY), Err(ParticlesError::Spacing { .. })));
    assert!(matches!(over(CUBE, f64::NAN, 0.75, PLENTY), Err(ParticlesError::Spacing { .. })));
    assert!(matches!(over(CUBE, 0.1, 1.0, PLENTY), Err(ParticlesError::Overlap { .. })));
    let back = [[1.0, 0.0], [0.0, 1.0], [0.0, 1.0]];
    assert!(matches!(over(back, 0.1, 0.75, PLENTY), Err(ParticlesError::Region { axis: "x", .. })));
    assert!(matches!(over(CUBE, 1e-6, 0.75, PLENTY), Err(ParticlesError::Memory { .. })));
    let settings = over(CUBE, 0.1, 0.75, PLENTY).unwrap();
    assert!(settings.memory() < 1331 * 400);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    #[test]
    fn the_order_of_particles_and_a_steady_wind_change_nothing(seed in 0_u64..500, wind in -9.0_f64..9.0) {
        let at = |[x, y, z]: [f64; 3]| [x * y, (3.0 * z).sin(), x - y * z];
        let mut all = particles(seed, 800, CUBE, at);
        let before = binned(bins(0.25, Order::Linear), &all);
        all.reverse();
        for particle in &mut all {
            particle.velocity[0] += wind;
        }
        let after = binned(bins(0.25, Order::Linear), &all);
        prop_assert_eq!(&before.moments.n_samples, &after.moments.n_samples);
        for index in 0..before.grid.len() {
            let change = after.moments.mean[0][index] - before.moments.mean[0][index];
            prop_assert!((f64::from(change) - wind).abs() < 1e-4);
            for place in 0..6 {
                let (a, b) = (before.moments.stress[place][index], after.moments.stress[place][index]);
                prop_assert!((a - b).abs() < 1e-5, "{} {}", a, b);
            }
        }
    }
}
