//! The table of a study on the terminal.

use std::fmt::Write;
use wakemix::basis::records::{Summary, TurbineSummary};
use wakemix::postprocessing::analyses::with_interval;

/// Loads of which the 1-Hz damage-equivalent is told: heading, channel, what it is.
const LOADS: [(&str, &str, &str); 2] = [
    ("flapwise MN m", "RootMyb1", "flapwise at the root of blade 1"),
    ("tower MN m", "TwrBsMyt", "fore-aft at the tower base"),
];

/// Runs × turbines: power, gain, thrust, rotor speed, delivered excitation, and loads and their changes where any turbine
/// has them; the conditions above, the conventions below.
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
    let loads: Vec<Load> = LOADS.iter().filter_map(|load| Load::find(load, summaries)).collect();
    let headings: String = loads.iter().map(Load::headings).collect();
    let _ = writeln!(
        text,
        "{:<14} {:<6} {:<28} {:>18} {:>18} {:>9} {:>7} {:>16}{headings}",
        "run", "", "control", "power kW", "gain %", "thrust kN", "rpm", "pitch delivered"
    );
    for summary in summaries {
        for turbine in &summary.turbines {
            let delivered = turbine.delivered_pitch.map_or(String::new(), |pitch| {
                format!("{:.2}° {:.4} Hz", pitch.delivered_amplitude_deg, pitch.frequency_hz)
            });
            let cells: String = loads.iter().map(|load| load.cells(turbine)).collect();
            let _ = writeln!(
                text,
                "{:<14} {:<6} {:<28} {:>18} {:>18} {:>9.0} {:>7.2} {:>16}{cells}",
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
        "± 95 % from blocks of the analysed time; gains and changes compare the same blocks of the same wind"
    );
    if !loads.is_empty() {
        let told: Vec<String> = loads.iter().map(Load::told).collect();
        let _ = writeln!(
            text,
            "1-Hz damage-equivalent loads, rainflow, no mean correction: {}",
            told.join("; ")
        );
    }
    text
}

/// A column of damage-equivalent loads, and one of their changes where any run is compared.
struct Load<'a> {
    heading: &'a str,
    what: &'a str,
    /// Key of the summaries, such as `RootMyb1, m = 10 (kN m)`.
    key: &'a str,
    is_compared: bool,
}

impl<'a> Load<'a> {
    /// The column of `load` (heading, channel, what it is); None where no turbine of `summaries` has it.
    fn find(load: &(&'a str, &str, &'a str), summaries: &'a [Summary]) -> Option<Self> {
        let &(heading, channel, what) = load;
        let of_channel = |key: &&String| {
            key.strip_prefix(channel).is_some_and(|rest| rest.starts_with(", m = "))
        };
        let mut turbines = summaries.iter().flat_map(|summary| &summary.turbines);
        let mut keys = turbines.clone().flat_map(|turbine| turbine.damage_equivalent_loads.keys());
        let key = keys.find(of_channel)?;
        let is_compared = turbines.any(|turbine| turbine.load_changes.contains_key(key));
        Some(Self { heading, what, key, is_compared })
    }

    fn headings(&self) -> String {
        self.columns(self.heading, "change %")
    }

    /// The load of `turbine` (MN m) and its change (%), empty where it has none.
    fn cells(&self, turbine: &TurbineSummary) -> String {
        let load = turbine.damage_equivalent_loads.get(self.key);
        let change = turbine.load_changes.get(self.key);
        self.columns(
            &load.map_or(String::new(), |load| format!("{:.2}", load / 1e3)),
            &change.map_or(String::new(), |change| with_interval(change, 100.0, 1)),
        )
    }

    fn columns(&self, load: &str, change: &str) -> String {
        if self.is_compared { format!(" {load:>13} {change:>13}") } else { format!(" {load:>13}") }
    }

    /// What the column is, with its channel and slope.
    fn told(&self) -> String {
        let channel = self.key.strip_suffix(" (kN m)").unwrap_or(self.key);
        format!("{} ({channel})", self.what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::basis::records::{Conditions, Cost, SCHEMA_VERSION, Statistic};

    fn statistic(mean: f64) -> Statistic {
        Statistic { mean, standard_deviation: 0.0, half_width_95: None, n_blocks: 1 }
    }

    fn turbine(name: &str, loads: &[(&str, f64)]) -> TurbineSummary {
        TurbineSummary {
            name: name.into(),
            model: "iea-15mw".into(),
            control: "baseline".into(),
            power: statistic(1e7),
            thrust: statistic(1.9e6),
            rotor_speed: statistic(0.7),
            pitch: statistic(0.0),
            delivered_pitch: None,
            power_gain: None,
            pitch_response: None,
            individual_pitch_offset: None,
            meandering: None,
            load_deviations: Default::default(),
            damage_equivalent_loads: loads
                .iter()
                .map(|(key, load)| ((*key).into(), *load))
                .collect(),
            load_changes: Default::default(),
            pitch_duty: None,
        }
    }

    fn summary(turbines: Vec<TurbineSummary>) -> Summary {
        Summary {
            schema_version: SCHEMA_VERSION,
            case: "row".into(),
            run: "baseline".into(),
            compare_with: None,
            conditions: Conditions {
                wind_speed: 9.0,
                turbulence_intensity: 0.05,
                arriving_wind_speed: 8.9,
                arriving_turbulence_intensity: 0.05,
                shear_exponent: Some(0.1),
                roughness_length: None,
                seed: 1,
                rotor_diameter: 240.0,
                cells_per_diameter: None,
                interval: 0.1,
                spin_up: 300.0,
                duration: 900.0,
            },
            turbines,
            array_power: statistic(2e7),
            array_power_gain: None,
            cost: Cost::default(),
            warnings: Vec::new(),
        }
    }

    #[test]
    fn loads_stand_behind_the_turbines_that_have_them() {
        let loads = [
            ("RootMyb1, m = 10 (kN m)", 12_340.0),
            ("RootMyc1, m = 10 (kN m)", 99_999.0),
            ("TwrBsMyt, m = 4 (kN m)", 67_890.0),
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
        let loads = [("RootMyb1, m = 10 (kN m)", 12_340.0), ("TwrBsMyt, m = 4 (kN m)", 67_890.0)];
        let mut compared = turbine("T1", &loads);
        let change = Statistic { half_width_95: Some(0.0312), ..statistic(-0.0678) };
        compared.load_changes.insert(loads[0].0.into(), change);
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
        let text = render(&[summary(vec![turbine("T1", &[("TwrBsMyt, m = 4 (kN m)", 1e3)])])]);
        assert!(!text.contains("flapwise") && text.contains("tower MN m"), "{text}");
        let text = render(&[summary(vec![turbine("T1", &[])])]);
        assert!(text.lines().nth(1).unwrap().ends_with("pitch delivered"), "{text}");
        assert!(text.lines().last().unwrap().starts_with("± 95 %"), "{text}");
    }
}
