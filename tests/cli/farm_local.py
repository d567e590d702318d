"""submit --to local: dependencies, failures, stops, wedges and hostile names; the files equal those of `hoodoo run`."""

import json
import os
import re
import signal
import subprocess
import time

from script import HOODOO, TOP, ask, clear_meshes, finish, hoodoo, obstruct_meshes, of_a_run, ok, tree

PATIENCE = 180

with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as f:
    text = f.read()
FARM = "farm: {block_frames: 5, chunk_frames: 3, meshes: true, still_every: 11, turntable: 0, retries: 1}\n"
with open("plain.yaml", "w") as f:
    f.write(text + FARM)
with open("wedges.csv", "w") as f:
    f.write('seed,wind.speed_m_s\n3,"{1001: 9, 1012: 12}"\n4,8\n')
with open("wedges.yaml", "w") as f:
    f.write(text + FARM + "wedge: {csv: wedges.csv}\n")

# Two wedges from a CSV file, on two workers.
code, said = hoodoo("submit", "wedges.yaml", "--to", "local", "--workers", "2", "--out", "two")
lines = [line.split("hoodoo: ")[-1] for line in said.splitlines()]
ok(code == 0 and os.path.exists("two/twelve.wedges.png"), "two wedges on two workers, to the sheet across them", said)
with open("two/farm/job.yaml") as f:
    frozen = f.read()
ok("wedges.csv" not in frozen and "{1001: 9, 1012: 12}" in frozen, "the job as submitted holds the CSV file's values", frozen[-800:])
done = {line.split(":")[0] for line in lines if ": done in " in line}
order = [line.split(":")[0] for line in lines if ": started by" in line or ": done in" in line]
code, plan = hoodoo("plan", "wedges.yaml", "--json")
tasks = {t["name"]: t for t in json.loads(plan)["tasks"]}
ok(done == set(tasks), "every task of the plan was done", sorted(done ^ set(tasks)))
bad = [(name, before) for name, t in tasks.items() for before in t["after"]
       if order.index(name) < len(order) - 1 - order[::-1].index(before)]
ok(not bad, "none before what it waits for", bad)
for wedge in (1, 2):
    hoodoo("run", "wedges.yaml", f"--wedge={wedge}", "--device", "cpu", "--out", f"alone{wedge}", "--progress", "none")
    hoodoo("mesh", f"alone{wedge}")
    here, there = tree(f"two/w000{wedge}", of_a_run), tree(f"alone{wedge}", of_a_run)
    ok(here == there and len(here) > 60, f"wedge {wedge}: the files of a run alone, byte for byte",
       sorted(p for p in here.keys() | there.keys() if here.get(p) != there.get(p)))
with open("two/w0002/run.json") as f:
    run = json.load(f)
ok(run["name"] == "twelve_w0002" and run["wedge"] == 2 and run["wedge_values"] == "seed=4, wind.speed_m_s=8", "a wedge knows its index and values", run)
code, said = hoodoo("submit", "wedges.yaml", "--to", "local", "--workers", "2", "--out", "two")
ok(code == 0 and "started" not in said, "the same command again has nothing to do", said)
code, said = hoodoo("status", "two", "--json")
status = json.loads(said)
ok(code == 0 and status["tasks_done"] == status["task_count"] and [w["done"] for w in status["wedges"]] == [12, 12], "status says so", said)

# Sheets are made again when a still is another one, not when it is younger.
def sheets_to_make():
    code, said = hoodoo("status", "two", "--json")
    return sorted(t["task"] for t in json.loads(said)["tasks"] if t["state"] != "done" and t["task"] != "end")


still = "two/w0002/preview/twelve_w0002.1012.png"
os.utime(still, (time.time() + 9999, time.time() + 9999))
ok(sheets_to_make() == [], "a still that was only copied leaves its sheets as they are", sheets_to_make())
hoodoo("preview", "two/w0002", "--frames", "1012", "--only", "stills", "--resolution", "128x64")
os.utime(still, (1e9, 1e9))
ok(sheets_to_make() == ["w0002.sheet", "wedges"], "sheets that show an earlier still are made again", sheets_to_make())
code, said = hoodoo("submit", "wedges.yaml", "--to", "local", "--workers", "2", "--out", "two")
ok(code == 0 and sheets_to_make() == [], "and are current then", said)

code, said = hoodoo("verify", "two", "--json")
found = json.loads(said[:said.rindex("}") + 1])
ok(code == 0 and found["frames"] == 24 and found["products"] > 20, "verify reads every wedge and what is made of all", said[-600:])
with open("two/w0002/mesh/twelve_w0002.1003.ply", "r+b") as f:
    f.truncate(100)
os.remove("two/w0001/frames/twelve_w0001.1002.json")
os.remove("two/records/twelve.wedges.png.json")
code, said = hoodoo("verify", "two", "--json")
found = json.loads(said[:said.rindex("}") + 1])
named = {problem["file"] for problem in found["problems"]}
made = [ask("sh", "-c", '"$HOODOO"' + command[len("hoodoo"):]) for command in found["commands"]]
ok(code == 3 and {"w0002/mesh/twelve_w0002.1003.ply", "w0001/frames/twelve_w0001.1002.json", "twelve.wedges.png"} <= named and
   all(code == 0 for code, _ in made), "names what is damaged in a wedge, and the commands that make it again", found, made)
code, said = hoodoo("verify", "two")
ok(code == 0, "after them, all is well", said[-600:])
code, said = hoodoo("submit", "wedges.yaml", "--to", "local", "--out", "two", "--set", "wind.abrasion=0.9")
ok(code == 7 and "holds another job" in said and "w0001" in said, "another job is refused the folder before anything starts", code, said)

# A temporary failure, a permanent one, and the tasks that depend on it.
obstruct_meshes("fails", "twelve", range(1001, 1013))
code, said = hoodoo("submit", "plain.yaml", "--to", "local", "--workers", "1", "--out", "fails")
ok(code == 4 and said.count("it will be retried") >= 1 and "failed permanently" in said and "Is a directory" in said and
   "sim.1011-1012: done" in said and "\r" not in said, "a task that keeps failing is tried twice; the rest is done; the log says why", code, said)
clear_meshes("fails")
code, said = hoodoo("submit", "plain.yaml", "--to", "local", "--workers", "1", "--out", "fails")
ok(code == 0 and "sim." not in "".join(l for l in said.splitlines() if "started" in l) and len(os.listdir("fails/mesh")) == 3 * 12 + 1,
   "with its cause gone the same command does what is left", code, said)


# Stopped at any moment by any signal, then resumed.
def stop_after(out, frames, number, times=1, group=False):
    child = subprocess.Popen([HOODOO, "submit", "plain.yaml", "--to", "local", "--workers", "2", "--out", out], stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, start_new_session=True)
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and child.poll() is None:
        if os.path.isdir(out + "/frames") and len([n for n in os.listdir(out + "/frames") if n.endswith(".json")]) >= frames:
            break
        time.sleep(0.002)
    for _ in range(times):
        (os.killpg if group else os.kill)(child.pid, number)
    said = child.communicate(timeout=PATIENCE)[0]
    return child.returncode, said


alone = tree("fails", of_a_run)
for frames, number, times in ((1, signal.SIGTERM, 1), (4, signal.SIGINT, 3), (7, signal.SIGUSR1, 1)):
    code, said = stop_after("halted", frames, number, times)
    ok(code == 85 and "run the same command again" in said and not os.path.exists("halted/lock"),
       f"{signal.Signals(number).name} after {frames} frames: everything saved, exit 85", code, said)
code, said = stop_after("halted", 9, signal.SIGKILL)
time.sleep(3)  # its children receive the signal and save
left = []
for pid in filter(str.isdigit, os.listdir("/proc")):
    try:
        with open(f"/proc/{pid}/cmdline", "rb") as f:
            line = f.read()
    except OSError:
        continue  # the run has ended meanwhile
    if b"halted" in line and b"run\0" in line:
        left.append(pid)
ok(code == -signal.SIGKILL and not left, "killed: its children do not stay", code, left)
code, said = hoodoo("submit", "plain.yaml", "--to", "local", "--workers", "2", "--out", "halted")
here = tree("halted", of_a_run)
ok(code == 0 and here == alone, "and the same command goes on, to the same bytes", code, sorted(p for p in here.keys() | alone.keys() if here.get(p) != alone.get(p)), said)
with open("halted/log/run.log") as f:
    times = re.findall(r" frame (\d+), \d+/", f.read())
ok(sorted(set(times)) == [str(n) for n in range(1001, 1013)] and len(times) <= 13, "no frame was written twice, but where it was killed", times)

# Hostile names: two as working folders, others only passed on.
NAMES = ("it's $(touch pwned) `touch pwned`\nopenjd_env: A=B\n", "-rf é岩 ;touch pwned %j\\%A", "..", "two words", "{{Param.X}}", "*")
for i, name in enumerate(NAMES):
    out = os.path.join(f"names{i}", name, "deep")
    few = ("--set", "frames=1001-1002", "--set", "farm.still_every=0", "--set", "farm.meshes=false")
    if i < 2:
        code, said = hoodoo("submit", "plain.yaml", "--to", "local", "--workers", "1", "--out", out, *few)
        ok(code == 0 and not [line for line in said.splitlines() if line.startswith("openjd_")] and len(os.listdir(os.path.join(out, "frames"))) == 2,
           f"a folder called {name!r}", code, said)
    code, said = hoodoo("submit", "plain.yaml", "--to", "slurm", "--dry-run", "--out", out, *few, "--", "--comment=$(touch pwned)")
    ok(code == 0 and not [line for line in said.splitlines() if line.startswith("openjd_")], f"and for Slurm, {name!r}", said)
ok(not any("pwned" in names for _, _, names in os.walk(".")), "nothing of a name was run")
for value in ("../x", "a b", "$(touch pwned)", "a\nb", ""):
    code, said = hoodoo("submit", "plain.yaml", "--to", "local", "--set", f"name={json.dumps(value)}", "--dry-run")
    ok(code == 2 and "not a name" in said or "is expected" in said or "control" in said or "holds" in said, f"a job called {value!r} is refused", code, said)
for wedge, word in (("[{key: name, values: [x]}]", "cannot differ"), ("[{key: nosuch, values: [1]}]", "unknown key"), ("[{key: seed, values: []}]", "without values"),
                    ("[{key: seed, values: [1, 2]}, {key: fps, values: [1]}]", "the same length"), ("[{key: seed, values: [-5]}]", "out of range"),
                    ("[{key: 'x=1; touch pwned', values: [1]}]", "")):
    with open("bad.yaml", "w") as f:
        f.write(text + f"wedge: {{over: {wedge}}}\n")
    code, said = hoodoo("plan", "bad.yaml")
    ok(code == 2 and word in said, f"wedge {wedge} is refused", code, said)
for body, word in (("seed\n", "no line of values"), ("seed\n1,2\n", "more fields"), ("seed,fps\n1\n", "fewer fields"), ('seed\n"1\n', "spans several lines"), ('seed\n"1', "quote"), ("seed\n\x01\n", "control"), ("", "no line")):
    with open("wedges.csv", "w") as f:
        f.write(body)
    code, said = hoodoo("plan", "wedges.yaml")
    ok(code == 3 and word in said, f"a CSV file of {body!r} is refused", code, said)
finish()
