//! A curve over one input as it is shown: its mean, its band, and where it is highest and lowest, each with a
//! 95 % interval.

use crate::sample::Normals;
use crate::{GaussianProcess, Observations, Shape, SurrogateError};

/// Sweeps of the sampler before its draws count (–); noise variances forget their start within a few.
const N_BURN_IN: usize = 50;
/// Ends of a central 95 % interval (–).
const ENDS: [f64; 2] = [0.025, 0.975];

/// How a curve is drawn from a process.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveSettings<'a> {
    /// Degrees of freedom behind the known variance of each observation (–): n − 1 for the variance of a mean
    /// from n blocks. Empty where variances are exact, or none is known.
    pub degrees_of_freedom: &'a [usize],
    /// Curves drawn (–).
    pub n_draws: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// Where a curve is highest or lowest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// Input at which the mean curve has it (unit of the inputs).
    pub input: f64,
    /// The mean curve there (unit of the values).
    pub value: f64,
    /// Central 95 % of the inputs at which drawn curves have it (unit of the inputs). With a periodic kernel
    /// they are counted from `input` the shorter way round, so that the ends lie within half a period of it,
    /// on either side of the seam; an interval of a whole period knows nothing.
    pub input_95: [f64; 2],
}

/// A curve over one input.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Mean at each of the inputs asked for (unit of the values).
    pub means: Vec<f64>,
    /// 95 % of the drawn curves at each input alone (unit of the values).
    pub bands_95: Vec<[f64; 2]>,
    /// Where it is highest.
    pub highest: Extreme,
    /// Where it is lowest.
    pub lowest: Extreme,
}

impl GaussianProcess {
    /// The curve at ascending `inputs`, all inside one period of a periodic kernel, from draws of the
    /// posterior.
    ///
    /// A variance that was itself found from ν + 1 blocks is uncertain: with `degrees_of_freedom` it is drawn
    /// with the curve, from its distribution given the reported variance s² and the observation's distance r
    /// from the drawn curve, (ν s² + r²)/χ²_(ν+1), in turns with the curve (Gibbs' sampler, prior 1/σ²). So
    /// an observation counts with the tails of Student's t with ν degrees of freedom, not of a normal
    /// distribution. Estimated noise is part of the distance and is taken off it by a draw.
    ///
    /// Covered: noise, its own uncertainty, and the curve between the observations. Not covered: the
    /// hyperparameters, which stay at their most likely values, and errors that observations share.
    ///
    /// Source: Gelman et al., "Bayesian Data Analysis", 3rd ed., 2013, §2.6 and §17.2 (Student's t as normal
    /// with a drawn variance).
    ///
    /// # Errors
    /// [`SurrogateError::Lengths`] for a process of several inputs, fewer than three `inputs`, or degrees of
    /// freedom that are neither absent nor one for each observation; [`SurrogateError::NotPositive`] without
    /// draws; those of [`samples`](Self::samples).
    pub fn curve(
        &self,
        inputs: &[f64],
        settings: &CurveSettings<'_>,
    ) -> Result<Curve, SurrogateError> {
        self.check_curve(inputs, settings)?;
        let observations = self.observations();
        let n_inputs = inputs.len();
        // Where the observations are, the draws tell their distances.
        let places: Vec<Vec<f64>> =
            inputs.iter().chain(&observations.inputs).map(|input| vec![*input]).collect();
        let mut draws: Vec<Vec<f64>> = Vec::with_capacity(settings.n_draws);
        let mut means = vec![0.0; n_inputs];
        if settings.degrees_of_freedom.is_empty() || observations.variances.is_empty() {
            draws = self.samples(&places[..n_inputs], settings.n_draws, settings.seed)?;
            for (mean, place) in means.iter_mut().zip(&places) {
                *mean = self.predict(place)?.mean;
            }
        } else {
            let mut normals = Normals::new(settings.seed);
            let mut process = self.clone();
            for sweep in 0..N_BURN_IN + settings.n_draws {
                let seed = settings.seed.wrapping_add(1 + sweep as u64);
                let drawn = process.samples(&places, 1, seed)?.remove(0);
                if sweep >= N_BURN_IN {
                    for (mean, place) in means.iter_mut().zip(&places) {
                        *mean += process.predict(place)?.mean / settings.n_draws as f64;
                    }
                    draws.push(drawn[..n_inputs].to_vec());
                }
                process = self.with_drawn_noise(&drawn[n_inputs..], settings, &mut normals)?;
            }
        }
        let bands_95 = (0..n_inputs)
            .map(|place| quantiles(draws.iter().map(|draw| draw[place]).collect()))
            .collect();
        let highest = self.extreme(inputs, &means, &draws, 1.0);
        let lowest = self.extreme(inputs, &means, &draws, -1.0);
        Ok(Curve { means, bands_95, highest, lowest })
    }

    /// The process with variances drawn for a curve that is `drawn` at the observations.
    fn with_drawn_noise(
        &self,
        drawn: &[f64],
        settings: &CurveSettings<'_>,
        normals: &mut Normals,
    ) -> Result<Self, SurrogateError> {
        let observations = self.observations();
        let estimated = self.hyperparameters().noise_variance;
        let mut variances = Vec::with_capacity(drawn.len());
        for (index, freedom) in settings.degrees_of_freedom.iter().enumerate() {
            let known = observations.variances[index];
            let away = observations.values[index] - drawn[index];
            // Of the distance, what is not estimated noise.
            let share = known / (known + estimated).max(f64::MIN_POSITIVE);
            let own = share * away + (share * estimated).sqrt() * normals.next();
            let square: f64 = (0..freedom + 1).map(|_| normals.next().powi(2)).sum();
            variances.push((*freedom as f64 * known + own * own) / square.max(f64::MIN_POSITIVE));
        }
        let observations = Observations { variances, ..observations.clone() };
        Self::new(self.shape(), self.hyperparameters().clone(), observations, self.kind_of_mean())
    }

    /// Where `sign` times the `means` is highest, and where the `draws` have it.
    fn extreme(&self, inputs: &[f64], means: &[f64], draws: &[Vec<f64>], sign: f64) -> Extreme {
        let period = match self.shape() {
            Shape::Periodic { period } => Some(period),
            _ => None,
        };
        let (input, value) = summit(inputs, means, sign, period);
        let away = draws.iter().map(|draw| {
            let away = summit(inputs, draw, sign, period).0 - input;
            period.map_or(away, |period| away - period * (away / period).round())
        });
        let input_95 = quantiles(away.collect()).map(|end| input + end);
        Extreme { input, value, input_95 }
    }

    fn check_curve(
        &self,
        inputs: &[f64],
        settings: &CurveSettings<'_>,
    ) -> Result<(), SurrogateError> {
        let n_dimensions = self.observations().n_dimensions;
        if n_dimensions != 1 {
            let what = "an input of a curve";
            return Err(SurrogateError::Lengths { what, found: n_dimensions, needed: 1 });
        }
        if inputs.len() < 3 {
            let (what, found) = ("the inputs of a curve", inputs.len());
            return Err(SurrogateError::Lengths { what, found, needed: 3 });
        }
        let (found, needed) = (settings.degrees_of_freedom.len(), self.observations().len());
        if found != 0 && found != needed {
            let what = "the degrees of freedom";
            return Err(SurrogateError::Lengths { what, found, needed });
        }
        if settings.n_draws == 0 {
            return Err(SurrogateError::NotPositive { what: "the number of draws", value: 0.0 });
        }
        Ok(())
    }
}

/// Input and value at which `sign` times `values` is highest: of the parabola through the highest of them and
/// its neighbours, which lie on the other end where inputs have a `period`.
fn summit(inputs: &[f64], values: &[f64], sign: f64, period: Option<f64>) -> (f64, f64) {
    let n = inputs.len();
    let best = (0..n)
        .max_by(|a, b| (sign * values[*a]).total_cmp(&(sign * values[*b])))
        .unwrap_or_default();
    let (before, after) = match period {
        Some(_) => ((best + n - 1) % n, (best + 1) % n),
        None if best == 0 || best + 1 == n => return (inputs[best], values[best]),
        None => (best - 1, best + 1),
    };
    let step = |from: usize, to: usize| {
        let step = inputs[to] - inputs[from];
        period.map_or(step, |period| step.rem_euclid(period))
    };
    // Slopes to the left and to the right of it.
    let (left, right) = (step(before, best), step(best, after));
    let [rise, fall] =
        [(values[best] - values[before]) / left, (values[after] - values[best]) / right];
    let bend = (fall - rise) / (0.5 * (left + right));
    let slope = (rise * right + fall * left) / (left + right);
    if bend == 0.0 || !bend.is_finite() {
        return (inputs[best], values[best]);
    }
    let away = (-slope / bend).clamp(-left, right);
    (inputs[best] + away, values[best] + slope * away + 0.5 * bend * away * away)
}

/// The 2.5 and 97.5 % points of `values`, linear between them.
fn quantiles(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    ENDS.map(|share| {
        let place = share * (values.len() - 1) as f64;
        let (below, above) = (place.floor() as usize, place.ceil() as usize);
        values[below] + (place - place.floor()) * (values[above] - values[below])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FitSettings, Hyperparameters, Mean};
    use std::f64::consts::{PI, TAU};

    const PERIODIC: Shape = Shape::Periodic { period: TAU };

    fn grid(n: usize) -> Vec<f64> {
        (0..n).map(|index| TAU * index as f64 / n as f64).collect()
    }

    fn wrapped(angle: f64) -> f64 {
        angle - TAU * (angle / TAU).round()
    }

    #[test]
    fn the_summit_of_a_parabola_is_found_between_inputs_and_across_the_seam() {
        let inputs = [0.0, 1.0, 2.5, 3.0];
        let law = |x: f64| 2.0 - 0.7 * (x - 1.8).powi(2);
        let (input, value) = summit(&inputs, &inputs.map(law), 1.0, None);
        assert!((input - 1.8).abs() < 1e-12 && (value - 2.0).abs() < 1e-12, "{input} {value}");
        let (input, value) = summit(&inputs, &inputs.map(|x| -law(x)), -1.0, None);
        assert!((input - 1.8).abs() < 1e-12 && (value + 2.0).abs() < 1e-12, "{input} {value}");
        // A summit on an end stays there; with a period the neighbour is on the other end.
        assert_eq!(summit(&[0.0, 1.0, 2.0], &[3.0, 2.0, 0.0], 1.0, None), (0.0, 3.0));
        let inputs = grid(72);
        let values: Vec<f64> = inputs.iter().map(|x| (x - TAU + 0.03).cos()).collect();
        let (input, _) = summit(&inputs, &values, 1.0, Some(TAU));
        assert!(wrapped(input + 0.03).abs() < 1e-3, "{input}");
    }

    /// Without uncertain variances the draws are those of the process: their band is its band.
    #[test]
    fn a_curve_with_exact_noise_is_the_process() {
        let inputs = grid(8);
        let values = inputs.iter().map(|x| (x - 2.0).cos()).collect();
        let observations = Observations::of_curve(inputs, values).with_deviations(&[0.1; 8]);
        let parameters =
            Hyperparameters { signal_variance: 1.0, lengths: vec![1.0], noise_variance: 0.0 };
        let process = GaussianProcess::new(PERIODIC, parameters, observations, Mean::Zero)
            .expect("a process");
        let settings = CurveSettings { degrees_of_freedom: &[], n_draws: 4000, seed: 3 };
        let curve = process.curve(&grid(24), &settings).expect("a curve");
        for ((input, mean), band) in grid(24).iter().zip(&curve.means).zip(&curve.bands_95) {
            let found = process.predict(&[*input]).expect("one input");
            assert!((found.mean - mean).abs() < 1e-12);
            // Four standard errors of a 97.5 % point from 4000 draws.
            let near = 4.0 * found.standard_deviation * 2.67 / 4000_f64.sqrt();
            for (drawn, exact) in band.iter().zip(found.band_95()) {
                assert!((drawn - exact).abs() < near, "{drawn} {exact}");
            }
        }
        assert!(wrapped(curve.highest.input - 2.0).abs() < 0.05, "{:?}", curve.highest);
        assert!(wrapped(curve.lowest.input - 2.0 - PI).abs() < 0.05, "{:?}", curve.lowest);
    }

    /// Alone, under a prior that says nothing, an observation with a standard error s of ν degrees of freedom
    /// tells its value within t(0.975, ν) s: 4.30 s for two, not 1.96 s.
    #[test]
    fn a_lone_observation_has_the_tails_of_students_t() {
        let inputs = vec![0.0, 10.0, 20.0];
        let observations = Observations::of_curve(inputs.clone(), vec![0.0; 3]);
        let observations = observations.with_deviations(&[1.0; 3]);
        let parameters =
            Hyperparameters { signal_variance: 1e4, lengths: vec![0.1], noise_variance: 0.0 };
        let shape = Shape::SquaredExponential;
        let process =
            GaussianProcess::new(shape, parameters, observations, Mean::Zero).expect("a process");
        let settings = CurveSettings { degrees_of_freedom: &[2; 3], n_draws: 8000, seed: 5 };
        let curve = process.curve(&inputs, &settings).expect("a curve");
        let half: f64 = curve.bands_95.iter().map(|[low, high]| (high - low) / 6.0).sum();
        // A 97.5 % point of this distribution has a standard error of 14.5 over the root of the draws; six of
        // them, whose draws count for a quarter as many.
        let near = 4.0 * 14.5 / (6.0 * 8000.0 / 4.0_f64).sqrt();
        assert!((half - 4.303).abs() < near, "{half}, {near}");
    }

    /// Studies as they are run: eight offsets, each a mean of three blocks with its standard error. The
    /// interval of the best offset holds the true one 95 times in a hundred; 100 studies may show 87 at the
    /// least (99.9 % of a binomial distribution).
    #[test]
    fn the_interval_of_the_best_input_holds_the_true_one() {
        let offsets: Vec<f64> =
            [0.0, 90.0, 120.0, 150.0, 180.0, 210.0, 270.0, 330.0_f64].map(f64::to_radians).into();
        let (n_studies, freedom, deviation) = (100, 2_usize, 0.25);
        let mut normals = Normals::new(11);
        let mut n_held = 0;
        for study in 0..n_studies {
            let best = TAU * study as f64 / n_studies as f64;
            let (mut values, mut errors) = (Vec::new(), Vec::new());
            for offset in &offsets {
                values.push((offset - best).cos() + deviation * normals.next());
                let square: f64 = (0..freedom).map(|_| normals.next().powi(2)).sum();
                errors.push(deviation * (square / freedom as f64).sqrt());
            }
            let observations =
                Observations::of_curve(offsets.clone(), values).with_deviations(&errors);
            let fit = FitSettings { n_starts: 2, ..FitSettings::default() };
            let process = GaussianProcess::fit(PERIODIC, observations, &fit).expect("a fit");
            let freedom = vec![freedom; offsets.len()];
            let settings =
                CurveSettings { degrees_of_freedom: &freedom, n_draws: 200, seed: study as u64 };
            let curve = process.curve(&grid(24), &settings).expect("a curve");
            let [low, high] = curve.highest.input_95;
            let away = wrapped(best - curve.highest.input) + curve.highest.input;
            n_held += usize::from((low..=high).contains(&away));
        }
        assert!(n_held >= 87, "{n_held} of {n_studies}");
    }

    #[test]
    fn what_makes_no_curve_is_refused() {
        let observations = Observations::of_curve(vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 0.0]);
        let process = GaussianProcess::fit(PERIODIC, observations, &FitSettings::default());
        let process = process.expect("a fit");
        let settings = CurveSettings { degrees_of_freedom: &[], n_draws: 10, seed: 1 };
        let refused = |inputs: &[f64], settings: &CurveSettings<'_>| {
            process.curve(inputs, settings).expect_err("no curve")
        };
        let short = refused(&[0.0, 1.0], &settings);
        assert!(matches!(short, SurrogateError::Lengths { needed: 3, found: 2, .. }), "{short}");
        let odd = CurveSettings { degrees_of_freedom: &[2], ..settings };
        let odd = refused(&grid(6), &odd);
        assert!(matches!(odd, SurrogateError::Lengths { needed: 3, found: 1, .. }), "{odd}");
        let none = refused(&grid(6), &CurveSettings { n_draws: 0, ..settings });
        assert!(matches!(none, SurrogateError::NotPositive { .. }), "{none}");
    }
}
