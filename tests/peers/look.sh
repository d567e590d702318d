#!/bin/sh
# Chromium opens the page of `hoodoo look --serve`: a picture, no error on its console, something to see on a desk and on a phone.
set -u
say() {
    if [ "$1" = 0 ]; then echo "ok $2"; else echo "not ok $2"; fi
}
cp "$HOODOO_TOP/tests/restart/edits.yaml" .
XDG_CACHE_HOME=$PWD/cache "$HOODOO" look edits.yaml --serve >address 2>said &
hoodoo=$!
trap 'kill "$hoodoo" 2>/dev/null' EXIT
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    [ -s address ] && break
    sleep 1
done
browse() {
    HOME=$PWD timeout 120 chromium --headless=new --no-sandbox --disable-gpu --disable-background-networking --no-first-run \
        --disable-component-update --user-data-dir="$PWD/profile" --virtual-time-budget=20000 "$@" "$(cat address)" 2>browser
}
browse --enable-logging=stderr --dump-dom >dom.html
say $? "chromium opens the page"
if grep CONSOLE browser; then bad=1; else bad=0; fi
say $bad "nothing on its console"
grep -q 'id="number">frame 1010, 9.5 kyr<' dom.html
say $? "it says which frame it shows, and its age"
grep -q 'src="blob:' dom.html
say $? "it has a picture"
[ "$(grep -o '<figure class="chart">' dom.html | wc -l)" = 5 ] && grep -q 'The job itself: 0.5 m, [0-9]* particles, roughly [0-9.]* s' dom.html
say $? "it has the curves, and what the job itself would cost"
for size in 1200,950 390,800; do
    browse --window-size=$size --hide-scrollbars --screenshot="$PWD/$size.png" >/dev/null
    oiiotool --stats "$size.png" >stats 2>&1
    # Rock before a sky: more than text on one colour.
    awk '/Stats StdDev/ { found = ($3 > 20) } END { exit !found }' stats
    say $? "there is something to see at $size"
done
page=$(cat address)
echo "$page&show=stress&cut=y=7&frame=1003" >address
browse --dump-dom >dom.html
grep -q 'id="number">frame 1003, ' dom.html && grep -q 'id="where">7 m<' dom.html && grep -q 'id="unit">stress, MPa<' dom.html
say $? "the address chooses frame, cut and value"
for size in 1200,950 390,800; do
    browse --window-size=$size --hide-scrollbars --screenshot="$PWD/cut.$size.png" >/dev/null
    ! cmp -s "$size.png" "cut.$size.png"
    say $? "the cut is seen at $size"
done
kill "$hoodoo"
wait "$hoodoo"
say $? "it ends cleanly"
