#!/bin/sh
# cost.sh: the cost of `make demo` in CPU seconds, which depend less on other work on the machine than elapsed time. Builds
# build/hoodoo, so it measures the build only in a clean checkout, and then runs a tenth of the demo: its first frames, a still,
# and a few views. Prints a TAP line for each part, and the counts. The README promises the whole in 5 minutes on 2 cores, that
# is 10 minutes of CPU time. Each part may take about twice as long as when this was written.
set -u
cd "$(dirname "$0")/.." || exit 1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export HOODOO_CACHE="$scratch/cache" # the first demo includes compiling kernels
bad=0
spent=0

# within NAME SECONDS COMMAND...
within() {
    name=$1 most=$2
    shift 2
    "$@" >"$scratch/log" 2>&1
    code=$?
    times >"$scratch/times" # the second line is for ended children: user and system time, as 1m2.30s
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
