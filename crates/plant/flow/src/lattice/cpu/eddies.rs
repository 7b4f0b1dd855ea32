//! Eddies whose viscosity follows from the wind of neighbours, on the processor.

use crate::lattice::atmosphere::stratification::Stratification;
use crate::lattice::eddies::{EddyLaw, Mixing, Noted};
use crate::lattice::fields::{Field, Fields};
use crate::lattice::layout::{Edge, Layout};
use crate::lattice::settings::LatticeSettings;
use std::io::{Read, Result, Write};

/// What the processor keeps of them.
pub(super) struct Eddies {
    law: EddyLaw,
    /// Wind and viscosity where there is no temperature, beside which they lie otherwise.
    fields: Fields,
}

impl Eddies {
    /// Those of `settings` in a box of `layout`, with `sides` beyond y and `levels` below and above: none
    /// where the collision finds the viscosity. None at all when the system refuses the memory.
    pub(super) fn new(
        settings: &LatticeSettings,
        layout: &Layout,
        sides: Edge,
        levels: [Edge; 2],
    ) -> Option<Option<Self>> {
        let Some(law) = EddyLaw::new(settings) else { return Some(None) };
        let fields = match settings.atmosphere {
            Some(_) => Fields::none(layout, sides, levels),
            None => Fields::of_eddies(layout, sides, levels),
        };
        Some(Some(Self { law, fields: fields? }))
    }

    /// Air without temperature whose cells tell their wind; none where they tell it with their temperature.
    pub(super) fn noted(&self) -> Option<Noted<'_>> {
        let Self { law, fields } = self;
        fields.hold(Field::Viscosity).then_some(Noted { fields, periodic: law.periodic })
    }

    /// The pass that finds the viscosity in step number `n_steps` of what may be an atmosphere, `air`.
    pub(super) fn mixing<'a>(
        &'a self,
        air: Option<&'a Stratification>,
        n_steps: u64,
    ) -> Mixing<'a> {
        let law = self.law;
        match air.map(|air| air.warmth(n_steps)) {
            Some((fields, warmth)) => Mixing { law, fields, heat: Some(warmth) },
            None => Mixing { law, fields: &self.fields, heat: None },
        }
    }

    /// On return there are none, as at first, nor in an atmosphere, `air`.
    pub(super) fn forget(&mut self, air: Option<&mut Stratification>) {
        match air.map(Stratification::fields_mut) {
            Some(fields) => {
                fields.clear(Field::Viscosity);
                fields.clear(Field::Diffusivity);
            }
            None => self.fields.clear(Field::Viscosity),
        }
    }

    /// Writes what they have left where there is no temperature.
    pub(super) fn write(&self, writer: &mut dyn Write, bytes: &mut Vec<u8>) -> Result<()> {
        match self.fields.hold(Field::Viscosity) {
            true => self.fields.write(Field::Viscosity, writer, bytes),
            false => Ok(()),
        }
    }

    /// Reads it back.
    pub(super) fn read(&mut self, reader: &mut dyn Read, bytes: &mut Vec<u8>) -> Result<()> {
        match self.fields.hold(Field::Viscosity) {
            true => self.fields.read(Field::Viscosity, reader, bytes),
            false => Ok(()),
        }
    }

    /// Memory that they hold beside that of an atmosphere (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.fields.bytes()
    }
}
