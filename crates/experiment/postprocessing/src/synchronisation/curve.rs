//! The curve through changes over the phase offset, with its band and where it is highest and lowest.

#[cfg(feature = "curves")]
mod process;

use report::{CurveEnd, CurvePoint, OffsetPanel, OffsetPoint};

/// Whether this program draws curves: it does when built with its default features.
pub(crate) const CURVES: bool = cfg!(feature = "curves");

/// A curve with its highest and lowest points.
#[derive(Default)]
struct Drawn {
    curve: Vec<CurvePoint>,
    highest: Option<CurveEnd>,
    lowest: Option<CurveEnd>,
}

/// A panel called `title` of `points` with the curve through them; without the curve where the points are too
/// few, or allow none, or the crate was built without its feature `curves`.
///
/// A point whose change has an interval from n blocks counts with its standard error, s/√n, and its n − 1
/// degrees of freedom; beside these, one noise variance is estimated for all points. Band and intervals are
/// those of `surrogate::GaussianProcess::curve`: they cover what the blocks vary by and what lies between the
/// offsets. They do not cover what all offsets share, such as the wind in which all of them ran.
pub fn offset_panel(title: String, points: Vec<OffsetPoint>) -> OffsetPanel {
    let Drawn { curve, highest, lowest } = through(&points).unwrap_or_default();
    OffsetPanel { title, points, curve, highest, lowest }
}

#[cfg(feature = "curves")]
use process::through;

#[cfg(not(feature = "curves"))]
fn through(_: &[OffsetPoint]) -> Option<Drawn> {
    None
}
