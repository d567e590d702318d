"""A shot in real time that branches from a run in years gives the same bytes when it is stopped during the fall and resumed. So do blocks
that fall between frames of years, with any number of threads."""

import json
import os
import shutil
import subprocess
import sys

from script import HOODOO, finish, ok, tree

sys.dont_write_bytecode = True
YEARS = {
    "hoodoo": 1, "name": "years", "frames": "1001-1006", "clock": {"years_per_frame": 1000}, "seed": 5,
    "domain": {"size_m": [18, 10, 12], "spacing_m": 0.5},
    "scene": {"union": [{"box": {"min_m": [3, 3, 0], "max_m": [6, 7, 8]}}, {"box": {"min_m": [6, 3, 5], "max_m": [13, 7, 8]}}]},
    "strata": [{"weak_m_per_kyr": 0.05, "strong_m_per_kyr": 0.01, "interlock_MPa": 0.2}],
    "cameras": {"main": {"orbit": {"target_m": [8, 5, 5], "distance_m": 26}, "resolution": [96, 54]}},
    "output": {"aov": {"cameras": ["main"]}}, "checkpoint": {"every": 2, "keep": 9},
}
SHOT = {**YEARS, "name": "shot", "frames": "1003-1014", "clock": {"seconds_per_frame": 1 / 24},
        "collapse": {"strength_MPa": 1, "joints_m": 2, "joint_strength": 0.002}, "checkpoint": {"every": 3, "keep": 9}}
# A lintel on two pillars, one of which weathers fast, so that the lintel falls.
BLOCKS = {
    "hoodoo": 1, "name": "blocks", "frames": "1001-1008", "clock": {"years_per_frame": 1000}, "seed": 5,
    "domain": {"size_m": [16, 8, 12], "spacing_m": 0.5},
    "scene": {"union": [{"box": {"min_m": [2, 2, 0], "max_m": [14, 6, 2]}}, {"box": {"min_m": [7, 3, 2], "max_m": [8.5, 4.5, 5]}},
                        {"box": {"min_m": [4, 2, 5], "max_m": [12, 6, 8]}}]},
    "strata": [{"to_m": 2, "weak_m_per_kyr": 0.001, "strong_m_per_kyr": 0.001}, {"to_m": 5, "weak_m_per_kyr": 0.3, "strong_m_per_kyr": 0.3},
               {"weak_m_per_kyr": 0.02, "strong_m_per_kyr": 0.02}],
    "collapse": {"blocks": "fall", "strength_MPa": 2, "joints_m": 2, "rubble_m": 1},
    "output": {"vdb": {"codec": "none"}}, "checkpoint": {"every": 2, "keep": 9},
}


def run(job, out, *options, env=None):
    with open(job["name"] + ".json", "w") as file:
        json.dump(job, file)
    done = subprocess.run([HOODOO, "run", job["name"] + ".json", "--out", out, "--progress", "plain", *options], stderr=subprocess.PIPE,
                          stdin=subprocess.DEVNULL, text=True, timeout=300, env={**os.environ, **env} if env else None)
    return done.returncode, done.stderr


def lasting(path):
    return not path.startswith("log/")


def differences(a, b):
    """Compares two folders, except for checkpoints that only one of them has, since blocks end with a checkpoint."""
    return sorted(path for path in a.keys() | b.keys() if a.get(path) != b.get(path) and
                  (path in a and path in b or not path.startswith("checkpoint/")))


def manifest(out, name, frame):
    with open(os.path.join(out, "frames", f"{name}.{frame}.json")) as file:
        return json.load(file)


def adds_up(ledger):
    return ledger["start"] == ledger["rock"] + ledger["deposit"] + ledger["fallen"] + ledger["left"]


code, said = run(YEARS, "years")
ok(code == 0, "years", said)
code, said = run(SHOT, "whole", "--from", "years@1003")
ok(code == 0, "a shot from the third frame of years", said)
years, first, last = (manifest("years", "years", 1003)["ledger"], manifest("whole", "shot", 1003)["ledger"],
                      manifest("whole", "shot", 1014)["ledger"])
ok(first == years, "begins with its particles", years, first)
ok(adds_up(last) and last["fallen"] > 100, f"falls: {last['fallen']} of {last['start']} particles are in the air, and none is lost", last)
whole = tree("whole", lasting)
STOP = 1007  # during the fall
code, said = run(SHOT, "again", "--from", "years@1003", "--frames", f"1003-{STOP}")
ok(code == 0 and not os.path.exists(f"again/frames/shot.{STOP + 1}.json"), f"stopped after frame {STOP}", said)
code, said = run(SHOT, "again", "--from", "years@1003")
ok(code == 0 and not differences(tree("again", lasting), whole), "resumed: the same bytes", said, differences(tree("again", lasting), whole))

code, said = run(BLOCKS, "blocks")
ok(code == 0, "blocks fall between frames", said)
whole = tree("blocks", lasting)
ledgers = [manifest("blocks", "blocks", frame)["ledger"] for frame in range(1001, 1009)]
ok(all(adds_up(ledger) for ledger in ledgers), "the ledger adds up in every frame", *ledgers)
ok(ledgers[0]["fallen"] == 0 and ledgers[-1]["fallen"] > 0 and ledgers[-1]["deposit"] > 0,
   f"rubble and deposits lie at the end: {ledgers[-1]['fallen']} and {ledgers[-1]['deposit']} particles", *ledgers)
falls = next(frame for frame in range(1001, 1009) if ledgers[frame - 1001]["fallen"] > 0)
# A fall takes long, so the resumed run also uses another number of threads.
for stop, threads in ((max(falls - 1, 1002), ("0", "1")), (min(falls + 1, 1007), ("1", "2"))):
    shutil.rmtree("again", ignore_errors=True)
    run(BLOCKS, "again", "--frames", f"1001-{stop}", env={"LP_NUM_THREADS": threads[0]})
    code, said = run(BLOCKS, "again", env={"LP_NUM_THREADS": threads[1]})
    ok(code == 0 and not differences(tree("again", lasting), whole),
       f"stopped after frame {stop} (it falls in {falls}) with {threads[0]} threads, resumed with {threads[1]}: the same bytes", said,
       differences(tree("again", lasting), whole))
finish()
