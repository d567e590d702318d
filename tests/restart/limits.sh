#!/bin/sh
# Under ulimit -v and -u no library ends the process in its own way or waits for ever: every outcome is in the table of exit codes.
cp "$HOODOO_TOP/tests/restart/twelve.yaml" job.yaml
umask 0
chmod 777 .
bad=
try() { # LIMIT VALUE COMMAND...
    limit=$1 value=$2
    shift 2
    rm -rf out
    (ulimit -c 0 && exec "$@" prlimit "$limit=$value" "$HOODOO" run job.yaml --device cpu --frames 1001-1002 --out out --progress none) >said 2>&1 &
    pid=$!
    for _ in $(seq 300); do
        kill -0 $pid 2>/dev/null || break
        sleep 0.1
    done
    kill -KILL $pid 2>/dev/null && bad="$bad; $limit=$value: it hangs"
    wait $pid
    code=$?
    case $code in 0 | 3 | 4 | 5 | 6) ;; *) bad="$bad; $limit=$value: exit $code: $(tail -n 1 said | cut -c 1-200)" ;; esac
    codes="$codes $code"
}
for megabytes in 150 250 300 350 400 450 500 600 800 4000; do try --as ${megabytes}000000; done
case $codes in *0) [ -z "$bad" ] && echo "ok ulimit -v ends in the table of exit codes:$codes" || echo "not ok ulimit -v$bad" ;; *) echo "not ok with 4 GB a run is done:$codes" ;; esac
[ -z "$bad" ] || status=1
if [ "$(id -u)" != 0 ]; then
    echo "ok ulimit -u # skip needs root, for a user who has no other processes"
    exit ${status:-0}
fi
bad= codes=
home=$PWD
for n in 2 3 4 5 6 8 12 40; do try --nproc $n setpriv --reuid 4242 --regid 4242 --clear-groups env HOME="$home"; done
case $codes in *0) [ -z "$bad" ] && echo "ok ulimit -u likewise:$codes" || echo "not ok ulimit -u$bad" ;; *) echo "not ok with 40 processes a run is done:$codes"; tail -n 3 said ;; esac
[ -z "$bad" ] || status=1
exit ${status:-0}
