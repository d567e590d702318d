#!/bin/sh
# Every signal after every frame, once and three times; and kill -9 at 300 random moments.
set -u
lib=$HOODOO_TOP/tests/restart
mkdir -p signals killed
(cd signals && /usr/bin/python3 "$lib/signals.py" all)
(cd killed && SEED=${SEED:-2} /usr/bin/python3 "$lib/killed.py" 100)
