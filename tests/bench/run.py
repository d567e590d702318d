#!/usr/bin/env python3
"""Runs the benches and keeps their results, or compares two of them.

    run.py BUILD [--only GLOB]... [--out FOLDER] [--without-peers]
    run.py compare A.json B.json

A bench is a program BUILD/tests/bench/NAME, or a script tests/bench/peers/NAME.py that times somebody else's program on
the same task. Each prints its rows as lines of JSON (bench.h, struct row); every other line is a remark and is shown.
A peer's row has no samples of ours: it is compared with the row of the same case that a bench printed before in the same
run. Peers that are not installed are named and left out.

FOLDER (BUILD/bench) then holds DATE-COMMIT.json and .md: the machine, device, commit, and for each case the median and
the spread (the middle half of the samples) of ours and of each peer, their ratio, and the goal. The exit code is 1 where
a bench failed, not where a goal is missed: seconds on a busy machine decide nothing.
"""
import argparse
import datetime
import fnmatch
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
# In this order: a peer after the bench whose case it repeats.
BENCHES = ["bench", "stress", "algebraic.py", "mpm", "taichi_mpm.py", "water", "fastscape.py", "wind", "arches", "goblins", "farm",
           "surface", "files"]
ABSENT = 77  # the exit code of a peer that is not installed


def spread(samples):
    """The bounds of the middle half."""
    if len(samples) < 3:
        return min(samples), max(samples)
    low, _, high = statistics.quantiles(samples, n=4, method="inclusive")
    return low, high


def number(x):
    return f"{x:.0f}" if abs(x) >= 1000 else f"{x:.3g}"


def measured(samples):
    if not samples:
        return ""
    low, high = spread(samples)
    median = number(statistics.median(samples))
    return median if len(samples) == 1 else f"{median} ({number(low)} to {number(high)})"


def ratio(row):
    if not row.get("theirs") or not row.get("ours"):
        return None
    return statistics.median(row["theirs"]) / statistics.median(row["ours"])


def goal(row):
    """Its text, and whether it is met (None: there is none)."""
    if "at_most" in row:
        return f"at most {row['at_most']:g}", statistics.median(row["ours"]) <= row["at_most"]
    if "at_least" in row and ratio(row) is not None:
        return f"{row['at_least']:.2g} times", ratio(row) >= row["at_least"]
    return "", None


def table(rows):
    lines = ["| case | unit | hoodoo | compared with | theirs | times as good | goal | |", "|---|---|---|---|---|---|---|---|"]
    for row in rows:
        text, met = goal(row)
        times = ratio(row)
        lines.append("| {} | {} | {} | {} | {} | {} | {} | {} |".format(
            row["case"], row.get("unit", ""), measured(row.get("ours")), row.get("peer", ""), measured(row.get("theirs")),
            "" if times is None else number(times), text, {None: "", True: "met", False: "missed"}[met]))
    return "\n".join(lines)


def machine(hoodoo):
    devices = subprocess.run([hoodoo, "devices"], capture_output=True, text=True, check=False).stdout.splitlines()
    cpu = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return {"cpu": cpu[0] if cpu else platform.machine(), "cores": len(os.sched_getaffinity(0)),
            "device": devices[0].split(None, 1)[1] if devices else "none",
            "driver": next((line.split("driver", 1)[1].strip() for line in devices if " driver " in f" {line.strip()} "), ""),
            "hoodoo": subprocess.run([hoodoo, "--version"], capture_output=True, text=True, check=True).stdout.strip(),
            "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "load": os.getloadavg()[0]}


def command(name, build):
    if name.endswith(".py"):
        python = build / "venv-bench" / "bin" / "python"
        return [str(python if python.exists() else sys.executable), str(TOP / "tests" / "bench" / "peers" / name)]
    return [str(build / "tests" / "bench" / name), str(build / "hoodoo")]


def run_one(name, build, folder, rows):
    """Adds the bench's rows; its exit code."""
    environment = dict(os.environ, BENCH_FOLDER=folder)
    process = subprocess.Popen(command(name, build), cwd=TOP, env=environment, stdout=subprocess.PIPE, text=True)
    for line in process.stdout:
        if not line.startswith("{"):
            print(line, end="", flush=True)
            continue
        row = json.loads(line)
        if "ours" not in row:
            same = [other["ours"] for other in rows if other["case"] == row["case"] and "ours" in other]
            if not same:
                print(f"    {row['peer']}: {row['case']} was not measured here, so there is nothing to compare with")
                continue
            row["ours"] = same[0]
        rows.append(row)
        print(table([row]).splitlines()[-1], flush=True)
    return process.wait()


def bench(arguments):
    build = pathlib.Path(arguments.build).resolve()
    rows, failed, absent = [], [], []
    facts = machine(str(build / "hoodoo"))
    names = [n for n in BENCHES if not arguments.only or any(fnmatch.fnmatch(n, glob) for glob in arguments.only)]
    if arguments.without_peers:
        names = [n for n in names if not n.endswith(".py")]
    if not names:
        sys.exit(f"run.py: no bench is named {' or '.join(arguments.only)}; there are {', '.join(BENCHES)}")
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            print(f"== {name}", flush=True)
            code = run_one(name, build, folder, rows)
            if code == ABSENT:
                absent.append(name)
            elif code != 0:
                failed.append(name)
                print(f"run.py: {name} ended with {code}", file=sys.stderr)
    out = pathlib.Path(arguments.out or build / "bench")
    out.mkdir(parents=True, exist_ok=True)
    stem = facts["date"].replace(":", "") + "-" + facts["hoodoo"].split("(")[-1].split(",")[0]
    kept = {"kind": "hoodoo bench", "format": 1, "machine": facts, "rows": rows, "failed": failed, "absent": absent}
    (out / f"{stem}.json").write_text(json.dumps(kept, indent=1) + "\n")
    head = f"{facts['hoodoo']},\non {facts['device']} ({facts['driver']}),\n{facts['cpu']}, {facts['cores']} cores, " \
           f"load {facts['load']:.1f} at the start, {facts['date']}."
    notes = [f"Not installed, and left out: {', '.join(absent)}."] if absent else []
    (out / f"{stem}.md").write_text("\n\n".join(["# Benches", head, table(rows), *notes]) + "\n")
    print(f"\n{out / stem}.json and .md hold the results")
    return 1 if failed else 0


def compare(first, second):
    """Of each row of both: the medians, and whether they differ by more than either's spread."""
    a, b = (json.load(open(path)) for path in (first, second))
    for path, kept in ((first, a), (second, b)):
        if kept.get("kind") != "hoodoo bench":
            sys.exit(f"run.py: {path} holds no results of a bench")
    for fact in ("cpu", "cores", "device", "driver"):
        if a["machine"][fact] != b["machine"][fact]:
            print(f"They are of different machines: {fact} {a['machine'][fact]} and {b['machine'][fact]}.\n")
    before = {(row["case"], row.get("unit")): row for row in a["rows"] if row.get("ours")}
    print("| case | unit | before | after | after / before | |\n|---|---|---|---|---|---|")
    seen = set()
    for row in b["rows"]:
        key = row["case"], row.get("unit")
        if key not in before or key in seen or not row.get("ours"):
            continue
        seen.add(key)
        old, new = before[key]["ours"], row["ours"]
        times = statistics.median(new) / statistics.median(old) if statistics.median(old) else float("nan")
        apart = spread(new)[0] > spread(old)[1] or spread(new)[1] < spread(old)[0]
        verdict = "" if not apart or abs(times - 1) < 0.05 else "more" if times > 1 else "less"
        print(f"| {row['case']} | {row.get('unit', '')} | {measured(old)} | {measured(new)} | {times:.2f} | {verdict} |")
    gone = [case for case, unit in before if (case, unit) not in seen]
    if gone:
        print(f"\nOnly in {first}: {', '.join(gone)}.")
    return 0


def main():
    if sys.argv[1:2] == ["compare"]:
        if len(sys.argv) != 4:
            sys.exit("usage: run.py compare A.json B.json")
        return compare(*sys.argv[2:])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--only", action="append")
    parser.add_argument("--out")
    parser.add_argument("--without-peers", action="store_true")
    return bench(parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
