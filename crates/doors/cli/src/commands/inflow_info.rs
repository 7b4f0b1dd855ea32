//! `wakemix inflow info`: what a turbulence box holds.

use super::output::{detail, print_json, print_text};
use std::path::Path;
use wakemix::flow::inflow::statistics::{BoxStatistics, line_deviations, statistics};
use wakemix::formats::turbulence_box::{self, StoredBox};

/// Prints what the box in `file` holds, as JSON where `json` says so.
///
/// # Errors
/// A box that cannot be read, an output that cannot be written.
pub(crate) fn run(file: &Path, json: bool) -> miette::Result<()> {
    let stored = turbulence_box::read(file)?;
    detail(&format!("read: {}", file.display()));
    let numbers = statistics(&stored.turbulence);
    if json {
        let [u, ..] = numbers.standard_deviations;
        let value = serde_json::json!({
            "description": stored.description,
            "n_points": stored.turbulence.n_points(),
            "spacing": stored.turbulence.spacing(),
            "lengths": stored.turbulence.lengths(),
            "hub_speed": stored.hub_speed,
            "hub_height": stored.hub_height,
            "lowest_height": stored.lowest_height,
            "mean_speeds": stored.mean_speeds,
            "turbulence_intensity": u / stored.hub_speed,
            "hub_standard_deviations": hub_deviations(&stored),
            "statistics": numbers,
        });
        print_json(&value)
    } else {
        print_text(&text(&stored, &numbers))
    }
}

/// Standard deviations of u, v, w at the point nearest the hub (m/s).
fn hub_deviations(stored: &StoredBox) -> [f64; 3] {
    let [_, n_y, n_z] = stored.turbulence.n_points();
    let row = (stored.hub_height - stored.lowest_height) / stored.turbulence.spacing()[2];
    let z = (row.round().max(0.0) as usize).min(n_z - 1);
    line_deviations(&stored.turbulence, n_y / 2, z)
}

fn text(stored: &StoredBox, numbers: &BoxStatistics) -> String {
    let [n_x, n_y, n_z] = stored.turbulence.n_points();
    let [d_x, d_y, d_z] = stored.turbulence.spacing();
    let [l_x, l_y, l_z] = stored.turbulence.lengths();
    let three = |values: [f64; 3], digits: usize| {
        // What rounds to nothing is printed without a sign.
        let least = 0.5 * 0.1_f64.powi(digits as i32);
        values
            .map(|value| if value.abs() < least { 0.0 } else { value })
            .map(|value| format!("{value:10.digits$}"))
            .join("")
    };
    format!(
        "{}\n\
         points               {n_x} × {n_y} × {n_z} along x, y, z\n\
         spacing              {d_x:.3} × {d_y:.3} × {d_z:.3} m\n\
         repeats after        {l_x:.0} × {l_y:.0} × {l_z:.0} m, {:.1} s at {:.2} m/s\n\
         heights              {:.1} to {:.1} m, hub {:.1} m\n\
         mean speeds          {:.2} to {:.2} m/s\n\
         \x20                             u         v         w\n\
         mean           m/s   {}\n\
         deviation      m/s   {}\n\
         intensity      %     {}\n\
         at hub         %     {}\n\
         length scale   m     {}\n\
         u'w'           {:.4} m²/s²\n\
         divergence     {:.1e} of the gradients, in Fourier space\n",
        stored.description,
        l_x / stored.hub_speed,
        stored.hub_speed,
        stored.lowest_height,
        stored.lowest_height + (n_z - 1) as f64 * d_z,
        stored.hub_height,
        stored.mean_speeds.iter().copied().fold(f64::INFINITY, f64::min),
        stored.mean_speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        three(numbers.means, 4),
        three(numbers.standard_deviations, 4),
        three(numbers.standard_deviations.map(|value| 100.0 * value / stored.hub_speed), 2),
        three(hub_deviations(stored).map(|value| 100.0 * value / stored.hub_speed), 2),
        three(numbers.integral_scales, 1),
        numbers.shear_stress,
        numbers.divergence_residual,
    )
}
