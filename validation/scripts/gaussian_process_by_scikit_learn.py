"""Fits Gaussian processes with scikit-learn and prints what the tests of the room `surrogate` compare with.

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6 scikit-learn==1.9.1
    .venv/bin/python validation/scripts/gaussian_process_by_scikit_learn.py > validation/data/surrogate/scikit-learn.txt

Five fits of two data sets, made up from a fixed seed: gains over the eight published phase offsets with one period, with known noise
and with the published squared exponential, and a surface over two inputs with two kernels. For each, the log marginal likelihood and its slopes at hyperparameters that
are far from the best, then the best ones of forty starts, and the curve there. All means are zero. Deviations are those of one
more observation, which is what scikit-learn gives for a kernel with a white part. Slopes and hyperparameters stand in the order
signal variance, lengths, noise variance; slopes are by their logarithms.
"""

import warnings

import numpy as np
import sklearn
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, ExpSineSquared, Matern, WhiteKernel

TURN = 2.0 * np.pi
OFFSETS = np.radians([0.0, 90.0, 120.0, 150.0, 180.0, 210.0, 270.0, 330.0])


def kernel(shape, signal, lengths, noise, spread, span):
    """scikit-learn's kernel with the bounds that wakemix uses."""
    wide = [(1e-2 * s, 1e2 * s) for s in span]
    scale = ConstantKernel(signal, (1e-4 * spread, 1e4 * spread))
    white = WhiteKernel(noise, (1e-8 * spread, 1e2 * spread))
    if shape == "periodic":
        return scale * ExpSineSquared(lengths[0], TURN, (0.05, 50.0), "fixed") + white
    if shape == "squared-exponential":
        return scale * RBF(lengths, wide) + white
    return scale * Matern(lengths, wide, nu=1.5 if shape == "matern-32" else 2.5) + white


def line(key, numbers):
    print(key, *(repr(float(number)) for number in np.ravel(numbers)))


def case(name, shape, inputs, values, points, guess, variances=None):
    spread, span = np.mean(values**2), np.ptp(inputs, axis=0)
    alpha = np.zeros(len(values)) if variances is None else variances
    start = kernel(shape, guess[0], guess[1:-1], guess[-1], spread, span)
    fixed = GaussianProcessRegressor(start, alpha=alpha, optimizer=None).fit(inputs, values)
    log, slopes = fixed.log_marginal_likelihood(fixed.kernel_.theta, eval_gradient=True)
    best = GaussianProcessRegressor(start, alpha=alpha, n_restarts_optimizer=40, random_state=1).fit(inputs, values)
    found = np.exp(best.kernel_.theta)
    means, deviations = best.predict(points, return_std=True)
    print("case", name, shape)
    line("inputs", inputs)
    line("values", values)
    line("variances", [] if variances is None else variances)
    line("guess", guess)
    line("guess-log", [log])
    line("guess-slopes", slopes)
    line("best", found)
    line("best-log", [best.log_marginal_likelihood_value_])
    line("points", points)
    line("means", means)
    line("deviations", deviations)


def main():
    warnings.filterwarnings("ignore")
    random = np.random.default_rng(10)
    print(f"# scikit-learn {sklearn.__version__}, numpy {np.__version__}; validation/scripts/gaussian_process_by_scikit_learn.py")
    gains = 0.02 + 0.08 * np.cos(OFFSETS - np.radians(150.0)) + 0.01 * np.sin(2.0 * OFFSETS)
    gains += 0.005 * random.normal(size=8)
    offsets, around = OFFSETS[:, None], np.radians(np.arange(0.0, 360.0, 45.0))[:, None]
    variances = (0.004 + 0.004 * random.random(8)) ** 2
    case("offsets-periodic", "periodic", offsets, gains, around, [0.01, 0.7, 1e-4])
    case("offsets-known-noise", "periodic", offsets, gains, around, [0.01, 0.7, 1e-5], variances)
    case("offsets-published", "squared-exponential", offsets, gains, around, [0.01, 1.2, 1e-4])
    inputs = random.random((30, 2)) * [3.0, 40.0]
    surface = np.sin(2.0 * inputs[:, 0]) + 0.002 * (inputs[:, 1] - 15.0) ** 2 + 0.05 * random.normal(size=30)
    points = random.random((6, 2)) * [3.0, 40.0]
    case("surface-52", "matern-52", inputs, surface, points, [1.5, 0.8, 25.0, 0.01])
    case("surface-32", "matern-32", inputs, surface, points, [1.5, 0.8, 25.0, 0.01])


if __name__ == "__main__":
    main()
