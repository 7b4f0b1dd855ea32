//! Blade elements in the cores of other turbines' vortices, where the core decides what they feel.

use super::segment::Segment;
use super::sheet::Sheet;
use super::wake::FreeWake;
use basis::Vector3;

impl FreeWake {
    /// Elements of the blades of `turbine`, by its place among the farm's machines, that now stand nearer to
    /// the end of a vortex of another turbine than its core's radius, and all of its elements (–).
    pub fn elements_in_cores(&self, turbine: usize) -> [u64; 2] {
        let Some(index) = self.rotors.iter().position(|rotor| rotor.turbine() == turbine) else {
            return [0; 2];
        };
        let is_close =
            |station: &&Vector3| self.of_others(index).any(|of_one| touches(of_one, **station));
        let stations = &self.rotors[index].stations;
        [stations.iter().filter(is_close).count() as u64, stations.len() as u64]
    }

    /// Segments of the wakes of all rotors but number `index`, blade by blade.
    fn of_others(&self, index: usize) -> impl Iterator<Item = &[Segment]> {
        let mut first = 0;
        let of_blade = move |sheet: &Sheet| {
            let segments = first..first + sheet.n_segments();
            first = segments.end;
            (sheet.owner[0] != index).then_some(segments)
        };
        self.sheets.iter().filter_map(of_blade).filter_map(move |place| self.segments().get(place))
    }
}

/// Whether `station` lies in the core at the end of one of `segments`.
fn touches(segments: &[Segment], station: Vector3) -> bool {
    segments.iter().any(|segment| {
        let (x, core) = (segment.to.x - station.x, segment.core_squared);
        // Most are far along the wake.
        x * x < core && segment.circulation != 0.0 && (segment.to - station).length_squared() < core
    })
}

impl Sheet {
    /// Segments that it has now (–).
    fn n_segments(&self) -> usize {
        let rows = |n_rows: usize, n_nodes: usize| n_rows * (2 * n_nodes - 1);
        match self.near.n_rows() {
            0 => 0,
            1 => rows(self.far.n_rows(), self.far.n_nodes()),
            n => {
                let n_nodes = self.near.n_nodes();
                rows(self.far.n_rows(), self.far.n_nodes()) + rows(n - 1, n_nodes) + n_nodes - 1
            }
        }
    }
}
