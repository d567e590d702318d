#!/bin/sh
# deps.sh PACKAGE...: installs the missing Debian packages when root; otherwise prints the one command and fails.
set -eu
missing=
for p in "$@"; do
    dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q 'ok installed' || missing="$missing $p"
done
[ -n "$missing" ] || exit 0
command="apt-get install -y --no-install-recommends$missing"
if [ "$(id -u)" = 0 ]; then
    echo "installing:$missing"
    apt-get update -q >/dev/null
    # shellcheck disable=SC2086 # a list of package names
    DEBIAN_FRONTEND=noninteractive $command >build/apt.log 2>&1 || { tail -n 20 build/apt.log; exit 1; }
else
    echo "hoodoo needs some Debian packages first; run:" >&2
    echo "  sudo $command" >&2
    exit 1
fi
