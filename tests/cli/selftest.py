"""hoodoo selftest: everything is ok on a correct device, within the promised time; no files remain, however it ends; a missing or lost device
gives exit code 6. unit/test_selftest shows that it detects errors."""
import json
import os
import re
import signal
import subprocess
import time

from script import HOODOO, finish, hoodoo, ok

SECONDS = 300  # for all checks, on two cores; --quick takes a fifth of it, or half next to other tests
os.mkdir("empty")
os.mkdir("tmp")
HERE = {**os.environ, "TMPDIR": os.path.abspath("tmp")}
HERE.pop("HOODOO_DEVICE", None)


def nothing_left(when):
    ok(not os.listdir("tmp") and not os.listdir("empty"), f"nothing is left {when}", os.listdir("tmp"), os.listdir("empty"))


def selftest(*words, **more):
    done = subprocess.run([HOODOO, "selftest", *words], cwd="empty", env={**HERE, **more}, capture_output=True, text=True, timeout=2 * SECONDS)
    return done.returncode, done.stdout, done.stderr


# ---- a correct device

start = time.monotonic()
code, said, errors = selftest("--quick", "--device", "cpu", "--json")
took = time.monotonic() - start
ok(code == 0, "the CPU's device is right", said[-3000:], errors[-1000:])
found = json.loads(said)
checks = {(c["group"], c["name"]): c for c in found["checks"]}
ok(found["format"] == 1 and found["ok"] and found["quick"] and all(c["ok"] for c in found["checks"]), "every check is ok", [c for c in found["checks"] if not c["ok"]])
ok(took < SECONDS / 2, "in its time", took)
for model in ("arenite", "arenite in seconds", "arenite, slow", "arenite, blocks", "goblins", "arches"):
    for what in ("as recorded", "run again", "resumed", "kernel variants"):
        ok((model, what) in checks, f"{model}: {what}", sorted(checks))
ok({n for g, n in checks if g.startswith("kernels")} == {"scan", "sort", "compaction", "gather", "reduce", "pointer doubling"}, "kernels against plain C", sorted(checks))
ok(found["device"]["type"] == "cpu" and found["device"]["variant"] == "texel" and found["device"]["subgroup"] > 0 and found["device"]["binding_bytes"] >= 1 << 27, "it names the device",
   found["device"])
ok(checks["memory", "largest buffer"]["values"]["bytes"] >= found["device"]["binding_bytes"] + 4096, "buffers beyond what a kernel binds", checks["memory", "largest buffer"])
ok(checks["speed", "copy"]["values"]["bytes_a_second"] > 1e8 and checks["picture", "1920 x 1080"]["values"]["picture_seconds"] > 0, "speeds are numbers")
dispatch = checks["speed", "dispatch"]["values"]
ok(0 < dispatch["record_seconds"] < dispatch["wait_seconds"] < 1, "to record a dispatch takes less than to wait for one", dispatch)
demo = found["demo"]
ok(1 <= len(demo) <= 3 and all(a["spacing_m"] == 2 * b["spacing_m"] and a["particles"] < b["particles"] for a, b in zip(demo, demo[1:])), "the demo, coarse to fine", demo)
ok(all(d["frame_dispatches"] > 20 and 0 < sum(s["frame_ms"] for s in d["stages"]) <= 1001 * d["frame_seconds"] for d in demo), "its stages are within its frames", demo)
nothing_left("after it")

# ---- missing devices

for words, more in ((("--device", "99"), {}), ((), {"HOODOO_DEVICE": "99"}), (("--json", "--device", "uuid:00000000000000000000000000000001"), {})):
    code, said, errors = selftest("--quick", *words, **more)
    ok(code == 6 and not said and "devices here" in errors and errors.count("\n") == 1, f"{words} {more}: there is no such device", code, said, errors)
ok(selftest("--device", "first")[0] == 2, "a device that cannot be one is wrong usage")
code, said, errors = selftest("--quick", HOODOO_TMP="/nowhere")
ok(code == 4 and "/nowhere" in errors, "no place for temporary files", code, errors)
nothing_left("after a refusal")

# ---- stopped by a signal

for number, name in ((signal.SIGTERM, "arenite, as recorded"), (signal.SIGINT, "kernels against plain C, scan")):
    child = subprocess.Popen([HOODOO, "selftest", "--device", "cpu"], cwd="empty", env=HERE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for line in child.stderr:
        if name in line:
            break
    ok(len(os.listdir("tmp")) == 1, "it works in a temporary folder", os.listdir("tmp"))
    child.send_signal(number)
    start = time.monotonic()
    said, errors = child.communicate(timeout=SECONDS)
    ok(child.returncode == 85 and not said and "stopped" in errors, f"{number.name}: it stops", child.returncode, said, errors)
    ok(time.monotonic() - start < 60, "soon", time.monotonic() - start)
    nothing_left(f"after {number.name}")

# ---- a lost device: at the first submission, in a check of kernels, in a model

with open("lost.c", "w") as file:
    file.write("""#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>
VkResult vkQueueSubmit(VkQueue queue, uint32_t n, const VkSubmitInfo *submit, VkFence fence)
{
    static int count;
    if (++count >= atoi(getenv("LOST_AT")))
        return VK_ERROR_DEVICE_LOST;
    return ((PFN_vkQueueSubmit)dlsym(RTLD_NEXT, "vkQueueSubmit"))(queue, n, submit, fence);
}
""")
subprocess.run(["gcc", "-shared", "-fPIC", "-o", "lost.so", "lost.c", "-ldl"], check=True)
for at in (1, 30, 1500):
    code, said, errors = selftest("--quick", "--device", "cpu", LD_PRELOAD=os.path.abspath("lost.so"), LOST_AT=str(at))
    rows = re.findall(r"^\| .{18} \| (ok|NO) \|", said, re.M)
    ok(code == 6 and "VK_ERROR_DEVICE_LOST" in errors.splitlines()[-1] and "computes wrong results" in errors.splitlines()[-1], f"lost at submission {at}: exit code 6, and why", code, errors[-600:])
    ok(rows and rows[-1] == "NO" and rows[:-1].count("NO") == 0 and "NOT OK" in said, "the table ends there", said)
    ok(all(len(line) <= 80 for line in said.splitlines()), "it is 80 columns wide at most", said)
    nothing_left("after that")
ok(hoodoo("selftest", "x")[0] == 2, "operands are wrong usage")
finish()
