"""`hoodoo plan` predicts the CPU time of a run within 30 %; with `--rehearse 0` it ends immediately and predicts no time."""
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
import timed

JOBS = os.path.join(os.environ["HOODOO_TOP"], "jobs")
good = timed.compare("an arch", f"{JOBS}/demo.yaml", ["domain.spacing_m=2", "frames=1001-1010"], 1)
good &= timed.compare("goblins", f"{JOBS}/goblin_cube.yaml", ["domain.spacing_m=0.2", "frames=1001-1010"], 0.2)
silent = json.loads(subprocess.run([timed.HOODOO, "plan", f"{JOBS}/demo.yaml", "--rehearse", "0", "--json"], stdout=subprocess.PIPE, check=True).stdout)
quiet = "estimated_seconds" not in silent and silent["fits_in_memory"]
print("ok" if quiet else "not ok", "--rehearse 0 says no time")
sys.exit(not (good and quiet))
