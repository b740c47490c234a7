import errno
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from solver.errors import InputError
from solver.io import atomic
from solver.io.atomic import staged, write_atomically

OLD, NEW = b"old " * 50_000, b"the new one " * 40_000


def names(folder):
    return sorted(one.name for one in folder.iterdir())


def refuse_with(number):
    def refuse(*_args, **_kwargs):
        raise OSError(number, os.strerror(number))

    return refuse


def test_a_new_file_holds_what_was_written_and_nothing_else_is_left(tmp_path):
    write_atomically(tmp_path / "A.LS", NEW)
    assert (tmp_path / "A.LS").read_bytes() == NEW
    assert names(tmp_path) == ["A.LS"]


def test_an_old_file_is_replaced(tmp_path):
    path = tmp_path / "A.LS"
    path.write_bytes(OLD)
    write_atomically(path, NEW)
    assert path.read_bytes() == NEW
    assert names(tmp_path) == ["A.LS"]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such permissions")
def test_a_new_file_has_the_permissions_that_any_new_file_gets(tmp_path):
    (tmp_path / "plain").write_bytes(b"")
    write_atomically(tmp_path / "A.LS", NEW)
    assert (tmp_path / "A.LS").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_relative_name_means_the_current_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_atomically(Path("A.LS"), NEW)
    assert (tmp_path / "A.LS").read_bytes() == NEW


def test_a_missing_folder_a_file_as_folder_and_a_folder_as_file_are_refused(tmp_path):
    (tmp_path / "file").write_bytes(OLD)
    (tmp_path / "folder").mkdir()
    for path, says in (
        (tmp_path / "none" / "A.LS", "the folder .*none does not exist"),
        (tmp_path / "file" / "A.LS", "the folder .*file does not exist"),
        (tmp_path / "folder", "is a folder"),
        (tmp_path / "a\0b", "cannot be written"),
        (tmp_path / ("x" * 300), "cannot be written"),
    ):
        with pytest.raises(InputError, match=says):
            write_atomically(path, NEW)
    assert names(tmp_path) == ["file", "folder"]


@pytest.mark.parametrize(
    ("owner", "function", "number"),
    [
        (os, "fsync", errno.ENOSPC),
        (Path, "replace", errno.EACCES),
        (Path, "open", errno.EACCES),
    ],
)
def test_a_failure_at_any_step_leaves_the_old_file_and_no_other(
    tmp_path, monkeypatch, owner, function, number
):
    path = tmp_path / "A.LS"
    path.write_bytes(OLD)
    with monkeypatch.context() as patch:
        patch.setattr(owner, function, refuse_with(number))
        with pytest.raises(InputError, match=rf"A\.LS: cannot be written \({os.strerror(number)}"):
            write_atomically(path, NEW)
    assert path.read_bytes() == OLD
    assert names(tmp_path) == ["A.LS"]


def test_an_interrupt_while_the_file_is_checked_leaves_nothing(tmp_path):
    def check(temporary):
        assert temporary.read_bytes() == NEW
        assert temporary.parent == tmp_path
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), staged(tmp_path / "A.LS", NEW) as temporary:
        check(temporary)
    assert names(tmp_path) == []


def test_a_folder_that_cannot_be_flushed_does_not_spoil_a_file_that_is_whole(tmp_path, monkeypatch):
    monkeypatch.setattr(atomic.os, "open", refuse_with(errno.EACCES))
    write_atomically(tmp_path / "A.LS", NEW)
    assert (tmp_path / "A.LS").read_bytes() == NEW


def test_a_killed_process_leaves_the_old_file_or_the_new_one_whole(tmp_path):
    path = tmp_path / "A.LS"
    path.write_bytes(OLD)
    script = (
        "import sys\n"
        "from pathlib import Path\n"
        "from solver.io.atomic import write_atomically\n"
        "old, new = b'old ' * 50_000, b'the new one ' * 40_000\n"
        "print('ready', flush=True)\n"
        "while True:\n"
        "    write_atomically(Path(sys.argv[1]), new)\n"
        "    write_atomically(Path(sys.argv[1]), old)\n"
    )
    root = str(Path(__file__).parents[2])
    environment = {**os.environ, "PYTHONPATH": root}
    for delay in (0.0, 0.003, 0.01, 0.023, 0.05):
        command = [sys.executable, "-c", script, str(path)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, env=environment) as process:
            assert process.stdout is not None
            assert process.stdout.readline().strip() == b"ready"
            time.sleep(delay)
            process.kill()
        assert path.read_bytes() in {OLD, NEW}
        assert all(name == "A.LS" or name.startswith(".posopt-") for name in names(tmp_path))
