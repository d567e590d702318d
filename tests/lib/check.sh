# For tests in sh. check NAME COMMAND...: a TAP line; where the command fails, with the last that `out`, `err` and `log` say, those
# that there are.
checks_failed=0
check() {
    name=$1
    shift
    if "$@"; then
        echo "ok $name"
        return
    fi
    echo "not ok $name"
    checks_failed=$((checks_failed + 1))
    for said in out err log; do
        [ ! -f "$said" ] || tail -n 20 "$said" | sed "s/^/# $said: /"
    done
}

# fault KIND TRIED WHAT: a row of the table in tests/README.md, as in script.py.
fault() {
    echo "# fault | $1 | $2 | $3 | $checks_failed |"
}
