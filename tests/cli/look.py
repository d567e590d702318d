"""hoodoo look: a picture in seconds. Frames before a change come from cached states, with the same result as from the start; --watch draws
again at each save; errors are reported."""
import atexit
import glob
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

from looking import Page, look, png_size, with_cache, write
from script import HOODOO, TOP, cut_half, finish, hoodoo, ok

sys.dont_write_bytecode = True
EDITS = open(f"{TOP}/tests/restart/edits.yaml").read()


def states(cache):
    return {os.path.basename(p): open(p, "rb").read() for p in glob.glob(f"{cache}/hoodoo/look/*.state")}


# ---- states before a change

def changed(job, first, what, *words, compare=True):
    """Looks at the changed job with the states cached so far: it must start at `first` and give the same result as from the start."""
    code, made = look(job, "--out", "kept.png", *words)
    if not ok(code == 0 and isinstance(made, dict), f"{what}: a picture comes", made):
        return
    ok(made["from_frame"] == first, f"{what}: begins with the state of frame {first}", made)
    if not compare:
        return
    shutil.rmtree("fresh", ignore_errors=True)
    code, again = look(job, "--out", "fresh.png", *words, cache="fresh")
    kept, fresh = states("kept"), states("fresh")
    ok(code == 0 and open("kept.png", "rb").read() == open("fresh.png", "rb").read(), f"{what}: the picture is that from the start")
    ok(set(fresh) <= set(kept) and all(kept[name] == fresh[name] for name in fresh), f"{what}: so is every state",
       len(set(fresh) - set(kept)), [n for n in fresh if n in kept and kept[n] != fresh[n]])


CHANGES = [
    ("radius_m: 1.2", "radius_m: 1.5", 1007, "a later edit's carve"),
    ("vegetation: 0.6", "vegetation: 0.5", 1007, "a later edit's paint"),
    ("threshold_Pa: 0.1", "threshold_Pa: 0.2", 1007, "a curve that a later edit sets"),
    ("radius_m: 1.8", "radius_m: 1.7", 1003, "an edit's addition"),
    ("1010: 16", "1010: 20", 1005, "a curve that an edit sets"),
    ("rock.density_kg_m3: 2500, ", "rock.density_kg_m3: 2400, ", 1001, "a setting that is no curve"),
    ("deposition.viability: 0.5", "deposition.viability: 0", 1001, "whether there are ever deposits"),
    ("name: edits", "name: other", 1010, "the name"),
    ("distance_m: 26", "distance_m: 30", 1010, "the camera"),
    ("noise: {amplitude: 0.3, scale_m: 4}", "noise: {amplitude: 0.3, scale_m: 4}\nvegetation: {growth_per_kyr: {1008: 0.5, 1009: 0.7}}", 1001, "a curve"),
    ("noise: {amplitude: 0.3, scale_m: 4}", "noise: {amplitude: 0.3, scale_m: 4}\nvegetation: {growth_per_kyr: {1008: 0.5, 1009: 0.8}}", 1008, "its later key"),
]
write(EDITS)
code, made = look("edits.yaml")
ok(code == 0 and made["from_frame"] == 1001 and not made["state_found"] and png_size("edits.look.png") == (96, 54), "the first look begins with the scene", made)
ok(made["spacing_m"] == 0.5 and made["job_spacing_m"] == 0.5, "a small job is looked at as it is", made)
code, made = look("edits.yaml")
ok(code == 0 and made["from_frame"] == 1010 and made["state_found"], "the second finds the frame's state", made)
for old, new, first, what in CHANGES:
    assert old in EDITS, old
    write(EDITS.replace(old, new))
    changed("edits.yaml", first, what, compare=first in (1005, 1007, 1008))
write(EDITS)
code, made = look("edits.yaml", "--frame", "1005")
ok(code == 0 and made["from_frame"] == 1005 and made["frame"] == 1005, "another frame of the same job is there already", made)

# A truncated state is ignored.
for path in glob.glob("kept/hoodoo/look/*.state"):
    cut_half(path)
changed("edits.yaml", 1001, "states that were cut short", compare=False)
shutil.rmtree("kept")

# Other models: the last frame of a tool, the last key of a rate.
CAVE = open(f"{TOP}/jobs/arches_cave.yaml").read()
write(CAVE, "cave.yaml")
size = ("--spacing", "4")
code, made = look("cave.yaml", *size)
ok(code == 0 and made["spacing_m"] == 4, "arches: a look", made)
last = json.loads(hoodoo("plan", "cave.yaml", "--json", "--device", "none")[1])["frames"].split("-")[1]
changed("cave.yaml", int(last), "arches: the same from the start", *size)
shutil.copy(f"{TOP}/jobs/goblin_cap.png", ".")
GOBLIN = open(f"{TOP}/jobs/goblin_cap.yaml").read()
write(GOBLIN, "goblin.yaml")
code, made = look("goblin.yaml")
ok(code == 0, "goblins: a look", made)
changed("goblin.yaml", made["frame"], "goblins: the same from the start")

# A look begins with another run's checkpoint; the picture is that of a look at the branch.
write(EDITS)
code, said = hoodoo("run", "edits.yaml", "--out", "branch", "--progress", "none", "--set", "checkpoint.mark=[1007]", "--frames", "1001-1007")
code, made = look("edits.yaml", "--from", "branch@1007", "--frame", "1008", "--out", "branch.png", cache="branched")
ok(code == 0 and made["from_frame"] == 1007 and made["spacing_m"] == 0.5, "--from: begins with the other run's checkpoint", made)
_, straight = look("edits.yaml", "--frame", "1008", "--out", "straight.png")
ok(open("branch.png", "rb").read() == open("straight.png", "rb").read(), "--from: and shows its rock")
code, made = look("edits.yaml", "--from", "branch@1007", "--out", "branch.png", cache="branched")
ok(code == 0 and made["from_frame"] == 1008 and made["state_found"], "--from: states are cached too", made)
code, made = look("edits.yaml", "--from", "branch@1007", "--spacing", "1", "--frame", "1008", "--out", "coarse.png")
ok(code == 0 and made["from_frame"] == 1007 and made["spacing_m"] == 1, "--from: at another spacing", made)

# ---- options of the picture

write(EDITS)
for words, what in [(("--camera", "30,20"), "a direction"), (("--show", "stress"), "a value"), (("--figure",), "a figure"), (("--gizmos", "none"), "no lines"), (("--gizmos", "all"), "all lines")]:
    code, made = look("edits.yaml", "--out", "shown.png", *words)
    ok(code == 0 and png_size("shown.png") and open("shown.png", "rb").read() != open("kept.png", "rb").read(), f"{what} shows", made)
code, made = look("edits.yaml", "--spacing", "1")
ok(code == 0 and made["spacing_m"] == 1 and 6 < made["job_particles"] / made["particles"] < 10, "a coarser look has an eighth of the particles", made)
code, said = hoodoo("look", "edits.yaml", "--out", "slate.png", "--gizmos", "all", "--progress", "none", "--set", "cameras.main.resolution=[320, 180]")
ok(code == 0 and png_size("slate.png") == (320, 180) and "slate.png: edits, frame 1010, at 0.5 m" in said and "edits.3: frame 1008" in said, "in words, with the strip", said)
first = open("slate.png", "rb").read()
hoodoo("look", "edits.yaml", "--out", "slate.png", "--gizmos", "all", "--progress", "none", "--set", "cameras.main.resolution=[320, 180]")
ok(open("slate.png", "rb").read() == first, "equal looks are equal files")
ok(not [name for name in os.listdir(".") if name.endswith((".ppm", ".tmp"))], "nothing else is left", os.listdir("."))

WRONG = [
    (("--frame", "1011"), 2, "the job's frames are 1001-1010"),
    (("--frame", "x"), 2, "--frame x"),
    (("--camera", "side"), 2, "no camera of that name"),
    (("--camera", "30,100"), 2, "no camera of that name"),
    (("--seconds", "-1"), 2, "above 0"),
    (("--seconds", "2", "--spacing", "1"), 2, "exclude each other"),
    (("--range", "0:1"), 2, "choose a value with --show"),
    (("--show", "deposit"), 2, "not available in look"),
    (("--spacing", "9"), 2, ""),
    (("--out", "nowhere/here.png"), 4, "nowhere/here.png"),
    (("--set", "from=elsewhere.ckpt"), 7, "elsewhere.ckpt"),
    (("--from", "branch@1009"), 7, "its checkpoints are of frames"),
    (("--from", "branch@1007", "--spacing", "0.8"), 7, "domain"),
    (("--device", "99"), 6, "99"),
]
for words, want, sentence in WRONG:
    code, said = look("edits.yaml", *words)
    ok(code == want and sentence in str(said), f"{' '.join(words)}: exit {want}", code, said)
ok("fresh" in os.listdir("."), "the folder is ours")
code, made = look("edits.yaml", cache="edits.yaml/no")
ok(code == 0, "a cache that cannot be is done without", made)

# ---- --watch

watching = subprocess.Popen([HOODOO, "look", "edits.yaml", "--watch", "--json", "--no-slate", "--progress", "none"], stdout=subprocess.PIPE, stderr=open("said", "w"),
                            text=True, env=with_cache("kept"))
atexit.register(watching.kill)
ok(json.loads(watching.stdout.readline())["from_frame"] == 1010, "--watch: a first picture")
write(EDITS.replace("radius_m: 1.2", "radius_m: 1.9"))
ok(json.loads(watching.stdout.readline())["from_frame"] == 1007, "--watch: again at a save, from before the change")
write(EDITS.replace("radius_m: 1.2", "radius_m: -1"))
for _ in range(300):
    if "radius_m" in open("said").read():
        break
    time.sleep(0.1)
ok("edits.yaml:" in open("said").read(), "--watch: a broken job is said, with its place", open("said").read())
write(EDITS)
ok(json.loads(watching.stdout.readline())["from_frame"] == 1010, "--watch: and waited for")
watching.send_signal(signal.SIGINT)
ok(watching.wait(timeout=60) == 0, "--watch: ends cleanly")

# ---- --serve


def raw(text):
    """The first line of the answer to these bytes; "" without an answer."""
    try:
        with socket.create_connection(server, timeout=30) as s:
            s.sendall(text)
            s.shutdown(socket.SHUT_WR)
            return s.recv(1000).decode("latin-1").split("\r\n")[0]
    except OSError:  # the server closes the connection on a malformed request
        return ""


page = Page("edits.yaml")
server, token, fetch = page.server, page.token, page.fetch
ok(server[0] == "127.0.0.1" and len(token) == 32, "--serve: an address on this machine, with a token", server)
code, kind, _, body = fetch("/", token=token)
ok(code == 200 and kind.startswith("text/html") and b"<title>hoodoo look" in body and not re.search(rb"https?://", body), "the page, which asks nobody else for anything")
code, kind, _, body = fetch("/job", token=token)
job = json.loads(body)
ok(code == 200 and (job["name"], job["first"], job["last"], job["cameras"]) == ("edits", 1001, 1010, ["main"]) and {"name": "stress", "unit": "MPa"} in job["values"], "the job", job)
code, kind, note, body = fetch("/picture", token=token, frame=1005, show="stress", camera="20,30", zoom=2)
note = json.loads(note)
ok(code == 200 and kind == "image/png" and body[:4] == b"\x89PNG" and note["frame"] == 1005 and note["legend"]["unit"] == "MPa", "a picture of a value", note)
places = [json.loads(fetch("/at", token=token, x=x / 8, y=0.6)[3]) for x in range(1, 8)]
rock = [p for p in places if p["rock"]]
ok(rock and len(rock) < 7 and all(1.5 < p["P.X"] < 12.5 and -0.5 < p["P.Z"] < 14 and abs(p["stress.trace"]) < 1e7 for p in rock), "places and values in it", places)
code, _, _, body = fetch("/picture", token=token, frame=1500)
ok(code == 422 and b"1001-1010" in body, "a frame that is not there", code, body)
for what, want, got in [("no token", 403, fetch("/")[0]), ("a wrong one", 403, fetch("/job", token=token[:-1] + "x")[0]), ("another name for this machine", 400, fetch("/", host="rock.example:80", token=token)[0]),
                        ("POST", 400, fetch("/picture", "POST", token=token)[0]), ("another page", 404, fetch("/../edits.yaml", token=token)[0])]:
    ok(got == want, f"{what}: {want}", got)
for text in (b"GARBAGE\r\n\r\n", b"GET / HTTP/1.1\r\n\r\n", b"GET " + b"/" * 100000 + b" HTTP/1.1\r\n\r\n", b"\0" * 50, b"GET /?token= HTTP/9.9\r\nHost: x\r\n\r\n"):
    line = raw(text)
    ok(line == "" or re.match(r"HTTP/1.[01] (4|5)\d\d", line), f"hostile bytes ({text[:12]}): {line or 'no answer'}", line)
write(EDITS.replace("radius_m: 1.2", "radius_m: -1"))
for _ in range(100):
    job = json.loads(fetch("/job", token=token)[3])
    if job["saves"]:
        break
    time.sleep(0.1)
ok(job["saves"] > 0 and "radius_m" in job.get("error", "") and fetch("/picture", token=token)[0] == 422, "a save is known, and what is wrong with it", job)
page.process.send_signal(signal.SIGTERM)
ok(page.process.wait(timeout=60) == 0, "--serve: ends cleanly")
code, said = hoodoo("look", "edits.yaml", "--serve", "--port", "70000")
ok(code == 2 and "65535" in said, "--port 70000: exit 2", code, said)
finish()
