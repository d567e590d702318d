"""Readers of images, meshes and volumes that die while they read, as when the machine runs out of memory and kills the largest: an error that
names the file, and nothing is left behind."""

import os
import random
import subprocess
import sys

import numpy
import OpenImageIO

sys.dont_write_bytecode = True
from script import *

HERE = os.getcwd()
READERS = ("hoodoo-read", "hoodoo-read-image", "hoodoo-read-mesh")
DYING = """#!/bin/sh
# Starts the reader, kills it after DIE_AFTER seconds, and dies like it.
"%s" "$@" &
sleep "$DIE_AFTER"
kill -9 $! $$
"""
os.makedirs("libexec")
for name in READERS:
    with open("libexec/" + name, "w") as file:
        file.write(DYING % os.path.join(os.path.dirname(HOODOO), name))
    os.chmod("libexec/" + name, 0o755)
os.symlink(os.path.join(os.path.dirname(HOODOO), "hoodoo-vdb.so"), "libexec/hoodoo-vdb.so")
draw = random.Random(int(os.environ.get("SEED", "1")))
BASE = """hoodoo: 1
name: n
model: goblins
frames: 1-2
clock: {years_per_frame: 100}
domain: {size_m: [8, 8, 8], spacing_m: 0.5}
strata: [{weak_m_per_kyr: 0.1}]
scene: {%s}
"""
out = OpenImageIO.ImageOutput.create("hill.exr")
out.open("hill.exr", OpenImageIO.ImageSpec(1024, 1024, 1, OpenImageIO.FLOAT))
out.write_image(numpy.fromfunction(lambda y, x: 2 + numpy.sin(x / 90) + numpy.cos(y / 70), (1024, 1024)).astype("float32")[..., None])
out.close()
n = 60
corners = [(4 + 3 * numpy.cos(a) * numpy.sin(b), 4 + 3 * numpy.sin(a) * numpy.sin(b), 3 + 3 * numpy.cos(b))
           for b in numpy.linspace(0, numpy.pi, n + 1) for a in numpy.arange(n) * 2 * numpy.pi / n]
with open("ball.obj", "w") as file:
    for c in corners:
        file.write("v %.6f %.6f %.6f\n" % c)
    for j in range(n):
        for i in range(n):
            a, b, c, d = (j * n + i, j * n + (i + 1) % n, (j + 1) * n + (i + 1) % n, (j + 1) * n + i)
            file.write(f"f {a + 1} {d + 1} {c + 1}\nf {a + 1} {c + 1} {b + 1}\n")
SCENES = {"hill.exr": "heightfield: {file: hill.exr, min_m: [0, 0, 0], max_m: [8, 8, 0], scale_m: 1}", "ball.obj": "mesh: {file: ball.obj}",
          "rock.vdb": "volume: {file: rock.vdb}"}
for name, scene in SCENES.items():
    with open(name.split(".")[0] + ".yaml", "w") as file:
        file.write(BASE % scene)
code, said = hoodoo("run", "ball.yaml", "--device", "cpu", "--out", "whole", "--progress", "none")
ok(code == 0, "a run reads a mesh", said)
os.symlink("whole/volumes/n.0002.vdb", "rock.vdb")
tried, died, bad = 0, 0, []
for name in SCENES:
    job = name.split(".")[0] + ".yaml"
    code, said = hoodoo("check", job)
    ok(code == 0, f"{name} is read", said)
    for words in (["check", job], ["run", job, "--device", "cpu", "--out", "out", "--progress", "none"], ["inspect", name]):
        if words[0] == "inspect" and name == "ball.obj":
            continue
        for after in (0, 0.003, draw.uniform(0.003, 0.05)):
            code, said = hoodoo(*words, env={**os.environ, "HOODOO_LIBEXEC": HERE + "/libexec", "DIE_AFTER": str(after)})
            tried += 1
            died += code != 0
            if not (code == 0 or code == 3 and name.split(".")[0] in said) or os.path.exists("out/lock"):
                bad.append(f"{' '.join(words)}, {after} s: exit {code}: {said[-300:]}")
            ask("rm", "-rf", "out")
ok(not bad and died > tried // 2, f"{died} of {tried} commands lost their reader: exit 3, and the file is named", "\n".join(bad))
left = ask("pgrep", "-f", HERE + "/libexec")[1]
ok(not left, "no reader is left", left)
fault("readers of images, meshes and volumes killed while they read", tried, "exit code 3 with the file's name; no process and no lock is left")
finish()
