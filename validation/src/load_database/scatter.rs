//! How far means of six blocks scatter about those of endless ones.
//!
//! Rows that share a wind share most of it: a surrogate that is trained on rows of a wind may come nearer to
//! others of that wind. To rows of another wind it cannot on average, but by knowing more of that wind.

use super::{AMPLITUDE, MISALIGNMENT, OUTPUTS, YAW, inputs};
use crate::least_squares::Fit;
use crate::studies::words;
use formats::table::Samples;
use std::collections::BTreeMap;
use std::path::Path;

/// Blocks of a row, and inputs that differ among them: all but the amplitude.
const N_BLOCKS: usize = 6;
const N_INPUTS: usize = 9;
/// Where the inputs begin in a block, behind yaw and amplitude, which tell the strategy.
const FIRST: usize = 2;

/// Prints for each output of the table at `path`, which has a row for each block, the standard error of the
/// mean of six blocks, were these independent, and what of it is left by the best linear fit, one for each
/// strategy, of the output's logarithm on how the inputs differ from block to block.
pub(super) fn tell_all(path: &Path) -> Result<(), String> {
    let inputs: Vec<String> =
        inputs(MISALIGNMENT).into_iter().filter(|input| input != AMPLITUDE).collect();
    let outputs = OUTPUTS.map(|(output, ..)| output);
    let wanted: Vec<&str> = [YAW, AMPLITUDE]
        .into_iter()
        .chain(inputs.iter().map(String::as_str))
        .chain(outputs)
        .collect();
    let table = Samples::read(path, &wanted).map_err(|error| words(&error))?;
    let blocks: Vec<&[f64]> = table.values.chunks_exact(wanted.len()).collect();
    if inputs.len() != N_INPUTS || !blocks.len().is_multiple_of(N_BLOCKS) {
        return Err(format!("{}: not {N_BLOCKS} blocks of each row", path.display()));
    }
    for (place, (_, name, ..)) in OUTPUTS.iter().enumerate() {
        let [alone, left] = errors(&blocks, FIRST + N_INPUTS + place);
        tell!(
            "{name}: the mean of six blocks has a standard error of {alone:.1} %, of which a line in the inputs leaves {left:.1} %"
        );
    }
    Ok(())
}

/// Both (%), root mean squares over all rows, of the value at `place` of each of `blocks`.
fn errors(blocks: &[&[f64]], place: usize) -> [f64; 2] {
    let mut square = 0.0;
    let mut strategies = BTreeMap::<_, (Fit<N_INPUTS>, usize)>::new();
    for row in blocks.chunks_exact(N_BLOCKS) {
        let mean = |of: &dyn Fn(&[f64]) -> f64| {
            row.iter().map(|block| of(block)).sum::<f64>() / N_BLOCKS as f64
        };
        let output = |block: &[f64]| block[place].ln();
        let of_output = mean(&output);
        let of_inputs: [f64; N_INPUTS] =
            std::array::from_fn(|input| mean(&|block| block[FIRST + input]));
        let strategy = [row[0][0], row[0][1]].map(f64::to_bits);
        let (fit, n_rows) = strategies.entry(strategy).or_default();
        *n_rows += 1;
        for block in row {
            let away = output(block) - of_output;
            square += away * away;
            let inputs = std::array::from_fn(|input| block[FIRST + input] - of_inputs[input]);
            fit.add(inputs, away);
        }
    }
    // A row spends a degree of freedom on its own mean, a fit one on each of its parts.
    let n_free = (blocks.len() - blocks.len() / N_BLOCKS) as f64;
    let rest: f64 =
        strategies.values().map(|(fit, n_rows)| fit.rest() * (n_rows * N_BLOCKS) as f64).sum();
    let percent = |variance: f64| 100.0 * (variance / N_BLOCKS as f64).sqrt();
    let of_fits = (N_INPUTS * strategies.len()) as f64;
    [percent(square / n_free), percent(rest / (n_free - of_fits))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Blocks of `n_rows` rows of two strategies, whose logarithm has a deviation of 0.1 that the first
    /// input tells, of another sign in the other strategy, and one of 0.05 that nothing tells.
    fn blocks(random: &mut Random, n_rows: usize) -> Vec<Vec<f64>> {
        let block = |block: usize| {
            let row = block / N_BLOCKS;
            let yaw = if row.is_multiple_of(2) { 30.0 } else { -30.0 };
            let mut values = vec![yaw, 0.0];
            values.extend((0..N_INPUTS).map(|_| random.normal()));
            let away = 0.1 * values[FIRST] * f64::signum(yaw) + 0.05 * random.normal();
            values.push((0.01 * row as f64 + away).exp());
            values
        };
        (0..n_rows * N_BLOCKS).map(block).collect()
    }

    /// Both as the mean of their squares over `n` draws of so many rows, over what they are (–).
    fn found(n: usize, n_rows: usize) -> [f64; 2] {
        let mut random = Random(1);
        let mut sums = [0.0; 2];
        for _ in 0..n {
            let blocks = blocks(&mut random, n_rows);
            let blocks: Vec<&[f64]> = blocks.iter().map(Vec::as_slice).collect();
            let squares = errors(&blocks, FIRST + N_INPUTS).map(|error| error * error / n as f64);
            sums.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square);
        }
        let expected =
            [0.1_f64.hypot(0.05), 0.05].map(|deviation| 100.0 * deviation / 6.0_f64.sqrt());
        [0, 1].map(|part| sums[part] / expected[part].powi(2))
    }

    /// Of 1500 draws of 100 free blocks, 82 behind the fits, variances are right to √(2/82/1500) or 0.4 %;
    /// without the degrees of freedom of rows they were 17 % too small, without those of fits 18 %.
    #[test]
    fn what_the_inputs_tell_is_taken_off() {
        for (n, n_rows) in [(1500, 20), (1, 15_000)] {
            for ratio in found(n, n_rows) {
                assert!((ratio - 1.0).abs() < 0.02, "{n_rows} rows: {ratio}");
            }
        }
    }
}
