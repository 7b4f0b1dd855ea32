#!/usr/bin/env python3
"""Reads the results of a campaign as pandas and pyarrow do: Parquet and CSV must hold the same values, units and types.

    python3 -m venv .venv && .venv/bin/pip install pandas pyarrow
    .venv/bin/python validation/scripts/campaign_by_pandas.py target/release/wakemix CAMPAIGN_FOLDER
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pandas
import pyarrow.parquet

program, campaign = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    for name in ("results.csv", "results.parquet"):
        path = str(Path(folder, name))
        subprocess.run([program, "campaign", "collect", campaign, "-o", path, "-q"], check=True)
    table = pandas.read_parquet(Path(folder, "results.parquet"))
    units = json.loads(pyarrow.parquet.read_schema(Path(folder, "results.parquet")).metadata[b"units"])
    # Its usual reader of numbers may miss the last bit; Python's own does not.
    text = pandas.read_csv(Path(folder, "results.csv"), engine="python")
headings = [re.fullmatch(r"(.+?)(?: \[(.+)\])?", heading).groups() for heading in text.columns]
assert [name for name, _ in headings] == list(table.columns), "other columns"
for name, unit in headings:
    assert units.get(name, "–") == (unit or "–"), f"{name}: {unit} and {units.get(name)}"
text.columns = table.columns
assert not table.duplicated("task").any()
for name in table.columns:
    own, other = table[name], text[name]
    if own.dtype.kind in "if":
        assert (own.isna() == other.isna()).all() and (own.dropna() == other.dropna()).all(), name
    else:
        assert (own.dropna().astype(str) == other.dropna().astype(str)).all(), name
print(f"{len(table)} rows, {len(table.columns)} columns, {len(units)} units: Parquet and CSV hold the same")
