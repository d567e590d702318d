#!/bin/sh
# faults.sh ROWS: compares the rows that fault campaigns have printed with the table in tests/README.md. Differences are printed, with a line of
# counts for run.sh that reports a failure. With HOODOO_FAULTS=write the rows are written into the table instead (`make faults`). With an
# effort other than 1 the numbers differ, so nothing is compared.
set -u
rows=$1 page=$(dirname "$0")/README.md
[ -s "$rows" ] || exit 0
if [ "${HOODOO_FAULTS:-}" = write ]; then
    # Rows are identified by their command; rows of campaigns that did not run stay.
    awk -F '|' 'NR == FNR { fresh[$6] = fresh[$6] $0 "\n"; next }
        /^\| .*sh tests\/run.sh build/ { if (!($6 in fresh)) print; else if (!($6 in done)) { printf "%s", fresh[$6]; done[$6] } ; next }
        /^<!-- end of the table -->/ { for (c in fresh) if (!(c in done)) printf "%s", fresh[c] }
        { print }' "$rows" "$page" >"$page.new" && mv "$page.new" "$page"
    exit 0
fi
[ "${HOODOO_TEST_EFFORT:-1}" = 1 ] || exit 0
grep -vxFf "$page" "$rows" >"$rows.new" || exit 0
sed 's/^/differs from tests\/README.md: /' "$rows.new" >&2
echo "0 1 0 faults 0"
