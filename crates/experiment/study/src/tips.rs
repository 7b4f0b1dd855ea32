//! Blade tips that exceeded the speed of sound of the solver's air: the step is chosen in the mean wind, and
//! a gust may turn a rotor faster.

/// How fast a tip moved in a record, against the sound of the solver's air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outrun {
    /// The speed of sound (m/s).
    sound_speed: f64,
    /// When it first exceeded that (s).
    first: f64,
    /// Share of the instants at which it did (–).
    share: f64,
    /// Its greatest speed (m/s), and when that was (s).
    fastest: f64,
    fastest_at: f64,
    /// Longest step with which it would not have exceeded the speed of sound (s).
    longest_step: f64,
}

impl Outrun {
    /// None where the tip stayed slower: `radius` (m) from the axis of a rotor that turned at `rotor_speeds`
    /// (rad/s) at `times` (s), in air whose `sound_speed` (m/s) goes with steps of `interval` (s): shorter
    /// steps, faster sound.
    pub(crate) fn of(
        times: &[f64],
        rotor_speeds: &[f64],
        radius: f64,
        sound_speed: f64,
        interval: f64,
    ) -> Option<Self> {
        let tips = || {
            let instants = times.iter().zip(rotor_speeds);
            instants.map(move |(&time, speed)| (time, speed.abs() * radius))
        };
        let outruns = |tip: &(f64, f64)| tip.1 > sound_speed;
        let (first, _) = tips().find(outruns)?;
        let (fastest_at, fastest) = tips().reduce(|a, b| if b.1 > a.1 { b } else { a })?;
        Some(Self {
            sound_speed,
            first,
            share: tips().filter(outruns).count() as f64 / times.len() as f64,
            fastest,
            fastest_at,
            longest_step: interval * sound_speed / fastest,
        })
    }

    /// What a reader of the figures of the turbine `name` in `run` must know.
    pub(crate) fn warning(&self, run: &str, name: &str) -> String {
        format!(
            "{run}: the tip of {name} moved faster than the flow's numerical speed of sound, {:.1} m/s, {:.1} % of the time, first at {:.0} s; \
             at {:.0} s it moved at {:.1} m/s; its power is then too low: use flow.step = {:.4} or less",
            self.sound_speed,
            100.0 * self.share,
            self.first,
            self.fastest_at,
            self.fastest,
            // Rounded down, so that the step printed is short enough.
            (1e4 * self.longest_step).floor() / 1e4,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sound crosses cells of 15 m in steps of 0.1 s at 86.6 m/s; tips turn 120 m from their axis.
    fn outrun(rotor_speeds: &[f64]) -> Option<Outrun> {
        let times: Vec<f64> =
            (0..rotor_speeds.len()).map(|row| 300.0 + 100.0 * row as f64).collect();
        Outrun::of(&times, rotor_speeds, 120.0, 150.0 / 3.0_f64.sqrt(), 0.1)
    }

    #[test]
    fn tips_below_the_sound_are_no_matter() {
        assert_eq!(outrun(&[0.6, 0.7, 0.72]), None);
        assert_eq!(outrun(&[]), None);
    }

    #[test]
    fn the_first_and_the_fastest_instant_are_reported_with_a_step_that_is_short_enough() {
        // 84, 87.6, 90 and 72 m/s.
        let found = outrun(&[0.7, 0.73, 0.75, 0.6]).expect("two of four instants");
        assert_eq!((found.first, found.fastest_at, found.share), (400.0, 500.0, 0.5));
        assert!((found.fastest - 90.0).abs() < 1e-9);
        // With that step the fastest tip moves with the sound.
        let moved = found.fastest * found.longest_step / 15.0;
        assert!((moved - 1.0 / 3.0_f64.sqrt()).abs() < 1e-12, "{moved}");
        let message = found.warning("helix", "T1");
        assert!(message.starts_with("helix: the tip of T1 moved faster than"), "{message}");
        assert!(
            message.contains("50.0 % of the time, first at 400 s; at 500 s it moved at 90.0 m/s")
        );
        assert!(message.ends_with("use flow.step = 0.0962 or less"), "{message}");
    }
}
