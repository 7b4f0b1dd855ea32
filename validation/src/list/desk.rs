//! Validations of what is learnt from many simulations: databases of loads, tunings.

use crate::{Cost, Validation, load_database, tuning_array};

pub(super) const LOAD_DATABASE: Validation = Validation {
    name: "load-database",
    about: "surrogates of power and loads of a turbine in ten recorded wakes, beside a published table: errors and coverage of what was kept aside, and what the database costs beside what was foretold",
    cost: Cost::Minutes(90),
    run: load_database::load_database,
    pictures: None,
    page: "load-database",
    recorded: include_str!("../../recorded/load-database.toml"),
};

pub(super) const TUNING_ARRAY: Validation = Validation {
    name: "tuning-array",
    about: "tuning of a helix of either sense on the published array, in resolved flow: optimum and gains beside the published ones, and the runs that a grid takes",
    cost: Cost::Minutes(70),
    run: tuning_array::tuning_of_the_published_array,
    pictures: None,
    page: "tuning",
    recorded: include_str!("../../recorded/tuning-array.toml"),
};
