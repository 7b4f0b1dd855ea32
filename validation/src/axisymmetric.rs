//! Steady axisymmetric flow through a loaded disc in a duct: what momentum theory, ring by ring, leaves out.
//!
//! Without mixing, the head H that a stream surface ψ lost at the disc and the angular momentum C = r u_θ
//! that it won there stay with it, and what differs from surface to surface is vorticity behind the disc:
//!
//! ```text
//! ∂²ψ/∂x² + r ∂/∂r (1/r ∂ψ/∂r) = r² dH/dψ − C dC/dψ,  u = 1/r ∂ψ/∂r,  H = −Δp/ρ + C²/2r²
//! ```
//!
//! with Δp the load of the disc where the surface meets it: the equation of Bragg and Hawthorne (1950). Swirl
//! lowers the pressure in the wake, most of all near its axis, so that more air passes there than under the
//! same load without it; [`Swirl::LeftOut`] takes C for nothing in this equation.
//!
//! Rings feel one another through the pressure and the widening wake, where momentum theory takes each for
//! itself; the mean over a uniformly loaded disc is momentum theory's, which is a test. Source: Wu (1962),
//! Schriften Schiffbau 9, for a heavily loaded disc. Lengths are over the rotor's radius, speeds over the
//! wind's.

mod rotor;

pub(crate) use rotor::{Outer, Swirl, coefficients, loaded};

use std::f64::consts::PI;

/// Width of the finest cells (radii), and the radius within which cells across are half as wide.
const SPACING: f64 = 0.05;
const FINE_RADIUS: f64 = 1.6;
/// Ratio of a cell's width to that of the one before, outside.
const STRETCH: f64 = 1.06;
/// Share of the new flow that a round takes (–).
const RELAXATION: f64 = 0.15;

/// The duct, its flow, and what solves it: sines along the axis, a tridiagonal system for each across it.
pub(crate) struct Flow {
    /// Radii of the nodes across, from the axis to the wall.
    radii: Vec<f64>,
    /// Number along the axis, from one, of the nodes at the disc; the inlet is number zero.
    disc: usize,
    /// Stream function at the nodes, all across for each along the axis behind the inlet.
    psi: Vec<f64>,
    /// Sine of number `k` at node `i` at `k · n + i − 1`.
    sines: Vec<f64>,
    /// Weights of the inner and the outer neighbour in the second derivative across.
    neighbours: Vec<[f64; 2]>,
    right_side: Vec<f64>,
    amplitudes: Vec<f64>,
}

impl Flow {
    /// An empty duct of radius `wall`, its inlet `upstream` before the disc, its end `downstream` behind it.
    pub(crate) fn new(upstream: f64, downstream: f64, wall: f64) -> Self {
        let disc = (upstream / SPACING).round() as usize;
        let n = disc + (downstream / SPACING).round() as usize;
        let (mut radii, mut width) = (vec![0.0], 0.5 * SPACING);
        let mut last = 0.0;
        while last < wall {
            last += width;
            radii.push(last);
            if last > FINE_RADIUS {
                width *= STRETCH;
            }
        }
        radii.iter_mut().for_each(|radius| *radius *= wall / last);
        let neighbours: Vec<[f64; 2]> = radii
            .windows(3)
            .map(|r| {
                let (inner, outer) = (r[1] - r[0], r[2] - r[1]);
                let mean = 0.5 * (inner + outer);
                [
                    r[1] / ((r[1] - 0.5 * inner) * inner * mean),
                    r[1] / ((r[1] + 0.5 * outer) * outer * mean),
                ]
            })
            .collect();
        let empty: Vec<f64> = radii.iter().map(|r| 0.5 * r * r).collect();
        let sines = (0..n * n)
            .map(|at| ((at / n) as f64 + 0.5) * PI * (at % n + 1) as f64 / n as f64)
            .map(f64::sin)
            .collect();
        let room = vec![0.0; n * neighbours.len()];
        Self {
            disc,
            psi: empty.repeat(n),
            sines,
            neighbours,
            right_side: room.clone(),
            amplitudes: room,
            radii,
        }
    }

    /// Stream function and axial speed at the disc at `radius`.
    pub(crate) fn at_disc(&self, radius: f64) -> [f64; 2] {
        let psi = &self.psi[(self.disc - 1) * self.radii.len()..][..self.radii.len()];
        let squared = |node: usize| self.radii[node] * self.radii[node];
        let speed =
            |node: usize| 2.0 * (psi[node + 1] - psi[node]) / (squared(node + 1) - squared(node));
        let middle = |node: usize| 0.5 * (squared(node + 1) + squared(node));
        let here = radius * radius;
        let node = self.radii.partition_point(|r| *r < radius).clamp(1, self.radii.len() - 1) - 1;
        let stream = psi[node] + 0.5 * speed(node) * (here - squared(node));
        // Speeds belong to the middles between nodes.
        let other = if here < middle(node) { node.saturating_sub(1) } else { node + 1 };
        let other = other.min(self.radii.len() - 2);
        if other == node {
            return [stream, speed(node)];
        }
        let share = (here - middle(node)) / (middle(other) - middle(node));
        [stream, speed(node) + share * (speed(other) - speed(node))]
    }

    /// Radius of the stream surface `psi` at `place` (radii behind the disc), and axial speed there.
    fn surface(&self, place: f64, psi: f64) -> [f64; 2] {
        let n_all = self.radii.len();
        let row = self.disc - 1 + (place / SPACING).round() as usize;
        let all = &self.psi[row * n_all..(row + 1) * n_all];
        let node = all.partition_point(|value| *value < psi).clamp(1, n_all - 1) - 1;
        let squared = |node: usize| self.radii[node] * self.radii[node];
        let area = squared(node + 1) - squared(node);
        let step = all[node + 1] - all[node];
        [(squared(node) + (psi - all[node]) / step * area).sqrt(), 2.0 * step / area]
    }

    /// One round towards the flow in which the stream surface ψ has lost the head `lost(ψ)`, and has C²/2 of
    /// `swirl(ψ)`.
    pub(crate) fn relax(&mut self, lost: impl Fn(f64) -> f64, swirl: impl Fn(f64) -> f64) {
        let (n_all, n) = (self.radii.len(), self.sines.len().isqrt());
        let m = self.neighbours.len();
        for row in self.disc..=n {
            // The disc's own nodes see half of the wake.
            let share = if row == self.disc { 0.5 } else { 1.0 };
            let psi = &self.psi[(row - 1) * n_all..][..n_all];
            let between = |node: usize| {
                let r = [self.radii[node], self.radii[node + 1]];
                let middle = 0.25 * (r[0] + r[1]).powi(2) - r[0] * r[0];
                psi[node] + middle / (r[1] * r[1] - r[0] * r[0]) * (psi[node + 1] - psi[node])
            };
            for (node, value) in self.right_side[(row - 1) * m..][..m].iter_mut().enumerate() {
                let (inner, outer) = (between(node), between(node + 1));
                // The mean slope over the cell, so that no head is lost or won however steep it is.
                let step = (outer - inner).max(1e-9);
                let [head, swirl] =
                    [(lost(outer) - lost(inner)) / step, (swirl(outer) - swirl(inner)) / step];
                *value = -share * (self.radii[node + 1].powi(2) * head + swirl);
            }
        }
        for k in 0..n {
            let sines = &self.sines[k * n..][..n];
            let amplitudes = &mut self.amplitudes[k * m..][..m];
            amplitudes.fill(0.0);
            for row in self.disc..=n {
                let weight = if row == n { 0.5 } else { 1.0 } * 2.0 / n as f64 * sines[row - 1];
                let source = &self.right_side[(row - 1) * m..][..m];
                amplitudes.iter_mut().zip(source).for_each(|(sum, value)| *sum += weight * value);
            }
            let angle = (k as f64 + 0.5) * PI / n as f64;
            let along = 2.0 * (1.0 - angle.cos()) / (SPACING * SPACING);
            solve_across(&self.neighbours, along, amplitudes);
        }
        let mut departure = vec![0.0; m];
        for i in 0..n {
            departure.fill(0.0);
            for k in 0..n {
                let sine = self.sines[k * n + i];
                let amplitudes = &self.amplitudes[k * m..][..m];
                departure.iter_mut().zip(amplitudes).for_each(|(sum, value)| *sum += sine * value);
            }
            for (node, departure) in departure.iter().enumerate() {
                let psi = &mut self.psi[i * n_all + node + 1];
                let empty = 0.5 * self.radii[node + 1].powi(2);
                *psi += RELAXATION * (empty + departure - *psi);
            }
        }
    }
}

/// On return `values` solves the system across for one sine, whose second derivative along the axis is
/// −`along` of itself.
fn solve_across(neighbours: &[[f64; 2]], along: f64, values: &mut [f64]) {
    let mut factors = vec![0.0; values.len()];
    let (mut factor, mut value) = (0.0, 0.0);
    for (node, [inner, outer]) in neighbours.iter().enumerate() {
        let pivot = -(inner + outer + along) - inner * factor;
        factor = outer / pivot;
        value = (values[node] - inner * value) / pivot;
        (factors[node], values[node]) = (factor, value);
    }
    for node in (1..values.len()).rev() {
        values[node - 1] -= factors[node - 1] * values[node];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axisymmetric::rotor::Table;

    #[test]
    fn a_uniform_disc_is_as_momentum_theory_has_it() {
        // Load with a soft rim; momentum theory holds for the mean of what passes, weighted with the load.
        for coefficient in [0.4, 0.8_f64] {
            let mut flow = Flow::new(10.0, 10.0, 20.0);
            let n = 100;
            let centres: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
            let rim = |r: f64| ((1.0 - r) / 0.1).clamp(0.0, 1.0);
            let load = |r: f64| 0.5 * coefficient * rim(r) * rim(r) * (3.0 - 2.0 * rim(r));
            for _ in 0..250 {
                let mut table = Table::default();
                table.push(0.0, load(0.0));
                for r in &centres {
                    table.push(flow.at_disc(*r)[0], load(*r));
                }
                table.push(flow.at_disc(1.0)[0], 0.0);
                flow.relax(|psi| table.at(psi), |_| 0.0);
            }
            let (mut thrust, mut work, mut expected) = (0.0, 0.0, 0.0);
            for r in &centres {
                thrust += r * load(*r);
                work += r * load(*r) * flow.at_disc(*r)[1];
                expected += r * load(*r) * 0.5 * (1.0 + (1.0 - 2.0 * load(*r)).sqrt());
            }
            let (speed, expected) = (work / thrust, expected / thrust);
            assert!((speed / expected - 1.0).abs() < 0.004, "{speed} against {expected}");
        }
    }

    /// A disc that turns the air as much as its load asks for: load and momentum of all that passes the duct
    /// agree, whatever pressure swirl makes in the wake.
    #[test]
    fn the_load_of_a_disc_with_swirl_is_the_momentum_that_its_wake_lacks() {
        const TIP_SPEED: f64 = 2.0;
        let mut flow = Flow::new(8.0, 12.0, 8.0);
        let n = 100;
        let places: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
        // Soft towards the hub and the tip.
        let ramp = |x: f64| x.clamp(0.0, 1.0).powi(2) * (3.0 - 2.0 * x.clamp(0.0, 1.0));
        let won = |r: f64| 0.12 * ramp((r - 0.1) / 0.3) * ramp((1.0 - r) / 0.2);
        let (mut head, mut swirl) = (Table::default(), Table::default());
        for _ in 0..300 {
            (head, swirl) = (Table::default(), Table::default());
            [&mut head, &mut swirl].into_iter().for_each(|table| table.push(0.0, 0.0));
            for r in &places {
                let surface = flow.at_disc(*r)[0];
                head.push(surface, TIP_SPEED * won(*r));
                swirl.push(surface, 0.5 * won(*r).powi(2));
            }
            let rim = flow.at_disc(1.0)[0];
            [&mut head, &mut swirl].into_iter().for_each(|table| table.push(rim, 0.0));
            flow.relax(|psi| head.at(psi), |psi| swirl.at(psi));
        }
        let load = |r: f64| TIP_SPEED * won(r) + 0.5 * (won(r) / r).powi(2);
        let thrust: f64 = places.iter().map(|r| 2.0 * r * load(*r) / f64::from(n)).sum();
        let end = &flow.psi[flow.psi.len() - flow.radii.len()..];
        let lacking: f64 = (1..end.len())
            .map(|node| {
                let area = flow.radii[node].powi(2) - flow.radii[node - 1].powi(2);
                let speed = 2.0 * (end[node] - end[node - 1]) / area;
                let psi = 0.5 * (end[node] + end[node - 1]);
                let squared = 0.5 * (flow.radii[node].powi(2) + flow.radii[node - 1].powi(2));
                let pressure = 0.5 * (1.0 - speed * speed) - head.at(psi) - swirl.at(psi) / squared;
                area * (1.0 - speed * speed - pressure)
            })
            .sum();
        // With the swirl left out of the flow the two differ by 4e-3, with its sign turned by 5e-3.
        let without: f64 =
            places.iter().map(|r| 2.0 * r * TIP_SPEED * won(*r) / f64::from(n)).sum();
        assert!((thrust / without - 1.0) > 0.05, "{thrust} {without}");
        assert!((lacking / thrust - 1.0).abs() < 1e-3, "{lacking} against {thrust}");
    }
}
