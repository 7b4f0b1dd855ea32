//! Models of the eddies that the grid does not resolve, and their constants.

/// Smagorinsky's constant in sheared flow away from walls.
///
/// Deardorff (1970), J. Fluid Mech. 41, 453, found 0.10 for channel flow; free shear and wakes are run with
/// 0.10 to 0.14, isotropic turbulence with 0.17 (Lilly 1967).
pub const DEFAULT_SMAGORINSKY: f64 = 0.12;

/// Viscosity that stands for the eddies that the grid does not resolve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subgrid {
    /// Law that it follows.
    pub model: SubgridModel,
    /// The law's constant (–); 0 switches it off.
    pub constant: f64,
}

impl Subgrid {
    /// `model` with its [usual constant](SubgridModel::usual_constant).
    pub fn new(model: SubgridModel) -> Self {
        Self { model, constant: model.usual_constant() }
    }

    /// Smagorinsky's model with `constant` (–).
    pub fn smagorinsky(constant: f64) -> Self {
        Self { model: SubgridModel::Smagorinsky, constant }
    }

    /// No model: the air's own viscosity alone.
    pub fn none() -> Self {
        Self::smagorinsky(0.0)
    }
}

/// What the viscosity of unresolved eddies follows from, with a filter as wide as a cell, Δ.
///
/// Smagorinsky's strain is that of the cell itself, from what its populations lack to equilibrium. The others
/// need the whole gradient of the velocity, which is taken from the wind of the six neighbours: a pass of its
/// own after each step, whose viscosity acts in the next one.
///
/// In stratified air Smagorinsky's model has Lilly's correction, √(1 − N²/(Pr |S|²)); WALE's and Vreman's
/// viscosity has it with the square of all slopes of the wind in place of |S|², the same in pure shear.
/// Minimum dissipation has a term of buoyancy and a diffusivity of heat of its own (Abkar, Moin 2017,
/// Bound.-Layer Meteorol. 165, 405).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubgridModel {
    /// ν = (C Δ)² |S| (Smagorinsky 1963, Mon. Weather Rev. 91, 99).
    Smagorinsky,
    /// Wall-adapting local eddy viscosity: none in pure shear, little at walls (Nicoud, Ducros 1999, Flow
    /// Turbul. Combust. 62, 183).
    Wale,
    /// Vreman's: none in pure shear and in pure strain along one axis (Vreman 2004, Phys. Fluids 16, 3670).
    Vreman,
    /// Anisotropic minimum dissipation: as much as keeps unresolved energy from growing, none where the
    /// gradient makes no smaller eddies (Rozema, Bae, Moin, Verstappen 2015, Phys. Fluids 27, 085107).
    MinimumDissipation,
}

impl SubgridModel {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Smagorinsky, Self::Wale, Self::Vreman, Self::MinimumDissipation];

    /// Its word in files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Smagorinsky => "smagorinsky",
            Self::Wale => "wale",
            Self::Vreman => "vreman",
            Self::MinimumDissipation => "amd",
        }
    }

    /// The model that files call `word`.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.word() == word)
    }

    /// The constant that it is published with (–): Nicoud and Ducros' of isotropic turbulence; Vreman's, 2.5
    /// times the square of Smagorinsky's of isotropic turbulence; that of minimum dissipation for central
    /// differences of second order.
    pub fn usual_constant(self) -> f64 {
        match self {
            Self::Smagorinsky => DEFAULT_SMAGORINSKY,
            Self::Wale => 0.5,
            Self::Vreman => 0.07,
            Self::MinimumDissipation => 0.3,
        }
    }

    /// Whether it needs the velocity of neighbours.
    pub fn needs_neighbours(self) -> bool {
        self != Self::Smagorinsky
    }
}
