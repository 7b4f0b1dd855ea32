//! From a table to a surrogate.

use super::KernelText;
use super::pairs::{Columns, Held, Pairs, held};
use super::stored::{model, port};
use crate::DesignError;
use formats::FileError;
use formats::surrogate_model::SurrogateModel;
use formats::table::Samples;
use std::collections::BTreeMap;
use std::path::PathBuf;
use surrogate::{
    LeaveOneOut, NoiseGroups, Observations, Regression, RegressionSettings, Searched,
    SurrogateError, Trend, Validation, shuffled,
};

/// Different inputs for each hyperparameter below which bands are warned of (–).
const FEWEST: usize = 5;

/// What to train, and on what.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainQuestion {
    /// CSV, names in its first line.
    pub file: PathBuf,
    /// Columns of the inputs.
    pub inputs: Vec<String>,
    /// Column of what is predicted.
    pub output: String,
    /// Form of the kernel.
    pub kernel: KernelText,
    /// Mean far from all data.
    pub trend: Trend,
    /// Column with a known standard deviation of each value, in its unit.
    pub deviation: Option<String>,
    /// Column with the number of the noise group of each row.
    pub group: Option<String>,
    /// Whether a noise is estimated.
    pub estimates_noise: bool,
    /// Share of the different inputs that is trained on (–); the others test.
    pub split: f64,
    /// Seed of split and search.
    pub seed: u64,
    /// Starts of the search (–).
    pub n_starts: usize,
    /// Inducing points, where not all data is to be taken as it is (–).
    pub n_inducing: Option<usize>,
}

/// What was trained.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The surrogate, as its file has it.
    pub model: SurrogateModel,
    /// Rows of the table, and different inputs that were trained and tested on (–).
    pub n: [usize; 3],
    /// On what was trained on.
    pub on_training: Option<Validation>,
    /// On what was kept aside; none without a split.
    pub on_test: Option<Validation>,
    /// Each input predicted from all others; none through inducing points.
    pub left_out: Option<Validation>,
    /// True and predicted values of what was kept aside.
    pub test_pairs: Vec<LeaveOneOut>,
    /// What a user must know.
    pub warnings: Vec<String>,
}

/// Rows of a table, sorted out.
struct Data {
    samples: Samples,
    n_inputs: usize,
    noise: Columns,
}

/// Trains a surrogate.
///
/// # Errors
/// [`DesignError`] naming the table and what is wrong with it.
pub fn train(question: &TrainQuestion) -> Result<Trained, DesignError> {
    let data = Data::read(question)?;
    let of = |source| data.failed(source);
    let refused = |problem: String, fix: &str| {
        DesignError::from(FileError::content("a table of samples", &question.file, problem, fix))
    };
    let ports: Vec<_> = data.samples.columns[..=data.n_inputs].iter().map(port).collect();
    let names: Vec<String> = question.inputs.iter().map(|name| name.trim().to_owned()).collect();
    let kernel = question.kernel.kernel(&names);
    let kernel = kernel.map_err(|problem| refused(problem, "name inputs as in --inputs"))?;
    let [training, test] = data.split(question.split, question.seed);
    let mut settings =
        RegressionSettings { trend: question.trend, ..RegressionSettings::default() };
    (settings.search.n_starts, settings.search.seed) = (question.n_starts, question.seed);
    settings.noise = match (&question.group, question.estimates_noise) {
        (_, false) => NoiseGroups::Known,
        (None, true) => NoiseGroups::One,
        (Some(_), true) => NoiseGroups::Each(data.noise.groups_of(&training)),
    };
    if let Some(n_inducing) = question.n_inducing {
        (settings.exact_up_to, settings.n_inducing) = (0, n_inducing);
    }
    let found = Regression::fit(&kernel, &data.observations(&training), &settings).map_err(of)?;
    let held = |rows: &[usize]| {
        let noise = &data.noise;
        let table = Pairs { samples: &data.samples, rows, n_inputs: data.n_inputs, noise };
        held(&found, &table).map_err(of)
    };
    let Held { validation: on_test, unknown, pairs: test_pairs } = held(&test)?;
    let [inputs, output] = [ports[..data.n_inputs].to_vec(), ports[data.n_inputs..].to_vec()];
    let n_different = found.n_inputs();
    let description = format!(
        "{} over {}, kernel {}, from {}",
        question.output,
        names.join(", "),
        question.kernel.text(),
        question.file.display()
    );
    Ok(Trained {
        warnings: warnings(&found, training.len()).into_iter().chain(unknown).collect(),
        n: [data.samples.lines.len(), n_different, data.n_different(&test)],
        on_training: held(&training)?.validation,
        on_test,
        test_pairs,
        left_out: found.leave_one_out().as_deref().and_then(Validation::of),
        model: model(description, [inputs, output], &found),
    })
}

fn warnings(found: &Regression, n_rows: usize) -> Vec<String> {
    let mut told = Vec::new();
    let n_different = found.n_inputs();
    if n_different < n_rows {
        told.push(format!(
            "{n_rows} rows have {n_different} different inputs: rows of the same inputs count as replicates, exactly"
        ));
    }
    if found.jitter() > 0.0 {
        told.push(format!(
            "the covariance could not be factorised as it is: {:.1e} (unit of the output, squared) was added to its diagonal; allow for noise, or leave out points that lie close together",
            found.jitter()
        ));
    }
    told.extend(found.searched().map(|searched| of_search(searched, found)).unwrap_or_default());
    if let Some(sparse) = found.sparse() {
        told.push(format!(
            "{} inducing points stand for {n_different} inputs: the bound on the log likelihood loses {:.1} by that",
            sparse.n_points, sparse.lost
        ));
    }
    told
}

/// What of the search makes bands too narrow.
fn of_search(searched: &Searched, found: &Regression) -> Vec<String> {
    let mut told = Vec::new();
    let (n, n_estimated) = (found.n_inputs(), searched.n_hyperparameters);
    if n < FEWEST * n_estimated {
        told.push(format!(
            "{n} different inputs for {n_estimated} hyperparameters, fewer than {FEWEST} for each: they fit what is chance, and bands may be much too narrow; leave out inputs that say little, or hold it against other rows"
        ));
    }
    for group in &searched.noise_at_lower {
        told.push(format!(
            "the noise of group {group} was found at its lower bound, a deviation of {:.1e} in the unit of the output: the curve goes through its values, and where these are noisy its bands are much too narrow",
            found.parameters().noise[*group].sqrt()
        ));
    }
    for group in &searched.noise_at_upper {
        told.push(format!(
            "the noise of group {group} was found at its upper bound, a deviation of {:.1e} in the unit of the output: nothing was learnt of its size, and its bands say little",
            found.parameters().noise[*group].sqrt()
        ));
    }
    told
}

impl Data {
    fn read(question: &TrainQuestion) -> Result<Self, DesignError> {
        let inputs = question.inputs.iter().chain([&question.output]);
        let further = question.deviation.iter().chain(&question.group);
        let names: Vec<&str> = inputs.chain(further).map(|name| name.trim()).collect();
        let samples = Samples::read(&question.file, &names)?;
        let n_inputs = question.inputs.len();
        let noise = Columns::new(&samples, n_inputs, &question.deviation, &question.group)?;
        Ok(Self { samples, n_inputs, noise })
    }

    /// An error of the surrogate in words of the table.
    fn failed(&self, source: SurrogateError) -> DesignError {
        let path = self.samples.path.clone();
        if let SurrogateError::Constant { input, value } = source {
            let name = &self.samples.columns[input].name;
            let problem = format!("{name} is {value} in every row");
            let fix = "leave it out of --inputs";
            return FileError::content("a table of samples", &path, problem, fix).into();
        }
        DesignError::Surrogate { path, source }
    }

    fn key(&self, row: usize) -> Vec<u64> {
        self.samples.row(row)[..self.n_inputs].iter().map(|x| (x + 0.0).to_bits()).collect()
    }

    fn n_different(&self, rows: &[usize]) -> usize {
        let keys: std::collections::BTreeSet<_> = rows.iter().map(|row| self.key(*row)).collect();
        keys.len()
    }

    /// Rows to train and to test on; rows of the same inputs stay together.
    fn split(&self, share: f64, seed: u64) -> [Vec<usize>; 2] {
        let mut different: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
        let mut place_of = Vec::new();
        for row in 0..self.samples.lines.len() {
            let next = different.len();
            place_of.push(*different.entry(self.key(row)).or_insert(next));
        }
        let n_training = (share * different.len() as f64).round() as usize;
        let mut is_training = vec![false; different.len()];
        let order = shuffled(different.len(), seed);
        order.iter().take(n_training).for_each(|place| is_training[*place] = true);
        let rows = 0..place_of.len();
        let (training, test) = rows.partition(|row| is_training[place_of[*row]]);
        [training, test]
    }

    fn observations(&self, rows: &[usize]) -> Observations {
        let n_inputs = self.n_inputs;
        let of = |column: usize| rows.iter().map(move |row| self.samples.row(*row)[column]);
        Observations {
            inputs: rows
                .iter()
                .flat_map(|row| &self.samples.row(*row)[..n_inputs])
                .copied()
                .collect(),
            n_dimensions: n_inputs,
            values: of(n_inputs).collect(),
            variances: match self.noise.deviation {
                Some(column) => of(column).map(|s| s * s).collect(),
                None => Vec::new(),
            },
        }
    }
}
