"""A step of Taichi's own 3D MLS-MPM example (taichi/examples/simulation/mpm3d.py of the installed package: elastic
fluid, floats, atomics) on the CPU, with a million particles on 128^3 cells. For tests/bench/mpm.c to be compared
with; run by hand:

    python3 -m venv /tmp/taichi && /tmp/taichi/bin/pip install taichi && /tmp/taichi/bin/python tests/bench/taichi_mpm.py
"""
import importlib.util
import os
import sys
import tempfile
import time

import taichi

THREADS = int(sys.argv[1]) if len(sys.argv) > 1 else 2
path = os.path.join(os.path.dirname(taichi.__file__), "examples", "simulation", "mpm3d.py")
text = open(path).read()
for old, new in [
    ("ti.init(arch=ti.gpu)", f"ti.init(arch=ti.cpu, cpu_max_num_threads={THREADS})"),
    ("\ndim, n_grid, steps, dt = 3, 32, 25, 4e-4", "\ndim, n_grid, steps, dt = 3, 128, 25, 8e-5"),
    ("n_particles = n_grid**dim // 2 ** (dim - 1)", "n_particles = 1000000"),
]:
    if old not in text:
        sys.exit(f"{path} is another version of the example: it has no line '{old.strip()}'")
    text = text.replace(old, new)
with tempfile.TemporaryDirectory() as folder:
    file = os.path.join(folder, "mpm3d_million.py")
    open(file, "w").write(text)
    spec = importlib.util.spec_from_file_location("mpm3d_million", file)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    example.init()
    example.substep()  # compiles
    taichi.sync()
    best = 1e9
    for _ in range(7):
        begin = time.perf_counter()
        example.substep()
        taichi.sync()
        best = min(best, time.perf_counter() - begin)
print(f"taichi {taichi.__version__}: a step of {example.n_particles} particles on {example.n_grid}^3 cells "
      f"{1e3 * best:.1f} ms on {THREADS} threads")
