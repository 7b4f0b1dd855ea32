"""Spectral proper orthogonal decomposition of a small field in numpy, for `wakemix validate wake-analysis` to stand
beside.

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6
    .venv/bin/python validation/scripts/spod_beside_numpy.py > validation/data/wake-analysis/spod.json

The field is two travelling waves in noise that is coherent over a few places. The way there is another one than that
of wakemix: the whole matrix of block transforms of one frequency is written out and its singular values are taken
(numpy.linalg.svd), where wakemix sums correlations between blocks place by place and takes their eigenvalues; the
transform is a full complex one (numpy.fft.fft). Definitions: mean over all instants taken off, symmetric Hamming
window, one-sided densities, blocks that overlap by half: Towne, Schmidt and Colonius (2018), J. Fluid Mech. 847, 821.
"""

import json
import sys

import numpy as np

INSTANTS, PLACES, BLOCK, OVERLAP, INTERVAL, WEIGHT = 320, 12, 64, 32, 0.25, 0.125


def field():
    """Instants x places, rounded so that both programs read the same numbers."""
    random = np.random.default_rng(20)
    t, x = np.meshgrid(np.arange(INSTANTS) * INTERVAL, np.arange(PLACES) / PLACES, indexing="ij")
    waves = 1.2 * np.cos(2 * np.pi * (0.31 * t - x)) + 0.5 * np.sin(2 * np.pi * (0.9 * t + 2 * x))
    noise = random.standard_normal((INSTANTS, PLACES + 2))
    smooth = (noise[:, :-2] + noise[:, 1:-1] + noise[:, 2:]) / 3
    return np.round(4.0 + waves + 0.4 * smooth, 6)


def spod(values):
    """Frequencies, energies of each (greatest first), and the first mode of each."""
    fluctuation = values - values.mean(axis=0)
    window = np.hamming(BLOCK)
    starts = range(0, INSTANTS - BLOCK + 1, BLOCK - OVERLAP)
    blocks = np.stack([np.fft.fft(window[:, None] * fluctuation[s : s + BLOCK], axis=0) for s in starts])
    frequencies, energies, modes = [], [], []
    for k in range(BLOCK // 2 + 1):
        sides = 1.0 if k in (0, BLOCK // 2) else 2.0
        scale = np.sqrt(sides * INTERVAL / np.sum(window**2) * WEIGHT / len(blocks))
        left, singular, _ = np.linalg.svd(scale * blocks[:, k, :].T, full_matrices=False)
        frequencies.append(k / (BLOCK * INTERVAL))
        energies.append(list(singular**2))
        modes.append(left[:, 0] / np.sqrt(WEIGHT))
    return frequencies, energies, modes


def main():
    values = field()
    frequencies, energies, modes = spod(values)
    peak = int(np.argmax([row[0] for row in energies]))
    json.dump(
        {
            "interval": INTERVAL,
            "block": BLOCK,
            "overlap": OVERLAP,
            "weight": WEIGHT,
            "places": PLACES,
            "values": values.ravel().tolist(),
            "frequencies": frequencies,
            "energies": energies,
            "peak": peak,
            "mode": [[float(v.real), float(v.imag)] for v in modes[peak]],
        },
        sys.stdout,
    )
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
