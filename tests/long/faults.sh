#!/bin/sh
# Campaigns of faults at length: each kind of product by each kind of damage, hundreds of planted numbers, every call about files and the
# device, and a thousand kills. Takes hours.
set -u
export HOODOO_TEST_EFFORT=20
mkdir -p products numbers calls killed
(cd products && /usr/bin/python3 "$HOODOO_TOP/tests/restart/products.py")
(cd numbers && "$(dirname "$HOODOO")/tests/physics/test_numbers")
(cd calls && FAULTS=all /usr/bin/python3 "$HOODOO_TOP/tests/restart/faults.py")
(cd killed && /usr/bin/python3 "$HOODOO_TOP/tests/restart/killed.py" 200)
