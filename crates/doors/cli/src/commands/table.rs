//! The table of a study on the terminal.

use std::fmt::Write;
use wakemix::basis::records::{Conditions, Load, LoadKind, Statistic, Summary, TurbineSummary};
use wakemix::postprocessing::analyses::with_interval;

/// Loads of which the 1-Hz damage-equivalent is printed: heading, channel, what it is.
const LOADS: [(&str, &str, &str); 2] = [
    ("flapwise MN m", "RootMyb1", "flapwise at the root of blade 1"),
    ("tower MN m", "TwrBsMyt", "fore-aft at the tower base"),
];

/// Runs × turbines: power, gain, thrust, rotor speed, delivered excitation, and loads and their changes where
/// any turbine has them; the conditions above, the conventions below.
pub(crate) fn render(summaries: &[Summary]) -> String {
    let Some(first) = summaries.first() else {
        return String::new();
    };
    let loads: Vec<Column> =
        LOADS.iter().filter_map(|load| Column::find(load, summaries)).collect();
    let headings: String = loads.iter().map(Column::headings).collect();
    let mut text = format!(
        "{}: {}\n{:<14} {:<6} {:<28} {:>18} {:>18} {:>9} {:>7} {:>16}{headings}\n",
        first.case,
        conditions(&first.conditions),
        "run",
        "",
        "control",
        "power kW",
        "gain %",
        "thrust kN",
        "rpm",
        "pitch delivered"
    );
    for summary in summaries {
        for turbine in &summary.turbines {
            text += &row(&summary.run, turbine, &loads);
        }
        // Without wakes no turbine feels another, so that a sum means nothing.
        if !summary.has_wakes() && summary.turbines.len() > 1 {
            continue;
        }
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<14} {:<6} {:<28} {:>18} {:>18}",
            summary.run,
            "all",
            "",
            with_interval(&summary.array_power, 1e-3, 0),
            percent(summary.array_power_gain.as_ref(), 2),
        );
    }
    text += "± 95 % from blocks of the analysed time; gains and changes compare the same blocks of the same wind\n";
    if !loads.is_empty() {
        let printed: Vec<String> = loads.iter().map(Column::printed).collect();
        let _ = writeln!(
            text,
            "1-Hz damage-equivalent loads, rainflow, no mean correction: {}",
            printed.join("; ")
        );
    }
    text
}

/// Wind, length and grid.
fn conditions(wind: &Conditions) -> String {
    let grid = wind
        .cells_per_diameter
        .map_or("prescribed wind".to_owned(), |cells| format!("{cells:.0} cells per diameter"));
    let from = match wind.direction_deg {
        270.0 => String::new(),
        degrees => format!(" from {degrees}°"),
    };
    format!(
        "{:.1} m/s{from}, turbulence intensity {:.1} % target, {:.1} % realised; {:.0} min analysed after {:.0} s; {grid}",
        wind.target_wind_speed,
        100.0 * wind.target_turbulence_intensity,
        100.0 * wind.realised_turbulence_intensity,
        (wind.duration - wind.spin_up) / 60.0,
        wind.spin_up,
    )
}

/// The line of `turbine` in the run called `run`.
fn row(run: &str, turbine: &TurbineSummary, loads: &[Column]) -> String {
    let delivered = turbine.delivered_pitch.map_or(String::new(), |pitch| {
        format!("{:.2}° {:.4} Hz", pitch.delivered_amplitude_deg, pitch.frequency_hz)
    });
    let cells: String = loads.iter().map(|load| load.cells(turbine)).collect();
    format!(
        "{:<14} {:<6} {:<28} {:>18} {:>18} {:>9.0} {:>7.2} {:>16}{cells}\n",
        run,
        turbine.name,
        turbine.control.description,
        with_interval(&turbine.power, 1e-3, 0),
        percent(turbine.power_gain.as_ref(), 2),
        turbine.thrust.mean / 1e3,
        turbine.rotor_speed.mean * 30.0 / std::f64::consts::PI,
        delivered,
    )
}

/// A column of damage-equivalent loads, and one of their changes where any run is compared.
struct Column<'a> {
    heading: &'a str,
    what: &'a str,
    channel: &'a str,
    /// Slope of the Wöhler line (–).
    slope: f64,
    is_compared: bool,
}

impl<'a> Column<'a> {
    /// The column of `load` (heading, channel, what it is); None where no turbine of `summaries` has it.
    fn find(load: &(&'a str, &'a str, &'a str), summaries: &[Summary]) -> Option<Self> {
        let &(heading, channel, what) = load;
        let turbines = summaries.iter().flat_map(|summary| &summary.turbines);
        let found: Vec<&Load> =
            turbines.filter_map(|turbine| turbine.damage_equivalent(channel)).collect();
        let LoadKind::DamageEquivalent { slope, .. } = found.first()?.kind else { return None };
        let is_compared = found.iter().any(|load| load.change.is_some());
        Some(Self { heading, what, channel, slope, is_compared })
    }

    fn headings(&self) -> String {
        self.columns(self.heading, "change %")
    }

    /// The load of `turbine` (MN m) and its change (%), empty where it has none.
    fn cells(&self, turbine: &TurbineSummary) -> String {
        let load = turbine.damage_equivalent(self.channel);
        self.columns(
            &load.map_or(String::new(), |load| format!("{:.2}", load.value / 1e3)),
            &percent(load.and_then(|load| load.change.as_ref()), 1),
        )
    }

    fn columns(&self, load: &str, change: &str) -> String {
        if self.is_compared { format!(" {load:>13} {change:>13}") } else { format!(" {load:>13}") }
    }

    /// What the column is, with its channel and slope.
    fn printed(&self) -> String {
        format!("{} ({}, m = {})", self.what, self.channel, self.slope)
    }
}

/// A gain or change in percent with so many `digits`; empty where there is none.
fn percent(change: Option<&Statistic>, digits: usize) -> String {
    change.map_or(String::new(), |change| with_interval(change, 100.0, digits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::basis::records::examples::{self, damage_equivalent, load, statistic};

    fn turbine(name: &str, loads: &[Load]) -> TurbineSummary {
        TurbineSummary { loads: loads.to_vec(), ..examples::turbine(name, 1e7) }
    }

    fn summary(turbines: Vec<TurbineSummary>) -> Summary {
        examples::summary("baseline", turbines)
    }

    #[test]
    fn loads_stand_behind_the_turbines_that_have_them() {
        let loads = [
            load("RootMyb1", damage_equivalent(10.0), 12_340.0),
            load("RootMyb1", LoadKind::Deviation, 99_999.0),
            load("RootMyc1", damage_equivalent(10.0), 99_999.0),
            load("TwrBsMyt", damage_equivalent(4.0), 67_890.0),
        ];
        let text = render(&[summary(vec![turbine("T1", &loads), turbine("T2", &loads[..1])])]);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[1].ends_with("pitch delivered flapwise MN m    tower MN m"), "{text}");
        let cells = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(cells(lines[2])[6..], ["12.34", "67.89"], "{text}");
        assert_eq!(cells(lines[3])[6..], ["12.34"], "{text}");
        // Cells stand under their headings.
        let end = lines[1].find("flapwise MN m").map(|start| start + "flapwise MN m".len());
        assert_eq!(lines[3].find("12.34").map(|start| start + 5), end, "{text}");
        assert!(!text.contains("change %"), "{text}");
        let last = lines[lines.len() - 1];
        assert!(last.starts_with("1-Hz damage-equivalent loads, rainflow"), "{text}");
        assert!(last.contains("flapwise at the root of blade 1 (RootMyb1, m = 10); "), "{text}");
        assert!(last.ends_with("fore-aft at the tower base (TwrBsMyt, m = 4)"), "{text}");
    }

    #[test]
    fn changes_stand_behind_their_loads_with_their_intervals() {
        let loads = [
            load("RootMyb1", damage_equivalent(10.0), 12_340.0),
            load("TwrBsMyt", damage_equivalent(4.0), 67_890.0),
        ];
        let mut compared = turbine("T1", &loads);
        let change = Statistic { half_width_95: Some(0.0312), ..statistic(-0.0678) };
        compared.loads[0].change = Some(change);
        let text = render(&[
            summary(vec![turbine("T1", &loads)]),
            summary(vec![compared, turbine("T2", &loads[..1])]),
        ]);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[1].ends_with("flapwise MN m      change %    tower MN m"), "{text}");
        assert!(lines[2].ends_with("        12.34                       67.89"), "{text}");
        assert!(lines[4].ends_with("        12.34    -6.8 ± 3.1         67.89"), "{text}");
    }

    #[test]
    fn a_column_that_no_turbine_fills_is_left_out() {
        let tower = load("TwrBsMyt", damage_equivalent(4.0), 1e3);
        let text = render(&[summary(vec![turbine("T1", &[tower])])]);
        assert!(!text.contains("flapwise") && text.contains("tower MN m"), "{text}");
        let text = render(&[summary(vec![turbine("T1", &[])])]);
        assert!(text.lines().nth(1).unwrap().ends_with("pitch delivered"), "{text}");
        assert!(text.lines().last().unwrap().starts_with("± 95 %"), "{text}");
    }
}
