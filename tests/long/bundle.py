"""The bundle on Debian 11 and 12 with nothing but a loader of Vulkan and lavapipe: as an ordinary user it makes the frames of the program that was
not packed. Debian 11's own lavapipe is too old to compute, so there the loader and C library of the bundle run the driver of Debian 12."""

import hashlib
import os
import shutil
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.environ["HOODOO_TOP"], "tests/peers/lib"))
from packed import archive, inside, pack, root, unpack
from script import *

if os.getuid() != 0 or not shutil.which("debootstrap"):
    print("ok the bundle on other systems # skip needs root and debootstrap")
    sys.exit(0)
code, said = ask("debootstrap", "--variant=minbase", "--print-debs", "bookworm", "probe")
if code:
    print("ok the bundle on other systems # skip Debian's packages cannot be had")
    sys.exit(0)


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


first = digest(pack())
os.remove(archive())
ok(digest(pack()) == first, "packing again gives the same bytes")

JOB, FRAMES = os.path.join(TOP, "jobs/demo.yaml"), "1001-1003"
code, said = ask(HOODOO, "run", JOB, "--frames", FRAMES, "--device", "cpu", "--out", "plain")
ok(code == 0, "the program that was not packed makes the first frames of the demo", said[-800:])
wanted = tree("plain", of_a_run)


def driver_of_12(folder):
    """lavapipe of Debian 12 and its libraries except the C library, as a driver of its own in Debian 11."""
    os.makedirs(folder + "/opt/driver")
    icd = "/usr/lib/x86_64-linux-gnu/libvulkan_lvp.so"
    paths = [line.split()[2] for line in ask("chroot", "bookworm", "ldd", icd)[1].splitlines() if "=> /" in line] + [icd]
    for path in paths:
        if os.path.basename(path) not in ("libc.so.6", "libm.so.6"):
            shutil.copy("bookworm" + os.path.realpath("/" + path) if os.path.exists("bookworm" + os.path.realpath("/" + path)) else "bookworm" + path,
                        folder + "/opt/driver/" + os.path.basename(path))
    with open(folder + "/opt/driver/icd.json", "w") as file:
        file.write('{"file_format_version": "1.0.0", "ICD": {"library_path": "/opt/driver/libvulkan_lvp.so", "api_version": "1.3.230"}}')
    return {"VK_ICD_FILENAMES": "/opt/driver/icd.json", "LD_LIBRARY_PATH": "/opt/driver"}


for release, libc in (("bookworm", "2.36"), ("bullseye", "2.31")):
    code, said = ask("debootstrap", "--variant=minbase", "--include=libvulkan1,mesa-vulkan-drivers", release, release, timeout=1800)
    if not ok(code == 0, f"{release} is set up", said[-1500:]):
        continue
    bundle = unpack(release + "/opt").removeprefix(release)
    hoodoo_there = bundle + "/bin/hoodoo"
    os.makedirs(release + "/w")
    os.chmod(release + "/w", 0o777)
    with root(release) as there:
        if not ok(there, "a root has /proc"):
            continue

        def here(*argv, **more):
            return inside(release, *argv, cwd="/w", HOME="/w", **more)

        ok(libc in here("ldd", "--version")[1], f"{release} has the C library {libc}")
        code, said = here(hoodoo_there, "--version")
        begun = time.monotonic()
        here(hoodoo_there, "--version")
        ok(code == 0, f"hoodoo starts in {1000 * (time.monotonic() - begun):.0f} ms", said)
        code, said = here(hoodoo_there, "devices")
        ok("llvmpipe" in said, "the driver of the system is found and loaded", code, said)
        driver = driver_of_12(release) if release == "bullseye" else {}
        code, said = here(hoodoo_there, "plan", bundle + "/share/hoodoo/jobs/demo.yaml", "--device", "cpu", **driver)
        ok(code == 0 and "tasks" in said, "plan", said[-800:])
        code, said = here(hoodoo_there, "run", bundle + "/share/hoodoo/jobs/demo.yaml", "--frames", FRAMES, "--device", "cpu", "--out", "out", **driver)
        ok(code == 0, "run", said[-800:])
        got = tree(release + "/w/out", of_a_run)
        same = {p for p in wanted if got.get(p) == wanted[p]}
        ok(set(got) == set(wanted) and len(same) == len(wanted), f"all {len(wanted)} files are those of the program that was not packed", sorted(set(wanted) - same))
        code, said = here(hoodoo_there, "mesh", "out", **driver)
        ok(code == 0, "mesh", said[-800:])
        code, said = here(hoodoo_there, "verify", "out", "--frames", FRAMES, **driver)
        ok(code == 0, "verify", said[-800:])
        code, said = here(hoodoo_there, "preview", "out", **driver)
        ok(code == 3 and "povray" in said and "install" in said, "preview says that POV-Ray is missing", code, said[-800:])
        begun = time.monotonic()
        code, said = here(hoodoo_there, "selftest", "--quick", "--device", "cpu", **driver)
        ok(code == 0 and " 0 not ok" in said, f"selftest --quick, {time.monotonic() - begun:.0f} s", said[-3000:])
    shutil.rmtree(release) if release == "bullseye" else None
finish()
