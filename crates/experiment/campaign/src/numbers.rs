//! The numbers of a summary under names, with their units: what a surrogate is made of.

use basis::records::{Load, LoadKind, Statistic, Summary, TurbineSummary};

/// A number of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its name, such as `T1.power.mean`.
    pub name: String,
    /// Its unit, `–` of a ratio.
    pub unit: String,
    /// The number, in [`unit`](Self::unit); absent where it does not apply.
    pub value: Option<f64>,
}

/// Numbers as they are gathered.
struct Gathered(Vec<Number>);

impl Gathered {
    fn add(&mut self, name: String, unit: &str, value: impl Into<Option<f64>>) {
        self.0.push(Number { name, unit: unit.to_owned(), value: value.into() });
    }

    fn statistic(&mut self, name: &str, unit: &str, statistic: &Statistic) {
        self.add(format!("{name}.mean"), unit, statistic.mean);
        self.add(format!("{name}.standard_deviation"), unit, statistic.standard_deviation);
        self.add(format!("{name}.half_width_95"), unit, statistic.half_width_95);
    }

    fn load(&mut self, turbine: &str, load: &Load) {
        let figure = match load.kind {
            LoadKind::Deviation => "deviation".to_owned(),
            LoadKind::DamageEquivalent { slope, .. } => format!("del_m{slope}"),
        };
        let name = format!("{turbine}.{}.{figure}", load.channel);
        self.add(name.clone(), &load.unit, load.value);
        if let Some(change) = &load.change {
            self.add(format!("{name}.change"), "–", change.mean);
        }
    }

    fn turbine(&mut self, turbine: &TurbineSummary) {
        let own = turbine.name.as_str();
        self.statistic(&format!("{own}.power"), "W", &turbine.power);
        self.statistic(&format!("{own}.thrust"), "N", &turbine.thrust);
        self.statistic(&format!("{own}.rotor_speed"), "rad/s", &turbine.rotor_speed);
        self.statistic(&format!("{own}.pitch"), "rad", &turbine.pitch);
        if let Some(gain) = &turbine.power_gain {
            self.statistic(&format!("{own}.power_gain"), "–", gain);
        }
        if let Some(rotor) = &turbine.rotor {
            self.add(format!("{own}.yaw_deg"), "deg", rotor.yaw_deg);
        }
        if let Some(misalignment) = turbine.yaw_misalignment_deg {
            self.add(format!("{own}.yaw_misalignment_deg"), "deg", misalignment);
        }
        for sector in &turbine.sectors {
            let name = format!("{own}.sector_{}", sector.name);
            self.add(format!("{name}.wind_speed"), "m/s", sector.wind_speed);
            self.add(format!("{name}.turbulence_intensity"), "–", sector.turbulence_intensity);
        }
        for load in &turbine.loads {
            self.load(own, load);
        }
        if let Some(delivered) = &turbine.delivered_pitch {
            for (name, unit, value) in [
                ("commanded_amplitude_deg", "deg", delivered.commanded_amplitude_deg),
                ("delivered_amplitude_deg", "deg", delivered.delivered_amplitude_deg),
                ("frequency_hz", "Hz", delivered.frequency_hz),
                ("excitation_frequency_hz", "Hz", delivered.excitation_frequency_hz),
                ("clipped_share", "–", delivered.clipped_share),
            ] {
                self.add(format!("{own}.delivered_pitch.{name}"), unit, value);
            }
        }
        if let Some(duty) = &turbine.pitch_duty {
            for (name, unit, value) in [
                ("travel_deg", "deg", duty.travel_deg),
                ("travel_in_ten_minutes_deg", "deg", duty.travel_in_ten_minutes_deg),
                ("maximum_rate_deg_s", "deg/s", duty.maximum_rate_deg_s),
                ("moving_share", "–", duty.moving_share),
                ("n_reversals", "–", duty.n_reversals as f64),
            ] {
                self.add(format!("{own}.pitch_duty.{name}"), unit, value);
            }
            let worst = duty.worst_bearing_load().map(|load| load.load_kn_m);
            self.add(format!("{own}.pitch_duty.worst_bearing_load"), "kN m", worst);
        }
        for finding in &turbine.control.findings {
            self.add(format!("{own}.control.{}", finding.name), &finding.unit, finding.value);
        }
    }
}

/// The numbers of the run of `summary`: of all turbines, of their powers together, and of the wind that they
/// met.
pub fn numbers(summary: &Summary) -> Vec<Number> {
    let mut found = Gathered(Vec::new());
    for turbine in &summary.turbines {
        found.turbine(turbine);
    }
    found.statistic("array_power", "W", &summary.array_power);
    if let Some(gain) = &summary.array_power_gain {
        found.statistic("array_power_gain", "–", gain);
    }
    let wind = &summary.conditions;
    found.add("realised_wind_speed".to_owned(), "m/s", wind.realised_wind_speed);
    let intensity = wind.realised_turbulence_intensity;
    found.add("realised_turbulence_intensity".to_owned(), "–", intensity);
    found.0
}

/// Whether `name` is what `pattern` says, where `*` stands for any part.
pub(crate) fn is_like(name: &str, pattern: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return name == pattern };
    let Some(name) = name.strip_prefix(start) else { return false };
    let places = name.char_indices().map(|(place, _)| place).chain([name.len()]);
    places.into_iter().any(|place| is_like(&name[place..], rest))
}
