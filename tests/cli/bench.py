"""The harness of the benches: rows of several peers, spreads, goals, comparison of two results, and what is missing."""
import json
import os
import pathlib
import subprocess
import sys

from script import HOODOO, TOP, finish, ok

RUN = [sys.executable, f"{TOP}/tests/bench/run.py"]


def build(name, rows, code=0):
    """A build folder whose benches `bench` and `farm` print given rows."""
    bench = pathlib.Path(name) / "tests" / "bench"
    bench.mkdir(parents=True)
    os.symlink(HOODOO, pathlib.Path(name) / "hoodoo")
    for program, text in (("bench", rows), ("farm", [])):
        file = bench / program
        lines = "\n".join(row if isinstance(row, str) else json.dumps(row) for row in text)
        file.write_text(f"#!/bin/sh\ncat <<'END'\n{lines}\nEND\nexit {code if program == 'farm' else 0}\n")
        file.chmod(0o755)


def run(*arguments):
    return subprocess.run(RUN + list(arguments), capture_output=True, text=True, check=False)


def results(folder):
    return next(pathlib.Path(folder).glob("*.json"))


ONLY = ["--only", "bench", "--only", "farm"]
OURS = {"case": "x: one", "unit": "ms", "ours": [10, 11, 12, 13, 30]}
build("a", ["a remark", dict(OURS, peer="plain C", theirs=[24, 24, 24], at_least=3), {"case": "x: one", "unit": "ms",
      "peer": "another", "theirs": [60], "at_least": 3}, {"case": "x: count", "unit": "", "ours": [16], "at_most": 15},
      {"case": "y: alone", "unit": "ms", "peer": "another", "theirs": [1]}])
ran = run("a", *ONLY, "--out", "ra")
ok(ran.returncode == 0, "a bench runs", ran.stdout + ran.stderr)
ok("a remark" in ran.stdout, "its remarks are shown", ran.stdout)
ok("y: alone was not measured here" in ran.stdout, "a peer's row without a bench's is named", ran.stdout)
kept = json.loads(results("ra").read_text())
ok(all(kept["machine"][key] for key in ("cpu", "cores", "device", "driver", "hoodoo", "date")), "the machine is recorded",
   kept["machine"])
ok(kept["rows"][1]["ours"] == OURS["ours"], "a later peer gets the samples of the bench", kept["rows"])
page = next(pathlib.Path("ra").glob("*.md")).read_text()
ok("| x: one | ms | 12 (11 to 13) | plain C | 24 (24 to 24) | 2 | 3 times | missed |" in page,
   "medians, the middle half, ratio and a missed goal", page)
ok("| x: one | ms | 12 (11 to 13) | another | 60 | 5 | 3 times | met |" in page, "a goal that is met", page)
ok("| x: count |  | 16 |  |  |  | at most 15 | missed |" in page, "a limit that is passed", page)

build("b", [dict(OURS, ours=[20, 21, 22, 23, 24]), {"case": "x: count", "unit": "", "ours": [16]}, {"case": "new", "unit": "s", "ours": [1]}],
      code=5)
ran = run("b", *ONLY, "--out", "rb")
ok(ran.returncode == 1 and "farm ended with 5" in ran.stderr, "a bench that fails is named, and the code is 1", ran.stderr)
ran = run("compare", str(results("ra")), str(results("rb")))
ok("| x: one | ms | 12 (11 to 13) | 22 (21 to 23) | 1.83 | more |" in ran.stdout, "a difference beyond the spreads is told",
      ran.stdout)
ok("| x: count |  | 16 | 16 | 1.00 |  |" in ran.stdout, "equal is not", ran.stdout)
pathlib.Path("none.json").write_text("{}")
ran = run("compare", "none.json", str(results("rb")))
ok(ran.returncode == 1 and "none.json holds no results" in ran.stderr, "what is no result is refused", ran.stderr)
ran = run("a", "--only", "nothing")
ok(ran.returncode == 1 and "no bench is named nothing" in ran.stderr, "an unknown bench is refused", ran.stderr)
finish()
