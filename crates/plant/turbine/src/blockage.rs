//! Blockage of a rotor in a channel: the unbounded free stream that gives the same rotor state.

/// Largest thrust coefficient for which momentum theory without mixing holds (–).
const GREATEST_THRUST: f64 = 0.96;

/// Ratio of the equivalent unbounded free-stream speed to the channel's inflow speed (–), never below one.
///
/// `thrust_coefficient` (–) is on the channel's inflow speed and the rotor's area; `area_ratio` (–) is the
/// rotor's area over the channel's cross-section, whose walls are frictionless or whose sides are periodic.
///
/// A disc of the same thrust T and the same speed through it, u₁, in unbounded air has U′ with T = 2 ρ A u₁
/// (U′ − u₁), so U′/U = u₁/U + C_T / (4 u₁/U). The speed u₁ follows from mass, momentum and Bernoulli in the
/// channel, with the wake and the faster bypass at one pressure far behind.
/// Source: axial momentum theory of a disc in a wind tunnel, Glauert (1935), ch. IX, in the form of
/// Mikkelsen, Sørensen (2002) and Werle (2010).
/// Limits: no swirl, no mixing of wake and bypass; above C_T 0.96, where that no longer holds, the value at
/// 0.96.
///
/// ```
/// // 8 D × 8 D: a percent of blockage lets a rotor at C_T 0.8 work as if the wind were 0.5 % faster
/// let ratio = turbine::blockage::equivalent_speed_ratio(0.8, std::f64::consts::PI / 4.0 / 64.0);
/// assert!((ratio - 1.005_255).abs() < 1e-6);
/// ```
pub fn equivalent_speed_ratio(thrust_coefficient: f64, area_ratio: f64) -> f64 {
    if thrust_coefficient <= 0.0 || area_ratio <= 0.0 {
        return 1.0;
    }
    let thrust_coefficient = thrust_coefficient.min(GREATEST_THRUST);
    let disc = disc_speed_ratio(thrust_coefficient, area_ratio);
    disc + thrust_coefficient / (4.0 * disc)
}

/// Speed through the disc over the channel's inflow speed (–).
fn disc_speed_ratio(thrust_coefficient: f64, area_ratio: f64) -> f64 {
    // Symbols, speeds over the inflow's: b bypass, w wake, beta wake area over channel area.
    // Bernoulli b² − w² = C_T; mass 1 = w beta + b (1 − beta); the momentum balance is the residual.
    let wake = |b: f64| (b * b - thrust_coefficient).max(0.0).sqrt();
    let wake_share = |b: f64| (b - 1.0) / (b - wake(b));
    let residual = |b: f64| {
        let (w, beta) = (wake(b), wake_share(b));
        0.5 * (b * b - 1.0) + 1.0
            - 0.5 * thrust_coefficient * area_ratio
            - w * w * beta
            - b * b * (1.0 - beta)
    };
    // Without a bypass speed-up there is no wake, so the thrust is not balanced; bisect the way up.
    let mut low = thrust_coefficient.sqrt().max(1.0);
    let mut high = low + 2.0;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if residual(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let b = 0.5 * (low + high);
    wake(b) * wake_share(b) / area_ratio
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_walls_nothing_changes() {
        for thrust_coefficient in [0.1, 0.5, 0.8, 0.95] {
            assert!((equivalent_speed_ratio(thrust_coefficient, 1e-7) - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn the_channel_balances_mass_momentum_and_energy() {
        let (thrust_coefficient, area_ratio) = (0.75, 0.1);
        let disc = disc_speed_ratio(thrust_coefficient, area_ratio);
        // Rebuild the channel from the disc speed: mass through the disc fixes the wake's area for each wake
        // speed.
        let mut best = f64::MAX;
        for i in 1..10_000 {
            let w = f64::from(i) * 1e-4;
            let b = (w * w + thrust_coefficient).sqrt();
            let beta = disc * area_ratio / w;
            let mass = w * beta + b * (1.0 - beta) - 1.0;
            let momentum = 0.5 * (b * b - 1.0) + 1.0
                - 0.5 * thrust_coefficient * area_ratio
                - w * w * beta
                - b * b * (1.0 - beta);
            best = best.min(mass.abs() + momentum.abs());
        }
        assert!(best < 2e-4, "{best}");
    }

    #[test]
    fn more_thrust_and_narrower_channels_speed_up_more() {
        let at = equivalent_speed_ratio;
        assert!(at(0.8, 0.05) > at(0.8, 0.02) && at(0.8, 0.05) > at(0.5, 0.05));
    }
}
