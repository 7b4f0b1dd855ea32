"""Evaluates a surrogate of `wakemix surrogate train` in plain Python: python3 predict.py model.json 8.5 0.06 12.0"""

import json
import math
import sys


def shape(part, square):
    """Covariance over the squared distance in lengths."""
    r = math.sqrt(square)
    if part["shape"] in ("squared-exponential", "periodic"):
        return math.exp(-0.5 * square)
    if part["shape"] == "matern32":
        return (1.0 + math.sqrt(3.0) * r) * math.exp(-math.sqrt(3.0) * r)
    if part["shape"] == "matern52":
        return (1.0 + math.sqrt(5.0) * r + 5.0 / 3.0 * square) * math.exp(-math.sqrt(5.0) * r)
    return (1.0 + square / (2.0 * part["exponent"])) ** -part["exponent"]


def factor(part, a, b):
    away = [a[i] - b[i] for i in part["inputs"]]
    if part["shape"] == "periodic":
        away = [2.0 * math.sin(math.pi * d / part["period"]) for d in away]
    return shape(part, sum((d / length) ** 2 for d, length in zip(away, part["lengths"])))


def covariance(model, a, b):
    return sum(term["variance"] * math.prod(factor(part, a, b) for part in term["parts"]) for term in model["kernel"])


def mean(model, x):
    trend = sum(c * f for c, f in zip(model["coefficients"], [1.0, *x]))
    return trend + sum(w * covariance(model, x, p) for w, p in zip(model["weights"], model["points"]))


if __name__ == "__main__":
    print(mean(json.load(open(sys.argv[1])), [float(word) for word in sys.argv[2:]]))
