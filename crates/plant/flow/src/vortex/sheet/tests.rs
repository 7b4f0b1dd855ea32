//! What joined rings keep.

use super::*;

/// Impulse over density, ½ Σ Γ x × dl, of the wake that a blade of 60 m leaves in two turns at
/// `resolution` (m⁴/s), the blade being bent downwind in the middle by `bend` (rad) from its root to its
/// tip.
fn impulse(resolution: Resolution, bend: f64) -> Vector3 {
    const N: usize = 16;
    let cores = Cores {
        initial_widths: 0.1,
        kinematic_viscosity: 1.5e-5,
        eddy_constant: 0.0,
        strain: false,
    };
    let mut sheet = Sheet::new([0, 0], N, resolution);
    let circulations: Vec<f64> =
        (0..N).map(|s| 30.0 * (1.0 - ((s as f64 + 0.5) / N as f64 * 2.0 - 1.0).powi(4))).collect();
    for step in 0..=96 {
        let angle = std::f64::consts::TAU * f64::from(step) / 48.0;
        let radial = Vector3::new(0.0, -angle.sin(), angle.cos());
        let place = Vector3::X * (-0.8 * f64::from(step));
        let (mut line, mut node) = (Vec::new(), place + radial * 4.0);
        for s in 0..=N {
            line.push(node);
            let (sine, cosine) = (bend * (0.5 - (s as f64 + 0.5) / N as f64)).sin_cos();
            node += (radial * cosine + Vector3::X * sine) * (56.0 / N as f64);
        }
        sheet.place_line(&line, &circulations);
    }
    let mut segments = Vec::new();
    sheet.push_segments(&cores, &mut segments);
    let of = |segment: &Segment| {
        let middle = 0.5 * (segment.from + segment.to);
        middle.cross(segment.to - segment.from) * (0.5 * segment.circulation)
    };
    segments.iter().map(of).sum()
}

#[test]
fn a_coarser_wake_has_the_same_impulse() {
    let fine = Resolution {
        near_rows: 100,
        far_stride: 1,
        far_filaments: 17,
        length: 1e6,
        end: f64::INFINITY,
        far_rows: 100,
    };
    // Straight, rings being tilted by their pitch, each by another angle: of that squared, a hundredth,
    // some. And rolled up, by an eighth to either side of a ring's middle where there are four.
    for (bend, close) in [(0.0, 5e-3), (1.0, 0.125 * 0.125)] {
        let whole = impulse(fine, bend);
        // The blade pushes the air upwind: its rings point that way.
        let across = whole.y.hypot(whole.z);
        assert!(whole.x.abs() > 1e5 && whole.x.abs() > 10.0 * across, "{whole}");
        for (far_stride, far_filaments) in [(1, 5), (2, 9), (4, 5), (4, 2)] {
            let resolution = Resolution { near_rows: 8, far_stride, far_filaments, ..fine };
            let coarse = impulse(resolution, bend);
            let error = (coarse.x / whole.x - 1.0).abs();
            assert!(error < close, "{bend} {far_stride} {far_filaments}: {coarse} {whole}");
        }
    }
}
