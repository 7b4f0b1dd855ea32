"""Identifies a record with a subspace method of another family in numpy and prints its poles, for
`wakemix validate identification` to stand beside.

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6
    .venv/bin/python validation/scripts/pbsid_beside_numpy.py record.csv --inputs 2 --order 4 > poles.json

The record is a table with one header line, a row for each sample: inputs first, then outputs, no time. wakemix finds
states by a predictor's coefficients (PBSID-opt); here future outputs are projected at once on the past along future
inputs, and left vectors are weighted by canonical correlation (N4SID with the weights of CVA: Van Overschee and De
Moor, "Subspace identification for linear systems", 1996, chapter 4). Matrices A and C come from the shift of the
extended observability matrix, B and D from least squares of the simulated output.

The method takes inputs not to depend on noise: for a record of a closed loop `--closed-loop` projects by a long
autoregression instead, written out row by row (a direct PBSID with explicit matrices and numpy's least squares).
"""

import argparse
import json
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record", help="table with one header line, inputs first")
    parser.add_argument("--inputs", type=int, required=True, help="number of input columns")
    parser.add_argument("--order", type=int, help="order of the model; otherwise the largest gap's")
    parser.add_argument("--window", type=int, default=20, help="samples of past and of future")
    parser.add_argument("--interval", type=float, default=1.0, help="s between samples")
    parser.add_argument("--feedthrough", action="store_true", help="inputs act within a sample")
    parser.add_argument("--closed-loop", action="store_true", help="inputs depend on noise")
    args = parser.parse_args()
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
