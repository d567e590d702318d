"""hoodoo preview: the pictures are there, whole, the right size and the right way round; what is done is not done again."""
import json
import os
import shutil
import signal
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


def stone(pixel):
    return pixel[0] > 1.15 * pixel[2]


# A wall with a tower at its +x end, seen from -y: the tower must stand on the right.
job = {"hoodoo": 1, "name": "tower", "frames": "1001-1002", "domain": {"size_m": [16, 8, 16], "spacing_m": 0.5},
       "scene": {"union": [{"box": {"min_m": [2, 3, 0], "max_m": [14, 5, 3]}}, {"box": {"min_m": [11, 2, 0], "max_m": [14, 5, 14]}}]},
       "cameras": {"front": {"position_m": [8, -30, 9], "target_m": [8, 4, 8]}}}
with open("tower.json", "w") as file:
    json.dump(job, file)
code, said = hoodoo("run", "tower.json", "--out", "o", "--progress", "none")
check(code == 0, "the job runs")
code, said = hoodoo("preview", "o", "--resolution", "96x54", "--preset", "draft")
check(code == 0 and said == "", f"stills are made without a word {said}")
picture = pixels("o/preview/tower.1001.png", 96, 54)
check(picture is not None and os.path.exists("o/preview/tower.1002.png"), "two stills of the size asked for")
upper = [sum(stone(p) for row in picture[8:24] for p in row[side:side + 48]) for side in (0, 48)]
check(upper[1] > 30 and upper[1] > 5 * upper[0], f"nothing is mirrored: stone in the upper picture, left and right: {upper}")
check(os.path.exists("o/tower.contact.png"), "the contact sheet")
check(sorted(os.listdir("o/preview")) == ["tower.1001.png", "tower.1002.png"], "scenes and temporary files are gone")

before = os.stat("o/preview/tower.1001.png").st_mtime_ns
code, _ = hoodoo("preview", "o", "--resolution", "96x54", "--preset", "draft")
check(code == 0 and os.stat("o/preview/tower.1001.png").st_mtime_ns == before, "a finished still is not made again")
code, _ = hoodoo("preview", "o", "--frames", "1001", "--resolution", "64x36", "--preset", "draft")
check(code == 0 and pixels("o/preview/tower.1001.png", 64, 36) is not None, "one of another size is")
os.remove("o/preview/tower.1002.png")
code, _ = hoodoo("preview", "o", "--resolution", "96x54", "--preset", "draft", "--keep-scenes")
check(code == 0 and os.path.exists("o/preview/tower.1002.pov") and os.path.exists("o/preview/tower.1002.png"),
      "a missing one is, and its scene stays when asked for")
again = subprocess.run(["povray", "+Io/preview/tower.1002.pov", "+Oalone.png", "+W32", "+H18", "-D", "-GA"], capture_output=True)
check(again.returncode == 0 and os.path.getsize("alone.png") > 0, "the scene stands on its own")

code, said = hoodoo("preview", "o", "--turntable", "--views", "4", "--resolution", "96x54", "--preset", "draft")
check(code == 0 and len(os.listdir("o/turntable")) == 4, f"an orbit of four views {said}")
probe = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=codec_name,width,height,pix_fmt",
                        "-of", "csv=p=0", "o/tower.turntable.mp4"], capture_output=True, text=True)
check(probe.stdout.strip() == "h264,96,54,yuv420p", f"the video: {probe.stdout.strip()}")
views = [pixels(f"o/turntable/tower.1002.{v:03}.png", 96, 54) for v in range(4)]
check(all(views) and len({str(v) for v in views}) == 4, "four different views")

shutil.rmtree("o/turntable")
child = subprocess.Popen([HOODOO, "preview", "o", "--turntable", "--views", "300", "--resolution", "320x180"], stderr=subprocess.PIPE,
                         text=True)
while not os.path.isdir("o/turntable") or not any(name.endswith(".png") and "tmp" not in name for name in os.listdir("o/turntable")):
    time.sleep(0.02)
child.send_signal(signal.SIGTERM)
_, said = child.communicate()
check(child.returncode == 85 and said.count("\n") == 1, f"stopped: 85 and one line, {said.strip()}")
left = subprocess.run(["pgrep", "-f", "o/turntable/tower"], capture_output=True, text=True).stdout
check(left == "", "no renderer is left behind")

for words, expected, why in ((("preview", "o", "--frames", "7-9"), 3, "volumes"), (("preview", "nowhere"), 3, "nowhere"),
                             (("preview", "o", "--camera", "side"), 2, "side"), (("preview", "o", "--resolution", "big"), 2, "WIDTHxHEIGHT"),
                             (("preview", "o", "--views", "0", "--turntable"), 2, "--views")):
    code, said = hoodoo(*words)
    check(code == expected and said.count("\n") == 1 and why in said, f"{' '.join(words)}: {code}, {said.strip()}")
sys.exit(failed)
