//! Validations of the atmosphere.

use crate::{Cost, Validation, atmosphere};

pub(super) const ATMOSPHERE: Validation = Validation {
    name: "atmosphere",
    about: "air with temperature on a turning earth against closed forms: conduction, inertial and internal waves, Ekman's layer, onset of convection",
    cost: Cost::UnderAMinute,
    run: atmosphere::atmosphere,
    pictures: None,
    page: "atmosphere",
    recorded: include_str!("../../recorded/atmosphere.toml"),
};

pub(super) const IN_STUDY: Validation = Validation {
    name: "study-in-atmosphere",
    about: "what becomes of a precursor's wind over 8 D in a study without turbines: speed, direction, veer, turbulence",
    cost: Cost::Minutes(20),
    run: atmosphere::study_in_atmosphere,
    pictures: None,
    page: "atmosphere",
    recorded: include_str!("../../recorded/study-in-atmosphere.toml"),
};

pub(super) const STABLE: Validation = Validation {
    name: "stable-boundary-layer",
    about: "the stable boundary layer of GABLS1 on cells of 6.25 m beside the published spread of simulations",
    cost: Cost::Minutes(25),
    run: atmosphere::stable_boundary_layer,
    pictures: None,
    page: "atmosphere",
    recorded: include_str!("../../recorded/stable-boundary-layer.toml"),
};

pub(super) const STABLE_MODELS: Validation = Validation {
    name: "stable-subgrid-models",
    about: "the same on cells of 12.5 m with each model of unresolved eddies",
    cost: Cost::Minutes(8),
    run: atmosphere::stable_subgrid_models,
    pictures: None,
    page: "atmosphere",
    recorded: include_str!("../../recorded/stable-subgrid-models.toml"),
};

pub(super) const CAPPED: Validation = Validation {
    name: "capped-boundary-layer",
    about: "a neutral layer under its own inversion on cells of 10 m against published simulations on 5 m",
    cost: Cost::Minutes(55),
    run: atmosphere::capped_boundary_layer,
    pictures: None,
    page: "atmosphere",
    recorded: include_str!("../../recorded/capped-boundary-layer.toml"),
};
