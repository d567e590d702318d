#!/bin/sh
# demo.sh HOODOO: erodes jobs/demo.yaml into out/demo, with stills, turntable, video and contact sheet. Run again, it does only
# what is missing.
set -eu
hoodoo=$1
"$hoodoo" run jobs/demo.yaml --out out/demo
"$hoodoo" preview out/demo --frames 1001-1061x20 --resolution 480x270
# A look around: without smooth edges, small, and few, a view takes a second.
"$hoodoo" preview out/demo --frames 1061 --turntable --views 18 --preset draft --resolution 320x180
echo
echo "The arch:"
ls out/demo/preview/*.png out/demo/demo.contact.png out/demo/demo.turntable.mp4
