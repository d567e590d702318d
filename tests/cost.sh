#!/bin/sh
# cost.sh: what `make demo` costs, in CPU seconds, which other work on the machine changes less than the time that passes. Makes
# all of build/hoodoo that is not there yet, so it measures the build only where it runs first; then a tenth of the demo:
# its first frames, a still, and a few views. A TAP line for each, and the count. The README promises the whole in 5 minutes
# on 2 cores: 10 minutes of CPU. Here each part may take about twice what it took when it was written.
set -u
cd "$(dirname "$0")/.." || exit 1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export HOODOO_CACHE="$scratch/cache" # compiled kernels are part of what a first demo costs
bad=0
spent=0

# within NAME SECONDS COMMAND...
within() {
    name=$1 most=$2
    shift 2
    "$@" >"$scratch/log" 2>&1
    code=$?
    times >"$scratch/times" # the second line is of what has ended here: user, system, as 1m2.30s
    now=$(awk 'NR == 2 { gsub(/s/, ""); split($1, u, "m"); split($2, s, "m"); printf "%.0f", 60 * (u[1] + s[1]) + u[2] + s[2] }' "$scratch/times")
    took=$((now - spent)) spent=$now
    if [ $code = 0 ] && [ $took -le "$most" ]; then
        echo "ok $name: $took s of CPU, of at most $most"
    else
        echo "not ok $name: $took s of CPU, of at most $most; exit code $code"
        tail -n 20 "$scratch/log" | sed 's/^/# /'
        bad=$((bad + 1))
    fi
}
within "the build" 340 make
within "the demo's first frames" 60 build/hoodoo run jobs/demo.yaml --out "$scratch/out" --frames 1001-1005
within "a still" 24 build/hoodoo preview "$scratch/out" --frames 1005 --only stills
within "views" 24 build/hoodoo preview "$scratch/out" --frames 1005 --turntable --only views --view 0-3 --preset draft --resolution 480x270
echo "$((4 - bad)) passed, $bad failed"
[ $bad = 0 ]
