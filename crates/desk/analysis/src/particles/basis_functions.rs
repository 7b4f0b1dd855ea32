//! Terms of polynomials within a bin: 1, x, y, z, and their products.

use super::Order;

/// Terms of three coordinates at most (–).
pub(super) const MOST_TERMS: usize = 10;

/// Terms of `order` in the coordinates `axes` (–).
pub(super) fn n_terms(order: Order, axes: [bool; 3]) -> usize {
    let n = axes.iter().filter(|is| **is).count();
    match order {
        Order::Constant => 1,
        Order::Linear => 1 + n,
        Order::Quadratic => 1 + n + n * (n + 1) / 2,
    }
}

/// On return `terms` begins with those of `order` at `place`, in the coordinates `axes`: the constant, the
/// linear ones, the quadratic ones.
pub(super) fn terms_at(
    place: [f64; 3],
    order: Order,
    axes: [bool; 3],
    terms: &mut [f64; MOST_TERMS],
) {
    terms[0] = 1.0;
    let mut next = 1;
    let mut add = |value: f64| {
        terms[next] = value;
        next += 1;
    };
    let spanned = || (0..3).filter(|axis| axes[*axis]);
    if order >= Order::Linear {
        spanned().for_each(|axis| add(place[axis]));
    }
    if order >= Order::Quadratic {
        for first in spanned() {
            for second in spanned().filter(|second| *second >= first) {
                add(place[first] * place[second]);
            }
        }
    }
}

/// Place of the linear term of `axis`; none where it has none.
pub(super) fn linear_term(axis: usize, axes: [bool; 3]) -> Option<usize> {
    axes[axis].then(|| 1 + axes[..axis].iter().filter(|is| **is).count())
}
