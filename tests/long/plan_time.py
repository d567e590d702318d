"""What `hoodoo plan` says of time is within 30 % of the CPU time taken, for every job that is shipped, over all of its frames, at two and a half times
its own spacing; and of one job at its own, which is too large to be rehearsed whole."""
import glob
import os
import re
import sys

sys.dont_write_bytecode = True
TOP = os.environ["HOODOO_TOP"]
sys.path.insert(0, os.path.join(TOP, "tests/cli/lib"))
import timed

good = True
for job in sorted(glob.glob(os.path.join(TOP, "jobs/*.yaml"))):
    with open(job) as file:
        spacing = float(re.search(r"spacing_m: ([\d.]+)", file.read())[1])
    good &= timed.compare(f"{os.path.basename(job)} at {2.5 * spacing:g} m", job, [f"domain.spacing_m={2.5 * spacing:g}"], 10)
good &= timed.compare("demo.yaml", os.path.join(TOP, "jobs/demo.yaml"), [], 30)
sys.exit(not good)
