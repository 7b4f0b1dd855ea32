"""Identifies a record with a subspace method of another family in numpy and prints its poles, for
`wakemix validate identification` to stand beside.

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6
    .venv/bin/python validation/scripts/pbsid_beside_numpy.py --simulated \\
        > validation/data/identification/numpy_poles.json
    .venv/bin/python validation/scripts/pbsid_beside_numpy.py record.csv --inputs 2 --order 4 > poles.json

The first makes the records of the validation anew, sample by sample, from the same generator of random numbers
(validation/src/random.rs, identification.rs), and writes what is found in each. In the second the record is a
table with one header line, a row for each sample: inputs first, then outputs, no time.

wakemix finds states by a predictor's coefficients (PBSID-opt); here future outputs are projected at once on the
past along future inputs, and left vectors are weighted by canonical correlation (N4SID with the weights of CVA:
Van Overschee and De Moor, "Subspace identification for linear systems", 1996, chapter 4). Matrices A and C come
from the shift of the extended observability matrix, B and D from least squares of the simulated output.

The method takes inputs not to depend on noise: for a record of a closed loop `--closed-loop` projects by a long
autoregression instead, written out row by row (a direct PBSID with explicit matrices and numpy's least squares).
"""

import argparse
import json
import math
import sys

import numpy as np


def hankel(signals, start, rows, columns):
    """Blocks of `rows` samples from `start` on below one another, each channels x `columns`."""
    return np.vstack([signals[:, start + row : start + row + columns] for row in range(rows)])


def along(target, onto, aside):
    """Projection of `target` on `onto`, `aside` taken out of both, and `target` without `aside`."""
    basis, _ = np.linalg.qr(aside.T)
    left, rest = onto - (onto @ basis) @ basis.T, target - (target @ basis) @ basis.T
    factor = np.linalg.lstsq(left.T, rest.T, rcond=1e-10)[0].T
    return factor @ left, rest


def observability_open(u, y, window):
    """Extended observability matrix, all its columns, and the canonical correlations."""
    columns = u.shape[1] - 2 * window + 1
    past = np.vstack([hankel(u, 0, window, columns), hankel(y, 0, window, columns)])
    future_u, future_y = hankel(u, window, window, columns), hankel(y, window, window, columns)
    explained, free = along(future_y, past, future_u)
    # The inverse root of the future outputs' covariance aside from the inputs: canonical correlations.
    values, vectors = np.linalg.eigh(free @ free.T)
    values = np.maximum(values, 1e-12 * values[-1])
    root = vectors @ np.diag(np.sqrt(values)) @ vectors.T
    inverse = vectors @ np.diag(1.0 / np.sqrt(values)) @ vectors.T
    left, singular, _ = np.linalg.svd(inverse @ explained, full_matrices=False)
    return root @ left, singular


def states_closed(u, y, window, feedthrough):
    """State sequence and singular values by a predictor written out with explicit matrices."""
    z = np.vstack([u, y])
    samples = u.shape[1]
    past = np.vstack([z[:, window - lag : samples - lag] for lag in range(1, window + 1)])
    regressors = np.vstack([past, u[:, window:]]) if feedthrough else past
    coefficients = np.linalg.lstsq(regressors.T, y[:, window:].T, rcond=None)[0].T
    n_y, n_z = y.shape[0], z.shape[0]
    product = np.zeros((window * n_y, window * n_z))
    for row in range(window):
        width = (window - row) * n_z
        product[row * n_y : (row + 1) * n_y, :width] = coefficients[:, row * n_z : window * n_z]
    _, singular, right = np.linalg.svd(product @ past, full_matrices=False)
    return np.diag(np.sqrt(singular)) @ right, singular


def largest_gap(singular, most):
    """The order after which singular values fall by the largest factor."""
    singular = np.maximum(singular, 1e-12 * singular[0])
    return int(np.argmax(singular[:most] / singular[1 : most + 1])) + 1


def simulated(a, b, c, d, u):
    """Outputs of a system at rest."""
    state, outputs = np.zeros(a.shape[0]), []
    for now in u.T:
        outputs.append(c @ state + d @ now)
        state = a @ state + b @ now
    return np.array(outputs).T


def inputs_fitted(a, c, u, y, feedthrough):
    """B and D with which the simulated outputs come closest to `y`, from a state that is fitted as well."""
    order, n_u, n_y = a.shape[0], u.shape[0], y.shape[0]
    free, power = [], c
    for _ in range(u.shape[1]):
        free.append(power)
        power = power @ a
    columns = [np.vstack(free)[:, [state]] for state in range(order)]
    for channel in range(n_u):
        for state in range(order):
            b = np.zeros((order, n_u))
            b[state, channel] = 1.0
            columns.append(simulated(a, b, c, np.zeros((n_y, n_u)), u).T.reshape(-1, 1))
    if feedthrough:
        for channel in range(n_u):
            for output in range(n_y):
                moved = np.zeros((u.shape[1], n_y))
                moved[:, output] = u[channel]
                columns.append(moved.reshape(-1, 1))
    found = np.linalg.lstsq(np.hstack(columns), y.T.reshape(-1), rcond=None)[0]
    b = found[order : order + order * n_u].reshape(n_u, order).T
    d = found[order + order * n_u :].reshape(n_u, n_y).T if feedthrough else np.zeros((n_y, n_u))
    return b, d


def identified(u, y, args):
    """A, B, C, D and singular values, of channels divided by their deviations."""
    if args.closed_loop:
        states, singular = states_closed(u, y, args.window, args.feedthrough)
        order = args.order or largest_gap(singular, args.window // 2)
        states, now_u, now_y = states[:order], u[:, args.window :], y[:, args.window :]
        seen = np.vstack([states, now_u]) if args.feedthrough else states
        outputs = np.linalg.lstsq(seen.T, now_y.T, rcond=None)[0].T
        errors = now_y - outputs @ seen
        driven = np.vstack([states, now_u, errors])[:, :-1]
        next_states = np.linalg.lstsq(driven.T, states[:, 1:].T, rcond=None)[0].T
        a, b, c = next_states[:, :order], next_states[:, order : order + len(u)], outputs[:, :order]
        d = outputs[:, order:] if args.feedthrough else np.zeros((len(y), len(u)))
        return a, b, c, d, singular
    vectors, singular = observability_open(u, y, args.window)
    order = args.order or largest_gap(singular, args.window // 2)
    extended = vectors[:, :order] * np.sqrt(singular[:order])
    c = extended[: len(y)]
    a = np.linalg.lstsq(extended[: -len(y)], extended[len(y) :], rcond=None)[0]
    b, d = inputs_fitted(a, c, u, y, args.feedthrough)
    return a, b, c, d, singular


class Random:
    """Knuth's congruential generator (MMIX), as validation/src/random.rs has it."""

    def __init__(self, seed):
        self.state = seed

    def uniform(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return ((self.state >> 11) + 0.5) / 2**53

    def normal_pair(self):
        size = math.sqrt(-2.0 * math.log(self.uniform()))
        turn = 2.0 * math.pi * self.uniform()
        return size * math.cos(turn), size * math.sin(turn)


def known_system(order):
    """A, B and C of the validation's system of that order."""
    a, b, c = np.zeros((order, order)), np.zeros((order, 2)), np.zeros((2, order))
    for pair, (size, angle) in enumerate([(0.95, 0.25), (0.9, 0.7), (0.85, 1.3), (0.92, 2.0)][: order // 2]):
        real, imaginary = size * math.cos(angle), size * math.sin(angle)
        a[2 * pair : 2 * pair + 2, 2 * pair : 2 * pair + 2] = [[real, -imaginary], [imaginary, real]]
    random = Random(20_261_124 + order)
    # Entries are drawn column by column.
    for column in range(2):
        for row in range(order):
            b[row, column] = random.uniform() + 0.5
    for column in range(order):
        for row in range(2):
            sign = -1.0 if (row + column) % 3 == 0 else 1.0
            c[row, column] = sign * (0.5 + 0.1 * column)
    return a, b, c


def simulated_record(order, share, seed, samples=6000):
    """Inputs and outputs of the validation's record, noise included, means taken off."""
    a, b, c = known_system(order)
    random = Random(seed * 0x9E3779B97F4A7C15 % 2**64)
    u = np.array([random.normal_pair() for _ in range(samples)]).T
    y = simulated(a, b, c, np.zeros((2, 2)), u)
    for output in y:
        deviation, noise = math.sqrt(np.mean(output**2)), 0.0
        for sample in range(samples):
            noise = 0.8 * noise + 0.6 * random.normal_pair()[0]
            output[sample] += share * deviation * noise
    return [signal - signal.mean(axis=1, keepdims=True) for signal in (u, y)]


def all_simulated(window=30):
    """What is found in every record of the validation."""
    records = []
    for order in (2, 4, 6, 8):
        for share in (0.1, 0.01):
            u, y = simulated_record(order, share, 2 * order)
            args = argparse.Namespace(order=order, window=window, closed_loop=False, feedthrough=False)
            scales = y.std(axis=1, keepdims=True)
            model = identified(u, y / scales, args)
            poles = sorted(np.linalg.eigvals(model[0]), key=lambda pole: (abs(np.angle(pole)), pole.imag))
            records.append(
                {
                    "order": order,
                    "noise": share,
                    "last": y[:, -1].tolist(),
                    "poles": [[float(pole.real), float(pole.imag)] for pole in poles],
                }
            )
    return {"numpy": np.__version__, "method": "N4SID with weights of CVA", "window": window, "records": records}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record", nargs="?", help="table with one header line, inputs first")
    parser.add_argument("--simulated", action="store_true", help="all records of the validation")
    parser.add_argument("--inputs", type=int, help="number of input columns")
    parser.add_argument("--order", type=int, help="order of the model; otherwise the largest gap's")
    parser.add_argument("--window", type=int, default=20, help="samples of past and of future")
    parser.add_argument("--interval", type=float, default=1.0, help="s between samples")
    parser.add_argument("--feedthrough", action="store_true", help="inputs act within a sample")
    parser.add_argument("--closed-loop", action="store_true", help="inputs depend on noise")
    args = parser.parse_args()
    if args.simulated:
        json.dump(all_simulated(), sys.stdout, indent=1)
        print()
        return
    if args.record is None or args.inputs is None:
        parser.error("give a record and --inputs, or --simulated")
    table = np.loadtxt(args.record, delimiter=",", skiprows=1).T
    table = table - table.mean(axis=1, keepdims=True)
    deviations = table.std(axis=1, keepdims=True)
    u, y = np.split(table / deviations, [args.inputs])
    a, b, c, d, singular = identified(u, y, args)
    of_u, of_y = np.split(deviations.ravel(), [args.inputs])
    b, c, d = b / of_u, of_y[:, None] * c, of_y[:, None] * d / of_u
    at_rest = c @ np.linalg.solve(np.eye(len(a)) - a, b) + d
    poles = sorted(np.linalg.eigvals(a), key=lambda pole: (abs(np.angle(pole)), np.imag(pole)))
    model = {
        "method": "predictor, explicit matrices" if args.closed_loop else "N4SID with weights of CVA",
        "order": len(a),
        "interval": args.interval,
        "poles": [[float(np.real(pole)), float(np.imag(pole))] for pole in poles],
        "gain_at_rest": at_rest.tolist(),
        "singular_values": singular[: 2 * len(a) + 4].tolist(),
    }
    json.dump(model, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
