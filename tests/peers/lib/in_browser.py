"""in_browser.py NETLOG DOM [control]: what Chromium asked for, and what it made of the page."""
import json
import re
import sys

log, dom, *control = sys.argv[1:]


def check(good, what, *notes):
    print(("ok " if good else "not ok ") + what)
    if not good:
        print("#", *notes)


text = open(log).read()
try:
    events = json.loads(text)
except json.JSONDecodeError:  # the browser ended first
    events = json.loads(text.rstrip().rstrip(",") + "]}")
kinds = {number: name for name, number in events["constants"]["logEventTypes"].items()}
asked = [(e["params"]["url"], e["params"].get("initiator", "")) for e in events["events"]
         if kinds[e["type"]] == "URL_REQUEST_START_JOB" and "url" in e.get("params", {})]
# The browser's own errands have no file for an initiator.
page = [u for u, initiator in asked if initiator.startswith("file:") or initiator == "null"]
print(*(f"# {u[:80]} from {i}" for u, i in asked), sep="\n")
check(bool(page) == bool(control), "no request to a network" if not control else "a request to a network would be seen", *page)
if control:
    sys.exit()
dom = open(dom, encoding="utf-8").read()
check(re.search(r'<div class="slider" style="--at: ?50%', dom) is not None, "the slider's script ran")
check(re.search(r"<video[^>]*controls", dom) is not None and "turntable.mp4" in dom, "the video is there")
check(dom.count("<svg") >= 5 and dom.count("<title>") > 20, f"charts with values to point at ({dom.count('<svg')})")
