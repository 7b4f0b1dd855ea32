//! Power against loads: settings that no other one betters in both.

use search::{Normal, Sum};

/// Settings told of each compromise at most (–).
const MOST: usize = 24;

/// Settings between the most power and the least load.
#[derive(Clone, Debug, PartialEq)]
pub struct Compromise {
    /// Channel of the load.
    pub channel: String,
    /// Wöhler's exponent (–).
    pub exponent: f64,
    /// Each with the gain of the array's power (–) and the change of the equivalent load (–), the least load
    /// first.
    pub settings: Vec<(Vec<f64>, Normal, Normal)>,
}

/// The front between power and output number `output`, a load, among `points`.
///
/// # Errors
/// [`search::SearchError::Surrogate`].
pub(crate) fn compromise(
    sum: &Sum,
    output: usize,
    (channel, exponent): &(String, f64),
    points: &[Vec<f64>],
) -> Result<Compromise, search::SearchError> {
    let (gains, loads) = (sum.at(points)?, sum.output(output, points)?);
    let pairs: Vec<[f64; 2]> =
        gains.iter().zip(&loads).map(|(gain, load)| [gain.mean, load.mean]).collect();
    let places = thinned(&front(&pairs), &pairs);
    let setting = |place: usize| (points[place].clone(), gains[place], loads[place]);
    Ok(Compromise {
        channel: channel.clone(),
        exponent: *exponent,
        settings: places.into_iter().map(setting).collect(),
    })
}

/// Places of `pairs` of a gain and a load than which no other has more gain and less load, the least load
/// first.
fn front(pairs: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..pairs.len()).collect();
    order.sort_by(|a, b| {
        pairs[*a][1].total_cmp(&pairs[*b][1]).then(pairs[*b][0].total_cmp(&pairs[*a][0]))
    });
    let mut most = f64::NEG_INFINITY;
    order.retain(|place| {
        let is_better = pairs[*place][0] > most;
        most = most.max(pairs[*place][0]);
        is_better
    });
    order
}

/// At most [`MOST`] of the places of a `front`, about evenly spread over its gain, both ends among them.
fn thinned(front: &[usize], pairs: &[[f64; 2]]) -> Vec<usize> {
    let [Some(first), Some(last)] = [front.first(), front.last()] else { return Vec::new() };
    let (low, high) = (pairs[*first][0], pairs[*last][0]);
    let (mut kept, mut next): (Vec<usize>, f64) = (Vec::new(), low);
    for place in front {
        if pairs[*place][0] >= next || place == last {
            kept.push(*place);
            next = pairs[*place][0] + (high - low) / MOST as f64;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_no_other_betters() {
        let pairs = [[1.0, 1.0], [2.0, 3.0], [1.5, 3.0], [0.5, 2.0], [3.0, 4.0], [3.0, 5.0]];
        assert_eq!(front(&pairs), [0, 1, 4]);
        let many: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i), f64::from(i)]).collect();
        let kept = thinned(&front(&many), &many);
        assert!(kept.len() <= MOST + 1 && kept[0] == 0 && kept.last() == Some(&999), "{kept:?}");
        assert!(thinned(&[], &[]).is_empty());
    }
}
