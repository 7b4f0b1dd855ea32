"""Makes ten generalised plants of order 2 to 20 and their least H-infinity norms by slycot (SB10AD), for
`wakemix validate synthesis` to stand beside.

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6 scipy==1.17.1 control==0.10.2 slycot==0.7.1
    .venv/bin/python validation/scripts/hinf_beside_slycot.py > validation/data/synthesis/hinf_plants.json

Five are mixed-sensitivity problems (`control.augw`) of plants with two inputs and two outputs, of which some are
unstable and some have zeros in the right half plane; five are random plants with full D11. Each closed loop's norm
is taken once more by `control.linfnorm` (AB13DD). The norms tell how low SLICOT's own search came: it ends where
its lower and upper bound are within its tolerance.
"""

import json
import sys

import control
import numpy as np
import slycot

SEED = 20_261_124


def stable(random, order, n_inputs, n_outputs):
    """A random system whose poles lie between 0.2 and 5 rad/s, well away from the imaginary axis."""
    poles = -np.exp(random.uniform(np.log(0.2), np.log(5.0), order))
    turn, _ = np.linalg.qr(random.normal(size=(order, order)))
    a = turn @ np.diag(poles) @ turn.T
    skew = random.normal(size=(order, order))
    a = a + 0.3 * (skew - skew.T)
    b = random.normal(size=(order, n_inputs))
    c = random.normal(size=(n_outputs, order)) / np.sqrt(order)
    return a, b, c


def mixed_sensitivity(random, order, unstable):
    """Weighted sensitivity and control of a plant of `order`, weights of order one a channel."""
    a, b, c = stable(random, order, 2, 2)
    if unstable:
        values, turn = np.linalg.eigh(0.5 * (a + a.T))
        a = a + (0.4 - values[-1]) * np.outer(turn[:, -1], turn[:, -1])
    plant = control.ss(a, b, c, np.zeros((2, 2)))
    w1 = control.ss(control.tf([0.5, 0.3], [1.0, 0.003]))
    w2 = control.ss(control.tf([1.0, 0.5], [0.1, 10.0]))
    whole = control.augw(plant, w1, w2)
    return whole.A, whole.B, whole.C, whole.D


def general(random, order):
    """Two disturbances beside two sensor noises, three errors, two controls, two measurements."""
    a, b, c = stable(random, order, 6, 5)
    d = 0.2 * random.normal(size=(5, 6))
    d[:3, 4:] = np.vstack([np.zeros((1, 2)), np.eye(2)]) + 0.1 * random.normal(size=(3, 2))
    d[3:, :4] = np.hstack([np.zeros((2, 2)), np.eye(2)]) + 0.1 * random.normal(size=(2, 4))
    d[3:, 4:] = 0.0
    return a, b, c, d


def solved(name, a, b, c, d):
    """The plant with what slycot finds."""
    n, m, p = a.shape[0], b.shape[1], c.shape[0]
    found = slycot.sb10ad(n, m, p, 2, 2, 1e6, a, b, c, d, job=1, gtol=1e-6, actol=0.0)
    gamma, (ac, bc, cc, dc) = found[0], found[5:9]
    norm, _ = control.linfnorm(control.ss(ac, bc, cc, dc))
    assert np.linalg.eigvals(ac).real.max() < 0.0, name
    print(f"{name}: order {n}, gamma {gamma:.6f}, norm of the loop {norm:.6f}", file=sys.stderr)
    return {
        "name": name,
        "n_controls": 2,
        "n_measurements": 2,
        "A": a.tolist(),
        "B": b.tolist(),
        "C": c.tolist(),
        "D": d.tolist(),
        "gamma": float(gamma),
        "norm": float(norm),
    }


def main():
    random = np.random.default_rng(SEED)
    plants = []
    for index, order in enumerate([2, 4, 6, 10, 16]):
        unstable = index % 2 == 1
        kind = "unstable" if unstable else "stable"
        plants.append(solved(f"mixed-{order}-{kind}", *mixed_sensitivity(random, order, unstable)))
    for order in [2, 5, 9, 14, 20]:
        plants.append(solved(f"general-{order}", *general(random, order)))
    versions = {"numpy": np.__version__, "control": control.__version__, "slycot": slycot.__version__}
    json.dump({"versions": versions, "seed": SEED, "plants": plants}, sys.stdout)


if __name__ == "__main__":
    main()
