"""scripts/setup.sh on made-up machines: each tool it calls is a stub that tells on it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="the script is for Debian and Ubuntu"
)

# Stands for a Python: answers the version question, makes a .venv of itself, 'installs' with pip.
PYTHON = """#!/bin/sh
echo "python $*" >>"$CALLS"
case "$*" in
    "-m venv --clear .venv") mkdir -p .venv/bin && cp "$0" .venv/bin/python ;;
    "-") exit {verdict} ;;
    --version) echo "Python {version}" ;;
esac
"""


class Machine:
    def __init__(self, home: Path) -> None:
        self.home = home
        self.calls = home / "calls"
        self.calls.touch()
        (home / "scripts").mkdir()
        shutil.copy(REPOSITORY / "scripts" / "setup.sh", home / "scripts")
        (home / "tools").mkdir()
        for tool in ("bash", "dirname", "env", "mkdir", "cp", "rm", "cat"):
            (home / "tools" / tool).symlink_to(shutil.which(tool))

    def add(self, name: str, text: str) -> None:
        path = self.home / "tools" / name
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def add_logging(self, name: str, then: str = "exit 0") -> None:
        self.add(name, f'#!/bin/sh\necho "{name} $*" >>"$CALLS"\n{then}\n')

    def setup(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [shutil.which("bash"), "scripts/setup.sh", *arguments],
            cwd=self.home,
            env={"PATH": str(self.home / "tools"), "CALLS": str(self.calls)},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )

    def log(self) -> str:
        return self.calls.read_text(encoding="utf-8")


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    machine = Machine(tmp_path)
    machine.add("python3", PYTHON.format(verdict=0, version="3.11.2"))
    machine.add("id", "#!/bin/sh\necho 0\n")
    machine.add_logging("apt-get")
    return machine


def test_root_installs_without_sudo(machine):
    done = machine.setup()
    assert done.returncode == 0, done.stderr
    assert "apt-get -qq install -y --no-install-recommends python3 python3-venv" in machine.log()
    assert "xvfb" not in machine.log()
    assert machine.log().rstrip().endswith("-m pip install --quiet --disable-pip-version-check .")


def test_the_test_option_adds_a_display_and_the_test_tools(machine):
    done = machine.setup("--test")
    assert done.returncode == 0, done.stderr
    assert "xvfb xauth" in machine.log()
    assert machine.log().rstrip().endswith("--disable-pip-version-check -e .[test]")


def test_a_user_installs_through_sudo(machine):
    machine.add("id", "#!/bin/sh\necho 1000\n")
    machine.add_logging("sudo", 'exec "$@"')
    done = machine.setup()
    assert done.returncode == 0, done.stderr
    assert "sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq update" in machine.log()


def test_a_user_without_sudo_goes_on_with_what_is_there(machine):
    machine.add("id", "#!/bin/sh\necho 1000\n")
    done = machine.setup()
    assert done.returncode == 0, done.stderr
    assert "neither root nor sudo" in done.stderr
    assert "apt-get" not in machine.log()
    assert "-m pip install" in machine.log()


def test_an_unusable_apt_is_said_and_does_not_stop(machine):
    machine.add_logging("apt-get", "exit 100")
    done = machine.setup()
    assert done.returncode == 0, done.stderr
    assert "apt-get install failed" in done.stderr
    assert "-m pip install" in machine.log()


def test_an_old_python_is_refused_with_one_sentence(machine):
    machine.add("python3", PYTHON.format(verdict=1, version="3.10.12"))
    done = machine.setup()
    assert done.returncode != 0
    assert "needs Python 3.11 to 3.13" in done.stderr
    assert "found Python 3.10.12" in done.stderr
    assert not (machine.home / ".venv").exists()


def test_a_newer_python_beside_an_old_default_is_taken(machine):
    machine.add("python3", PYTHON.format(verdict=1, version="3.10.12"))
    machine.add("python3.12", PYTHON.format(verdict=0, version="3.12.3"))
    done = machine.setup()
    assert done.returncode == 0, done.stderr
    assert "Python 3.12.3" in done.stderr


def test_a_failing_install_of_packages_is_a_failure(machine):
    broken = PYTHON.replace("case ", 'case "$*" in *"pip install"*) exit 7 ;; esac\ncase ', 1)
    machine.add("python3", broken.format(verdict=0, version="3.11.2"))
    assert machine.setup().returncode == 7


def test_an_unknown_option_is_refused_before_anything_is_installed(machine):
    done = machine.setup("--tset")
    assert done.returncode == 2
    assert "--tset" in done.stderr
    assert machine.log() == ""
