"""hoodoo preview: pictures are complete and have the right size and orientation; existing pictures are kept, and made again with other
options; partial commands together make the same files as the full command."""
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import time

HOODOO = os.environ["HOODOO"]
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True, errors="replace")
    return done.returncode, done.stderr


def pixels(path, width, height):
    """Rows of (r, g, b)."""
    raw = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    if len(raw) != width * height * 3:
        return None
    return [[raw[3 * (y * width + x):3 * (y * width + x) + 3] for x in range(width)] for y in range(height)]


def developed(path):
    """A linear picture of POV-Ray after tone mapping (render/develop.h)."""
    with open(path, "rb") as file:
        words = file.read()
    head = re.match(rb"P6\n(?:#[^\n]*\n)*(\d+) (\d+)\n65535\n", words)
    width, height = int(head[1]), int(head[2])
    value = struct.unpack(f">{3 * width * height}H", words[head.end():])
    n, grey, white = 1.3, 0.18, 4
    s, top = grey**n * (1 / grey - 1), 1
    for _ in range(8):
        top = white**n / (white**n + s)
        s = grey**n * (1 / (grey * top) - 1)

    def shown(v):
        step = (min(int(4096 * math.sqrt(v / 65535)), 4095) + 0.5) / 4096
        x = (4 * step * step)**n
        y = min(x / (x + s) / top, 1)
        return round(255 * (12.92 * y if y <= 0.0031308 else 1.055 * y**(1 / 2.4) - 0.055))

    table = {v: shown(v) for v in set(value)}
    flat = bytes(table[v] for v in value)
    return [[flat[3 * (y * width + x):3 * (y * width + x) + 3] for x in range(width)] for y in range(height)]


def stone(pixel):
    return pixel[0] > 1.15 * pixel[2]


def working_in(folder):
    """Processes with this working directory; renderers work in the output folder."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink(f"/proc/{pid}/cwd") == os.path.realpath(folder):
                with open(f"/proc/{pid}/cmdline", "rb") as file:
                    found.append(file.read().split(b"\0")[0].decode())
        except OSError:
            pass
    return found


def begin(*words):
    """Starts a preview into an empty o/turntable; returns once its first picture is there."""
    for folder in ("o/turntable", "o/records/turntable"):
        shutil.rmtree(folder, ignore_errors=True)
    child = subprocess.Popen([HOODOO, "preview", "o", "--turntable", *words], stderr=subprocess.PIPE, text=True)
    while not os.path.isdir("o/turntable") or not any(name.endswith(".png") and "tmp" not in name for name in os.listdir("o/turntable")):
        time.sleep(0.02)
    return child


DRAFT = ("--preset", "draft")
# A wall with a tower at its +x end, seen from -y: the tower must stand on the right.
job = {"hoodoo": 1, "name": "tower", "frames": "1001-1002", "domain": {"size_m": [16, 8, 16], "spacing_m": 0.5},
       "scene": {"union": [{"box": {"min_m": [2, 3, 0], "max_m": [14, 5, 3]}}, {"box": {"min_m": [11, 2, 0], "max_m": [14, 5, 14]}}]},
       "cameras": {"front": {"position_m": [8, -30, 9], "target_m": [8, 4, 8]}, "far": {"position_m": [8, -60, 9], "target_m": [8, 4, 8]}}}
with open("tower.json", "w") as file:
    json.dump(job, file)
code, said = hoodoo("run", "tower.json", "--out", "o", "--progress", "none")
check(code == 0, "the job runs")
code, said = hoodoo("preview", "o", "--resolution", "96x54", *DRAFT)
check(code == 0 and said == "", f"stills are made without a word {said}")
picture = pixels("o/preview/tower.1001.png", 96, 54)
check(picture is not None and os.path.exists("o/preview/tower.1002.png"), "two stills of the size asked for")
upper = [sum(stone(p) for row in picture[8:24] for p in row[side:side + 48]) for side in (0, 48)]
check(upper[1] > 30 and upper[1] > 5 * upper[0], f"nothing is mirrored: stone in the upper picture, left and right: {upper}")
check(os.path.exists("o/tower.contact.png"), "the contact sheet")
check(sorted(os.listdir("o/preview")) == ["tower.1001.png", "tower.1002.png"], "scenes and temporary files are gone")

with open("o/preview/tower.1001.png", "rb") as file:
    first = file.read()
os.remove("o/preview/tower.1001.png")
code, _ = hoodoo("preview", "o", "--resolution", "96x54", *DRAFT)
with open("o/preview/tower.1001.png", "rb") as file:
    check(code == 0 and file.read() == first, "made again, it is the same file")
before = os.stat("o/preview/tower.1001.png").st_mtime_ns
code, _ = hoodoo("preview", "o", "--resolution", "96x54", *DRAFT)
check(code == 0 and os.stat("o/preview/tower.1001.png").st_mtime_ns == before, "a finished still is not made again")
for what, words in (("size", ("--resolution", "64x36")), ("camera", ("--resolution", "64x36", "--camera", "far")),
                    ("care", ("--resolution", "64x36", "--preset", "preview"))):
    before = os.stat("o/preview/tower.1001.png").st_mtime_ns
    code, _ = hoodoo("preview", "o", "--frames", "1001", "--only", "stills", *DRAFT, *words)
    check(code == 0 and os.stat("o/preview/tower.1001.png").st_mtime_ns != before, f"one of another {what} is")
check(pixels("o/preview/tower.1001.png", 64, 36) is not None, "and has it")

# The scene is one file that says how to render it.
os.remove("o/preview/tower.1002.png")
code, _ = hoodoo("preview", "o", "--frames", "1002", "--resolution", "96x54", *DRAFT, "--keep-scenes")
check(code == 0 and os.path.exists("o/preview/tower.1002.pov") and os.path.exists("o/preview/tower.1002.png"),
      "a missing one is made, and its scene stays when asked for")
os.mkdir("elsewhere")
shutil.copy("o/preview/tower.1002.pov", "elsewhere")
with open("elsewhere/tower.1002.pov") as file:
    command = next(line for line in file if "povray " in line)
command = command[command.index("povray "):].split()
again = subprocess.run([*command, "-GA"], capture_output=True, cwd="elsewhere")
check(again.returncode == 0 and developed("elsewhere/tower.1002.ppm") == pixels("o/preview/tower.1002.png", 96, 54),
      f"alone in another folder, the command in it makes the light of the same picture: {' '.join(command)}")

# The orbit, and parts of it.
code, said = hoodoo("preview", "o", "--turntable", "--views", "4", "--resolution", "96x54", *DRAFT)
names = [f"tower.1002.{v:03}.png" for v in range(4)]
check(code == 0 and sorted(os.listdir("o/turntable")) == names, f"an orbit of four views {said}")
probe = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v", "-count_frames", "-show_entries",
                        "stream=codec_name,width,height,pix_fmt,nb_read_frames", "-of", "csv=p=0", "o/tower.turntable.mp4"],
                       capture_output=True, text=True)
check(probe.stdout.strip() == "h264,96,54,yuv420p,144", f"the video, once around in 6 s: {probe.stdout.strip()}")
whole = [pixels(f"o/turntable/{name}", 96, 54) for name in names]
check(all(whole) and len({str(v) for v in whole}) == 4, "four different views")
shutil.rmtree("o/turntable")
os.remove("o/tower.turntable.mp4")
part = ("preview", "o", "--views", "4", "--resolution", "96x54", *DRAFT)
code, said = hoodoo(*part, "--only", "views", "--view", "1-2")
check(code == 0 and sorted(os.listdir("o/turntable")) == names[1:3] and not os.path.exists("o/tower.turntable.mp4"),
      f"two of the views, without a video {said}")
code, said = hoodoo(*part, "--only", "video")
check(code == 3 and "000.png" in said, f"no video while views are missing: {code}, {said.strip()}")
both = [subprocess.Popen([HOODOO, *part, "--only", "views", "--view", view]) for view in ("0", "3")]
check([child.wait() for child in both] == [0, 0] and sorted(os.listdir("o/turntable")) == names, "the others, side by side")
code, said = hoodoo(*part, "--only", "video")
check(code == 0 and os.path.exists("o/tower.turntable.mp4"), f"then the video is made {said}")
check([pixels(f"o/turntable/{name}", 96, 54) for name in names] == whole, "made in parts they are what they are made at once")
code, said = hoodoo(*part, "--views", "8", "--only", "views", "--view", "1")
check(code == 0 and pixels("o/turntable/tower.1002.001.png", 96, 54) != whole[1], "the second of eight is not the second of four")

# Stopped, and killed.
child = begin("--views", "300", "--resolution", "320x180")
child.send_signal(signal.SIGTERM)
_, said = child.communicate()
check(child.returncode == 85 and said.count("\n") == 1, f"stopped: 85 and one line, {said.strip()}")
left = working_in("o")
check(left == [], f"no renderer is left behind {left}")
rest = [name for name in os.listdir("o/turntable") if "tmp" in name or name.endswith(".pov")]
check(rest == [], f"nor anything unfinished {rest}")
child = begin("--views", "300", "--resolution", "320x180")
busy = []
while not busy:  # a child that has not yet started its program still has hoodoo's name
    busy = [program for program in working_in("o") if program != HOODOO]
child.kill()
child.communicate()
for _ in range(100):
    left = working_in("o")
    if left:
        time.sleep(0.05)
check(set(busy) <= {"povray", "oiiotool"} and left == [], f"killed: {busy} were at work, and end with it {left}")
# A view counts as done once it has a record; a view finished just before the kill has none.
finished = {name: os.stat(f"o/turntable/{name}").st_mtime_ns for name in os.listdir("o/turntable")
            if name.count(".") == 3 and "tmp" not in name and os.path.exists(f"o/records/turntable/{name}.json")}
last = len(finished) + 1
code, said = hoodoo("preview", "o", "--views", "300", "--only", "views", "--view", f"0-{last}", "--resolution", "320x180")
kept = sum(os.stat(f"o/turntable/{name}").st_mtime_ns == at for name, at in finished.items())
check(code == 0 and sorted(os.listdir("o/turntable")) == [f"tower.1002.{v:03}.png" for v in range(last + 1)] and kept == len(finished),
      f"the same command goes on: {kept} views are kept, and nothing else is there {said}")

# Folders may have any name.
hostile = "a #%d {TOP} 'q' $(touch pwned) [1] -x"
shutil.copytree("o", hostile)
shutil.rmtree(f"{hostile}/preview")
shutil.rmtree(f"{hostile}/turntable")
code, said = hoodoo("preview", hostile, "--resolution", "160x120", *DRAFT)
check(code == 0 and len(os.listdir(f"{hostile}/preview")) == 2 and not os.path.exists("pwned"), f"in a folder of a hostile name {said}")
code, said = hoodoo("preview", hostile, "--turntable", "--views", "2", "--show", "stress", "--resolution", "160x120", *DRAFT)
check(code == 0 and os.path.exists(f"{hostile}/tower.stress.turntable.mp4"), f"its turntable {said}")

for words, expected, why in ((("preview", "o", "--frames", "7-9"), 3, "volumes"), (("preview", "nowhere"), 3, "nowhere"),
                             (("preview", "o", "--camera", "side"), 2, "side"), (("preview", "o", "--resolution", "big"), 2, "WIDTHxHEIGHT"),
                             (("preview", "o", "--views", "0", "--turntable"), 2, "--views"),
                             (("preview", "o", "--only", "views", "--view", "66-72"), 2, "0 to 71"),
                             (("preview", "o", "--only", "views", "--view", "-1-3"), 2, "--view"),
                             (("preview", "o", "--turntable", "--only", "sheet"), 2, "--only")):
    code, said = hoodoo(*words)
    check(code == expected and said.count("\n") == 1 and why in said, f"{' '.join(words)}: {code}, {said.strip()}")
sys.exit(failed)
