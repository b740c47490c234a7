import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ls_examples import move, program
from program_examples import grind_program, m20ia

from solver.errors import InputError, ModelError, RefusedError
from solver.io.ls_differences import part_mark
from solver.io.ls_reader import read_program
from solver.io.posts import POSTS, PostOptions
from solver.io.posts.parts import line_count, split_program
from solver.io.verified_program import differences, write_verified
from solver.model.toolpath import Event, EventKind, Role

JOINT = POSTS["fanuc-joint"]
SMALL = PostOptions(line_limit=16)


def long_program(count, **what):
    """A program whose moves can be told apart by J1."""
    return program(*(move([index / 1000, 0, 0, 0, -90, 0]) for index in range(count)), **what)


def write(asked, path, options=SMALL, verify=lambda _: None, post=JOINT):
    return write_verified(asked, path, verify, options, post, m20ia())


def contents(folder):
    return {one.name: one.read_bytes() for one in folder.iterdir()}


MOVES = st.lists(
    st.builds(
        lambda cnt, calls, role: move(
            [0, 0, 0, 0, -90, 0],
            cnt=cnt,
            role=role,
            events=tuple(Event(EventKind.CALL, f"TOOL{call}") for call in calls),
        ),
        st.none() | st.just(100),
        st.lists(st.integers(1, 3), max_size=3),
        st.sampled_from([Role.CONTACT, Role.LINK]),
    ),
    min_size=10,
    max_size=60,
)


@settings(max_examples=150)
@given(
    moves=MOVES,
    name=st.from_regex(r"(TOOL|A)[0-9_]{0,4}[A-Z]{0,29}", fullmatch=True),
    name_length=st.sampled_from([5, 8, 36]),
    line_limit=st.integers(12, 24),
)
def test_parts_hold_all_moves_in_order_within_the_limits(moves, name, name_length, line_limit):
    name = name[:name_length]
    asked = program(*moves, name=name, remarks=("a", "b"))
    options = PostOptions(name_length=name_length, line_limit=line_limit)
    files, refused = (), ""
    try:
        files = JOINT.render(asked, options, m20ia())
    except ModelError as error:
        refused = str(error)
    if refused:
        assert re.search("lines|names|call itself", refused)
        return
    found = tuple(read_program(one.text, one.name) for one in files)
    assert max(len(one.instructions) for one in found) <= line_limit
    assert len(found) > 1 or line_count(asked) <= line_limit
    names = [one.name for one in found]
    called = {event.target for one in moves for event in one.events}
    assert names[0] == name
    assert len(set(names)) == len(names)
    assert not called & set(names[1:])
    assert all(len(one) <= name_length for one in names)
    assert list(differences(asked, found, options, m20ia())) == []


def test_a_part_ends_at_rest_where_its_second_half_holds_a_rest():
    rests = {3, 7, 13}
    moves = [move([0] * 6, cnt=None if index in rests else 100) for index in range(20)]
    parts = split_program(program(*moves), PostOptions(line_limit=14))
    # Four lines of the head leave ten moves for a part.
    assert [len(one.moves) for one in parts] == [8, 6, 6]


def test_without_a_rest_a_part_ends_after_a_contact_move():
    roles = [Role.LINK if index in {8, 9} else Role.CONTACT for index in range(13)]
    moves = [move([0] * 6, cnt=100, role=role) for role in roles]
    first, second = split_program(program(*moves), PostOptions(line_limit=14))
    assert (len(first.moves), len(second.moves)) == (8, 5)


def test_a_program_that_fits_is_not_split():
    asked = grind_program()
    assert split_program(asked, PostOptions(line_limit=line_count(asked))) == (asked,)
    assert len(split_program(asked, PostOptions(line_limit=line_count(asked) - 1))) == 2


@pytest.mark.parametrize(
    ("name", "length", "first", "last"),
    [
        ("GROOVE", 36, "GROOVE1", "GROOVE12"),
        ("GROOVE_HW", 9, "GROOVE_1", "GROOVE_12"),
        ("GROOVE1", 36, "GROOVE1_1", "GROOVE1_12"),
        ("A1234567", 8, "A1234_1", "A1234_12"),
        ("AB1", 3, "A1", "A12"),
        ("A1", 3, "B1", "B12"),
    ],
)
def test_parts_are_named_after_the_program_and_never_like_another(name, length, first, last):
    options = PostOptions(line_limit=14, name_length=length, spindle_on="ON", spindle_off="OFF")
    parts = split_program(long_program(12 * 10, name=name), options)
    assert [one.name for one in parts][:: len(parts) - 1] == [first, last]


def test_no_part_is_called_like_a_program_that_it_calls():
    call = Event(EventKind.CALL, "P1")
    moves = [move([0] * 6, events=(call,)) for _ in range(10)]
    parts = split_program(program(*moves, name="P"), PostOptions(line_limit=14))
    assert "P1" not in [one.name for one in parts]


def test_where_no_name_is_left_the_program_is_refused():
    with pytest.raises(ModelError, match="no names of up to 1 characters"):
        split_program(long_program(20, name="A"), PostOptions(line_limit=14, name_length=1))


def test_a_head_that_leaves_no_room_for_a_move_is_refused():
    with pytest.raises(ModelError, match=r"move 1 needs 17 lines .* one file takes 16"):
        split_program(long_program(20, remarks=("x",) * 12), SMALL)


def test_more_calls_than_lines_are_refused():
    with pytest.raises(ModelError, match="parts, whose calls and 6 remarks"):
        split_program(long_program(200, remarks=("x",) * 6), SMALL)


def test_events_stay_with_the_move_that_they_belong_to():
    moves = [
        move([0] * 6, events=(Event(EventKind.DIGITAL_OUTPUT, str(index + 1), 1.0),) * 2)
        for index in range(12)
    ]
    for part in JOINT.render(program(*moves), SMALL, m20ia())[1:]:
        lines = read_program(part.text, part.name).instructions
        kinds = ["move" if one.motion else one.text[:3] for one in lines[4:]]
        assert kinds == ["move", "DO[", "DO["] * (len(kinds) // 3)


@pytest.mark.parametrize("name", ["A", "N" * 27, "N" * 28, "N" * 36])
def test_the_mark_of_a_part_is_read_from_its_remarks(name):
    parts = split_program(long_program(20, name=name, remarks=("MAIN road", "PART 1")), SMALL)
    for number, part in enumerate(parts, start=1):
        mark = part_mark(part.remarks)
        assert (mark.number, mark.count, mark.owner) == (number, len(parts), name)
        assert part.remarks[mark.lines :] == ("MAIN road", "PART 1")


@pytest.mark.parametrize("remarks", [(), ("a",), ("PART 1 OF 2",), ("MAIN A",), ("MAIN A", "b")])
def test_other_remarks_are_no_mark_of_a_part(remarks):
    assert part_mark(remarks) is None


def test_the_parts_are_written_beside_the_main_program_and_rechecked_together(tmp_path):
    seen = []

    def verify(found):
        seen.append([one.name for one in found])
        assert not any(one.name.startswith("SPLIT") for one in tmp_path.iterdir())

    written = write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS", verify=verify)
    names = ["SPLIT", "SPLIT1", "SPLIT2", "SPLIT3"]
    assert seen == [names]
    assert [one.name for one in written.paths] == [f"{one}.LS" for one in names]
    golden = Path(__file__).parents[1] / "golden"
    assert contents(tmp_path) == {f"{n}.LS": (golden / f"{n}.LS").read_bytes() for n in names}
    assert written.stale == ()


def test_a_refused_set_leaves_nothing_and_touches_nothing(tmp_path):
    write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS")
    before = contents(tmp_path)

    def verify(_found):
        raise RefusedError("too close")

    with pytest.raises(RefusedError, match="too close"):
        write(grind_program(name="SPLIT", payload=4), tmp_path / "SPLIT.LS", verify=verify)
    assert contents(tmp_path) == before


def test_the_main_program_is_placed_last(tmp_path, monkeypatch):
    order = []
    sound = Path.replace
    monkeypatch.setattr(
        Path, "replace", lambda self, target: (order.append(target.name), sound(self, target))[1]
    )
    write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS")
    assert sorted(order[:-1]) == ["SPLIT1.LS", "SPLIT2.LS", "SPLIT3.LS"]
    assert order[-1] == "SPLIT.LS"


@pytest.mark.parametrize("old", [False, True])
@pytest.mark.parametrize("fails", ["SPLIT.LS", "SPLIT1.LS", "SPLIT2.LS", "SPLIT3.LS"])
def test_when_a_name_cannot_be_given_all_are_put_back(tmp_path, monkeypatch, old, fails):
    if old:
        write(grind_program(name="SPLIT", payload=4), tmp_path / "SPLIT.LS")
    before = contents(tmp_path)
    sound = Path.replace

    def broken(self, target):
        if target.name == fails:
            raise PermissionError(13, "in use")
        return sound(self, target)

    monkeypatch.setattr(Path, "replace", broken)
    with pytest.raises(InputError, match="cannot be written"):
        write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS")
    assert contents(tmp_path) == before


def test_parts_that_cannot_be_put_back_are_named_in_one_sentence(tmp_path, monkeypatch):
    sound, remove = Path.replace, Path.unlink

    def broken(self, target):
        if target.name == "SPLIT.LS":
            raise PermissionError(13, "in use")
        return sound(self, target)

    def stuck(self, missing_ok=False):
        if self.name.startswith("SPLIT"):
            raise PermissionError(13, "in use")
        remove(self, missing_ok)

    monkeypatch.setattr(Path, "replace", broken)
    monkeypatch.setattr(Path, "unlink", stuck)
    with pytest.raises(InputError, match=r"its parts SPLIT3.LS, SPLIT2.LS, SPLIT1.LS are"):
        write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS")


def test_parts_of_an_earlier_longer_program_are_reported_and_left(tmp_path):
    path = tmp_path / "SPLIT.LS"
    write(grind_program(name="SPLIT"), path)
    write(grind_program(name="SPLIT1A"), tmp_path / "SPLIT1A.LS", SMALL)
    (tmp_path / "SPLIT9.LS").write_bytes(b"no program")
    shorter = write(grind_program(name="SPLIT"), path, PostOptions(line_limit=20))
    assert [one.name for one in shorter.paths] == ["SPLIT.LS", "SPLIT1.LS", "SPLIT2.LS"]
    assert [one.name for one in shorter.stale] == ["SPLIT3.LS"]
    whole = write(grind_program(name="SPLIT"), path, PostOptions())
    assert [one.name for one in whole.stale] == ["SPLIT1.LS", "SPLIT2.LS", "SPLIT3.LS"]
    assert (tmp_path / "SPLIT3.LS").exists()


@pytest.mark.parametrize("other", [b"somebody's program", None])
def test_a_part_never_replaces_a_program_that_is_none_of_its_own(tmp_path, other):
    if other is None:
        write(grind_program(name="SPLIT2"), tmp_path / "SPLIT2.LS", PostOptions())
    else:
        (tmp_path / "SPLIT2.LS").write_bytes(other)
    before = contents(tmp_path)
    with pytest.raises(InputError, match=r"SPLIT2\.LS: is no part of SPLIT"):
        write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS")
    assert contents(tmp_path) == before


@pytest.mark.parametrize(
    ("file", "old", "new", "says"),
    [
        ("SPLIT.LS", "CALL SPLIT1", "CALL SPLIT2", "instead of call SPLIT1"),
        ("SPLIT.LS", "CALL SPLIT1", "CALL GAUGE1", "instead of call SPLIT1"),
        ("SPLIT.LS", "CALL SPLIT3    ", "WAIT   1.00(sec) ", "instead of call SPLIT3"),
        ("SPLIT.LS", "!verify in T1", "!verify in T2", "its remarks"),
        ("SPLIT.LS", "1,*,*,*,*", "*,*,*,*,*", "its motion group"),
        ("SPLIT1.LS", "/PROG  SPLIT1", "/PROG  SPLIT3", "do not have names of their own"),
        ("SPLIT1.LS", "/PROG  SPLIT1", "/PROG  SPLIT8", "instead of call SPLIT8"),
        ("SPLIT2.LS", "!PART 2 OF 3", "!PART 1 OF 3", "SPLIT2: its remarks do not say PART 2"),
        ("SPLIT2.LS", "!MAIN SPLIT", "!MAIN OTHER", "SPLIT2: its remarks do not say PART 2"),
        ("SPLIT2.LS", "UTOOL_NUM=2", "UTOOL_NUM=1", "SPLIT2: UTOOL_NUM reads 1"),
        ("SPLIT2.LS", "  PAYLOAD[3] ", "  LBL[3] ", "SPLIT2: line 30 reads"),
        ("SPLIT3.LS", "561msec", "562msec", "SPLIT3: line 31 has the speed"),
        ("SPLIT3.LS", "J1=   -26.259", "J1=   -26.258", r"SPLIT3: P\[1\] has J1"),
    ],
)
def test_a_fault_in_any_file_of_a_set_is_found_out(tmp_path, file, old, new, says):
    def render(asked, options, robot):
        files = JOINT.render(asked, options, robot)
        assert any(one.name == file and old in one.text for one in files)
        return tuple(
            one._replace(text=one.text.replace(old, new, 1)) if one.name == file else one
            for one in files
        )

    with pytest.raises(RefusedError, match=says):
        write(
            grind_program(name="SPLIT"),
            tmp_path / "SPLIT.LS",
            post=replace(JOINT, render=render),
        )
    assert contents(tmp_path) == {}


def test_a_part_that_is_missing_or_out_of_order_is_found_out(tmp_path):
    for change in (
        lambda files: files[:-1],
        lambda files: (files[0], files[2], files[1], files[3]),
        lambda files: files[1:],
    ):
        broken = replace(
            JOINT,
            render=lambda asked, options, robot, c=change: c(JOINT.render(asked, options, robot)),
        )
        with pytest.raises(RefusedError, match="was not written"):
            write(grind_program(name="SPLIT"), tmp_path / "SPLIT.LS", post=broken)
        assert contents(tmp_path) == {}


def test_the_suffix_of_the_main_file_is_that_of_its_parts(tmp_path):
    write(grind_program(name="SPLIT"), tmp_path / "split.ls")
    assert sorted(contents(tmp_path)) == ["SPLIT1.ls", "SPLIT2.ls", "SPLIT3.ls", "split.ls"]
