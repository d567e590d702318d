#!/bin/sh
# Campaigns of faults at length: each kind of product by each kind of damage, and hundreds of planted numbers.
set -u
export HOODOO_TEST_EFFORT=20
mkdir -p products numbers
(cd products && /usr/bin/python3 "$HOODOO_TOP/tests/restart/products.py")
(cd numbers && "$(dirname "$HOODOO")/tests/physics/test_numbers")
