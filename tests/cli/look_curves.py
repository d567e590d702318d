"""The page of hoodoo look: the report's curves over the frames simulated so far, and what the job itself would cost."""
import json
import re
import sys

from looking import Page, look, write
from script import TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
EDITS = open(f"{TOP}/tests/restart/edits.yaml").read()
write(EDITS)


def figures(answer):
    """All charts in an answer, in its order."""
    if isinstance(answer, str):
        return [answer] if answer.startswith("<figure") else []
    parts = answer.values() if isinstance(answer, dict) else answer if isinstance(answer, list) else []
    return [figure for part in parts for figure in figures(part)]


def unmarked(figure):
    return re.sub(r'<line class="mark"[^>]*>\n', "", figure)


def marks(answer):
    return [float(x) for figure in figures(answer) for x in re.findall(r'<line class="mark" x1="([0-9.]+)"', figure)]


def frames(answer):
    return answer["erosion"]["volume_chart"].count("<title>")


page = Page("edits.yaml")
ok(page.json("/curves") == {}, "no curves before the first picture")
code = page.fetch("/picture", token=page.token, frame=1001)[0]
ok(code == 200 and figures(page.json("/curves")) == [], "none over a single frame")
page.fetch("/picture", token=page.token, frame=1006)
first = page.json("/curves")
ok(len(figures(first)) == 5 and frames(first) == 6, "curves over the frames so far", first.keys(), len(figures(first)))
page.fetch("/picture", token=page.token, frame=1010)
last = page.json("/curves")
ok(len(marks(last)) == len(figures(last)) == 5 and frames(last) == 10 and len(set(marks(last)) - {522.0}) == 0, "and over all, each with the last frame marked", marks(last))
page.fetch("/picture", token=page.token, frame=1004)
back = page.json("/curves")
ok([unmarked(f) for f in figures(back)] == [unmarked(f) for f in figures(last)] and 76 < min(marks(back)) <= max(marks(back)) < 522, "an earlier frame is marked in the same curves", marks(back))
again = Page("edits.yaml")
again.fetch("/picture", token=again.token, frame=1004)
ok(again.json("/curves") == back, "cached states carry the numbers of the frames before them")

# The curves are those of the report of a run.
code, said = hoodoo("run", "edits.yaml", "--out", "out", "--progress", "none")
code, said = hoodoo("report", "out", "--no-pictures")
html = open("out/report/index.html").read() if code == 0 else ""
ok(code == 0 and all(unmarked(figure) in html for figure in figures(last)), "the curves are the report's", code, said)

# An edit of the job is seen in the curves after it, and only there.
write(EDITS.replace("radius_m: 1.2", "radius_m: 1.9"))
page.fetch("/picture", token=page.token)
titles = [re.findall("<title>(.*?)</title>", curves["erosion"]["volume_chart"], re.S) for curves in (last, page.json("/curves"))]
ok(titles[0][:7] == titles[1][:7] and titles[0][7:] != titles[1][7:], "an edit changes the curves from its frame on", titles)

# What the job itself costs.
write(EDITS)
code, made = look("edits.yaml", "--spacing", "1")
plan = json.loads(hoodoo("plan", "edits.yaml", "--json", "--device", "none")[1])
ok(all(made["job_" + name] == plan[name] for name in ("particles", "device_bytes", "host_bytes")), "memory as plan estimates it", made, plan)
coarse = look("edits.yaml", "--spacing", "1", "--set", "domain.spacing_m=1")[1]
ok(1 < made["job_seconds"] / coarse["job_seconds"] <= 16, "time, which grows with particles and steps", made, coarse)
note = json.loads(page.fetch("/picture", token=page.token)[2])
ok(note["job_particles"] == plan["particles"] and note["job_bytes"] == plan["device_bytes"] + plan["host_bytes"] and note["job_seconds"] == made["job_seconds"], "the page has them", note)
code, said = hoodoo("look", "edits.yaml", "--spacing", "1", "--progress", "none")
ok(code == 0 and re.search(r"about \d+ particles; the job itself: \d+, roughly [\d.]+ s here, 0\.\d\d GB on the device and 0\.\d\d GB beside", said), "in words", said)
finish()
