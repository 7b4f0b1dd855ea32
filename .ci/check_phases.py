"""Checks that phases were found: the answers of `wakemix analyse phase --json` against what was published.

Bounds: van Vondelen et al. (2025), Wind Energ. Sci. 10, 2411, as docs/validation/synchronised-helix.md quotes it: coherence
above 0.8, root mean square errors of at most 82 degrees in tilt and 45 in yaw. A phase that knows nothing of the wind has 104
degrees, and a coherence below 0.55 in records of five segments, nineteen times in twenty.
"""

import json
import sys
from pathlib import Path

LEAST_COHERENCE = 0.8
MOST_RMSE_DEG = {"tilt": 82.0, "yaw": 45.0}


def check(path):
    answer = json.loads(path.read_text(encoding="utf-8"))
    where = f"{answer['turbine']} in {answer['run']}"
    for axis, most in MOST_RMSE_DEG.items():
        found = answer[axis]
        coherence, rmse = found["coherence"], found["rmse_deg"]
        assert coherence is not None, f"{where}: the record is too short for coherence; raise time.duration"
        assert coherence > LEAST_COHERENCE, f"{where}: coherence of {axis} is {coherence:.2f}, not above {LEAST_COHERENCE}"
        assert rmse <= most, f"{where}: phase error of {axis} is {rmse:.0f} degrees, at most {most:.0f} were published"
        print(f"{where}: {axis} coherence {coherence:.2f}, phase error {rmse:.0f} degrees")


for name in sys.argv[1:]:
    check(Path(name))
