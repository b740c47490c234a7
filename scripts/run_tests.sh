#!/bin/bash
# Sets everything up and runs the tests; arguments go to pytest (`bash scripts/run_tests.sh -n 2`).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash scripts/setup.sh --test

# The kernels are compiled once here, and not by every test process at the same time.
.venv/bin/posopt plan --no-program >/dev/null

# Tests of the window draw on a display in memory where there is one to be had.
display=()
if command -v xvfb-run >/dev/null && command -v xauth >/dev/null; then
    display=(xvfb-run --auto-servernum --server-args="-screen 0 1280x1024x24")
fi
exec "${display[@]}" .venv/bin/python -m pytest "$@"
