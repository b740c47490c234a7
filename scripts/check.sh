#!/bin/bash
# Static checks: lint, format, types and layers. Run scripts/setup.sh --test once before.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PATH="$PWD/.venv/bin:$PATH"

ruff check .
ruff format --check .
mypy
lint-imports
