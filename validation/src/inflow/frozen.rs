//! How far figures of turbulence may lie from their expectations, frozen: a tolerance that follows the
//! scatter of what is measured is the wider the worse that scatters.
//!
//! Each is what `validation/recorded` had on 2026-11-22, when tolerances were still made of that day's
//! boxes: four standard errors of the mean over ten seeds, or for a single record of another program four
//! standard deviations, and an allowance for what a finite box cannot hold (2 % of Mann's figures).

use crate::Row;
use crate::row::Tolerance::Within;

/// Claims and what is accepted around their expectations, in their units.
pub(super) type Frozen = &'static [(&'static str, f64)];

/// Of figures that scatter by more than half of what is expected: what they meet says nothing.
const NO_CLAIM: f64 = f64::INFINITY;

/// The claim that the figure `measured`, called `what`, is within what `frozen` accepts around `expected`;
/// none for one that decides nothing, which is printed. A figure that `frozen` does not know is accepted
/// nowhere.
pub(super) fn claim(
    frozen: Frozen,
    what: String,
    [measured, expected]: [f64; 2],
    unit: &'static str,
    source: &'static str,
) -> Option<Row> {
    let accepted =
        frozen.iter().find(|(claim, _)| *claim == what).map_or(f64::NAN, |found| found.1);
    if accepted == NO_CLAIM {
        tell!("no claim, {what}: {measured:.4} {unit} beside {expected:.4} {unit}");
        return None;
    }
    Some(Row { what, measured, expected, tolerance: Within(accepted), unit, source })
}

/// Of Kaimal's boxes.
pub(super) const KAIMAL: Frozen = &[
    ("standard deviation of u over all points", 0.0388524),
    ("spectrum of u, 0.003 to 0.01 Hz", 2.57203),
    ("spectrum of u, 0.01 to 0.03 Hz", 0.133764),
    ("spectrum of u, 0.03 to 0.1 Hz", 0.0066362),
    ("spectrum of u, 0.1 to 0.3 Hz", 0.000522088),
    ("standard deviation of v over all points", 0.0001),
    ("spectrum of v, 0.003 to 0.01 Hz", 0.000515813),
    ("spectrum of v, 0.01 to 0.03 Hz", 0.000220414),
    ("spectrum of v, 0.03 to 0.1 Hz", 0.0001),
    ("spectrum of v, 0.1 to 0.3 Hz", 0.0001),
    ("standard deviation of w over all points", 0.0001),
    ("spectrum of w, 0.003 to 0.01 Hz", 0.000100001),
    ("spectrum of w, 0.01 to 0.03 Hz", 0.0001),
    ("spectrum of w, 0.03 to 0.1 Hz", 0.0001),
    ("spectrum of w, 0.1 to 0.3 Hz", 0.0001),
    ("coherence of u 1 × 0 points apart, 0.003 to 0.01 Hz", 0.0185058),
    ("coherence of v 1 × 0 points apart, 0.003 to 0.01 Hz", 0.0142258),
    ("coherence of u 3 × 0 points apart, 0.003 to 0.01 Hz", 0.0493139),
    ("coherence of u 10 × 0 points apart, 0.003 to 0.01 Hz", 0.144067),
    ("coherence of u 0 × 3 points apart, 0.003 to 0.01 Hz", 0.0560923),
    ("coherence of u 0 × 10 points apart, 0.003 to 0.01 Hz", 0.145945),
    ("coherence of u 1 × 0 points apart, 0.01 to 0.03 Hz", 0.0112095),
    ("coherence of v 1 × 0 points apart, 0.01 to 0.03 Hz", 0.00928296),
    ("coherence of u 3 × 0 points apart, 0.01 to 0.03 Hz", 0.0253028),
    ("coherence of u 10 × 0 points apart, 0.01 to 0.03 Hz", 0.0434133),
    ("coherence of u 0 × 3 points apart, 0.01 to 0.03 Hz", 0.0270474),
    ("coherence of u 0 × 10 points apart, 0.01 to 0.03 Hz", 0.0427441),
    ("coherence of u 1 × 0 points apart, 0.03 to 0.1 Hz", 0.0075748),
    ("coherence of v 1 × 0 points apart, 0.03 to 0.1 Hz", 0.00632643),
    ("coherence of u 3 × 0 points apart, 0.03 to 0.1 Hz", 0.0127769),
    ("coherence of u 10 × 0 points apart, 0.03 to 0.1 Hz", 0.0199384),
    ("coherence of u 0 × 3 points apart, 0.03 to 0.1 Hz", 0.0116151),
    ("coherence of u 0 × 10 points apart, 0.03 to 0.1 Hz", 0.0160432),
    ("coherence of u 1 × 0 points apart, 0.1 to 0.3 Hz", 0.00444486),
    ("coherence of v 1 × 0 points apart, 0.1 to 0.3 Hz", 0.00357575),
    ("coherence of u 3 × 0 points apart, 0.1 to 0.3 Hz", 0.0046487),
    ("coherence of u 10 × 0 points apart, 0.1 to 0.3 Hz", 0.00477786),
    ("coherence of u 0 × 3 points apart, 0.1 to 0.3 Hz", 0.00438201),
    ("coherence of u 0 × 10 points apart, 0.1 to 0.3 Hz", 0.00448434),
    ("TurbSim: standard deviation of u, mean over all points", 0.120587),
    ("TurbSim: standard deviation of v, mean over all points", 0.0001),
    ("TurbSim: standard deviation of w, mean over all points", 0.0001),
    ("TurbSim: standard deviation of u at the hub", NO_CLAIM),
    ("TurbSim: spectrum of u, 0.003 to 0.01 Hz", NO_CLAIM),
    ("TurbSim: coherence of u 1 × 0 points apart, 0.003 to 0.01 Hz", 0.0522961),
    ("TurbSim: coherence of u 3 × 0 points apart, 0.003 to 0.01 Hz", 0.14972),
    ("TurbSim: coherence of u 10 × 0 points apart, 0.003 to 0.01 Hz", NO_CLAIM),
    ("TurbSim: coherence of u 0 × 3 points apart, 0.003 to 0.01 Hz", 0.171155),
    ("TurbSim: coherence of u 0 × 10 points apart, 0.003 to 0.01 Hz", NO_CLAIM),
    ("TurbSim: spectrum of u, 0.01 to 0.03 Hz", 0.422161),
    ("TurbSim: coherence of u 1 × 0 points apart, 0.01 to 0.03 Hz", 0.0292229),
    ("TurbSim: coherence of u 3 × 0 points apart, 0.01 to 0.03 Hz", 0.0737899),
    ("TurbSim: coherence of u 10 × 0 points apart, 0.01 to 0.03 Hz", NO_CLAIM),
    ("TurbSim: coherence of u 0 × 3 points apart, 0.01 to 0.03 Hz", 0.0793068),
    ("TurbSim: coherence of u 0 × 10 points apart, 0.01 to 0.03 Hz", NO_CLAIM),
    ("TurbSim: spectrum of u, 0.03 to 0.1 Hz", 0.0207693),
    ("TurbSim: coherence of u 1 × 0 points apart, 0.03 to 0.1 Hz", 0.0177291),
    ("TurbSim: coherence of u 3 × 0 points apart, 0.03 to 0.1 Hz", 0.0341796),
    ("TurbSim: coherence of u 10 × 0 points apart, 0.03 to 0.1 Hz", 0.0568262),
    ("TurbSim: coherence of u 0 × 3 points apart, 0.03 to 0.1 Hz", 0.0305056),
    ("TurbSim: coherence of u 0 × 10 points apart, 0.03 to 0.1 Hz", 0.0445085),
    ("TurbSim: spectrum of u, 0.1 to 0.3 Hz", 0.00143476),
    ("TurbSim: coherence of u 1 × 0 points apart, 0.1 to 0.3 Hz", 0.00783132),
    ("TurbSim: coherence of u 3 × 0 points apart, 0.1 to 0.3 Hz", 0.00847594),
    ("TurbSim: coherence of u 10 × 0 points apart, 0.1 to 0.3 Hz", 0.00888435),
    ("TurbSim: coherence of u 0 × 3 points apart, 0.1 to 0.3 Hz", 0.00763259),
    ("TurbSim: coherence of u 0 × 10 points apart, 0.1 to 0.3 Hz", 0.00795618),
];

/// Of Mann's boxes.
pub(super) const MANN: Frozen = &[
    ("isotropic box, turbulence intensity over the box", 1e-06),
    ("isotropic box, intensity met at 64 fixed points, every half spacing in time", 0.00164),
    ("isotropic box, deviation of v", 0.0136),
    ("isotropic box, deviation of w", 0.014),
    ("isotropic box, integral length scale of u along x", 1.32),
    ("isotropic box, integral length scale of v along x", 0.676),
    ("isotropic box, integral length scale of w along x", 0.627),
    ("isotropic box, divergence in Fourier space", 1e-05),
    ("isotropic box, F11, k1 L 0.1 to 0.2", 0.236),
    ("isotropic box, F22, k1 L 0.1 to 0.2", 0.132),
    ("isotropic box, F33, k1 L 0.1 to 0.2", 0.131),
    ("isotropic box, F13, k1 L 0.1 to 0.2", 0.148),
    ("isotropic box, F11, k1 L 0.2 to 0.5", 0.11),
    ("isotropic box, F22, k1 L 0.2 to 0.5", 0.107),
    ("isotropic box, F33, k1 L 0.2 to 0.5", 0.0934),
    ("isotropic box, F13, k1 L 0.2 to 0.5", 0.103),
    ("isotropic box, F11, k1 L 0.5 to 1", 0.0895),
    ("isotropic box, F22, k1 L 0.5 to 1", 0.0672),
    ("isotropic box, F33, k1 L 0.5 to 1", 0.0869),
    ("isotropic box, F13, k1 L 0.5 to 1", 0.0804),
    ("isotropic box, F11, k1 L 1 to 2", 0.0474),
    ("isotropic box, F22, k1 L 1 to 2", 0.0522),
    ("isotropic box, F33, k1 L 1 to 2", 0.0563),
    ("isotropic box, F13, k1 L 1 to 2", 0.0364),
    ("isotropic box, F11, k1 L 2 to 4", 0.0127),
    ("isotropic box, F22, k1 L 2 to 4", 0.0214),
    ("isotropic box, F33, k1 L 2 to 4", 0.0204),
    ("isotropic box, F13, k1 L 2 to 4", 0.0127),
    ("isotropic box, in-phase coherence of u, 12 m left, 0 m up, k1 L 0.1 to 0.2", 0.0251),
    ("isotropic box, quadrature coherence of u, 12 m left, 0 m up, k1 L 0.1 to 0.2", 0.0407),
    ("isotropic box, in-phase coherence of u, 12 m left, 0 m up, k1 L 0.2 to 0.5", 0.0238),
    ("isotropic box, quadrature coherence of u, 12 m left, 0 m up, k1 L 0.2 to 0.5", 0.026),
    ("isotropic box, in-phase coherence of u, 12 m left, 0 m up, k1 L 0.5 to 1", 0.0238),
    ("isotropic box, quadrature coherence of u, 12 m left, 0 m up, k1 L 0.5 to 1", 0.0282),
    ("isotropic box, in-phase coherence of u, 36 m left, 0 m up, k1 L 0.1 to 0.2", 0.0331),
    ("isotropic box, quadrature coherence of u, 36 m left, 0 m up, k1 L 0.1 to 0.2", 0.0617),
    ("isotropic box, in-phase coherence of u, 36 m left, 0 m up, k1 L 0.2 to 0.5", 0.0328),
    ("isotropic box, quadrature coherence of u, 36 m left, 0 m up, k1 L 0.2 to 0.5", 0.0368),
    ("isotropic box, in-phase coherence of u, 36 m left, 0 m up, k1 L 0.5 to 1", 0.0295),
    ("isotropic box, quadrature coherence of u, 36 m left, 0 m up, k1 L 0.5 to 1", 0.033),
    ("isotropic box, in-phase coherence of u, 0 m left, 12 m up, k1 L 0.1 to 0.2", 0.0273),
    ("isotropic box, quadrature coherence of u, 0 m left, 12 m up, k1 L 0.1 to 0.2", 0.032),
    ("isotropic box, in-phase coherence of u, 0 m left, 12 m up, k1 L 0.2 to 0.5", 0.0223),
    ("isotropic box, quadrature coherence of u, 0 m left, 12 m up, k1 L 0.2 to 0.5", 0.0299),
    ("isotropic box, in-phase coherence of u, 0 m left, 12 m up, k1 L 0.5 to 1", 0.0233),
    ("isotropic box, quadrature coherence of u, 0 m left, 12 m up, k1 L 0.5 to 1", 0.0249),
    ("isotropic box, in-phase coherence of u, 0 m left, 36 m up, k1 L 0.1 to 0.2", 0.0461),
    ("isotropic box, quadrature coherence of u, 0 m left, 36 m up, k1 L 0.1 to 0.2", 0.0508),
    ("isotropic box, in-phase coherence of u, 0 m left, 36 m up, k1 L 0.2 to 0.5", 0.0298),
    ("isotropic box, quadrature coherence of u, 0 m left, 36 m up, k1 L 0.2 to 0.5", 0.0444),
    ("isotropic box, in-phase coherence of u, 0 m left, 36 m up, k1 L 0.5 to 1", 0.0285),
    ("isotropic box, quadrature coherence of u, 0 m left, 36 m up, k1 L 0.5 to 1", 0.0291),
    ("sheared box, turbulence intensity over the box", 1e-06),
    ("sheared box, intensity met at 64 fixed points, every half spacing in time", 0.00164),
    ("sheared box, deviation of v", 0.018),
    ("sheared box, deviation of w", 0.0102),
    ("sheared box, integral length scale of u along x", 17.0),
    ("sheared box, integral length scale of v along x", NO_CLAIM),
    ("sheared box, integral length scale of w along x", 5.37),
    ("sheared box, divergence in Fourier space", 1e-05),
    ("sheared box, F11, k1 L 0.1 to 0.2", 1.87),
    ("sheared box, F22, k1 L 0.1 to 0.2", 0.643),
    ("sheared box, F33, k1 L 0.1 to 0.2", 0.144),
    ("sheared box, F13, k1 L 0.1 to 0.2", 0.581),
    ("sheared box, F11, k1 L 0.2 to 0.5", 0.242),
    ("sheared box, F22, k1 L 0.2 to 0.5", 0.181),
    ("sheared box, F33, k1 L 0.2 to 0.5", 0.0518),
    ("sheared box, F13, k1 L 0.2 to 0.5", 0.154),
    ("sheared box, F11, k1 L 0.5 to 1", 0.0874),
    ("sheared box, F22, k1 L 0.5 to 1", 0.0672),
    ("sheared box, F33, k1 L 0.5 to 1", 0.0232),
    ("sheared box, F13, k1 L 0.5 to 1", 0.0501),
    ("sheared box, F11, k1 L 1 to 2", 0.028),
    ("sheared box, F22, k1 L 1 to 2", 0.0382),
    ("sheared box, F33, k1 L 1 to 2", 0.0157),
    ("sheared box, F13, k1 L 1 to 2", 0.0194),
    ("sheared box, F11, k1 L 2 to 4", 0.00724),
    ("sheared box, F22, k1 L 2 to 4", 0.0116),
    ("sheared box, F33, k1 L 2 to 4", 0.00608),
    ("sheared box, F13, k1 L 2 to 4", 0.0042),
    ("sheared box, in-phase coherence of u, 12 m left, 0 m up, k1 L 0.1 to 0.2", 0.0266),
    ("sheared box, quadrature coherence of u, 12 m left, 0 m up, k1 L 0.1 to 0.2", 0.0471),
    ("sheared box, in-phase coherence of u, 12 m left, 0 m up, k1 L 0.2 to 0.5", 0.0241),
    ("sheared box, quadrature coherence of u, 12 m left, 0 m up, k1 L 0.2 to 0.5", 0.0319),
    ("sheared box, in-phase coherence of u, 12 m left, 0 m up, k1 L 0.5 to 1", 0.0238),
    ("sheared box, quadrature coherence of u, 12 m left, 0 m up, k1 L 0.5 to 1", 0.0338),
    ("sheared box, in-phase coherence of u, 36 m left, 0 m up, k1 L 0.1 to 0.2", 0.0482),
    ("sheared box, quadrature coherence of u, 36 m left, 0 m up, k1 L 0.1 to 0.2", 0.0898),
    ("sheared box, in-phase coherence of u, 36 m left, 0 m up, k1 L 0.2 to 0.5", 0.0375),
    ("sheared box, quadrature coherence of u, 36 m left, 0 m up, k1 L 0.2 to 0.5", 0.0533),
    ("sheared box, in-phase coherence of u, 36 m left, 0 m up, k1 L 0.5 to 1", 0.0292),
    ("sheared box, quadrature coherence of u, 36 m left, 0 m up, k1 L 0.5 to 1", 0.0452),
    ("sheared box, in-phase coherence of u, 0 m left, 12 m up, k1 L 0.1 to 0.2", 0.0244),
    ("sheared box, quadrature coherence of u, 0 m left, 12 m up, k1 L 0.1 to 0.2", 0.0335),
    ("sheared box, in-phase coherence of u, 0 m left, 12 m up, k1 L 0.2 to 0.5", 0.0231),
    ("sheared box, quadrature coherence of u, 0 m left, 12 m up, k1 L 0.2 to 0.5", 0.0255),
    ("sheared box, in-phase coherence of u, 0 m left, 12 m up, k1 L 0.5 to 1", 0.0224),
    ("sheared box, quadrature coherence of u, 0 m left, 12 m up, k1 L 0.5 to 1", 0.0248),
    ("sheared box, in-phase coherence of u, 0 m left, 36 m up, k1 L 0.1 to 0.2", 0.0419),
    ("sheared box, quadrature coherence of u, 0 m left, 36 m up, k1 L 0.1 to 0.2", 0.0586),
    ("sheared box, in-phase coherence of u, 0 m left, 36 m up, k1 L 0.2 to 0.5", 0.0357),
    ("sheared box, quadrature coherence of u, 0 m left, 36 m up, k1 L 0.2 to 0.5", 0.0346),
    ("sheared box, in-phase coherence of u, 0 m left, 36 m up, k1 L 0.5 to 1", 0.0296),
    ("sheared box, quadrature coherence of u, 0 m left, 36 m up, k1 L 0.5 to 1", 0.0299),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;

    #[test]
    fn what_is_recorded_is_what_is_frozen() {
        for (frozen, text, all) in [
            (KAIMAL, include_str!("../../recorded/kaimal.toml"), 3),
            (MANN, include_str!("../../recorded/inflow.toml"), 16),
        ] {
            let record = Record::parse(text).unwrap();
            let claims = frozen.iter().filter(|(_, accepted)| *accepted != NO_CLAIM);
            // The others have closed forms, or are exact.
            assert_eq!(claims.clone().count() + all, record.rows.len());
            for (claim, accepted) in claims {
                let row = record.rows.iter().find(|row| row.claim == *claim).unwrap();
                assert_eq!(row.tolerance, Within(*accepted), "{claim}");
            }
        }
    }

    #[test]
    fn scatter_makes_no_claim_easier() {
        let of = |what: &str, measured: f64| {
            claim(KAIMAL, what.to_owned(), [measured, 0.508576], "m/s", "")
        };
        let what = "standard deviation of u over all points";
        assert!(of(what, 0.54).unwrap().passes() && !of(what, 0.56).unwrap().passes());
        assert!(!of("such a figure", 0.508576).unwrap().passes());
        assert_eq!(of("TurbSim: standard deviation of u at the hub", 0.5), None);
    }
}
