//! The table of a study on the terminal.

use std::fmt::Write;
use wakemix::basis::records::{Statistic, Summary};

/// Runs × turbines: power, gain, thrust, rotor speed, delivered excitation; the conditions above.
pub(crate) fn render(summaries: &[Summary]) -> String {
    let mut text = String::new();
    let Some(first) = summaries.first() else {
        return text;
    };
    let wind = &first.conditions;
    let minutes = (wind.duration - wind.spin_up) / 60.0;
    let air = wind
        .cells_per_diameter
        .map_or("prescribed wind".to_owned(), |cells| format!("{cells:.0} cells per diameter"));
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{}: {:.1} m/s, turbulence {:.1} % asked, {:.1} % arrived; {:.0} min analysed after {:.0} s; {air}",
        first.case,
        wind.wind_speed,
        100.0 * wind.turbulence_intensity,
        100.0 * wind.arriving_turbulence_intensity,
        minutes,
        wind.spin_up,
    );
    let _ = writeln!(
        text,
        "{:<14} {:<6} {:<28} {:>18} {:>18} {:>9} {:>7} {:>16}",
        "run", "", "control", "power kW", "gain %", "thrust kN", "rpm", "pitch delivered"
    );
    for summary in summaries {
        for turbine in &summary.turbines {
            let delivered = turbine.delivered_pitch.map_or(String::new(), |pitch| {
                format!("{:.2}° {:.4} Hz", pitch.delivered_amplitude_deg, pitch.frequency_hz)
            });
            let _ = writeln!(
                text,
                "{:<14} {:<6} {:<28} {:>18} {:>18} {:>9.0} {:>7.2} {:>16}",
                summary.run,
                turbine.name,
                turbine.control,
                with_interval(&turbine.power, 1e-3, 0),
                turbine.power_gain.map_or(String::new(), |gain| with_interval(&gain, 100.0, 2)),
                turbine.thrust.mean / 1e3,
                turbine.rotor_speed.mean * 30.0 / std::f64::consts::PI,
                delivered,
            );
        }
        let _ = writeln!(
            text,
            "{:<14} {:<6} {:<28} {:>18} {:>18}",
            summary.run,
            "all",
            "",
            with_interval(&summary.array_power, 1e-3, 0),
            summary.array_power_gain.map_or(String::new(), |gain| with_interval(&gain, 100.0, 2)),
        );
    }
    let _ = writeln!(
        text,
        "± 95 % from blocks of the analysed time; gains compare the same blocks of the same wind"
    );
    text
}

fn with_interval(statistic: &Statistic, scale: f64, digits: usize) -> String {
    let mean = scale * statistic.mean;
    match statistic.half_width_95 {
        Some(half_width) => format!("{mean:.digits$} ± {:.digits$}", scale * half_width),
        None => format!("{mean:.digits$}"),
    }
}
