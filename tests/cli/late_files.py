"""A shared disk that shows late what another machine wrote: meshes, stills, sheets and videos wait for it (HOODOO_DISK_DELAY), and none is made of the wrong frame
or without some of its pictures."""

import os
import subprocess
import time

from script import HOODOO, TOP, finish, hoodoo, ok

with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as f:
    text = f.read().replace("1001-1012", "1001-1003").replace("spacing_m: 0.5", "spacing_m: 1")
with open("job.yaml", "w") as f:
    f.write(text + "farm: {still_every: 1}\n")
code, said = hoodoo("run", "job.yaml", "--device", "cpu", "--out", "o", "--progress", "none")
ok(code == 0, "three frames", said)
os.mkdir("hidden")


def late(what, *words, path, seconds=60):
    """Runs a command while `path` is hidden, which is shown after it has said that it waits. Returns its exit code and output."""
    hidden = "hidden/" + os.path.basename(path)
    os.rename("o/" + path, hidden)
    child = subprocess.Popen([HOODOO, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env={**os.environ, "HOODOO_DISK_DELAY": str(seconds)})
    said = ""
    for line in child.stdout:
        said += line
        if "looking again for" in line:
            break
    if seconds > 9:
        os.rename(hidden, "o/" + path)
    said += child.stdout.read()
    child.wait(120)
    if seconds <= 9:
        os.rename(hidden, "o/" + path)
    ok(said.count(f"{what} are there yet; looking again for {seconds} s") == 1, f"{' '.join(words)}: it says what it waits for", said)
    return child.returncode, said


code, said = late("frames", "mesh", "o", "--frames", "1001-1003", path="frames/twelve.1002.json")
ok(code == 0 and len([n for n in os.listdir("o/mesh") if n.endswith(".ply")]) == 3, "a manifest that shows late: a mesh of each frame", code, said)
code, said = late("frames", "aov", "o", "--frames", "1001-1003", "--device", "cpu", path="run.json")
ok(code == 0, "run.json that shows late", code, said)
STILL = ("preview", "o", "--preset", "draft", "--resolution", "64x36")
code, said = late("frames", *STILL, "--only", "stills", "--frames", "1001-1003", path="volumes/twelve.1003.vdb")
ok(code == 0 and len(os.listdir("o/preview")) == 3, "a volume that shows late: a still of each frame", code, said)
code, said = late("stills", *STILL, "--only", "sheet", path="preview/twelve.1002.png")
with open("o/records/twelve.contact.png.json") as f:
    ok(code == 0 and f.read().count("preview/twelve.") == 3, "a still that shows late: a sheet of all", code, said)
code, said = late("frames", *STILL, "--only", "views", "--views", "3", path="frames/twelve.1003.json")
ok(code == 0 and sorted(os.listdir("o/turntable")) == [f"twelve.1003.{i:03d}.png" for i in range(3)], "a last frame that shows late: views of that, not of another", os.listdir("o/turntable"))
code, said = late("views", *STILL, "--only", "video", "--views", "3", path="turntable/twelve.1003.001.png")
ok(code == 0 and os.path.exists("o/twelve.turntable.mp4"), "a view that shows late: the video", code, said)
begun = time.monotonic()
code, said = late("views", *STILL, "--only", "video", "--views", "3", path="turntable/twelve.1003.001.png", seconds=2)
ok(code == 3 and "make it first" in said and 2 <= time.monotonic() - begun < 30, "what does not show within the delay is reported", code, said)
begun = time.monotonic()
code, said = hoodoo("mesh", "o", "--frames", "1001-1009")
ok(code == 0 and "looking again" not in said, "without the variable nothing waits", said)
finish()
