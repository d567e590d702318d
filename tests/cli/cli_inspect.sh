#!/bin/sh
# inspect on JSON files: the same content as text and as JSON. (Checkpoints, VDB and EXR files need a run.)
set -u
. "$HOODOO_TOP/tests/lib/check.sh"

cat >run.json <<'END'
{"version": "0.1.0", "device": {"name": "a \"device\"", "memory_bytes": 2147483648}, "seed": 7,
 "inputs": [{"path": "a.obj", "file_bytes": 10}, {"path": "longer.obj", "file_bytes": 123456}], "took_seconds": 126,
 "list": [1, 2.5, true, null], "none": []}
END
"$HOODOO" inspect run.json >out
check "inspect exits 0" [ $? = 0 ]
check "the kind" grep -qE '^kind +run$' out
check "members of members" grep -qE '^    name +a "device"$' out
check "bytes for people" grep -qE '^    memory +2\.1 GB$' out
check "durations for people" grep -qE '^  took +2 min 6 s$' out
check "tables have heads" grep -qE '^    path        file$' out
check "tables line up" grep -qE '^    a\.obj       10 bytes$' out
check "lists on a line" grep -qE '^  list +1 2\.5 yes -$' out
check "empty lists" grep -qE '^  none +none$' out
"$HOODOO" inspect --json run.json >out
check "--json exits 0" [ $? = 0 ]
check "--json is JSON with the same content" /usr/bin/python3 -c '
import json
a, b = json.load(open("out"))["content"], json.load(open("run.json"))
assert a == b, a'
for bad in '{' '{"a": 1' '{"a": 1}}' '{"a": tru}'; do
    printf '%s' "$bad" >bad.json
    "$HOODOO" inspect bad.json >out 2>&1
    check "refuses $bad" [ $? = 3 ]
done
