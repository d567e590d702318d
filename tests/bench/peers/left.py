"""What our benches leave in BENCH_FOLDER for the peers that repeat their cases."""
import os
import sys

ABSENT = 77  # the exit code of a peer that is not installed, or has nothing to compare with (run.py)


def left_by(bench, name):
    """The path of the file `name` that the bench has left. Ends the script, as absent, if there is none."""
    path = os.path.join(os.environ.get("BENCH_FOLDER", "."), name)
    if not os.path.exists(path):
        print(f"    {os.path.basename(sys.argv[0])}: the bench {bench} has left no {name}; run it in the same run")
        sys.exit(ABSENT)
    return path
