"""Routing with depressions filled on the 1024 x 1024 heights that tests/bench/water.c left in BENCH_FOLDER, by fastscapelib:
single receivers, pits resolved by a minimum spanning tree, and the discharge summed along them."""
import json
import sys
import time

from left import ABSENT, left_by

try:
    import fastscapelib
    import numpy as np
except ImportError:
    sys.exit(ABSENT)
heights = np.fromfile(left_by("water", "heights"), np.float32).astype(float).reshape(1024, 1024)
grid = fastscapelib.RasterGrid(heights.shape, [1.0, 1.0], fastscapelib.NodeStatus.FIXED_VALUE)
flow = fastscapelib.FlowGraph(grid, [fastscapelib.SingleFlowRouter(), fastscapelib.MSTSinkResolver()])
samples = []
for again in range(6):
    start = time.perf_counter()
    flow.update_routes(heights)
    flow.accumulate(1.0)
    if again:  # the first is a warm-up
        samples.append(1e3 * (time.perf_counter() - start))
print(json.dumps({"case": "water: route and discharge on 1024 x 1024 columns", "unit": "ms",
                  "peer": f"fastscapelib {fastscapelib.__version__}, one thread", "theirs": samples, "at_least": 0.5}))
