"""A local farm's cancel, retry, status, logs and end hook; and templates for very long jobs, within OpenJD's limits."""

import json
import os
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from script import HOODOO, clear_meshes, finish, hoodoo, obstruct_meshes, ok

TINY = """hoodoo: 1
name: tiny
frames: 1-{last}
clock: {{years_per_frame: 500}}
domain: {{size_m: [8, 8, 8], spacing_m: 1}}
scene: {{box: {{min_m: [2, 2, 0], max_m: [6, 6, 6]}}}}
farm: {{block_frames: {block}, meshes: true, still_every: 0, turntable: 0, retries: 1, on_done: [sh, -c, 'echo "$HOODOO_STATE $HOODOO_TASKS_DONE/$HOODOO_TASKS" >>../hook.log']}}
"""


def read(path):
    if not os.path.exists(path):
        return ""
    with open(path) as f:
        return f.read()


def status(out):
    code, said = hoodoo("status", out, "--json")
    answer = json.loads(said[said.index("{"):])
    return {t["task"]: t for t in answer["tasks"]}


with open("job.yaml", "w") as f:
    f.write(TINY.format(last=4, block=2))
with open("long.yaml", "w") as f:
    f.write(TINY.format(last=4000, block=2000))

# A failure: what status says, and retry.
obstruct_meshes("out", "tiny", range(1, 5))
code, said = hoodoo("submit", "job.yaml", "--to", "local", "--workers", "1", "--out", "out")
ok(code == 4 and read("hook.log") == "failed 2/4\n", "a job that fails ends with its hook, told so", code, said, read("hook.log"))
t = status("out")["mesh.1-2"]
ok(t["state"] == "failed" and t["tries"] == 2 and t["exit"] == "4" and t["meaning"] == "output cannot be written" and t["node"] == os.uname().nodename and
   t["log"] == "log/farm/mesh.1-2.log", "status has state, tries, exit code, meaning, node and log", t)
log = read("out/log/farm/mesh.1-2.log")
ok(log.count("exit 4 after") == 2 and "try 2, worker 0" in log and log.count("Is a directory") >= 2, "its log has both tries and what they wrote", log)
code, said = hoodoo("status", "out")
ok(code == 0 and "4: output cannot be written" in said, "for people too", said)
clear_meshes("out")
for name, what in (("mesh.1-3", "did you mean mesh.1-2"), ("sim.1-2", "is done, so there is nothing to retry"), ("end", "waits for mesh.1-2, which is not done")):
    code, said = hoodoo("retry", "out", name)
    ok(code == 2 and what in said, f"retry {name}: {what}", said)
code, said = hoodoo("retry", "out", "mesh.1-2")
ok(code == 0 and set(status("out")) == {"mesh.3-4", "end"} and read("hook.log") == "failed 2/4\n", "one task is retried, and no more", said, status("out"))
code, said = hoodoo("retry", "out")
ok(code == 0 and not status("out") and read("hook.log") == "failed 2/4\ndone 4/4\n", "then the rest; the hook is called for the end", said, read("hook.log"))
code, said = hoodoo("submit", "job.yaml", "--to", "local", "--workers", "1", "--out", "out")
code2, said2 = hoodoo("status", "out", "--end")
ok(code == code2 == 0 and "started" not in said and read("hook.log") == "failed 2/4\ndone 4/4\n", "and never again", said, said2)
empty = [n for n in os.listdir("out/log/farm") if n.endswith(".log") and n != "on_done.log" and os.path.getsize(f"out/log/farm/{n}") == 0]
ok(not empty, "no task's log is empty", empty)

# Cancelled from elsewhere while it runs.
child = subprocess.Popen([HOODOO, "submit", "long.yaml", "--to", "local", "--workers", "1", "--out", "long"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         stdin=subprocess.DEVNULL, text=True)
end = time.monotonic() + 120
while time.monotonic() < end and not (os.path.isdir("long/frames") and len(os.listdir("long/frames")) > 3):
    time.sleep(0.02)
t = status("long")["sim.1-2000"]
ok(t["state"] == "running" and t["tries"] == 1, "status shows what runs", t)
code, said = hoodoo("submit", "long.yaml", "--to", "local", "--workers", "1", "--out", "long")
code2, said2 = hoodoo("retry", "long")
ok(code == 4 and code2 == 2 and "are run by process" in said and "cancel" in said2, "its tasks are not run twice at a time", said, said2)
code, said = hoodoo("cancel", "long", "--json")
output = child.communicate(timeout=120)[0]
ok(code == 0 and json.loads(said)["cancelled"] == ["sim.1-2000"] and child.returncode == 85 and not os.path.exists("long/lock"), "cancel has it save and end", said, output)
ok(status("long")["sim.1-2000"]["state"] == "stopped" and read("hook.log").count("\n") == 2, "status says stopped, and the hook was not called", status("long")["sim.1-2000"])
code, said = hoodoo("cancel", "long", "--json")
ok(code == 0 and json.loads(said)["cancelled"] == [], "nothing is left to cancel", said)

# What another scheduler has is not ours to cancel.
hoodoo("submit", "job.yaml", "--to", "tasks", "--out", "other")
for verb in ("cancel", "retry"):
    code, said = hoodoo(verb, "other")
    ok(code == 2 and f"was submitted to tasks: {verb} its tasks there" in said, f"{verb} of another scheduler's tasks is refused", said)
code, said = hoodoo("cancel", ".")
ok(code == 3 and "not made by hoodoo submit" in said, "and of what was never submitted", said)

# A program that is not here is remarked on, and one in a container is not.
for sets, count in ((("farm.binary=/nowhere/hoodoo",), 1), (("farm.binary=/nowhere/hoodoo", "farm.prologue=[apptainer, exec, image]"), 0)):
    code, said = hoodoo("submit", "job.yaml", "--to", "slurm", "--out", "nowhere", "--dry-run", *(w for s in sets for w in ("--set", s)))
    ok(code == 0 and said.count("/nowhere/hoodoo: No such file or directory; nodes that cannot run it are excluded") == count, f"submit with {' and '.join(sets)}", code, said[:800])

# A million frames: ranges stay ranges, whatever frames have volumes.
for every, still, expected in ((1, 1, "1-1000000"), (3, 7, "1-1000000:21")):
    sets = ("--set", "frames=1-1000000", "--set", "farm.block_frames=20000", "--set", f"output.vdb.every={every}", "--set", f"farm.still_every={still}", "--set", "farm.chunk_frames=1000")
    code, said = hoodoo("submit", "job.yaml", "--to", "openjd", "--out", "million", "--dry-run", *sets)
    template = json.loads(said[said.index("{"):]) if code == 0 else {}
    frames = [p["default"] for p in template.get("parameterDefinitions", []) if p["name"] == "StillFrames"]
    ok(code == 0 and frames == [expected] and len(template["steps"]) == 50 + 50 + 3, f"a million frames, a still every {still}", code, frames, said[:500])
finish()
