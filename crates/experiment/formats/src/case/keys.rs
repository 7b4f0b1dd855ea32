//! The one table of keys: what the reader accepts, what the reference prints, what the schema says.

mod campaign;
mod cut;
mod event;
mod flow;
mod grid;
mod instruments;
mod precursor;

pub(super) use campaign::CAMPAIGN;
pub(super) use cut::CUT;
pub(super) use event::{EVENTS, STEP};
pub(super) use flow::{COMMON as FLOW_COMMON, flow};
pub(super) use grid::GRID;
pub(super) use instruments::{
    ACCELERATION, ANGLE, INSTRUMENT_KINDS, INSTRUMENTS, MOMENT, POWER, SPEED,
};
pub(super) use precursor::{ATMOSPHERE, BOX, PLANES, PRECURSOR, TIME as PRECURSOR_TIME};

use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Range, Slip, Table, above, from, key};

/// The whole file.
pub(super) static ROOT: Table = Table {
    heading: "(top of the file)",
    about: "What the study is called. One file is one study: one wind, one layout, several runs to compare.",
    keys: &[
        key("name", Holds::Name, "", Required, "Name of the study: letters, digits, `-` and `_`."),
        key(
            "description",
            Holds::Text,
            "",
            Otherwise("no description"),
            "What it is for, in one line; the report shows it.",
        ),
        key("wind", Holds::Table(&WIND), "", Required, "The incoming wind."),
        key("flow", Holds::Flow, "", Otherwise("all defaults"), "The flow solver."),
        key("time", Holds::Table(&TIME), "", Required, "How long every run lasts."),
        key(
            "turbine",
            Holds::Tables(&TURBINE),
            "",
            Required,
            "The turbines; the order is free, the first one's diameter and hub height are the measure of all lengths in diameters.",
        ),
        key("run", Holds::Tables(&RUN), "", Required, "The runs, all in the same inflow."),
        key(
            "output",
            Holds::Table(&OUTPUT),
            "",
            Otherwise("all defaults"),
            "What is kept beside series and summary.",
        ),
        key(
            "sweep",
            Holds::Sweep,
            "",
            Otherwise("nothing is swept"),
            "Lists of values for any keys, by the key in quotes: `\"control.T1.strouhal\" = [0.2, 0.25]`. Every combination is made. Keys of `control.TURBINE` make more runs, of each [[run]] whose controller has the key; `run.NAME.control.TURBINE` of one [[run]] alone. All other keys, such as `wind.speed`, `wind.seed` or `turbine.T2.position_diameters`, make more studies, each in a folder of its own. Names tell the values: `helix-strouhal-0.25`, `speed-8`.",
        ),
    ],
};

/// `[wind]`.
pub(super) static WIND: Table = Table {
    heading: "[wind]",
    about: "The incoming wind: a mean profile with turbulence on it (Mann's, Kaimal's, recorded planes, or none), the same for every run.",
    keys: &[
        key("speed", above(0.0, 40.0), "m/s", Required, "Mean speed at hub height of the first turbine. At every hub it lies between the cut-in and cut-out wind speeds that the turbine's file states under `[operation]`.")
            .mistaken(&[Slip { unit: "km/h", factor: 1.0 / 3.6 }, Slip { unit: "cm/s", factor: 0.01 }]),
        key("direction_deg", from(0.0, 360.0), "deg", Value("270"), "Where the mean wind at hub height comes from, clockwise from north as meteorology has it: 270 is from the west, along x of the layout. With another one the layout is turned about the first turbine into the wind's frame, x downwind, where everything is simulated and shown."),
        key("turbulence_intensity", from(0.0, 0.5), "–", Required, "Standard deviation of the streamwise component over `speed`, at hub height; 0 switches the turbulence off.")
            .mistaken(&[Slip { unit: "percent", factor: 0.01 }]),
        key("shear_exponent", from(-0.5, 1.0), "–", Value("0.1"), "Power-law exponent of the mean profile."),
        key("roughness_length", above(0.0, 5.0), "m", Otherwise("a power law with `shear_exponent`"), "In place of `shear_exponent`: the mean profile is the logarithmic law, `speed` · ln(z/z₀) / ln(z_hub/z₀) with this roughness length z₀, zero at z₀ and below; at most a tenth of the hub height. A rough `flow.ground` keeps such a profile when it has the same z₀."),
        key("length_scale", above(0.0, 1000.0), "m", Otherwise("standard deviation over shear at hub height, from 33.6 m to twice the hub height"), "Length scale of Mann's tensor. The default is σ_u / (dU/dz) at hub height of the first turbine (Kelly 2018, Wind Energ. Sci. 3, 533): `turbulence_intensity` · z_hub / `shear_exponent`, or `turbulence_intensity` · z_hub · ln(z_hub/z₀). It is at least 33.6 m, which is 0.8 Λ₁ of IEC 61400-1, and that where nothing shears; and at most twice the hub height."),
        key("anisotropy", from(0.0, 10.0), "–", Value("3.9"), "Anisotropy Γ of Mann's tensor; 0 is isotropic. The default is that of IEC 61400-1."),
        key("seed", Holds::Whole { least: 0, most: SEED_MOST }, "–", Value("1"), "Seed of the turbulence; another seed is another hour of the same climate."),
        key("air_density", above(0.0, 5.0), "kg/m³", Value("1.225"), "Air density.")
            .mistaken(&[Slip { unit: "g/m³", factor: 0.001 }]),
        key("kinematic_viscosity", above(0.0, 1e-3), "m²/s", Value("1.46e-5"), "Kinematic viscosity of air; the default is air at 15 °C at sea level.")
            .mistaken(&[Slip { unit: "mm²/s", factor: 1e-6 }]),
        key("turbulence_model", Holds::Choice(&["mann", "kaimal"]), "", Value("\"mann\""), "`mann`: Mann's spectral tensor. `kaimal`: Kaimal's spectra with the exponential coherence of IEC 61400-1, not with `flow.solver = \"lattice\"`, which needs wind that is free of divergence."),
        key("grid", Holds::Table(&GRID), "", Otherwise("around all rotors, a tenth of a diameter farther, a 24th of a diameter apart"), "Where turbulence is made around the rotors: the points on which it is."),
        key("planes", Holds::Text, "", Otherwise("none"), "With `flow.solver = \"planes\"`, `\"vortex\"` or `\"lattice\"`: file with the planes of wind, `.bts` (TurbSim), `.wnd` (Bladed) or a HAWC2 box, relative to this file. In prescribed wind `speed` then only sets the Strouhal numbers and the rotor's first speed. The lattice takes the file's wind, its mean included, in at the inlet and makes no turbulence of its own: a plane reaches the place of the first turbine when it would in prescribed wind, and the air of the domain is filled with the planes before it. Below the lowest row of points the wind goes on to the ground in proportion to the profile of this case; `speed` sets the step, too."),
        key("precursor", Holds::Text, "", Otherwise("none"), "In place of `planes`, with `flow.solver = \"lattice\"`: folder that `wakemix inflow precursor` has left, relative to this file. Its planes come in at the inlet with their temperature, as those of `planes` do, and the air of the domain is its atmosphere: stratified, on a rotating earth, driven by the same pressure gradient, cooled or heated by the same ground, which `flow.ground` must name. Above the planes the mean wind and temperature are those of the precursor's box, which the domain must not rise above; beside them the mean blows, unless `beyond_planes` says otherwise. A cell takes 34 bytes more, and a third more time or less."),
        key("precursor_wind", Holds::Choice(&["planes", "beside"]), "", Value("\"planes\""), "Which wind of `precursor` comes in. `planes`: that of its record. `beside`: that of its box, which goes on from where the precursor stands, step by step beside each run: nothing ends, nothing comes round, no planes are in memory, and with `flow.sides = \"open\"` what comes in through the sides is the same air at the same time. It costs the precursor's steps and memory in each run. Its box ought to be longer and wider than the domain, which else meets the same eddies twice."),
        key("beyond_planes", Holds::Choice(&["repeat", "mean", "hold"]), "", Otherwise("refused; a HAWC2 box is repeated; `mean` with `precursor`"), "With `planes` or `precursor` and the lattice: what blows where the domain is wider or higher than the grid of the file. `repeat`: its turbulence again, to the sides and upwards, for files of Mann's model, which have no seam there. `mean`: the mean wind of the nearest row without turbulence, which fades over a tenth of the grid's width or height. `hold`: the turbulence of the edge. In each of them the mean wind above the grid goes on in proportion to the profile of this case, or as `precursor` has it."),
        key("cut", Holds::Table(&CUT), "", Otherwise("all of the file"), "With `planes`: the part of the file that is the wind, a window of time on a rectangle anywhere in it."),
        key("table", Holds::Text, "", Otherwise("none"), "With `flow.solver = \"uniform\"` or `\"vortex\"` (the lattice takes none: it would answer wind that changes everywhere at once with pressure waves): file with the wind over time, relative to this file: OpenFAST's uniform wind (`.wnd` or `.hh` with time, speed, direction, vertical speed, horizontal shear, exponent, linear shear, gust), or CSV with columns `time_s`, `speed_m_s` and, where wanted, `direction_deg` (counter-clockwise seen from above), `vertical_m_s`, `horizontal_shear`, `shear_exponent`, `vertical_shear`, `gust_m_s`. Lines join its rows, rows of equal time are a step, and it must last as long as the run. Shears are over the first turbine's diameter. `speed` then only sets the Strouhal numbers and the rotor's first speed; the profile is that of the case where the table has no exponent."),
        key("veer_deg_per_m", from(-1.0, 1.0), "deg/m", Value("0"), "Veer: per metre upwards the mean wind turns by so much, clockwise seen from above, as it does in the boundary layer of the northern hemisphere; at hub height it blows along x. Not with `planes` or `precursor`; with `flow.solver = \"lattice\"` between periodic or open sides, and by 60° at most up to the top of the domain.")
            .mistaken(&[Slip { unit: "deg per 100 m", factor: 0.01 }]),
        key("event", Holds::Event, "", Otherwise("nothing happens"), "With `flow.solver = \"uniform\"`, or `\"vortex\"` without turbulence: what happens in time, at all places at once: `event = { kind = \"step\", start = 100.0, speed = 12.0 }`."),
    ],
};

/// Greatest seed: TOML's integers are signed.
const SEED_MOST: u64 = i64::MAX as u64;

/// `[time]`.
pub(super) static TIME: Table = Table {
    heading: "[time]",
    about: "How long every run lasts.",
    keys: &[
        key(
            "spin_up",
            from(0.0, 1e6),
            "s",
            Required,
            "Time at the start that is not analysed: wakes develop and pass the row.",
        ),
        key(
            "duration",
            above(0.0, 1e6),
            "s",
            Required,
            "Time in all, spin-up included; longer than `spin_up`. Intervals need at least two blocks of `block` after it.",
        ),
        key(
            "block",
            above(0.0, 1e5),
            "s",
            Value("600"),
            "Length of the blocks whose means intervals are made of, of power, gains and loads: long beside the time in which wind and wakes forget. Ten minutes suit turbines; models in a wind tunnel take seconds, some twenty times diameter over wind speed.",
        ),
    ],
};

/// `[[turbine]]`.
pub(super) static TURBINE: Table = Table {
    heading: "[[turbine]]",
    about: "One turbine of the layout.",
    keys: &[
        key(
            "name",
            Holds::Name,
            "",
            Required,
            "Its name, such as `T1`: letters, digits, `-` and `_`.",
        ),
        key(
            "model",
            Holds::Model,
            "",
            Required,
            "Turbine model of the library (`wakemix turbine list`), or the path of a turbine file, relative to this file.",
        ),
        key(
            "discon",
            Holds::Text,
            "",
            Otherwise("the turbine's own controller"),
            "Input file of ROSCO (DISCON.IN, versions 2.6 to 2.10), relative to this file: the constants of the turbine's controller come from it instead of the turbine's file, with the table of coefficients that it names where that is there, and torque is controlled as it says.",
        ),
        key(
            "torque_gain",
            above(0.0, 1e14),
            "N m s²",
            Otherwise("that of the turbine's file"),
            "Gain k of the torque k ω² below rated power, of rotor torque and rotor speed: that at the generator, N m/(rad/s)², times the cube of the gear ratio. Not with `discon`, whose file has one.",
        ),
        key(
            "position_diameters",
            Holds::Pair(Range { low: -500.0, open: false, high: 500.0 }),
            "D",
            Otherwise("`position` must be given"),
            "Foot of the tower on the map, to the east and to the north, in diameters of the first turbine: with wind from the west, `wind.direction_deg = 270`, x is downwind and y to the left looking downwind. From every other turbine at least the mean of both diameters.",
        ),
        key(
            "position",
            Holds::Pair(Range { low: -1e7, open: false, high: 1e7 }),
            "m",
            Otherwise("`position_diameters` must be given"),
            "In place of `position_diameters`: the same in metres, to the east and to the north of any point, as maps have it. All turbines of a layout have the one or the other.",
        ),
        key(
            "yaw_deg",
            from(-60.0, 60.0),
            "deg",
            Value("0"),
            "Yaw misalignment: turn of the nacelle from facing the mean wind, positive counter-clockwise seen from above, which takes the wake to the right looking downwind. It stays so unless `kind = \"steering\"` turns it.",
        ),
        key(
            "pitch_misalignment_deg",
            Holds::Numbers(Range { low: -20.0, open: false, high: 20.0 }),
            "deg",
            Value("[]"),
            "Aerodynamic imbalance: error with which the pitch of each blade is mounted, one angle for each in their order, positive to feather. Pitch as it is commanded, limited, measured and written is that of the bearings, without it. What is found before the runs (azimuth offsets) is found with blades that are mounted right. Empty: all are.",
        ),
        key(
            "structure",
            Holds::Choice(&["flexible", "rigid"]),
            "",
            Value("\"flexible\""),
            "`flexible`: blades, tower and drive train bend. `rigid`: only the rotor turns.",
        ),
        key(
            "structure_step",
            from(0.001, 0.1),
            "s",
            Otherwise("0.025, less of a small and fast rotor"),
            "Longest step of the structure; a step of the flow is cut into as many as it takes, and at rated speed none turns the rotor by more than 0.05 rad. Longer ones cost less and follow fast modes less well: 0.05 changes equivalent loads of a large turbine by up to 0.8 % (docs/validation/openfast.md).",
        ),
        key(
            "stall",
            Holds::Choice(&["dynamic", "steady"]),
            "",
            Otherwise("`dynamic` in prescribed wind, `steady` in resolved flow"),
            "`dynamic`: flow about the blades' sections separates and attaches with delay. `steady`: their polars hold at once.",
        ),
        key(
            "dynamic_inflow",
            Holds::Choice(&["two-constant", "snel-schepers", "none"]),
            "",
            Otherwise("`two-constant` in prescribed wind"),
            "How the rotor's induction follows its loads, in prescribed wind only: a resolved flow has a wake of its own. `two-constant`: with two time constants, after Øye, as OpenFAST's DBEMT. `snel-schepers`: with the inertia of the air, after Snel and Schepers. `none`: at once.",
        ),
        key(
            "slow_constant",
            above(0.0, 1000.0),
            "s",
            Otherwise("follows wind and load"),
            "With `dynamic_inflow = \"two-constant\"`: the slow time constant τ₁, whatever wind and load (OpenFAST's `tau1_const`).",
        ),
        key(
            "tower_influence",
            Holds::Choice(&["none", "potential", "potential-with-drag", "potential-and-shadow"]),
            "",
            Value("\"none\""),
            "What the tower does to the wind that the blades meet, in prescribed wind and among free vortices: in the lattice its drag acts on the flow itself. `potential`: the wind parts as about a cylinder (AeroDyn's `TwrPotent` 1). `potential-with-drag`: and its drag slows the wind ahead, after Bak (`TwrPotent` 2). `potential-and-shadow`: as about a cylinder, and slow behind it, after Powles (`TwrShadow` 1).",
        ),
        key(
            "instruments",
            Holds::Table(&INSTRUMENTS),
            "",
            Otherwise("perfect instruments"),
            "What its controller sees of it: lag, bias, noise, resolution and drop-outs of each instrument.",
        ),
        key(
            "sensors",
            Holds::Sensors,
            "",
            Otherwise("none"),
            "Further sensors, each with a name of its own: `sensors.NAME = { kind = … }`; programs built on this one add kinds of their own.",
        ),
    ],
};

/// `[[run]]`.
pub(super) static RUN: Table = Table {
    heading: "[[run]]",
    about: "One run: who does what.",
    keys: &[
        key(
            "name",
            Holds::Folder,
            "",
            Required,
            "Its name, and that of the folder it leaves: letters, digits, `-`, `_`, and `.` inside.",
        ),
        key(
            "compare_with",
            Holds::Folder,
            "",
            Otherwise("the first run; the first compares with none"),
            "Run that its gains compare with; it stands before this one.",
        ),
        key(
            "control",
            Holds::Control,
            "",
            Otherwise("baseline on every turbine"),
            "What runs on each turbine, by the turbine's name: `control.T1 = { kind = \"helix\", … }`. Turbines not named run baseline.",
        ),
    ],
};

/// `output.volume_stride` of volumes that say none (–).
pub(super) const USUAL_STRIDE: usize = 2;

/// `[output]`.
pub(super) static OUTPUT: Table = Table {
    heading: "[output]",
    about: "What is kept of a run, beside series, summary and mean planes.",
    keys: &[
        key(
            "interval",
            above(0.0, 1e3),
            "s",
            Otherwise("every step of the lattice; five steps in prescribed wind, 0.1 s"),
            "Time between rows of the series, rounded to whole steps.",
        ),
        key(
            "plane_interval",
            above(0.0, 1e6),
            "s",
            Otherwise("no instantaneous planes"),
            "Instantaneous planes every so many seconds of the analysed time, all instants of a plane in one file.",
        ),
        key(
            "crosswind_diameters",
            Holds::Numbers(Range { low: -50.0, open: false, high: 500.0 }),
            "D",
            Value("[]"),
            "Crosswind planes at these distances behind the first turbine.",
        ),
        key(
            "helix_phases",
            Holds::Whole { least: 4, most: 360 },
            "–",
            Otherwise("no averages by phase"),
            "Phases of the first helix in the row by which the hub-height plane of the analysed time is averaged; 36 is one every ten degrees.",
        ),
        key(
            "lines_at",
            Holds::Turbines,
            "",
            Value("[]"),
            "Turbines at whose places runs without them keep the wind along 36 radial lines over the disc, as average, tilt and yaw: the true phase of a helix.",
        ),
        key(
            "inflow_at",
            Holds::Turbines,
            "",
            Value("[]"),
            "Turbines at whose places runs without them record the wind over the rotor from the end of the spin-up on, a plane for every half cell that the wind crosses: `RUN/inflow-T2.bts`, a full field in TurbSim's format, which `flow.solver = \"planes\"` and OpenFAST read.",
        ),
        key(
            "volume_interval",
            above(0.0, 1e6),
            "s",
            Otherwise("no volumes"),
            "Volume snapshots (VTK) every so many seconds; large.",
        ),
        key(
            "volume_stride",
            Holds::Whole { least: 1, most: 16 },
            "–",
            Otherwise("2 with `volume_interval`"),
            "Volumes hold every so many cells along each axis: 2 an eighth of them, 1 all of the flow's resolution. A cell takes 24 bytes on the disk, velocity and vorticity, and 16 of memory while a volume is written; `--dry-run` tells both.",
        ),
        key(
            "filament_interval",
            above(0.0, 1e6),
            "s",
            Otherwise("no vortices but those of the last instant"),
            "With `flow.solver = \"vortex\"`: the vortices of all wakes every so many seconds of the analysed time, VTK polydata with circulation, core radius, age, turbine and blade: `RUN/volumes/filaments-0000.vtp`. Those of the last instant are always kept, `filaments-last.vtp`; the report draws them.",
        ),
        key(
            "scans",
            Holds::Choice(&["keep", "none"]),
            "",
            Value("\"keep\""),
            "Scans of lidars, every one, spin-up included: `RUN/scans-T1.lidar.nc` of each lidar, with speed, place and time of each point. A point takes about 37 bytes a scan: 3 kB with 80 points, 30 MB in 1000 s at 10 Hz; `--dry-run` tells it. `none` where nobody asks `wakemix analyse hub-vortex`.",
        ),
        key(
            "checkpoint_interval",
            from(1.0, 1e6),
            "s",
            Value("300"),
            "Checkpoint every so many seconds of wall time.",
        ),
        key(
            "last_checkpoint",
            Holds::Choice(&["keep", "remove"]),
            "",
            Value("\"keep\""),
            "The checkpoint at the end of a run: with it a run goes on when `time.duration` is raised. `keep` takes the disk that `--dry-run` says, mainly the lattice; `remove` takes none.",
        ),
        key(
            "further",
            Holds::Outputs,
            "",
            Otherwise("none"),
            "Further outputs, each with a name of its own: `further.NAME = { kind = … }`. `phase-averages` and `wind-slices` come with the program; programs built on it add theirs.",
        ),
    ],
};
