"""hoodoo report: a complete and correct page for folders that are complete, incomplete, damaged or hostile."""
import glob
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import urllib.parse

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
VOID = {"meta", "link", "img", "input", "br", "source"}
failed = False


def check(good, what, *notes):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)
    if not good:
        print("#", *notes)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True, errors="replace")
    return done.returncode, done.stdout, done.stderr


class Page(html.parser.HTMLParser):
    """Collects elements with their attributes and text, and checks that they are closed in order."""

    def __init__(self, path):
        super().__init__(convert_charrefs=True)
        self.open, self.all, self.wrong, self.words = [], [], [], []
        with open(path, encoding="utf-8") as file:  # strictly
            self.raw = file.read()
        self.feed(self.raw)
        self.close()
        self.wrong += self.open
        self.text = re.sub(r"\s+", " ", "".join(self.words))

    def handle_starttag(self, tag, attributes):
        self.all.append((tag, dict(attributes)))
        if len(attributes) != len(dict(attributes)):
            self.wrong.append(f"{tag} has an attribute twice")
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.all.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}>")

    def handle_data(self, data):
        if not self.open or self.open[-1] not in ("script", "style"):
            self.words.append(data)

    def every(self, tag):
        return [a for t, a in self.all if t == tag]


def look(root, what):
    """Parses the page and makes the checks that every page must pass."""
    page = Page(f"{root}/report/index.html")
    check(not page.wrong, f"{what}: well formed", *page.wrong[:5])
    check(len(page.every("script")) == 1 and not any(k.startswith("on") for _, a in page.all for k in a), f"{what}: no script but its own")
    addresses = [a[k] for _, a in page.all for k in ("src", "href", "poster") if k in a and a[k] != "data:,"]
    bad = [a for a in addresses if re.match(r"[a-z]+:|//", a) or not os.path.exists(f"{root}/report/{urllib.parse.unquote(a)}")]
    check(not bad, f"{what}: every address is a file that is there, by a relative path ({len(addresses)})", *bad[:5])
    check("url(" not in page.raw and "@import" not in page.raw, f"{what}: fetches nothing else")
    check(all(a.get("alt") for a in page.every("img")), f"{what}: pictures have words")
    check(all(a.get("aria-label") for a in page.every("svg")), f"{what}: charts have titles")
    check("nan" not in re.sub(r"<style>.*?</style>|<script>.*?</script>", "", page.raw, flags=re.S).lower().replace("provenance", ""),
          f"{what}: no number is none")
    return page


HOSTILE = """<script>alert("1")</script><img src=x onerror='alert(2)'>&amp;"""
job = {"hoodoo": 1, "name": "7-wall", "frames": "1001-1004", "clock": {"years_per_frame": 500},
       "domain": {"size_m": [16, 8, 12], "spacing_m": 0.5},
       "scene": {"box": {"min_m": [2, 2, 0], "max_m": [14, 6, 10]}},
       "strata": [{"to_m": 5, "weak_m_per_kyr": 0.2, "strong_m_per_kyr": 0.002, "interlock_MPa": 0.1},
                  {"to_m": 12, "weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.001, "interlock_MPa": 0.2}],
       "cameras": {"front": {"position_m": [8, -30, 9], "target_m": [8, 4, 5], "resolution": [64, 36]}},
       "output": {"aov": {"cameras": ["front"]}, "owner": HOSTILE, "comments": "two\nlines " + HOSTILE}}
with open("wall.json", "w") as file:
    json.dump(job, file)
ROOT = """out <b>"it's" & 100%</b>"""
code, _, said = hoodoo("run", "wall.json", "--out", ROOT, "--progress", "none")
check(code == 0, "the job runs", said)

# ---- complete, without previews
code, told, said = hoodoo("report", ROOT)
check(code == 0 and told.strip() == f"{ROOT}/report/index.html" and said == "", "a page is made, and its name told", code, told, said)
page = look(ROOT, "complete")
check("complete" in page.text and "missing" not in page.text and "damaged" not in page.text, "it says that all is done")
check(page.text.count(HOSTILE) == 2, "what a user typed is shown as typed", page.text.count(HOSTILE))
check(f"hoodoo preview {ROOT} --turntable" in page.text, "it says how to make what is not there")
check(len(page.every("img")) == 2 + 4 and any(a.get("class") == "slider" for a in page.every("div")), "the run's own pictures stand in")
manifests = [json.load(open(f)) for f in sorted(glob.glob(glob.escape(ROOT) + "/frames/*.json"))]
last = manifests[-1]
plain = page.text.replace("\u202f", "")
for key, name in (("rock", "rock"), ("deposit", "deposit"), ("fallen", "fallen"), ("left", "left the domain"), ("start", "start")):
    n = last["ledger"][key]
    check(f"{name}{n}{100 * n / last['ledger']['start']:.2f} %" in plain, f"the ledger's {name} is the manifest's, exactly ({n})")
share = last["statistics"]["volume_m3"] / last["statistics"]["start_volume_m3"]
check(f"{100 * share:.1f} %" in page.text, "the rock that is left")
# The first line chart: frame by frame, on its own axes.
line = re.search(r'Rock that is left.*?<path class="line"[^>]* d="M([^"]+)"', page.raw, re.S).group(1).split("L")
ys = [float(p.split()[1]) for p in line]
volumes = [m["statistics"]["volume_m3"] for m in manifests]
slopes = [(ys[i] - ys[0]) / (volumes[i] - volumes[0]) for i in range(1, 4)]
check(len(line) == 4 and max(slopes) < 0 and max(slopes) - min(slopes) < 0.02 * -min(slopes) + 0.1 / (volumes[0] - volumes[1]),
      "the curve is the manifests' volumes", slopes)
for process, words in (("deflation", "wind plucks grains"), ("abrasion", "blown sand")):
    taken = -sum(m["change_m3"][process] for m in manifests)
    shown = re.search(f'<td>{words}</td><td class="n">([^<]+)</td>', page.raw).group(1).replace("\u202f", "")
    check(taken > 0 and abs(float(shown) / taken - 1) < 0.006, f"{words}: what the manifests add up to ({shown} m3)", taken)
bars = [float(x.replace("\u202f", "")) for x in re.findall(r"to [^<]*: ([-0-9.e]+) %</title></rect>", page.raw)]
check(len(bars) == 48 and abs(sum(bars) - 100) < 0.5, f"the stresses' shares add up to all ({sum(bars):.2f} %)")
check("layer interlock" in page.text, "with the interlocking stress marked")
layers = re.findall(r"([0-9.]+) %, ([0-9.]+) m³", plain)
# Values are rounded for display, by at most half a unit of the last digit.
rounding = sum(0.5 * 10.0 ** -len(v.partition(".")[2]) for _, v in layers)
off = sum(float(v) for _, v in layers) - last["statistics"]["volume_m3"]
check(len(layers) == 2 and abs(off) <= rounding + 1e-6, f"layers add up to the rock, but for their rounding ({off:.2f} m3)", layers)
timing = [json.loads(line) for line in open(f"{ROOT}/log/timing.jsonl")]
stages = {s["name"]: s["device_seconds"] for t in timing for s in t["stages"]}
check(len(timing) == 1 and {"stress", "field", "pictures"} <= stages.keys() and sum(stages.values()) < timing[0]["wall_seconds"]
      and (timing[0]["first_frame"], timing[0]["last_frame"]) == (1001, 1004), "log/timing.jsonl holds the stages", timing)
check(all(name in page.text for name in stages), "and the page shows them")
run = json.load(open(f"{ROOT}/run.json"))
check(all(run[k] in page.text for k in ("version", "commit", "device", "driver", "job_hash")), "provenance")
made = {f: os.stat(f).st_mtime_ns for f in glob.glob(glob.escape(ROOT) + "/report/*.jpg")}
first = page.raw
code, _, _ = hoodoo("report", ROOT)
check(code == 0 and made == {f: os.stat(f).st_mtime_ns for f in made}, "pictures that are current are not made again")
check(look(ROOT, "again").raw == first, "the same folder gives the same page")
check(not glob.glob(glob.escape(ROOT) + "/report/*tmp*"), "nothing temporary is left")

# ---- incomplete, damaged, hostile
shutil.copytree(ROOT, "half")
os.remove("half/frames/7-wall.1002.json")
with open("half/volumes/7-wall.1003.vdb", "r+b") as file:
    file.truncate(100)
with open("half/log/timing.jsonl", "a") as file:
    file.write('{"stages": [{"name": "<script>x", "device_seconds": 1e999}, 7, {"name": 3}], "ended": "<b>", "wall_seconds": "x"}\n{"cut sho')
with open("half/log/run.log", "ab") as file:
    file.write(b"</pre><script>\xff\xfe\x00 end\n")
run["device"] = HOSTILE
run["inputs"] = [{"path": "<script>in</script>.png", "size": 12, "xxh3": "0"}, 5]
json.dump(run, open("half/run.json", "w"))
os.remove("half/report/index.html")
code, _, said = hoodoo("report", "half")
check(code == 0, "half done, damaged and hostile: a page all the same", code, said)
page = look("half", "half done")
check("2 of 4 frames" in page.text and "1 frame is missing: 1002." in page.text and "Frame 1003 is damaged." in page.text, "it says what is missing")
check("7-wall.1003.vdb" in page.text and "100 bytes" in page.text, "and what is wrong")
check("<script>in</script>.png" in page.text and "</pre><script>" in page.text and "<script>x" in page.text, "hostile words are words")

# ---- one frame; no frame; missing points; unreadable picture
code, _, _ = hoodoo("run", "wall.json", "--out", "one", "--frames", "1001-1001", "--progress", "none", "--set", "output.vdb.points=none",
                    "--set", "output.aov.cameras=[]")
code, _, said = hoodoo("report", "one")
page = look("one", "one frame")
check(code == 0 and "3 frames are missing: 1002–1004." in page.text and "Curves begin" in page.text and "voxels" in page.text,
      "one frame: stresses of its volumes", said)
check("There are no pictures" in page.text, "one frame: it says that there are none")
for f in glob.glob("one/frames/*"):
    os.remove(f)
code, _, said = hoodoo("report", "one")
page = look("one", "no frame")
check(code == 3 and "0 of 4 frames" in page.text and "No frame is sound." in page.text and said.count("\n") == 1
      and "none of the 4 frames is complete and undamaged (0 damaged, 4 missing)" in said, "no frame: a page that says so, and exit 3", code, said)
shutil.copytree("half", "gone")
shutil.rmtree("gone/volumes")
os.mkdir("gone/volumes")
code, _, said = hoodoo("report", "gone", "--no-pictures")
page = look("gone", "volumes gone")
check(code == 3 and "3 damaged" in page.text and "No frame is sound." in page.text and "Frame 1001 is damaged." in page.text
      and "3 damaged, 1 missing" in said, "all volumes gone: said on the page, and exit 3", code, said)
shutil.copytree(ROOT, "unreadable")
for f in glob.glob("unreadable/frames/*"):
    open(f, "w").write("{")
code, _, said = hoodoo("report", "unreadable", "--no-pictures")
check(code == 3 and "4 damaged" in look("unreadable", "manifests damaged").text and "none of the 4 frames is complete and undamaged" in said,
      "every manifest damaged: said on the page, and exit 3", code, said)
with open("half/aov/7-wall.1001.exr", "r+b") as file:
    file.seek(200)
    file.write(b"\xff" * 400)
code, _, said = hoodoo("report", "half")
check(code == 0 and "could not be made" in said and "A picture is missing" in look("half", "bad picture").text, "a picture that cannot be read is left out", said)

# ---- with previews; and goblins
code, _, said = hoodoo("preview", ROOT, "--resolution", "64x36", "--preset", "draft", "--frames", "1001-1004x3")
code, _, said = hoodoo("preview", ROOT, "--turntable", "--views", "3", "--resolution", "64x36", "--preset", "draft")
code, _, said = hoodoo("report", ROOT)
page = look(ROOT, "with previews")
check(code == 0 and len(page.every("video")) == 1 and "There is no turntable" not in page.text and "hoodoo preview" not in page.text,
      "the turntable's video is on it", said)
code, _, said = hoodoo("report", ROOT, "--no-pictures")
page = look(ROOT, "pictures left out")
check(code == 0 and not page.every("img") and "leaves out the pictures" in page.text and "There are no pictures" not in page.text,
      "--no-pictures: it says that pictures are left out", said)
os.remove(f"{ROOT}/7-wall.turntable.mp4")
os.remove(f"{ROOT}/report/turntable.mp4")
code, _, said = hoodoo("report", ROOT)
page = look(ROOT, "views")
check(code == 0 and not page.every("video") and len(page.every("input")) == 2 and os.path.exists(f"{ROOT}/report/view.002.jpg"),
      "without the video its views are", said)
code, _, said = hoodoo("run", f"{TOP}/jobs/goblin_cube.yaml", "--out", "goblin", "--progress", "none", "--set", "domain.spacing_m=1",
                       "--set", "frames=1-3", "--set", "output.aov.cameras=[]")
code, _, said2 = hoodoo("report", "goblin", "--no-pictures")
check(code == 0, "goblins", said, said2)
page = look("goblin", "goblins")
check("voxels" in page.text and not page.every("img") and "interlocks" not in page.text, "goblins are counted in voxels")

for words, expected, why in ((("report", "nowhere"), 3, "nowhere"), (("report",), 2, "OUT"), (("report", "one", "--video"), 2, "--video")):
    code, _, said = hoodoo(*words)
    check(code == expected and said.count("\n") == 1 and why in said, f"{' '.join(words)}: {code}, {said.strip()}")
sys.exit(failed)
