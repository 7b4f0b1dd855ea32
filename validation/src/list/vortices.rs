//! Validations of the free wake.

use crate::{Cost, Validation, free_vortex};

pub(super) const VORTICES: Validation = Validation {
    name: "free-vortex",
    about: "free vortices against closed forms: rings, helices, an elliptic wing; boxes of them against their sum",
    cost: Cost::UnderAMinute,
    run: free_vortex::free_vortex,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex.toml"),
};

pub(super) const ROTOR: Validation = Validation {
    name: "free-vortex-rotor",
    about: "power and thrust of three rotors with free wakes against blade elements in axisymmetric flow, and blade-element momentum",
    cost: Cost::Minutes(10),
    run: free_vortex::free_vortex_rotor,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-rotor.toml"),
};

pub(super) const BUDGET: Validation = Validation {
    name: "free-vortex-budget",
    about: "impulse, momentum, angular momentum and circulation of a rotor and its free wake",
    cost: Cost::UnderAMinute,
    run: free_vortex::free_vortex_budget,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-budget.toml"),
};

pub(super) const WAKE: Validation = Validation {
    name: "free-vortex-wake",
    about: "wake and blade loading of a rotor with a free wake beside the lattice on 32 cells a diameter; its outer vortices beside axisymmetric flow",
    cost: Cost::Minutes(8),
    run: free_vortex::free_vortex_wake,
    pictures: Some(free_vortex::free_vortex_wake_pictures),
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-wake.toml"),
};

pub(super) const HELIX: Validation = Validation {
    name: "free-vortex-helix",
    about: "where the hub vortex of a rotor with a helix and a free wake is at 1 D, against amplitude and Strouhal number of twelve helices, beside a published study",
    cost: Cost::Minutes(20),
    run: free_vortex::free_vortex_helix,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-helix.toml"),
};

pub(super) const AMPLITUDE: Validation = Validation {
    name: "free-vortex-amplitude",
    about: "where the hub vortex of a rotor with a helix and a free wake is at 1 D, against the amplitude of four helices at one Strouhal number, beside a published study",
    cost: Cost::Minutes(8),
    run: free_vortex::free_vortex_amplitude,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-amplitude.toml"),
};

pub(super) const OPEN_LOOP: Validation = Validation {
    name: "free-vortex-open-loop",
    about: "power and blade loads of two turbines with free wakes and a helix in even, sheared and turbulent wind, beside a published study",
    cost: Cost::Minutes(70),
    run: free_vortex::free_vortex_open_loop,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-open-loop.toml"),
};

pub(super) const SHEAR: Validation = Validation {
    name: "free-vortex-shear",
    about: "height of a turbine's wake in sheared wind without turbulence, free vortices with and without the shear that carries them beside the lattice",
    cost: Cost::Minutes(10),
    run: free_vortex::free_vortex_shear,
    pictures: None,
    page: "free-vortex",
    recorded: include_str!("../../recorded/free-vortex-shear.toml"),
};
