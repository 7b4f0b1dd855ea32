"""Checks that a study left records that other programs can read: summary.json, series.csv, report.html."""

import csv
import json
import math
import sys
from pathlib import Path


WARNINGS = {"setup", "pitch-held-back", "controller", "tip-speed"}


def check_control(turbine):
    control, delivered = turbine["control"], turbine["delivered_pitch"]
    assert control["description"], f"{turbine['name']} has no description of its control"
    excitation = control["excitation"]
    assert (excitation is None) == (control["kind"] == "baseline"), f"{turbine['name']}: {control}"
    if excitation is not None and delivered is not None:
        assert excitation["sense"] in ("cw", "ccw", None), excitation["sense"]
        difference = abs(excitation["amplitude_deg"] - delivered["commanded_amplitude_deg"])
        assert difference < 1e-9, f"{turbine['name']} was set to and commanded amplitudes {difference}° apart"


def check_loads(turbine, is_compared):
    loads = {(load["channel"], load["kind"]): load for load in turbine["loads"]}
    assert len(loads) == len(turbine["loads"]), f"{turbine['name']} has a load twice"
    for channel, slope in [("RootMyb1", 10), ("TwrBsMyt", 4)]:
        assert loads[channel, "deviation"]["value"] > 0, f"{turbine['name']}: {channel} does not vary"
        load = loads[channel, "damage-equivalent"]
        assert load["unit"] == "kN m" and load["slope"] == slope, load
        assert load["value"] > 0 and load["reference_frequency_hz"] == 1, load
        assert (load["change"] is not None) == is_compared, load


def check_run(folder):
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["schema_version"] == 3, f"docs/summary.md is of version 3, not {summary['schema_version']}"
    assert summary["run"] == folder.name, f"the summary of {folder.name} says {summary['run']}"
    for turbine in summary["turbines"]:
        power = turbine["power"]["mean"]
        assert 1e5 < power < 1e8, f"{turbine['name']} makes {power} W"
        check_control(turbine)
        check_loads(turbine, is_compared=summary["compare_with"] is not None)
    for warning in summary["warnings"]:
        assert warning["kind"] in WARNINGS and warning["message"], f"no warning: {warning}"
    with open(folder / "series.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names, samples = rows[0], rows[1:]
    assert names[0] == "Time_s", f"the first column is {names[0]}"
    assert len(samples) > 100, f"{len(samples)} samples"
    for number, row in enumerate(samples, start=2):
        assert len(row) == len(names), f"line {number} has {len(row)} of {len(names)} values"
        assert all(math.isfinite(float(value)) for value in row), f"line {number} has no number"
    print(f"{folder.name}: {len(summary['turbines'])} turbines, {len(samples)} samples of {len(names)} channels")
    return summary


def main(study):
    runs = [check_run(path.parent) for path in sorted(study.glob("*/summary.json"))]
    assert len(runs) == 2, f"{len(runs)} runs, not 2"
    compared = [run for run in runs if run["compare_with"] is not None]
    assert len(compared) == 1, "one run compares with the other"
    assert compared[0]["array_power_gain"] is not None, "the compared run has no gain"
    report = (study / "report.html").read_text(encoding="utf-8")
    assert "</html>" in report, "the report is cut off"
    for elsewhere in ('src="http', "src='http", 'href="http://', "@import"):
        assert elsewhere not in report, f"the report needs something from elsewhere: {elsewhere}"
    print(f"report.html: {len(report) / 1e3:.0f} kB, self-contained")


main(Path(sys.argv[1]))
