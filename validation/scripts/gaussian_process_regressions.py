"""Makes the ten data sets that `wakemix validate gaussian-process` compares with scikit-learn on.

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6 scipy==1.17.1 scikit-learn==1.9.1
    .venv/bin/python validation/scripts/gaussian_process_regressions.py > validation/data/surrogate/regressions.json

Each from a fixed seed, with a kernel of its own: log marginal likelihood, posterior means and variances of the curve
(noise left out) at hyperparameters that are given, and the highest log marginal likelihood of ten starts, between the
bounds that wakemix searches between. All means are zero. Replicates are rows of their own for scikit-learn.
"""

import json
import sys
import warnings

import numpy as np
import sklearn
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import (
    RBF, ConstantKernel, ExpSineSquared, Matern, RationalQuadratic, WhiteKernel)


def part(shape, lengths, **more):
    return {"shape": shape, "lengths": lengths, **more}


def of_part(part, spans):
    """scikit-learn's kernel of one part, with the bounds that wakemix uses."""
    lengths, shape = part["lengths"], part["shape"]
    wide = [(1e-2 * span, 1e2 * span) for span in spans]
    if shape == "periodic":
        return ExpSineSquared(lengths[0], part["period"], (0.05, 50.0), "fixed")
    if shape == "rational-quadratic":
        return RationalQuadratic(lengths[0], part["exponent"], wide[0], (1e-2, 1e3))
    if shape == "squared-exponential":
        return RBF(lengths, wide)
    return Matern(lengths, wide, nu=1.5 if shape == "matern-32" else 2.5)


def of_terms(terms, spans, spread):
    kernel = None
    for term in terms:
        product = ConstantKernel(term["variance"], (1e-4 * spread, 1e4 * spread))
        for factor in term["parts"]:
            product = product * of_part(factor, spans)
        kernel = product if kernel is None else kernel + product
    return kernel


def case(name, terms, noise, inputs, values, points, known=None):
    spread, spans = np.mean(values**2), np.ptp(inputs, axis=0)
    known = np.zeros(len(values)) if known is None else known
    kernel = of_terms(terms, spans, spread)
    fixed = GaussianProcessRegressor(kernel, alpha=known + noise, optimizer=None).fit(inputs, values)
    means, covariance = fixed.predict(points, return_cov=True)
    noisy = kernel + WhiteKernel(noise, (1e-8 * spread, 1e2 * spread))
    best = GaussianProcessRegressor(noisy, alpha=known, n_restarts_optimizer=9, random_state=1).fit(inputs, values)
    print(name, best.kernel_, best.log_marginal_likelihood_value_, file=sys.stderr)
    return {
        "name": name, "terms": terms, "noise": noise,
        "inputs": inputs.ravel().tolist(), "values": values.tolist(), "known": known.tolist(),
        "points": points.ravel().tolist(),
        "log": fixed.log_marginal_likelihood_value_,
        "means": means.tolist(), "variances": np.diag(covariance).tolist(),
        "best_log": best.log_marginal_likelihood_value_,
    }


def one(variance, *parts):
    return [{"variance": variance, "parts": list(parts)}]


def main():
    warnings.filterwarnings("ignore")
    random = np.random.default_rng(4)
    normal, uniform = random.normal, random.random
    cases = []

    x = 10.0 * uniform((30, 1))
    y = np.sin(x[:, 0]) + 0.1 * normal(size=30)
    cases.append(case("curve, squared exponential", one(1.2, part("squared-exponential", [1.4])), 0.02, x, y, 10.0 * uniform((12, 1))))

    x = 10.0 * uniform((40, 1))
    y = np.exp(-x[:, 0]) + 0.3 * np.sin(0.7 * x[:, 0]) + 0.05 * normal(size=40)
    cases.append(case("curve, rational quadratic", one(0.6, part("rational-quadratic", [0.9], exponent=0.7)), 0.004, x, y, 10.0 * uniform((12, 1))))

    x = 2.0 * np.pi * uniform((24, 1))
    y = 0.3 * np.cos(x[:, 0] - 1.0) + 0.1 * np.sin(2.0 * x[:, 0]) + 0.03 * normal(size=24)
    cases.append(case("phase offset, periodic", one(0.1, part("periodic", [1.1], period=2.0 * np.pi)), 0.001, x, y, 7.0 * uniform((12, 1))))

    x = uniform((40, 2)) * [0.5, 4.0]
    y = np.sin(6.0 * x[:, 0]) + 0.2 * (x[:, 1] - 1.5) ** 2 + 0.05 * normal(size=40)
    cases.append(case("Strouhal number and amplitude, Matérn 3/2", one(1.5, part("matern-32", [0.3, 3.0])), 0.003, x, y, uniform((12, 2)) * [0.5, 4.0]))

    x = np.repeat(uniform((25, 2)) * [0.5, 4.0], 3, axis=0)
    y = np.cos(5.0 * x[:, 0]) * x[:, 1] + 0.3 * normal(size=75)
    cases.append(case("replicates, Matérn 5/2", one(4.0, part("matern-52", [0.25, 3.5])), 0.08, x, y, uniform((12, 2)) * [0.5, 4.0]))

    x = uniform((60, 3)) * [1.0, 30.0, 0.2]
    y = np.sin(3.0 * x[:, 0]) + 0.03 * x[:, 1] + 5.0 * x[:, 2] ** 2 + 0.02 * normal(size=60)
    cases.append(case("three inputs, squared exponential", one(1.0, part("squared-exponential", [0.8, 40.0, 0.3])), 0.001, x, y, uniform((12, 3)) * [1.0, 30.0, 0.2]))

    weights = normal(size=10)
    for shape, name in [("squared-exponential", "squared exponential"), ("matern-32", "Matérn 3/2")]:
        x = uniform((150, 10))
        y = np.sin(x @ weights) + x[:, 0] * x[:, 1] + 0.1 * normal(size=150)
        cases.append(case(f"ten inputs, {name}", one(1.0, part(shape, [1.5] * 10)), 0.02, x, y, uniform((12, 10))))

    x = np.sort(12.0 * uniform((50, 1)), axis=0)
    y = 0.1 * x[:, 0] + np.sin(2.0 * np.pi * x[:, 0] / 1.5) + 0.1 * normal(size=50)
    cases.append(case("sum, squared exponential and periodic", one(1.0, part("squared-exponential", [6.0])) + one(0.8, part("periodic", [1.2], period=1.5)), 0.02, x, y, 12.0 * uniform((12, 1))))

    x = np.sort(12.0 * uniform((50, 1)), axis=0)
    y = np.exp(-0.1 * x[:, 0]) * np.sin(2.0 * np.pi * x[:, 0] / 2.0) + 0.05 * normal(size=50)
    known = (0.03 + 0.05 * uniform(50)) ** 2
    cases.append(case("product, squared exponential and periodic, known noise", one(0.7, part("squared-exponential", [5.0]), part("periodic", [1.5], period=2.0)), 0.001, x, y, 12.0 * uniform((12, 1)), known))

    versions = f"scikit-learn {sklearn.__version__}, numpy {np.__version__}"
    print(json.dumps({"versions": versions, "cases": cases}, ensure_ascii=False))


if __name__ == "__main__":
    main()
