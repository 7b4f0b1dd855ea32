//! The tables of a study on the terminal.

use wakemix::basis::records::{Load, LoadKind, Statistic, Summary, TurbineSummary};
use wakemix::postprocessing::analyses::with_interval;
use wakemix::report::are_of_models;
use wakemix::report::text_table::{Column, TextTable, wrapped};

/// Loads of which the 1-Hz damage-equivalent is printed: heading, channel, what it is.
const LOADS: [(&str, &str, &str); 2] = [
    ("flapwise", "RootMyb1", "flapwise at the root of blade 1"),
    ("tower", "TwrBsMyt", "fore-aft at the tower base"),
];

/// In what a table shows powers, thrusts and moments.
struct Units {
    /// Name and size (W) of that of power, and digits behind its point.
    power: (&'static str, f64, usize),
    /// The same of thrust (N).
    thrust: (&'static str, f64, usize),
    /// Name and size (kN m) of that of moments.
    moment: (&'static str, f64),
}

const OF_TURBINES: Units =
    Units { power: ("kW", 1e3, 0), thrust: ("kN", 1e3, 0), moment: ("MN m", 1e3) };
const OF_MODELS: Units =
    Units { power: ("W", 1.0, 3), thrust: ("N", 1.0, 3), moment: ("N m", 1e-3) };

/// What suits the turbines of `summaries`.
fn units(summaries: &[Summary]) -> &'static Units {
    let turbines = summaries.iter().flat_map(|summary| &summary.turbines);
    let is_model = are_of_models(turbines.map(|turbine| turbine.power.mean));
    if is_model { &OF_MODELS } else { &OF_TURBINES }
}

/// Runs × turbines in `width` columns: power, gain, thrust, rotor speed; in a further table delivered
/// excitation, and loads with their changes where any turbine has them; the conditions above, the conventions
/// below.
pub(crate) fn render(summaries: &[Summary], width: usize) -> String {
    let Some(first) = summaries.first() else {
        return String::new();
    };
    let units = units(summaries);
    let loads: Vec<LoadColumn> =
        LOADS.iter().filter_map(|load| LoadColumn::find(load, summaries)).collect();
    let mut columns = vec![
        Column::words("control"),
        Column::number(format!("power {}", units.power.0)),
        Column::number("gain %"),
        Column::number(format!("thrust {}", units.thrust.0)),
        Column::number("rpm"),
        Column::number("pitch delivered").in_new_table(),
    ];
    columns.extend(loads.iter().flat_map(|load| load.columns(units)));
    let mut table = TextTable::new([Column::words("run"), Column::words("")], columns);
    for summary in summaries {
        for turbine in &summary.turbines {
            table.row(row(&summary.run, turbine, &loads, units));
        }
        // Without wakes no turbine feels another, so that a sum means nothing.
        if summary.has_wakes() {
            table.row([
                summary.run.clone(),
                "all".to_owned(),
                String::new(),
                with_interval(&summary.array_power, 1.0 / units.power.1, units.power.2),
                percent(summary.array_power_gain.as_ref(), 2),
            ]);
        }
    }
    let head = format!("{}: {}\n", first.case, conditions(first));
    let mut below = "± 95 % from blocks of the analysed time; gains and changes compare the same blocks of the same wind\n".to_owned();
    if !loads.is_empty() {
        let printed: Vec<String> = loads.iter().map(LoadColumn::printed).collect();
        below += &format!(
            "1-Hz damage-equivalent loads, rainflow, no mean correction: {}\n",
            printed.join("; ")
        );
    }
    wrapped(&head, width) + &table.fitted(width) + &wrapped(&below, width)
}

/// Wind, length, and what moves the air.
fn conditions(summary: &Summary) -> String {
    let wind = &summary.conditions;
    let solver = summary.flow.as_ref().map(|flow| flow.solver.as_str());
    let air = match (wind.cells_per_diameter, solver) {
        (Some(cells), _) => format!("{cells:.0} cells per diameter"),
        (None, Some(solver)) if summary.has_wakes() => format!("flow solver {solver}"),
        (None, _) => "prescribed wind".to_owned(),
    };
    let from = match wind.direction_deg {
        270.0 => String::new(),
        degrees => format!(" from {degrees}°"),
    };
    let analysed = match wind.duration - wind.spin_up {
        short if short < 60.0 => format!("{short:.1} s"),
        long => format!("{:.0} min", long / 60.0),
    };
    format!(
        "{:.1} m/s{from}, turbulence intensity {:.1} % target, {:.1} % realised; {analysed} analysed after {:.0} s; {air}",
        wind.target_wind_speed,
        100.0 * wind.target_turbulence_intensity,
        100.0 * wind.realised_turbulence_intensity,
        wind.spin_up,
    )
}

/// The cells of `turbine` in the run called `run`.
fn row(run: &str, turbine: &TurbineSummary, loads: &[LoadColumn], units: &Units) -> Vec<String> {
    let Units { power: (_, power, power_digits), thrust: (_, thrust, thrust_digits), .. } = *units;
    let delivered = turbine.delivered_pitch.map_or(String::new(), |pitch| {
        format!("{:.2}° {:.4} Hz", pitch.delivered_amplitude_deg, pitch.frequency_hz)
    });
    let mut cells = vec![
        run.to_owned(),
        turbine.name.clone(),
        turbine.control.description.clone(),
        with_interval(&turbine.power, 1.0 / power, power_digits),
        percent(turbine.power_gain.as_ref(), 2),
        format!("{:.thrust_digits$}", turbine.thrust.mean / thrust),
        format!("{:.2}", turbine.rotor_speed.mean * 30.0 / std::f64::consts::PI),
        delivered,
    ];
    cells.extend(loads.iter().flat_map(|load| load.cells(turbine, units)));
    cells
}

/// A column of damage-equivalent loads, and one of their changes.
struct LoadColumn<'a> {
    heading: &'a str,
    what: &'a str,
    channel: &'a str,
    /// Slope of the Wöhler line (–).
    slope: f64,
}

impl<'a> LoadColumn<'a> {
    /// The column of `load` (heading, channel, what it is); None where no turbine of `summaries` has it.
    fn find(load: &(&'a str, &'a str, &'a str), summaries: &[Summary]) -> Option<Self> {
        let &(heading, channel, what) = load;
        let mut turbines = summaries.iter().flat_map(|summary| &summary.turbines);
        let found: &Load = turbines.find_map(|turbine| turbine.damage_equivalent(channel))?;
        let LoadKind::DamageEquivalent { slope, .. } = found.kind else { return None };
        Some(Self { heading, what, channel, slope })
    }

    fn columns(&self, units: &Units) -> [Column; 2] {
        let heading = format!("{} {}", self.heading, units.moment.0);
        [heading, "change %".to_owned()].map(Column::number)
    }

    /// The load of `turbine` and its change (%), empty where it has none.
    fn cells(&self, turbine: &TurbineSummary, units: &Units) -> [String; 2] {
        let load = turbine.damage_equivalent(self.channel);
        [
            load.map_or(String::new(), |load| format!("{:.2}", load.value / units.moment.1)),
            percent(load.and_then(|load| load.change.as_ref()), 1),
        ]
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
mod tests;
