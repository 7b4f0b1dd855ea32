//! Validations beside the wind tunnel.

use crate::{Cost, Validation, tunnel};

pub(super) const TURBINE: Validation = Validation {
    name: "tunnel-turbine",
    about: "the tunnel turbine alone: power at its best tip-speed ratio, amplitudes that its swashplate delivers, beside a published experiment",
    cost: Cost::UnderAMinute,
    run: tunnel::tunnel_turbine,
    pictures: None,
    page: "tunnel-helix",
    recorded: include_str!("../../recorded/tunnel-turbine.toml"),
};

pub(super) const HELIX: Validation = Validation {
    name: "tunnel-helix",
    about: "two tunnel turbines at 5 D: what a helix of either sense costs and gives, beside a published experiment",
    cost: Cost::Minutes(8),
    run: tunnel::tunnel_helix,
    pictures: None,
    page: "tunnel-helix",
    recorded: include_str!("../../recorded/tunnel-helix.toml"),
};

pub(super) const TIP_VORTICES: Validation = Validation {
    name: "tunnel-tip-vortices",
    about: "one tunnel turbine in free vortices: where tip vortices leapfrog, with the helix and without, beside a published experiment",
    cost: Cost::Minutes(10),
    run: tunnel::tunnel_tip_vortices,
    pictures: None,
    page: "tunnel-helix",
    recorded: include_str!("../../recorded/tunnel-tip-vortices.toml"),
};

pub(super) const FREE_WAKE: Validation = Validation {
    name: "tunnel-free-wake",
    about: "two tunnel turbines at 5 D in free vortices: what a helix of either sense costs and gives, beside a published experiment",
    cost: Cost::Minutes(15),
    run: tunnel::tunnel_free_wake,
    pictures: None,
    page: "tunnel-helix",
    recorded: include_str!("../../recorded/tunnel-free-wake.toml"),
};
