"""Spectral modes and modes by energy of a small field with numpy, by other means than wakemix: transforms by a matrix of
exponentials, modes by singular values of weighted data instead of eigenvalues of correlations, all in one piece.

    python3 -m venv .venv && .venv/bin/pip install numpy
    .venv/bin/python validation/scripts/spod_beside_numpy.py > validation/data/modes/spod.json

The field is made of multiplications and additions alone, from a linear congruential generator, so that the same numbers come
out of any program: five first-order series times surfaces, and noise, on 7 x 6 points of a plane across the wind, 160 instants,
three components, kept in single precision. `wakemix validate wake-analysis` makes it anew and compares.
"""

import json

import numpy as np

N_Y, N_Z, N_INSTANTS, INTERVAL = 7, 6, 160, 0.5
SPACING_Y, SPACING_Z = 2.0, 3.0
N_SERIES, N_BLOCK, OVERLAP, N_MODES, INDEX = 5, 32, 16, 2, 3
MULTIPLIER, INCREMENT, MODULUS = 6364136223846793005, 1442695040888963407, 1 << 64


class Numbers:
    """Numbers in [-0.5, 0.5)."""

    def __init__(self, seed):
        self.state = seed

    def next(self):
        self.state = (self.state * MULTIPLIER + INCREMENT) % MODULUS
        return float(self.state >> 11) / float(1 << 53) - 0.5


def field():
    """Velocity [component][instant][point], y fastest."""
    numbers = Numbers(20)
    shapes = [[[numbers.next() for _ in range(4)] for _ in range(3)] for _ in range(N_SERIES)]
    series = []
    for _ in range(N_SERIES):
        values, value = [], 0.0
        for _ in range(N_INSTANTS):
            value = 0.75 * value + numbers.next()
            values.append(value)
        series.append(values)
    velocity = np.empty((3, N_INSTANTS, N_Z * N_Y), dtype=np.float32)
    for component in range(3):
        for instant in range(N_INSTANTS):
            for point in range(N_Z * N_Y):
                y, z = float(point % N_Y), float(point // N_Y)
                value = 0.125 * numbers.next()
                for number in range(N_SERIES):
                    a, b, c, d = shapes[number][component]
                    value += (((a + b * y) + c * z) + d * y * z) * series[number][instant]
                velocity[component, instant, point] = np.float32(value)
    return velocity


def weights():
    """Shares of the area by the trapezoidal rule, of all components, adding up to one."""
    along = lambda n, spacing: spacing * np.where((np.arange(n) == 0) | (np.arange(n) == n - 1), 0.5, 1.0)
    share = np.outer(along(N_Z, SPACING_Z), along(N_Y, SPACING_Y)).ravel()
    return np.tile(share / share.sum(), 3)


def main():
    velocity = field().astype(float)
    data = np.concatenate([velocity[component].T for component in range(3)])
    weight = weights()
    root = np.sqrt(weight)[:, None]
    data = data - data.mean(axis=1, keepdims=True)

    modes, singular, _ = np.linalg.svd(root * data, full_matrices=False)
    energies = singular**2 / N_INSTANTS
    by_energy = (modes / root)[:, :N_MODES]

    window = np.hamming(N_BLOCK)
    frequencies = np.arange(N_BLOCK // 2 + 1)
    exponentials = np.exp(-2j * np.pi * np.outer(np.arange(N_BLOCK), frequencies) / N_BLOCK)
    hop = N_BLOCK - OVERLAP
    starts = range(0, N_INSTANTS - N_BLOCK + 1, hop)
    blocks = np.array([(data[:, start : start + N_BLOCK] * window) @ exponentials for start in starts])
    scale = INTERVAL / (np.sum(window**2) * len(blocks))
    densities, kept = [], None
    for index in frequencies:
        sides = 1.0 if index in (0, N_BLOCK // 2) else 2.0
        vectors, singular, _ = np.linalg.svd(root * blocks[:, :, index].T, full_matrices=False)
        densities.append((sides * scale * singular**2).tolist())
        if index == INDEX:
            kept = (vectors / root)[:, :N_MODES]
    pairs = lambda mode: [[float(value.real), float(value.imag)] for value in mode]
    print(
        json.dumps(
            {
                "made_by": f"validation/scripts/spod_beside_numpy.py, numpy {np.__version__}",
                "first_values": [float(value) for value in velocity[:, 0, 0]],
                "last_values": [float(value) for value in velocity[:, -1, -1]],
                "energies": energies[:10].tolist(),
                "total": float(np.sum(energies)),
                "modes_by_energy": by_energy.T.tolist(),
                "frequency_step": 1.0 / (N_BLOCK * INTERVAL),
                "n_blocks": len(blocks),
                "densities": densities,
                "index": INDEX,
                "modes": [pairs(kept[:, mode]) for mode in range(N_MODES)],
            }
        )
    )


main()
