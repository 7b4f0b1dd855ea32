//! The file of a layout: turbines, what is done with them, the wind that comes to each.

use crate::DesignError;
use flow::inflow::Cut;
use formats::{FileError, atomic};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What the file holds, in words.
pub(super) const WHAT: &str = "a layout for surrogates";
/// Where its keys are told.
const FIX: &str = "write it as docs/surrogate.md has it";
/// Places of a range at most (–).
const MOST: f64 = 10_000.0;

/// A layout as its file has it, checked.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LayoutFile {
    /// Free stream, of turbulence intensities (m/s).
    pub(super) wind_speed: f64,
    /// Of every rotor (m).
    pub(super) diameter: f64,
    /// Of every hub (m).
    pub(super) hub_height: f64,
    /// Files of the surrogates by the names that answers have.
    pub(super) surrogates: BTreeMap<String, PathBuf>,
    /// What of each record counts.
    #[serde(default)]
    pub(super) block: Block,
    pub(super) directions: Directions,
    /// Lateral displacements of turbines in wakes (m).
    pub(super) displacements: Option<Range>,
    /// An input that is varied by itself.
    pub(super) along: Option<Along>,
    pub(super) turbine: Vec<Turbine>,
    pub(super) strategy: Vec<Strategy>,
}

/// A window of the records (s).
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Block {
    #[serde(default)]
    from: f64,
    duration: Option<f64>,
}

/// Values from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    from: f64,
    to: f64,
    step: f64,
}

/// Directions of the wind (deg) from the axis of the layout, counter-clockwise seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Directions {
    from: f64,
    to: f64,
    step: f64,
    /// The most probable one.
    #[serde(default)]
    pub(super) mean: f64,
    /// Standard deviation about it.
    pub(super) deviation: f64,
}

/// An input of one turbine's surrogates from one end to the other, in the first strategy.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Along {
    pub(super) turbine: String,
    pub(super) input: String,
    from: f64,
    to: f64,
    step: f64,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Turbine {
    pub(super) name: String,
    /// Place along and across the layout's axis (m).
    position: Option<[f64; 2]>,
    position_diameters: Option<[f64; 2]>,
    /// Turbine behind which its wind was recorded.
    pub(super) behind: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Strategy {
    pub(super) name: String,
    /// Record of the wind that comes to each turbine.
    pub(super) wind: BTreeMap<String, PathBuf>,
    /// Inputs of surrogates that are the turbine's own.
    #[serde(default)]
    pub(super) inputs: BTreeMap<String, BTreeMap<String, f64>>,
}

impl LayoutFile {
    /// Reads the file at `path`; paths in it are relative to its folder.
    ///
    /// # Errors
    /// [`DesignError::File`] with line or key.
    pub(super) fn read(path: &Path) -> Result<Self, DesignError> {
        let text = atomic::read_text(path, WHAT)?;
        let refused = |problem: String, fix: &str| {
            DesignError::from(FileError::content(WHAT, path, problem, fix))
        };
        let mut file: Self = toml::from_str(&text)
            .map_err(|error| refused(error.to_string().trim_end().to_owned(), FIX))?;
        file.check().map_err(|[problem, fix]| refused(problem, &fix))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let records = file.strategy.iter_mut().flat_map(|strategy| strategy.wind.values_mut());
        for named in file.surrogates.values_mut().chain(records) {
            *named = folder.join(&*named);
        }
        Ok(file)
    }

    /// # Errors
    /// What is wrong with it, and the fix.
    fn check(&self) -> Result<(), [String; 2]> {
        for (key, value) in [
            ("wind_speed", self.wind_speed),
            ("diameter", self.diameter),
            ("hub_height", self.hub_height),
            ("directions.deviation", self.directions.deviation),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err([format!("`{key}` is {value}"), "give a positive number".to_owned()]);
            }
        }
        let Directions { from, to, mean, .. } = self.directions;
        self.directions.range().check("directions")?;
        if !(from..=to).contains(&mean) {
            let problem = format!("`directions.mean` is {mean}");
            return Err([problem, format!("give a direction from {from} to {to}")]);
        }
        self.displacements.map_or(Ok(()), |range| range.check("displacements"))?;
        for (what, is_empty) in [
            ("surrogates", self.surrogates.is_empty()),
            ("turbine", self.turbine.is_empty()),
            ("strategy", self.strategy.is_empty()),
        ] {
            if is_empty {
                return Err([format!("`{what}` is empty"), format!("give one {what} at least")]);
            }
        }
        distinct("surrogates", self.surrogates.keys())?;
        distinct("turbine", self.turbine.iter().map(|turbine| &turbine.name))?;
        distinct("strategy", self.strategy.iter().map(|strategy| &strategy.name))?;
        self.turbine.iter().try_for_each(|turbine| self.check_turbine(turbine))?;
        self.strategy.iter().try_for_each(|strategy| self.check_strategy(strategy))?;
        let Some(along) = &self.along else { return Ok(()) };
        along.range().check("along")?;
        self.known(&along.turbine, "along.turbine")
    }

    fn names(&self) -> String {
        self.turbine.iter().map(|turbine| turbine.name.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// Whether there is a turbine called `name`, as `key` says.
    fn known(&self, name: &str, key: &str) -> Result<(), [String; 2]> {
        if self.turbine.iter().any(|turbine| turbine.name == name) {
            return Ok(());
        }
        Err([
            format!("`{key}` names {name}, which is no turbine"),
            format!("there are {}", self.names()),
        ])
    }

    fn check_turbine(&self, turbine: &Turbine) -> Result<(), [String; 2]> {
        let name = &turbine.name;
        if turbine.position.is_some() == turbine.position_diameters.is_some() {
            let problem = format!("turbine {name} has not one place");
            return Err([problem, "give `position` (m) or `position_diameters`".to_owned()]);
        }
        if self.position(turbine).iter().any(|place| !place.is_finite()) {
            return Err([format!("the place of turbine {name} is not finite"), FIX.to_owned()]);
        }
        let Some(other) = &turbine.behind else { return Ok(()) };
        self.known(other, &format!("turbine.{name}.behind"))?;
        let problem = format!("turbine {name} stands behind itself");
        if other == name { Err([problem, "name the turbine before it".to_owned()]) } else { Ok(()) }
    }

    fn check_strategy(&self, strategy: &Strategy) -> Result<(), [String; 2]> {
        let name = &strategy.name;
        for turbine in strategy.wind.keys().chain(strategy.inputs.keys()) {
            self.known(turbine, &format!("strategy {name}"))?;
        }
        let without = self.turbine.iter().find(|one| !strategy.wind.contains_key(&one.name));
        if let Some(Turbine { name: turbine, .. }) = without {
            let problem = format!("strategy {name} has no wind for turbine {turbine}");
            return Err([problem, format!("add wind.{turbine} = \"RECORD.bts\"")]);
        }
        let inputs = strategy.inputs.values().flatten();
        match inputs.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((input, value)) => {
                let problem = format!("strategy {name}: {input} is {value}");
                Err([problem, "give a finite number".to_owned()])
            }
            None => Ok(()),
        }
    }

    /// Place of `turbine` (m).
    pub(super) fn position(&self, turbine: &Turbine) -> [f64; 2] {
        let of_diameters = turbine.position_diameters.map(|place| place.map(|d| d * self.diameter));
        turbine.position.or(of_diameters).unwrap_or_default()
    }

    /// What is taken of a record: all of its width and height.
    pub(super) fn cut(&self) -> Cut {
        Cut { from: self.block.from, duration: self.block.duration, ..Cut::default() }
    }
}

impl Directions {
    pub(super) fn range(&self) -> Range {
        Range { from: self.from, to: self.to, step: self.step }
    }
}

impl Along {
    pub(super) fn range(&self) -> Range {
        Range { from: self.from, to: self.to, step: self.step }
    }
}

impl Range {
    fn check(&self, key: &str) -> Result<(), [String; 2]> {
        let Self { from, to, step } = *self;
        let n = (to - from) / step;
        let is_whole = (n - n.round()).abs() < 1e-6;
        if step > 0.0 && to >= from && n <= MOST && is_whole {
            return Ok(());
        }
        let problem = format!("`{key}` goes from {from} to {to} by {step}");
        Err([problem, "give a `step` above 0 that fills the way from `from` up to `to`".to_owned()])
    }

    /// Its places.
    pub(super) fn places(&self) -> Vec<f64> {
        let n = ((self.to - self.from) / self.step).round() as usize;
        (0..=n).map(|place| self.from + place as f64 * self.step).collect()
    }
}

/// Whether each of `names` is another one.
fn distinct<'a>(what: &str, names: impl Iterator<Item = &'a String>) -> Result<(), [String; 2]> {
    let mut known = BTreeSet::new();
    for name in names {
        if name.contains([',', '"', '\n']) {
            let problem = format!("`{what}` has the name {name}");
            return Err([problem, "give a name without commas and quotes".to_owned()]);
        }
        if !known.insert(name) {
            let problem = format!("two of `{what}` are called {name}");
            return Err([problem, "give each a name of its own".to_owned()]);
        }
    }
    Ok(())
}
