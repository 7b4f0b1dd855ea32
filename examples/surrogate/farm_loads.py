"""Loads of a wind farm whose flow PyWake computes, by surrogates of `wakemix surrogate train`, through DTU's wind-farm-loads.

    pip install wind-farm-loads py_wake
    python3 farm_loads.py surrogates/T1.RootMyb1.del_m10.json surrogates/T1.TwrBsMyt.del_m4.json

The surrogates are those of docs/surrogate.md: wind speeds on the upper, right, lower and left quarter of the rotor, looking
downwind, turbulence intensities there as shares of the free stream, then the turn of the nacelle from the wind and the amplitude of
the helix, in degrees.
"""

import json
import pathlib
import sys

import numpy as np

SIDES = ("up", "right", "down", "left")
INPUTS = [f"sector_{side}.{what}" for what in ("wind_speed", "turbulence_intensity") for side in SIDES] + ["yaw_misalignment_deg", "amplitude_deg"]


class Surrogate:
    """What wind-farm-loads asks of a surrogate: `n_outputs`, `output_names` and `predict_output(x)` with a row for each case."""

    def __init__(self, path):
        model = json.loads(pathlib.Path(path).read_text())
        self.model = model
        self.input_names = [port["name"] for port in model["inputs"]]
        self.output_names = [model["output"]["name"]]
        self.n_outputs = 1
        self.points = np.array(model["points"])
        if not all(name.endswith(wanted) for name, wanted in zip(self.input_names, INPUTS, strict=True)):
            sys.exit(f"{path}: its inputs are {self.input_names}; train with {INPUTS}, in this order")

    def covariance(self, x):
        total = 0.0
        for term in self.model["kernel"]:
            product = term["variance"]
            for part in term["parts"]:
                if part["shape"] != "squared-exponential":
                    sys.exit(f"a kernel of {part['shape']}: train with --kernel se, or add its formula from predict.py")
                scaled = [(y[:, part["inputs"]] / part["lengths"]) for y in (x, self.points)]
                square = ((scaled[0][:, None, :] - scaled[1][None, :, :]) ** 2).sum(axis=2)
                product = product * np.exp(-0.5 * square)
            total = total + product
        return total

    def predict_output(self, x):
        x = np.asarray(x, dtype=float)
        trend = self.model["coefficients"][0] + x @ np.array(self.model["coefficients"][1:] or np.zeros(x.shape[1]))
        return (trend + self.covariance(x) @ np.array(self.model["weights"]))[:, None]


if __name__ == "__main__":
    from py_wake.deficit_models import NiayifarGaussianDeficit
    from py_wake.site import UniformSite
    from py_wake.site.shear import PowerShear
    from py_wake.turbulence_models import CrespoHernandez
    from py_wake.wind_turbines.generic_wind_turbines import GenericWindTurbine
    from wind_farm_loads.py_wake import PropagateDownwindNoSelfInduction
    from wind_farm_loads.tool_agnostic import compute_sector_average, predict_loads_sector_average

    surrogates = {model.output_names[0]: model for model in map(Surrogate, sys.argv[1:])}
    diameter = 284.0
    turbine = GenericWindTurbine("IEA 22 MW", diameter=diameter, hub_height=170.0, power_norm=22000.0)
    # Shear as where the surrogates were trained; a rotor's own wake is left out on its own disc.
    site = UniformSite(ti=0.04, shear=PowerShear(h_ref=170.0, alpha=0.1))
    farm = PropagateDownwindNoSelfInduction(site, turbine, NiayifarGaussianDeficit(), turbulenceModel=CrespoHernandez())
    flow = farm([0.0, 5.0 * diameter], [0.0, 0.0], wd=np.arange(260.0, 281.0, 2.0), ws=[8.0], yaw=0.0, tilt=0.0)
    sectors = compute_sector_average(flow, radius=10, n_azimuth_per_sector=5, align_in_tilt=False)
    yaw, amplitude = 0.0, 0.0
    loads = predict_loads_sector_average(surrogates, sectors, yaw, amplitude, ti_in_percent=False)
    print(loads.sel(ws=8.0).stack(case=["wt", "wd"]).T.to_pandas().round(0))
