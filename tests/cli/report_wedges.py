"""hoodoo report on a folder of wedges: wedges side by side, texts of users escaped, unfinished wedges listed."""
import glob
import os
import re
import shutil
import subprocess

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]


def check(good, what):
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return done.returncode, done.stderr


def page():
    with open("o/report/index.html", encoding="utf-8") as file:
        return file.read()


with open(TOP + "/tests/restart/twelve.yaml") as file:
    text = re.sub(r"^output: .*$", "output: {vdb: {points: none}}", file.read(), flags=re.M)
text = text.replace("1001-1012", "1001-1004") + """
farm: {still_every: 0, turntable: 0}
wedge: {over: [{key: wind.speed_m_s, values: [2, 14, 8]}, {key: output.owner, values: ["<script>alert(1)</script>", "b", "c"]}]}
"""
with open("sweep.yaml", "w") as file:
    file.write(text)
code, said = hoodoo("submit", "sweep.yaml", "--to", "local", "--workers", "1", "--out", "o")
check(code == 0, "three wedges are made " + said.strip()[-80:])
code, said = hoodoo("report", "o")
check(code == 0, "their report " + said)
html = page()
check(all(f"w000{i}" in html for i in (1, 2, 3)) and html.count("4 of 4") == 3, "every wedge and its frames")
check("&lt;script&gt;alert(1)" in html and "<script>alert(1)" not in html, "values are text, not HTML")
left = [float(v) for v in re.findall(r"4 of 4</td><td>([0-9.]+)</td>", html)]
check(len(left) == 3 and left[0] > left[2] > left[1], f"the stronger the wind the less is left: {left} % at 2, 14 and 8 m/s")
check("<svg" in html and "hoodoo preview" in html, "a chart, and how to make the stills that are missing")
check(not re.search(r"https?://(?!www\.w3\.org)", html), "no address of the network")
shutil.rmtree("o/w0002")
code, _ = hoodoo("report", "o")
check(code == 0 and "not begun" in page(), "a wedge that has not begun is named")
with open(sorted(glob.glob("o/w0001/frames/*.json"))[-1], "w") as file:
    file.write("{")
code, _ = hoodoo("report", "o")
check(code == 0 and "3 of 4, 1 damaged</td>" in page(), "damaged frames are counted")
for name in glob.glob("o/w000?/frames/*.json"):
    with open(name, "w") as file:
        file.write("{")
code, said = hoodoo("report", "o")
check(code == 3 and "No wedge has a sound frame." in page() and "no sound frame" in page(), "no sound frame anywhere: said, and exit 3 " + said)
os.remove("o/farm/job.yaml")
code, said = hoodoo("report", "o")
check(code == 3, "a folder of neither is refused: " + said.strip()[-80:])
