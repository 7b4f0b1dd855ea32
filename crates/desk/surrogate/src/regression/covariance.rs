//! Covariances of many points at once, and sums of their derivatives.

use super::expression::{Kernel, Part};
use crate::Shape;
use crate::vector::{
    add_product, add_scaled, add_turns, add_weighted_squares, multiply, profile, square_distances,
};
use std::f64::consts::PI;
use std::ops::Range;

/// Points that are worked on together at most (–).
pub(crate) const CHUNK: usize = 256;

/// Points as a kernel sees them: coordinates in lengths, turns as sines and cosines.
#[derive(Clone, Debug)]
pub(crate) struct Points {
    terms: Vec<PointsOfTerm>,
}

#[derive(Clone, Debug)]
struct PointsOfTerm {
    variance: f64,
    parts: Vec<PointsOfPart>,
}

#[derive(Clone, Debug)]
struct PointsOfPart {
    shape: Shape,
    columns: Columns,
}

#[derive(Clone, Debug)]
enum Columns {
    /// Coordinates over lengths, one column for each input.
    Straight(Vec<Vec<f64>>),
    /// Sines and cosines of π x/p, and 1/ℓ, for each input.
    Turning(Vec<([Vec<f64>; 2], f64)>),
}

/// Room for what is worked out of one chunk, a row for each part.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    squares: Vec<[f64; CHUNK]>,
    values: Vec<[f64; CHUNK]>,
    slopes: Vec<[f64; CHUNK]>,
}

impl PointsOfPart {
    fn new(part: &Part, inputs: &[Vec<f64>]) -> Self {
        let of_part = || part.inputs.iter().zip(&part.lengths);
        let columns = match part.shape {
            Shape::Periodic { period } => {
                let turning = of_part().map(|(input, length)| {
                    let turns = |of: fn(f64) -> f64| {
                        inputs[*input].iter().map(|x| of(PI * x / period)).collect()
                    };
                    ([turns(f64::sin), turns(f64::cos)], 1.0 / length)
                });
                Columns::Turning(turning.collect())
            }
            _ => Columns::Straight(
                of_part()
                    .map(|(input, length)| inputs[*input].iter().map(|x| x / length).collect())
                    .collect(),
            ),
        };
        Self { shape: part.shape, columns }
    }

    /// On return `squares` are the squared distances of `range` to point `index` of `other`.
    fn squares(&self, range: Range<usize>, other: &Self, index: usize, squares: &mut [f64]) {
        match (&self.columns, &other.columns) {
            (Columns::Straight(own), Columns::Straight(other)) => {
                const MOST: usize = 16;
                squares.fill(0.0);
                let mut some = [0.0; CHUNK];
                for (own, other) in own.chunks(MOST).zip(other.chunks(MOST)) {
                    let (mut columns, mut others) = ([&[][..]; MOST], [0.0; MOST]);
                    for (slot, (own, other)) in own.iter().zip(other).enumerate() {
                        (columns[slot], others[slot]) = (&own[range.clone()], other[index]);
                    }
                    let some = &mut some[..range.len()];
                    square_distances(some, &columns[..own.len()], &others[..own.len()]);
                    add_scaled(squares, some, 1.0);
                }
            }
            (Columns::Turning(own), Columns::Turning(other)) => {
                squares.fill(0.0);
                for (([sines, cosines], gain), ([sine, cosine], _)) in own.iter().zip(other) {
                    let (sines, cosines) = (&sines[range.clone()], &cosines[range.clone()]);
                    add_turns(squares, sines, cosines, [sine[index], cosine[index]], *gain);
                }
            }
            _ => unreachable!("points of one kernel"),
        }
    }

    /// Adds Σ weight × squared distance along each input to `sums`.
    fn add_squares(
        &self,
        range: Range<usize>,
        other: &Self,
        index: usize,
        weights: &[f64],
        sums: &mut [f64],
    ) {
        match (&self.columns, &other.columns) {
            (Columns::Straight(own), Columns::Straight(other)) => {
                for ((own, other), sum) in own.iter().zip(other).zip(sums) {
                    add_weighted_squares(sum, weights, &own[range.clone()], other[index]);
                }
            }
            (Columns::Turning(own), Columns::Turning(other)) => {
                for ((([sines, cosines], gain), ([sine, cosine], _)), sum) in
                    own.iter().zip(other).zip(sums)
                {
                    let (mut some, other) = ([0.0; CHUNK], [sine[index], cosine[index]]);
                    let some = &mut some[..range.len()];
                    add_turns(some, &sines[range.clone()], &cosines[range.clone()], other, *gain);
                    add_product(sum, weights, some);
                }
            }
            _ => unreachable!("points of one kernel"),
        }
    }

    fn n_parameters(&self) -> usize {
        let n_lengths = match &self.columns {
            Columns::Straight(columns) => columns.len(),
            Columns::Turning(columns) => columns.len(),
        };
        n_lengths + usize::from(matches!(self.shape, Shape::RationalQuadratic { .. }))
    }
}

impl Points {
    /// Points of `inputs`, a column for each input.
    pub(crate) fn new(kernel: &Kernel, inputs: &[Vec<f64>]) -> Self {
        let of_term = |term: &super::expression::Term| PointsOfTerm {
            variance: term.variance,
            parts: term.parts.iter().map(|part| PointsOfPart::new(part, inputs)).collect(),
        };
        Self { terms: kernel.terms.iter().map(of_term).collect() }
    }

    /// On return `covariances` are those of the points `range`, a [`CHUNK`] at most, with point `index` of
    /// `other`.
    pub(crate) fn covariances(
        &self,
        range: Range<usize>,
        other: &Self,
        index: usize,
        covariances: &mut [f64],
    ) {
        let n = range.len();
        let [mut squares, mut values, mut slopes, mut product] = [[0.0; CHUNK]; 4];
        covariances.fill(0.0);
        for (own, other) in self.terms.iter().zip(&other.terms) {
            product[..n].fill(1.0);
            for (part, of_other) in own.parts.iter().zip(&other.parts) {
                part.squares(range.clone(), of_other, index, &mut squares[..n]);
                profile(part.shape, &squares[..n], &mut values[..n], &mut slopes[..n]);
                multiply(&mut product[..n], &values[..n]);
            }
            add_scaled(covariances, &product[..n], own.variance);
        }
    }

    /// Adds Σ weight × derivative of the covariance of `range` with point `index` by the logarithm of each
    /// hyperparameter to `sums`, in the order of [`Kernel::logarithms`].
    pub(crate) fn add_slopes(
        &self,
        range: Range<usize>,
        index: usize,
        weights: &[f64],
        room: &mut Room,
        sums: &mut [f64],
    ) {
        let n = range.len();
        let mut sums = sums;
        for term in &self.terms {
            let n_parts = term.parts.len();
            for rows in [&mut room.squares, &mut room.values, &mut room.slopes] {
                rows.resize(n_parts.max(rows.len()), [0.0; CHUNK]);
            }
            for (number, part) in term.parts.iter().enumerate() {
                part.squares(range.clone(), part, index, &mut room.squares[number][..n]);
                let (squares, values) = (&room.squares[number], &mut room.values[number]);
                profile(part.shape, &squares[..n], &mut values[..n], &mut room.slopes[number][..n]);
            }
            let mut weighted = [0.0; CHUNK];
            let (own, mut rest) = sums.split_first_mut().expect("a sum for each");
            for (number, part) in term.parts.iter().enumerate() {
                // Weights times all but this part.
                weighted[..n].fill(0.0);
                add_scaled(&mut weighted[..n], weights, term.variance);
                for (_, values) in
                    room.values[..n_parts].iter().enumerate().filter(|v| v.0 != number)
                {
                    multiply(&mut weighted[..n], &values[..n]);
                }
                if number == 0 {
                    add_product(own, &weighted[..n], &room.values[0][..n]);
                }
                let (of_part, others) = rest.split_at_mut(part.n_parameters());
                rest = others;
                if let Shape::RationalQuadratic { exponent } = part.shape {
                    let last = of_part.last_mut().expect("an exponent");
                    let (squares, values) = (&room.squares[number], &room.values[number]);
                    for ((weight, square), value) in weighted[..n].iter().zip(squares).zip(values) {
                        let share = square / (2.0 * exponent);
                        let slope = share / (1.0 + share) - (1.0 + share).ln();
                        *last += weight * value * exponent * slope;
                    }
                }
                // A longer length shrinks its own square: d r²/d ln ℓ = −2 (Δ/ℓ)².
                multiply(&mut weighted[..n], &room.slopes[number][..n]);
                let mut minus_twice = [0.0; CHUNK];
                add_scaled(&mut minus_twice[..n], &weighted[..n], -2.0);
                part.add_squares(range.clone(), part, index, &minus_twice[..n], of_part);
            }
            sums = rest;
        }
    }
}
