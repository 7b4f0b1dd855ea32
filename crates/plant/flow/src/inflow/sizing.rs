//! How large a box must be for a run.

use super::mann;
use serde::{Deserialize, Serialize};

/// What a run needs of its turbulence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Need {
    /// Streamwise extent over which the wind is sampled at any one time (m); 0 for an inlet plane alone.
    pub length: f64,
    /// Domain width (m). The box is exactly as wide, so that it repeats with a domain of periodic sides.
    pub width: f64,
    /// Domain height (m).
    pub height: f64,
    /// Speed with which the turbulence is carried along (m/s).
    pub hub_speed: f64,
    /// Duration (s).
    pub duration: f64,
    /// Grid spacing of the flow (m), which becomes that of the box.
    pub spacing: f64,
    /// Length scale L of the tensor (m).
    pub length_scale: f64,
    /// Memory that making the box may take at its peak (bytes).
    pub memory_limit: u64,
}

/// Dimensions of a box and what follows from them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Size {
    /// Points along x, y, z (–).
    pub n_points: [usize; 3],
    /// Distance of neighbouring points along x, y, z (m).
    pub spacing: [f64; 3],
    /// Memory at the peak of making it (bytes).
    pub peak_memory: u64,
    /// Time (s) after which the same turbulence returns, with `length` already taken off.
    pub repeats_after: f64,
    /// Whether the whole duration is covered without repetition.
    pub covers: bool,
}

/// Length scales of free box kept above the domain: the box repeats in z too, and eddies at the ground must
/// not be those at the top.
const MARGIN: f64 = 2.0;

/// Sizes a box for `need`.
///
/// Width: the domain's cells exactly. Height: the domain's and two length scales, rounded up to a product of
/// 2, 3 and 5. Length: speed × duration + `length` + two length scales, rounded up likewise; when that takes
/// more than `memory_limit`, the longest that fits, and the wind then repeats ([`Size::covers`] is false).
pub fn size_box(need: &Need) -> Size {
    let cells = |length: f64| (length / need.spacing - 1e-9).ceil().max(2.0) as usize;
    let n_y = (need.width / need.spacing).round().max(2.0) as usize;
    let n_z = smooth_at_least(cells(need.height + MARGIN * need.length_scale));
    let travel = need.hub_speed * need.duration + need.length + MARGIN * need.length_scale;
    let mut n_x = even_smooth_at_least(cells(travel));
    if mann::peak_memory([n_x, n_y, n_z]) > need.memory_limit {
        n_x = even_smooth_at_most(mann::points_along_x(need.memory_limit, n_y, n_z));
    }
    let n_points = [n_x, n_y, n_z];
    let length = n_x as f64 * need.spacing;
    Size {
        n_points,
        spacing: [need.spacing; 3],
        peak_memory: mann::peak_memory(n_points),
        repeats_after: ((length - need.length) / need.hub_speed).max(0.0),
        covers: length >= need.hub_speed * need.duration + need.length,
    }
}

/// Least product of powers of 2, 3 and 5 that is not less than `n`: Fourier transforms of it are fast.
pub fn smooth_at_least(n: usize) -> usize {
    (n.max(1)..).find(|candidate| is_smooth(*candidate)).unwrap_or(n)
}

fn even_smooth_at_least(n: usize) -> usize {
    2 * smooth_at_least(n.div_ceil(2))
}

fn even_smooth_at_most(n: usize) -> usize {
    (1..=n / 2).rev().find(|candidate| is_smooth(*candidate)).map_or(2, |half| 2 * half)
}

fn is_smooth(mut n: usize) -> bool {
    for prime in [2, 3, 5] {
        while n.is_multiple_of(prime) {
            n /= prime;
        }
    }
    n == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn need() -> Need {
        Need {
            length: 2880.0,
            width: 1440.0,
            height: 960.0,
            hub_speed: 9.0,
            duration: 1200.0,
            spacing: 15.0,
            length_scale: 33.6,
            memory_limit: 8 << 30,
        }
    }

    #[test]
    fn covers_the_run_and_fits_the_width() {
        let size = size_box(&need());
        assert_eq!(size.n_points[1], 96);
        assert!(size.covers && size.repeats_after >= 1200.0);
        assert!(size.n_points[2] as f64 * 15.0 >= 960.0 + 67.2);
    }

    #[test]
    fn says_that_it_repeats_when_memory_is_short() {
        let size = size_box(&Need { memory_limit: 40 << 20, ..need() });
        assert!(!size.covers && size.repeats_after < 1200.0);
        assert!(size.peak_memory <= 40 << 20);
    }

    proptest! {
        #[test]
        fn smooth_numbers_are_the_least_ones(n in 1_usize..5000) {
            let smooth = smooth_at_least(n);
            prop_assert!(smooth >= n && is_smooth(smooth));
            prop_assert!((n..smooth).all(|between| !is_smooth(between)));
        }

        #[test]
        fn a_box_is_never_smaller_than_its_need(
            width in 100.0..4000.0_f64, height in 50.0..1500.0_f64, duration in 1.0..4000.0_f64,
            spacing in 5.0..40.0_f64,
        ) {
            let memory_limit = u64::MAX;
            let need = Need { width, height, duration, spacing, memory_limit, ..need() };
            let size = size_box(&need);
            prop_assert!(size.covers);
            prop_assert!(size.n_points[0].is_multiple_of(2));
            prop_assert!(size.n_points[2] as f64 * spacing >= height);
            prop_assert!((size.n_points[1] as f64 * spacing - width).abs() <= 0.5 * spacing * (1.0 + 1e-9));
        }
    }
}
