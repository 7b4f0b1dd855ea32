//! Wakes placed at once as long as they become, those of blades and of bodies: what a step costs then is
//! timed without making the steps before.

use super::sheet::Sheet;
use super::wake::FreeWake;
use basis::Vector3;

/// Speed at which a wake is carried over that of the wind at its rotor (–).
const CARRIED: f64 = 0.65;

/// How one rotor's wake would go on if nothing bent it.
#[derive(Clone, Copy)]
struct Course {
    /// Where its blades meet (m).
    hub: Vector3,
    /// Angle by which it turns about x in a step (rad).
    turn: f64,
    /// Way of its wake along x in a step (m).
    way: f64,
}

impl FreeWake {
    /// On return the wakes of all blades and bodies that have begun one are as long as they become: helices
    /// and rows of rings that nothing bends. They cost about what grown ones do, and say nothing of the
    /// wind.
    ///
    /// Limits: for rotors whose axes lie along x, more or less. Grown wakes are slower, wider and tangled,
    /// and cost more.
    pub fn reach_full_length(&mut self) {
        for index in 0..self.rotors.len() {
            let Some(course) = self.course(index) else { continue };
            let (settings, rotor) = (&self.settings, &self.rotors[index]);
            for sheet in self.sheets.iter_mut().filter(|sheet| sheet.owner[0] == index) {
                let circulations = rotor.circulations_of(sheet.owner[1]);
                let Some(newest) = sheet.near.n_rows().checked_sub(1) else { continue };
                let line = sheet.near.row(newest).to_vec();
                *sheet = Sheet::new(sheet.owner, circulations.len(), settings.resolution);
                let length = settings.resolution.length_behind(course.hub.x);
                let n_rows = (length / course.way).ceil() as usize + 1;
                for step in (0..=n_rows).rev() {
                    let before: Vec<Vector3> =
                        line.iter().map(|node| course.back(*node, step)).collect();
                    sheet.place_line(&before, circulations);
                }
                sheet.count_ages(settings.interval);
            }
            let turbine = self.rotors[index].turbine();
            for body in self.bodies.iter_mut().filter(|body| body.turbine == turbine) {
                body.reach_full_length(course.way, self.settings.interval);
            }
        }
        self.gather(true);
        self.tell_rotors();
    }

    /// The course of rotor number `index`; none before it has a wake, or when that stands still.
    fn course(&self, index: usize) -> Option<Course> {
        let sheets = || self.sheets.iter().filter(|sheet| sheet.owner[0] == index);
        // A step that was refused leaves blades without wakes.
        if sheets().any(|sheet| sheet.near.n_rows() < 2) {
            return None;
        }
        let n_blades = sheets().count() as f64;
        let hub = sheets().map(|sheet| sheet.line()[0]).sum::<Vector3>() / n_blades;
        let (mut turn, mut speed) = (0.0, 0.0);
        for sheet in sheets() {
            let row = sheet.near.n_rows() - 2;
            let angle = |row: usize| {
                let tip = sheet.near.row(row)[sheet.n_elements()] - hub;
                tip.z.atan2(tip.y)
            };
            // The older row has only been carried along since.
            let turned = angle(row + 1) - angle(row);
            turn += turned.sin().atan2(turned.cos()) / n_blades;
            let n_nodes = sheet.near.n_nodes();
            let velocities = &sheet.near.velocities[row * n_nodes..][..n_nodes];
            speed += velocities.iter().map(|v| v.x).sum::<f64>() / (n_nodes as f64 * n_blades);
        }
        let way = CARRIED * speed * self.settings.interval;
        (way > 0.0).then_some(Course { hub, turn, way })
    }
}

impl Course {
    /// Where the piece of wake is that left the blade at `node` when that stood here, `steps` before now.
    fn back(&self, node: Vector3, steps: usize) -> Vector3 {
        let (sine, cosine) = (-self.turn * steps as f64).sin_cos();
        let from = node - self.hub;
        let turned = Vector3::new(
            from.x + self.way * steps as f64,
            cosine * from.y - sine * from.z,
            sine * from.y + cosine * from.z,
        );
        self.hub + turned
    }
}

impl Sheet {
    /// Nodes of the blade's bound vortex.
    fn line(&self) -> &[Vector3] {
        self.near.row(self.near.n_rows() - 1)
    }

    /// On return every row is as old as it is after as many steps of `interval` (s).
    fn count_ages(&mut self, interval: f64) {
        let (n_near, n_far) = (self.near.n_rows(), self.far.n_rows());
        for (row, age) in self.near.ages.iter_mut().enumerate() {
            *age = (n_near - 1 - row) as f64 * interval;
        }
        let (oldest, stride) = (n_near - 1, self.far_stride());
        for (row, age) in self.far.ages.iter_mut().enumerate() {
            *age = (oldest + stride * (n_far - row)) as f64 * interval;
        }
    }
}
