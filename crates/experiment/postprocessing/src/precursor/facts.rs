//! What a precursor was made of and came to, as facts with their remarks.

use farm::precursor::Precursor;
use formats::records::PrecursorResult;

/// Time of an hour (s).
const HOUR: f64 = 3600.0;

/// What each is, its value with unit, a remark.
pub(super) fn facts(result: &PrecursorResult, precursor: &Precursor) -> Vec<[String; 3]> {
    let (air, domain, time) = (&precursor.air, &precursor.domain, &precursor.time);
    let [length, width, height] = domain.size;
    let fact = |what: &str, value: String, remark: String| [what.to_owned(), value, remark];
    let asked = match air.hub_wind {
        Some(speed) => format!(
            "from {:.1}°, at the end; moved to hold {speed} m/s at the hub",
            result.geostrophic_direction_deg
        ),
        None => format!("from {:.1}°, as given", result.geostrophic_direction_deg),
    };
    vec![
        fact("Geostrophic wind", format!("{:.2} m/s", result.geostrophic_speed), asked),
        fact(
            "Friction velocity",
            format!("{:.3} m/s", result.friction_velocity),
            format!("mean of the record; roughness length {} m", air.roughness_length),
        ),
        fact(
            "Layer",
            format!("{:.0} m", result.boundary_layer_height),
            format!(
                "deep; the inversion began at {:.0} to {:.0} m with {} K",
                air.inversion_height,
                precursor.inversion_top(),
                air.inversion_strength
            ),
        ),
        fact(
            "Box",
            format!("{:.2} × {:.2} × {:.2} km", length / 1e3, width / 1e3, height / 1e3),
            format!("{:.2} million cells of {} m", result.n_cells as f64 / 1e6, domain.cell),
        ),
        fact(
            "Time",
            format!("{:.1} h + {:.0} min", time.spin_up / HOUR, time.record / 60.0),
            format!(
                "spin-up and record; {} planes, one every {:.2} s",
                result.planes.n_planes, result.planes.interval
            ),
        ),
        fact(
            "Latitude",
            format!("{:.1}°", air.latitude.to_degrees()),
            format!("Coriolis parameter {:.3e} /s", precursor.coriolis()),
        ),
        fact(
            "Cost",
            format!("{:.1} h", result.wall_time / HOUR),
            format!("wall time of {} steps", result.n_steps),
        ),
    ]
}
