//! The atmosphere that a precursor leaves to studies.

use super::Precursor;
use crate::wind::Surroundings;
use flow::inflow::{ColumnLevel, MeanColumn};
use flow::lattice::atmosphere::{Atmosphere, Damping, Driving, Heating};

impl Precursor {
    /// Its air after `time` (s), when its planes begin: with the means of `levels`, and driven
    /// by the geostrophic wind `geostrophic` (m/s), both along x and y of the planes. None without levels, or
    /// where their heights do not rise.
    pub fn surroundings(
        &self,
        time: f64,
        levels: Vec<ColumnLevel>,
        geostrophic: [f64; 2],
    ) -> Option<Surroundings> {
        let column = MeanColumn::new(levels)?;
        let air = &self.air;
        let heating = match (air.heat_flux, air.cooling_rate) {
            (Some(flux), _) => Heating::Flux(flux),
            (None, Some(rate)) => {
                Heating::Ground { temperature: air.temperature - rate * time, rate: -rate }
            }
            (None, None) => Heating::None,
        };
        let profile = column.levels().iter().map(|level| [level.height, level.temperature]);
        Some(Surroundings {
            atmosphere: Atmosphere {
                coriolis: self.coriolis(),
                driving: Driving::Geostrophic(geostrophic),
                temperature: profile.collect(),
                heating,
                ..Atmosphere::new(air.temperature)
            },
            column,
            roughness_length: air.roughness_length,
            extent: [self.domain.size[0], self.domain.size[1]],
            height: self.domain.size[2],
            inversion_top: self.inversion_top(),
            damping: Damping { from: self.damping_from(), rate: air.damping_rate },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precursor::{AirColumn, PeriodicBox, PrecursorTime, WantedPlanes};
    use flow::lattice::SubgridModel;

    fn precursor(cooling_rate: Option<f64>) -> Precursor {
        Precursor {
            name: "test".to_owned(),
            description: None,
            seed: 1,
            domain: PeriodicBox {
                size: [4000.0, 4000.0, 1280.0],
                cell: 20.0,
                subgrid: SubgridModel::Smagorinsky,
                threads: None,
            },
            air: AirColumn {
                latitude: 52.6_f64.to_radians(),
                roughness_length: 0.001,
                geostrophic_wind: Some(10.0),
                geostrophic_direction: None,
                hub_wind: None,
                hub_direction: None,
                temperature: 288.15,
                inversion_height: 700.0,
                inversion_strength: 2.5,
                inversion_depth: 100.0,
                lapse_rate: 0.001,
                heat_flux: None,
                cooling_rate,
                damping_from: None,
                damping_rate: 0.01,
            },
            time: PrecursorTime {
                spin_up: 7200.0,
                record: 600.0,
                step: None,
                statistics_interval: 60.0,
            },
            planes: WantedPlanes {
                hub_height: 170.0,
                rotor_diameter: None,
                width: None,
                height: None,
                interval: None,
            },
        }
    }

    fn level(height: f64) -> ColumnLevel {
        ColumnLevel { height, wind: [8.0, 0.01 * height], temperature: 288.0 + 0.003 * height }
    }

    fn surroundings(cooling_rate: Option<f64>) -> Surroundings {
        let levels = (0..64).map(|index| level(10.0 + 20.0 * f64::from(index))).collect();
        precursor(cooling_rate).surroundings(7200.0, levels, [9.5, -2.0]).unwrap()
    }

    #[test]
    fn waves_are_damped_above_the_inversion_alone() {
        let air = surroundings(None);
        let from = |height: f64| air.damping(height, 15.0).map(|damping| damping.from);
        // As high as the precursor, lower, and so low that the inversion is in the way.
        assert_eq!(from(1280.0), Some(960.0));
        assert_eq!(from(1100.0), Some(825.0));
        assert_eq!(from(900.0), Some(800.0));
        assert_eq!(from(850.0), None);
    }

    #[test]
    fn its_air_is_driven_and_cooled_as_the_precursor_is_when_its_planes_begin() {
        let air = surroundings(Some(0.25 / 3600.0)).atmosphere;
        assert_eq!(air.driving, Driving::Geostrophic([9.5, -2.0]));
        assert!((air.coriolis - 1.1586e-4).abs() < 1e-7, "{}", air.coriolis);
        let Heating::Ground { temperature, rate } = air.heating else {
            panic!("{:?}", air.heating)
        };
        assert!((temperature - 287.65).abs() < 1e-9 && (rate + 0.25 / 3600.0).abs() < 1e-12);
        assert!((air.temperature_at(100.0) - 288.3).abs() < 1e-9);
        assert_eq!(precursor(None).surroundings(0.0, Vec::new(), [0.0; 2]), None);
        assert_eq!(surroundings(None).atmosphere.heating, Heating::None);
    }
}
