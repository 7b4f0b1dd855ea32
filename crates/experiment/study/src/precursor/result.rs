//! What came of a precursor, and whether its wind was steady.

use super::Job;
use super::error::PrecursorError;
use super::history::History;
use super::levels::direction;
use super::recording::{AtHub, at_hub};
use formats::records::{
    Drift, PRECURSOR_VERSION, PrecursorResult, RecordedPlanes, now, sha256_of_file,
};

/// Most that a block of the spin-up may be long (s), and over the spin-up (–).
const LONGEST_BLOCK: f64 = 3600.0;
const BLOCK_SHARE: f64 = 0.25;
/// What is said of a record that changes, and of a wind that is not steady when it begins.
const CHANGES: &str =
    "the wind changes while it is recorded: its first half differs from its second one";
pub(super) const UNSTEADY: &str = "the wind is not steady yet when its record begins: stop, raise time.spin_up and go on with --resume, or look at statistics.nc and take it as it is";

/// That a layer of `depth` (m) has grown through its inversion from `foot` to `top` (m), where it has.
fn outgrown(depth: f64, foot: f64, top: f64) -> Option<String> {
    (depth > top).then(|| {
        format!(
            "the layer is {depth:.0} m deep while it is recorded: it has grown through its inversion, which began at {foot:.0} to {top:.0} m"
        )
    })
}

impl Job {
    /// Length of the blocks (s) by which the end of the spin-up is judged.
    fn block(&self) -> f64 {
        LONGEST_BLOCK.min(BLOCK_SHARE * self.file.precursor.time.spin_up)
    }

    /// Time of the first plane (s).
    fn spin_up(&self) -> f64 {
        self.plan.time(self.plan.first_plane)
    }

    /// What changed in the end of the spin-up; none without one.
    pub(super) fn drift_of_spin_up(&self, history: &History) -> Option<Drift> {
        history.drift(self.block(), self.spin_up())
    }

    /// Mean wind at hub height in the last block of the spin-up, towards east and north (m/s).
    pub(super) fn wind_of_spin_up(&self, history: &History) -> [f64; 2] {
        history.hub_wind(self.spin_up() - self.block(), self.spin_up())
    }

    /// What a record tells of itself, whose layer is `depth` (m) deep.
    pub(super) fn of_record(&self, record: &Option<Drift>, depth: f64) -> Vec<String> {
        let precursor = &self.file.precursor;
        let (foot, top) = (precursor.air.inversion_height, precursor.inversion_top());
        let changes = record.is_some_and(|drift| !drift.is_steady());
        let changes = changes.then(|| CHANGES.to_owned());
        changes.into_iter().chain(outgrown(depth, foot, top)).collect()
    }

    /// What came of it, from its `history` and the planes along `along`, after `wall_time` (s) on `backend`.
    ///
    /// # Errors
    /// [`PrecursorError`] for planes that cannot be read.
    pub(super) fn result(
        &self,
        history: &History,
        along: [f64; 2],
        wall_time: f64,
        backend: &str,
    ) -> Result<PrecursorResult, PrecursorError> {
        let (plan, path) = (&self.plan, self.folder.planes_path());
        let hub_height = self.file.precursor.planes.hub_height;
        let AtHub { speed, aside, intensity, n_planes } = at_hub(&path, hub_height)??;
        let (start, end) = (self.spin_up(), plan.time(plan.n_steps));
        let [friction_velocity, boundary_layer_height] = history.layer(start, end);
        let [geostrophic_speed, geostrophic_direction_deg] =
            history.last_geostrophic().unwrap_or([f64::NAN; 2]);
        let spin_up = self.drift_of_spin_up(history);
        let record = history.drift(0.5 * (end - start), end);
        let mut warnings = self.warnings();
        if !spin_up.is_some_and(|drift| drift.is_steady()) {
            warnings.push("the wind was not steady yet when its record began".to_owned());
        }
        warnings.extend(self.of_record(&record, boundary_layer_height));
        Ok(PrecursorResult {
            warnings,
            schema_version: PRECURSOR_VERSION,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            name: self.file.precursor.name.clone(),
            case_text: self.file.text.clone(),
            backend: backend.to_owned(),
            finished: now(),
            planes: RecordedPlanes {
                sha256: sha256_of_file(&path, "the planes of wind")?,
                n_planes,
                n_points: [plan.grid.n_y, plan.grid.n_z],
                spacing: plan.spacing,
                interval: plan.grid.interval,
                hub_height,
                hub_speed: speed,
                turbulence_intensity: intensity,
                direction_deg: direction(along),
                turned_deg: aside.atan().to_degrees(),
            },
            spin_up,
            record,
            profile: history.profile(start, end),
            friction_velocity,
            boundary_layer_height,
            geostrophic_speed,
            geostrophic_direction_deg,
            n_cells: plan.cells() as u64,
            n_steps: plan.n_steps,
            wall_time,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_that_outgrows_its_inversion_is_told() {
        assert_eq!(outgrown(240.0, 200.0, 250.0), None);
        let told = outgrown(394.0, 200.0, 250.0).unwrap();
        assert!(told.contains("394 m deep") && told.contains("200 to 250 m"), "{told}");
        assert_eq!(outgrown(f64::NAN, 200.0, 250.0), None);
    }
}
