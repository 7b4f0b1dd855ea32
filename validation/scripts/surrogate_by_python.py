"""Holds predictions of `wakemix surrogate` against examples/surrogate/predict.py, which reads the same model.

    python3 validation/scripts/surrogate_by_python.py target/release/wakemix

Trains with every shape of kernel and every trend on a made-up table with replicates, predicts, and evaluates the
model file in plain Python. Ends with 1 where a mean differs by more than 1e-10 of the spread of the output.
"""

import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "examples" / "surrogate"))
import predict  # noqa: E402

CASES = [
    ("se", "zero"), ("matern32", "constant"), ("matern52", "linear"), ("rq", "constant"),
    ("se(wind,turbulence)*periodic(direction:360)+matern32", "linear"),
]


def table(path, n, seed):
    draw = random.Random(seed)
    with open(path, "w") as file:
        file.write("wind [m/s],turbulence,direction [deg],load [MN-m]\n")
        for row in range(n):
            if row % 4 != 3:
                wind, turbulence, direction = draw.uniform(6, 12), draw.uniform(0.02, 0.12), draw.uniform(0, 360)
            load = 5 + 0.4 * wind + 20 * turbulence + math.sin(math.radians(direction)) + draw.gauss(0, 0.1)
            file.write(f"{wind},{turbulence},{direction},{load}\n")


def main():
    program, worst = sys.argv[1], 0.0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        table(folder / "train.csv", 120, 1)
        table(folder / "asked.csv", 40, 2)
        for kernel, trend in CASES:
            model, out = folder / "model.json", folder / "out.csv"
            subprocess.run([program, "-q", "surrogate", "train", folder / "train.csv", "--inputs",
                            "wind,turbulence,direction", "--output", "load", "--kernel", kernel, "--trend", trend,
                            "--starts", "2", "-o", model], check=True, stdout=subprocess.DEVNULL)
            for more in ([], ["--means"]):
                subprocess.run([program, "-q", "surrogate", "predict", model, folder / "asked.csv", "-o", out, *more],
                               check=True)
                stored = json.load(open(model))
                values = stored["observations"]["values"]
                middle = sum(values) / len(values)
                spread = math.sqrt(sum((value - middle) ** 2 for value in values) / len(values))
                rows = list(csv.reader(open(out)))[1:]
                for row in rows:
                    numbers = [float(word) for word in row]
                    worst = max(worst, abs(predict.mean(stored, numbers[:3]) - numbers[3]) / spread)
            print(f"{kernel}, {trend}: largest difference so far {worst:.1e} of the spread")
    return 1 if worst > 1e-10 else 0


if __name__ == "__main__":
    sys.exit(main())
