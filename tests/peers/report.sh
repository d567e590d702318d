#!/bin/sh
# Chromium opens a report from file://: no error on its console, no request beyond files, slider and video alive, something to see.
set -u
say() {
    if [ "$1" = 0 ]; then echo "ok $2"; else echo "not ok $2"; fi
}
job=$HOODOO_TOP/tests/peers/lib/usd.yaml
"$HOODOO" run "$job" --out out --progress none >log 2>&1 || {
    echo "not ok a run"
    sed 's/^/# /' log
    exit 1
}
"$HOODOO" preview out --preset draft --resolution 320x180 --frames 1001-1005x4 >log 2>&1
"$HOODOO" preview out --preset draft --resolution 320x180 --turntable --views 4 >>log 2>&1
"$HOODOO" report out >>log 2>&1
say $? "a report"
page=file://$PWD/out/report/index.html
browse() {
    HOME=$PWD timeout 120 chromium --headless=new --no-sandbox --disable-gpu --disable-background-networking --no-first-run \
        --disable-component-update --user-data-dir="$PWD/profile" --virtual-time-budget=5000 "$@" "$page" 2>said
}
browse --enable-logging=stderr --log-net-log=net.json --dump-dom >dom.html
say $? "chromium loads the page"
grep CONSOLE said && bad=1 || bad=0
say $bad "nothing on its console"
/usr/bin/python3 "$HOODOO_TOP/tests/peers/lib/in_browser.py" net.json dom.html
echo '<!DOCTYPE html><title>x</title><img src="http://localhost:9/x.png">' >control.html
page=file://$PWD/control.html
browse --log-net-log=net.json --dump-dom >control.dom
/usr/bin/python3 "$HOODOO_TOP/tests/peers/lib/in_browser.py" net.json control.dom control
# The slider moved by its script, as a visitor's hand does.
sed 's|</body>|<script>addEventListener("load", () => { const i = document.querySelector(".slider input"); i.value = 20; i.dispatchEvent(new Event("input")); document.title = document.querySelector(".slider").style.getPropertyValue("--at") + " " + document.querySelector("video").readyState + " " + Array.from(document.images).every(i => i.naturalWidth > 0); });</script></body>|' \
    out/report/index.html >out/report/moved.html
page=file://$PWD/out/report/moved.html
browse --dump-dom | grep -o -m 1 '<title>[^<]*' >title
grep -q '<title>20% [1-4] true' title
say $? "the slider follows its handle, the video's head and all pictures are read: $(cat title)"
page=file://$PWD/out/report/index.html
for size in 1280,2400 390,2400; do
    browse --window-size=$size --hide-scrollbars --screenshot="$PWD/$size.png" >/dev/null
    oiiotool --stats "$size.png" >stats 2>&1
    # Not one flat colour: the deviation of red is that of text and pictures on paper.
    awk '/Stats StdDev/ { found = ($3 > 8) } END { exit !found }' stats
    say $? "there is something to see at $size"
done
browse --print-to-pdf="$PWD/page.pdf" --no-pdf-header-footer >/dev/null
[ -s page.pdf ] && [ "$(grep -ac '/Type */Page\b' page.pdf)" -ge 2 ]
say $? "it prints on paper, $(grep -ac '/Type */Page\b' page.pdf) pages"
