"""The stress of the demo at 64^3 cells by algebraic multigrid: PyAMG's smoothed aggregation and PETSc's GAMG.

Both get the assembled matrix that tests/bench/stress.c left in BENCH_FOLDER, with rigid motions as near null space. They are
timed for the fewest iterations whose error in the energy norm, which is that of the stress, is no larger than our
solution's. The times count set-up and solution, but not the assembly of the matrix, which we do not need.
"""
import glob
import json
import sys
import time
import warnings

from left import ABSENT, left_by

try:
    import numpy as np
    import scipy.sparse as sp
except ImportError:
    sys.exit(ABSENT)

with open(left_by("stress", "system"), "rb") as f:
    *cells, weight = f.readline().split()
    nx, ny, nz = (int(n) for n in cells)
    K = np.frombuffer(f.read(24 * 24 * 8)).reshape(24, 24)
    fill = np.frombuffer(f.read(4 * nx * ny * nz), np.float32).astype(float)
    ours = np.frombuffer(f.read(), np.float32).reshape(-1, 4)[:, :3].astype(float)
weight = float(weight)

# A node belongs to the system where a cell beside it holds rock; those on the ground (k <= 1) are held.
held = np.flatnonzero(fill > 0)
i, j, k = held % nx, held // nx % ny, held // (nx * ny)
corner = np.stack([((k + (b >> 2)) * (ny + 1) + j + (b >> 1 & 1)) * (nx + 1) + i + (b & 1) for b in range(8)], axis=1)
free = np.zeros((nx + 1) * (ny + 1) * (nz + 1), bool)
free[corner] = True
free[: 2 * (nx + 1) * (ny + 1)] = False
number = np.full(len(free), -1)
number[free] = np.arange(free.sum())
dof = (3 * number[corner][:, :, None] + np.arange(3)).reshape(-1, 24)
dof[np.repeat(number[corner] < 0, 3, axis=1)] = -1
share = np.maximum(fill[held], 0.05)
rows = np.repeat(dof, 24, axis=1).ravel()
columns = np.tile(dof, (1, 24)).ravel()
values = (share[:, None] * K.ravel()).ravel()
inside = (rows >= 0) & (columns >= 0)
n = 3 * int(free.sum())
A = sp.csr_matrix((values[inside], (rows[inside], columns[inside])), shape=(n, n))
A.sum_duplicates()
b = np.zeros(n)
np.add.at(b, dof[:, 2::3][dof[:, 2::3] >= 0], -np.repeat(fill[held] * weight / 8, 8)[dof[:, 2::3].ravel() >= 0])
x = ours[free].ravel()
place = np.stack(np.unravel_index(np.flatnonzero(free), (nz + 1, ny + 1, nx + 1)), axis=1)[:, ::-1].astype(float)
place -= place.mean(axis=0)
rigid = np.zeros((n, 6))
for axis in range(3):
    rigid[axis::3, axis] = 1
    u, v = (axis + 1) % 3, (axis + 2) % 3
    rigid[u::3, 3 + axis], rigid[v::3, 3 + axis] = -place[:, v], place[:, u]


def row(peer, seconds):
    print(json.dumps({"case": "stress: demo at 64^3 cells, cold", "unit": "s", "peer": peer, "theirs": seconds, "at_least": 3}),
          flush=True)


def error(solution):
    """In the energy norm, by that of the exact solution."""
    off = solution - exact
    return float(np.sqrt(max(off @ (A @ off), 0) / (exact @ b)))


def fewest(solve):
    """The fewest iterations whose error is no larger than ours."""
    iterations = 1
    while error(solve(iterations)) > goal and iterations < 200:
        iterations += 1
    return iterations


def timed(solve, iterations):
    seconds = []
    for _ in range(3):
        start = time.perf_counter()
        solve(iterations)
        seconds.append(time.perf_counter() - start)
    return seconds


try:
    import pyamg
except ImportError:
    print("    PyAMG is not installed")
    sys.exit(ABSENT)


def by_pyamg(iterations, tolerance=1e-30):
    levels = pyamg.smoothed_aggregation_solver(blocks, B=rigid, strength=("symmetric", {"theta": 0.0}))
    return levels.solve(b, tol=tolerance, accel="cg", maxiter=iterations)


blocks = A.tobsr(blocksize=(3, 3))
warnings.simplefilter("ignore")  # that it has not reached the tolerance
exact = by_pyamg(1000, 1e-10)
goal = error(x)
print(f"    {n} unknowns; our solution's error in the energy norm is {goal:.2g}")
iterations = fewest(by_pyamg)
print(f"    PyAMG takes {iterations} iterations")
row(f"PyAMG {pyamg.__version__}", timed(by_pyamg, iterations))

# Debian has several builds of PETSc beside each other, none on the path of modules.
sys.path += sorted(glob.glob("/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages"))
try:
    import petsc4py
    petsc4py.init(["-pc_gamg_threshold", "0.0", "-mg_levels_ksp_type", "chebyshev", "-mg_levels_pc_type", "jacobi"])
    from petsc4py import PETSc
except ImportError as missing:
    print(f"    PETSc is not installed: {missing}")
    sys.exit(0)


def by_petsc(iterations):
    matrix = PETSc.Mat().createAIJ(size=A.shape, bsize=3, csr=(A.indptr.astype("i4"), A.indices.astype("i4"), A.data))
    vectors = [PETSc.Vec().createWithArray(np.ascontiguousarray(column)) for column in near.T]
    matrix.setNearNullSpace(PETSc.NullSpace().create(vectors=vectors))
    right, solution = PETSc.Vec().createWithArray(b), PETSc.Vec().createWithArray(np.zeros(n))
    solver = PETSc.KSP().create()
    solver.setType("cg")
    solver.getPC().setType("gamg")
    solver.setTolerances(rtol=1e-30, atol=0, max_it=iterations)
    solver.setOperators(matrix)
    solver.setFromOptions()
    solver.solve(right, solution)
    return solution.getArray().copy()


near = np.linalg.qr(rigid)[0]
iterations = fewest(by_petsc)
print(f"    PETSc takes {iterations} iterations")
row("PETSc GAMG " + ".".join(map(str, PETSc.Sys.getVersion())), timed(by_petsc, iterations))
