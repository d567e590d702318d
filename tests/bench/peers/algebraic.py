"""The stress of the demo at 64^3 cells by algebraic multigrid: PyAMG's smoothed aggregation and PETSc's GAMG.

Both get the assembled matrix that tests/bench/stress.c left in BENCH_FOLDER, with rigid motions as near null space,
and iterate until the residual is what it is for our solution. The times count set-up and solution, from the assembled matrix
on, for our times count set-up as well.
"""
import json
import os
import sys
import time

try:
    import numpy as np
    import scipy.sparse as sp
except ImportError:
    sys.exit(77)

path = os.path.join(os.environ.get("BENCH_FOLDER", "."), "system")
if not os.path.exists(path):
    print("    algebraic.py: the bench of stress has left no system; run that in the same run")
    sys.exit(77)
with open(path, "rb") as f:
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
residual = np.linalg.norm(b - A @ x) / np.linalg.norm(b)
print(f"    {n} unknowns; our solution's residual is {residual:.2g} of the load")
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


present = 0
try:
    import pyamg
    seconds = []
    for _ in range(3):
        start = time.perf_counter()
        levels = pyamg.smoothed_aggregation_solver(A.tobsr(blocksize=(3, 3)), B=rigid, strength=("symmetric", {"theta": 0.0}))
        solution = levels.solve(b, tol=residual, accel="cg", maxiter=500)
        seconds.append(time.perf_counter() - start)
    reached = np.linalg.norm(b - A @ solution) / np.linalg.norm(b)
    print(f"    PyAMG reached {reached:.2g}")
    row(f"PyAMG {pyamg.__version__}", seconds)
    present += 1
except ImportError:
    print("    PyAMG is not installed")
try:
    import petsc4py
    petsc4py.init(["-pc_gamg_threshold", "0.0", "-mg_levels_ksp_type", "chebyshev", "-mg_levels_pc_type", "jacobi"])
    from petsc4py import PETSc
    seconds = []
    for _ in range(3):
        matrix = PETSc.Mat().createAIJ(size=A.shape, csr=(A.indptr.astype("i4"), A.indices.astype("i4"), A.data))
        matrix.setBlockSize(3)
        vectors = []
        for column in np.linalg.qr(rigid)[0].T:
            vectors.append(PETSc.Vec().createWithArray(np.ascontiguousarray(column)))
        matrix.setNearNullSpace(PETSc.NullSpace().create(vectors=vectors))
        right, solution = PETSc.Vec().createWithArray(b), PETSc.Vec().createWithArray(np.zeros(n))
        solver = PETSc.KSP().create()
        solver.setType("cg")
        solver.getPC().setType("gamg")
        solver.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
        solver.setTolerances(rtol=residual, max_it=500)
        solver.setOperators(matrix)
        solver.setFromOptions()
        start = time.perf_counter()
        solver.setUp()
        solver.solve(right, solution)
        seconds.append(time.perf_counter() - start)
    print(f"    PETSc took {solver.getIterationNumber()} iterations and reached "
          f"{np.linalg.norm(b - A @ solution.getArray()) / np.linalg.norm(b):.2g}")
    row("PETSc GAMG " + ".".join(map(str, PETSc.Sys.getVersion())), seconds)
    present += 1
except ImportError:
    print("    petsc4py is not installed")
sys.exit(0 if present else 77)
