#!/bin/sh
# More water that nobody has looked at: tests/physics/any_water.py on a dozen other numbers.
exec /usr/bin/python3 "$HOODOO_TOP/tests/physics/any_water.py" "${1:-100}" "${2:-12}"
