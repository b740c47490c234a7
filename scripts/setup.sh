#!/bin/bash
# Sets posopt up in .venv: Debian packages (Python, Qt's libraries), then posopt itself.
#
#   bash scripts/setup.sh          the program
#   bash scripts/setup.sh --test   the program from this folder (editable) and the test tools
#
# Works as root and as a user with sudo. Where neither is at hand, or apt-get fails, it says so
# and goes on: the packages may be there already.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# What Qt 6 links against, and what its xcb plugin and a display in memory need.
packages=(
    python3 python3-venv
    libglib2.0-0 libegl1 libgl1 libx11-6 libdbus-1-3 libfontconfig1
    libxkbcommon0 libxkbcommon-x11-0
    libxcb-cursor0 libxcb-icccm4 libxcb-keysyms1 libxcb-shape0 libxcb-xkb1
)
target="."
if [ "${1:-}" = "--test" ]; then
    packages+=(xvfb xauth)
    target="-e .[test]"
elif [ $# -gt 0 ]; then
    echo "setup: unknown option '$1' (known: --test)" >&2
    exit 2
fi

say() { echo "setup: $*" >&2; }

install_debian_packages() {
    if ! command -v apt-get >/dev/null; then
        say "no apt-get here; Qt needs the equivalents of: ${packages[*]}"
        return
    fi
    local as_root=(env)
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            say "neither root nor sudo: going on without installing ${packages[*]}"
            return
        fi
        as_root=(sudo env)
    fi
    as_root+=(DEBIAN_FRONTEND=noninteractive apt-get -qq)
    say "Debian packages ..."
    "${as_root[@]}" update || say "apt-get update failed; going on with the lists at hand"
    "${as_root[@]}" install -y --no-install-recommends "${packages[@]}" >/dev/null ||
        say "apt-get install failed; going on, the packages may be there already"
}

# Prints the first Python that is 3.11 to 3.13 and can make a virtual environment.
find_python() {
    local candidate
    for candidate in python3 python3.13 python3.12 python3.11; do
        if "$candidate" - <<'PY' >/dev/null 2>&1
import sys, venv, ensurepip
sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))
PY
        then
            command -v "$candidate"
            return
        fi
    done
    say "posopt needs Python 3.11 to 3.13 with its venv module;" \
        "found $(python3 --version 2>/dev/null || echo none)." \
        "Install for example python3.11 and python3.11-venv, then run this again."
    return 1
}

install_debian_packages
if ! .venv/bin/python -c "import pip" 2>/dev/null; then
    python=$(find_python)
    say "virtual environment .venv with $("$python" --version) ..."
    "$python" -m venv --clear .venv
fi
say "posopt and its Python packages ..."
rm -rf build/lib # what an earlier build left would be packed again
# shellcheck disable=SC2086 # two words on purpose
.venv/bin/python -m pip install --quiet --disable-pip-version-check $target
say "done: .venv/bin/posopt"
