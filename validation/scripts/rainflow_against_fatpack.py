"""Counts random loads with `wakemix fatigue` and with the packages rainflow and fatpack of PyPI; all must agree.

    python3 -m venv .venv && .venv/bin/pip install numpy rainflow==3.2.0 fatpack==0.7.8
    cargo build --release
    .venv/bin/python validation/scripts/rainflow_against_fatpack.py target/release/wakemix

rainflow follows ASTM E1049-85 with half cycles, as wakemix does. fatpack counts four points at a time and leaves a residue; here
its closed cycles are taken from the exact reversals (its own entry point first sorts the load into classes) and each range of the
residue counts one half, which is the same count by another algorithm. Ends with 1 when a difference exceeds 1e-6.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import fatpack
import numpy as np
import rainflow

SLOPES = [1.0, 3.0, 4.0, 7.5, 10.0]
N_BINS = 200
TOLERANCE = 1e-6


def series(number, random):
    """Times and one of five kinds of load, between 300 and 6000 samples long."""
    n_samples = int(random.integers(300, 6000))
    time = 0.02 * np.arange(n_samples)
    noise = random.normal(size=n_samples)
    kinds = [
        lambda: 1e4 * noise,
        lambda: 1e3 * np.cumsum(noise),
        lambda: 5e7 + 1e7 * np.sin(0.7 * time) + 4e6 * np.sin(1.9 * time) + 1e6 * noise,
        # Whole numbers: equal samples in a row and equal ranges.
        lambda: np.round(4.0 * noise),
        lambda: 1e-3 * noise * np.exp(-time / time[-1]),
    ]
    return time, kinds[number % len(kinds)]()


def counted(program, folder, time, load, bins=None):
    """What the program says of the load: by slope, cycles, largest range."""
    path = folder / "load.csv"
    rows = (f"{t!r},{x!r}\n" for t, x in zip(time.tolist(), load.tolist()))
    path.write_text("time_s,load\n" + "".join(rows), encoding="utf-8")
    slopes = ",".join(f"{slope:g}" for slope in SLOPES)
    command = [program, "fatigue", path, "--channel", "load", "--slope", slopes, "--json"]
    if bins is not None:
        command += ["--bins", str(bins)]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    channel = found["channels"][0]
    loads = [entry["damage_equivalent_load"] for entry in channel["loads"]]
    return np.array(loads + [channel["n_cycles"], channel["largest_range"]])


def expected(ranges, counts, duration):
    """The same figures from ranges and their counts."""
    loads = [np.sum(counts * ranges**slope / duration) ** (1.0 / slope) for slope in SLOPES]
    return np.array(loads + [counts.sum(), ranges.max()])


def with_rainflow(load):
    cycles = list(rainflow.extract_cycles(load.tolist()))
    return np.array([cycle[0] for cycle in cycles]), np.array([cycle[2] for cycle in cycles])


def with_fatpack(load):
    distinct = load[np.insert(np.diff(load) != 0.0, 0, True)]
    turns = np.diff(np.sign(np.diff(distinct))) != 0.0
    reversals = distinct[np.concatenate(([True], turns, [True]))]
    closed, residue = fatpack.find_rainflow_cycles(reversals)
    closed = closed.reshape(-1, 2)
    ranges = np.concatenate((np.abs(closed[:, 1] - closed[:, 0]), np.abs(np.diff(residue))))
    counts = np.concatenate((np.ones(len(closed)), np.full(len(residue) - 1, 0.5)))
    return ranges, counts


def binned(ranges, counts):
    # Not numpy.histogram, whose edges are rounded: a range of a whole number may stand on one.
    bins = np.minimum(np.floor(ranges * N_BINS / ranges.max()).astype(int), N_BINS - 1)
    numbers = np.bincount(bins, weights=counts, minlength=N_BINS)
    return (np.arange(N_BINS) + 0.5) * ranges.max() / N_BINS, numbers


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path, help="the wakemix program")
    parser.add_argument("--series", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    random = np.random.default_rng(arguments.seed)
    largest = {"rainflow": 0.0, "fatpack": 0.0, f"{N_BINS} bins": 0.0}
    n_samples = 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(arguments.series):
            time, load = series(number, random)
            duration = time[-1] - time[0]
            n_samples += len(load)
            ours = counted(program, Path(folder), time, load)
            for name, count in [("rainflow", with_rainflow), ("fatpack", with_fatpack)]:
                difference = np.abs(ours / expected(*count(load), duration) - 1.0).max()
                largest[name] = max(largest[name], difference)
            ours = counted(program, Path(folder), time, load, N_BINS)[: len(SLOPES)]
            theirs = expected(*binned(*with_rainflow(load)), duration)[: len(SLOPES)]
            largest[f"{N_BINS} bins"] = max(largest[f"{N_BINS} bins"], np.abs(ours / theirs - 1.0).max())
    slopes = ", ".join(f"{slope:g}" for slope in SLOPES)
    print(f"{arguments.series} series, {n_samples} samples; slopes {slopes}, cycles, largest range")
    for name, difference in largest.items():
        print(f"largest relative difference from {name}: {difference:.1e}")
    return 0 if max(largest.values()) <= TOLERANCE else 1


if __name__ == "__main__":
    sys.exit(main())
