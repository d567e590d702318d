"""What `hoodoo plan` says of memory is within 10 % of what a run takes, for every job that is shipped, at its own spacing and at one and
a half times that."""
import glob
import os
import re
import sys

sys.dont_write_bytecode = True
TOP = os.environ["HOODOO_TOP"]
sys.path.insert(0, os.path.join(TOP, "tests/cli/lib"))
import peak

for job in sorted(glob.glob(os.path.join(TOP, "jobs/*.yaml"))):
    with open(job) as file:
        text = file.read()
    first, spacing = int(re.search(r"^frames: (\d+)-", text, re.M)[1]), float(re.search(r"spacing_m: ([\d.]+)", text)[1])
    # Terrain has its largest surface after its last tools.
    last = int(re.search(r"^frames: \d+-(\d+)", text, re.M)[1]) if "model: arches" in text else first + 3
    for s in (1.5 * spacing, spacing):
        peak.compare(f"{os.path.basename(job)} at {s:g} m", job, f"{first}-{last}", [f"domain.spacing_m={s:g}"])
sys.exit(peak.failed)
