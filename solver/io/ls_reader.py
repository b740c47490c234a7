"""Reader of FANUC .LS files: the oracle of what the post wrote, and a tolerant guest elsewhere.

It shares no code and no format string with the posts. It accepts what controllers, their
makers' tools and other people's posts are known to write (docs/fanuc_ls.md lists it) and
refuses all else with the line and, where known, the column. Every step is linear in the size
of the file.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from solver.errors import InputError, Place
from solver.io.ls_motion import looks_like_motion, read_motion
from solver.io.ls_positions import read_positions
from solver.io.ls_program import Instruction, Motion, Position, ProgramFile
from solver.io.ls_scanner import EXCERPT, Scanner, SourceText

SIZE_LIMIT: Final = 16 * 1024 * 1024
"""Largest file that is read [bytes]."""

LINE_COUNT_LIMIT: Final = 500_000
LINE_LENGTH_LIMIT: Final = 4_096
"""Most lines, and most characters of a line: far above what any controller writes."""

_SECTIONS: Final = ("PROG", "ATTR", "APPL", "MN", "POS", "END")
_NEEDED: Final = ("PROG", "MN", "POS", "END")
_HEADING: Final = re.compile(r"[ \t]*/([A-Za-z]+)(?=[ \t\n]|$)")
_PROGRAM: Final = re.compile(r"[ \t]+([^ \t\n]{1,64})(?:[ \t]+([^\n]*))?$")
_CONTROL: Final = re.compile(r"[\x00-\x08\x0b-\x1f\x7f]")
_BLANK: Final = re.compile(r"[ \t\n]*")
_ENTRY: Final = re.compile(r'((?:[^";]|"[^"\n]*")*);')
_PREFIX: Final = re.compile(r"[ \t]*(?:(?:([0-9]{1,6})[ \t]*)?:)?[ \t]*")
_CONTINUED: Final = re.compile(r"[ \t]*:")
_TWO_ENDS: Final = re.compile(r";[ \t]*;$")
_BEGINNING: Final = re.compile(r"[A-Za-z$!(@_=\-]|//|$")
_SELECTION: Final = re.compile(
    r"(UFRAME_NUM|UTOOL_NUM)[ \t]*+(?:\[[ \t]*(?:GP[2-8][ \t]*,[ \t]*)*GP1[^\]]*\][ \t]*+)?="
    r"[ \t]*+(?:([0-9]{1,3})$|.*)"
)


@dataclass(frozen=True, slots=True)
class _Section:
    """Offsets of a section: its heading's end, and its body."""

    heading: int
    start: int
    end: int


def read_program_file(path: Path) -> ProgramFile:
    """Read an .LS file from disk; see :func:`read_program`."""
    try:
        with Path(path).open("rb") as stream:
            data = stream.read(SIZE_LIMIT + 1)
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})", Place(str(path))) from error
    except ValueError as error:
        raise InputError(f"is not a file name ({error})", Place(repr(str(path)))) from error
    return read_program(data, str(path))


def read_program(data: str | bytes, file: str) -> ProgramFile:
    """Read the content of an .LS file; `file` is its name for errors.

    Bytes are read as Latin-1, the encoding of a controller's texts; in remarks and labels
    any other encoding comes out garbled but harmless.

    Raises
    ------
    InputError
        With file, line and column, for anything that is not a whole and sound program.
    """
    source = SourceText(_decoded(data, file), file)
    sections = _sections(source)
    name, kind = _program_line(source, sections["PROG"])
    attributes: dict[str, str] = {}
    if "ATTR" in sections:
        attributes = _attributes(source, sections["ATTR"])
    instructions = _instructions(source, sections["MN"])
    positions = read_positions(source, sections["POS"].start, sections["POS"].end)
    _check_targets(instructions, positions)
    return ProgramFile(
        file=file,
        name=name,
        kind=kind,
        attributes=attributes,
        remarks=tuple(one.text[1:] for one in instructions if one.text.startswith("!")),
        uframe=_first_selection(instructions, "UFRAME_NUM"),
        utool=_first_selection(instructions, "UTOOL_NUM"),
        instructions=instructions,
        positions=positions,
        application=_application(source),
    )


def _decoded(data: str | bytes, file: str) -> str:
    if len(data) > SIZE_LIMIT:
        raise InputError(
            f"larger than {SIZE_LIMIT // 1024 // 1024} MB, which no .LS program is", Place(file)
        )
    if isinstance(data, bytes):
        data = data.removeprefix(b"\xef\xbb\xbf").decode("latin-1")
    text = data.removeprefix("\ufeff").replace("\r\n", "\n")
    # A file that was cut between CR and LF still ends its last line.
    text = text.removesuffix("\r").rstrip("\x1a")
    if text.count("\n") >= LINE_COUNT_LIMIT:
        raise InputError(f"more than {LINE_COUNT_LIMIT} lines", Place(file))
    found = _CONTROL.search(text)
    if found is not None:
        raise InputError(
            f"control character {found[0]!r}: this is not a text file of a controller",
            SourceText(text, file).place(found.start()),
        )
    for number, line in enumerate(text.split("\n"), start=1):
        if len(line) > LINE_LENGTH_LIMIT:
            raise InputError(
                f"a line of {len(line)} characters; at most {LINE_LENGTH_LIMIT} are read",
                Place(file, number),
            )
    return text


def _sections(source: SourceText) -> dict[str, _Section]:
    found: list[tuple[str, int, int, int]] = []
    for start, end in source.lines(0, len(source.text)):
        heading = _HEADING.match(source.text, start, end)
        if heading is None:
            if not found and source.text[start:end].strip(" \t"):
                raise InputError("expected /PROG with the program's name", source.place(start))
            continue
        name = heading[1]
        if name not in _SECTIONS:
            raise InputError(f"unknown section /{name[:EXCERPT]}", source.place(start))
        # Controllers write /APPL several times.
        again = name == "APPL" and found and found[-1][0] == "APPL"
        if found and not again and _SECTIONS.index(name) <= _SECTIONS.index(found[-1][0]):
            raise InputError(f"section /{name} is out of order or repeated", source.place(start))
        if name != "PROG" and source.text[heading.end() : end].strip(" \t"):
            raise InputError(f"text after /{name}", source.place(heading.end()))
        found.append((name, heading.end(), start, min(end + 1, len(source.text))))
    sections: dict[str, _Section] = {}
    end = len(source.text)
    for name, heading_end, start, body in reversed(found):
        sections[name] = _Section(heading_end, body, end)
        end = start
    for needed in _NEEDED:
        if needed not in sections:
            raise InputError(
                f"section /{needed} is missing: the file is cut or no .LS program",
                source.place(len(source.text)),
            )
    rest = sections["END"]
    if source.text[rest.start : rest.end].strip(" \t\n"):
        raise InputError("text after /END", source.place(rest.start))
    return sections


def _application(source: SourceText) -> tuple[str, ...]:
    """The lines of all /APPL sections that say something."""
    inside, lines = False, []
    for start, end in source.lines(0, len(source.text)):
        heading = _HEADING.match(source.text, start, end)
        if heading is not None:
            if heading[1] == "MN":
                break
            inside = heading[1] == "APPL"
        elif inside:
            lines.append(source.text[start:end].strip(" \t\n"))
    return tuple(line for line in lines if line)


def _program_line(source: SourceText, section: _Section) -> tuple[str, str]:
    line_end = section.start - 1 if section.start > section.heading else section.start
    found = _PROGRAM.match(source.text, section.heading, line_end)
    if found is None:
        raise InputError("expected the program's name after /PROG", source.place(section.heading))
    if source.text[section.start : section.end].strip(" \t\n"):
        raise InputError("text between /PROG and the next section", source.place(section.start))
    return found[1], (found[2] or "").strip(" \t")


def _attributes(source: SourceText, section: _Section) -> dict[str, str]:
    """Return the entries of /ATTR; keys are kept as written, since controllers localise them."""
    scanner = Scanner(source, section.start, section.end, _BLANK)
    attributes: dict[str, str] = {}
    while not scanner.at_end():
        begin = scanner.offset
        entry = scanner.need(_ENTRY, "an attribute that ends with ';'")[1]
        equals = entry.find("=")
        if equals < 0:
            raise scanner.error("an attribute without '='", begin)
        colon = entry.find(":", 0, equals)
        # TCD: holds a list of pairs; elsewhere a comma belongs to the value.
        pairs = [entry] if colon < 0 else entry[colon + 1 :].split(",")
        for pair in pairs:
            key, separator, value = (part.strip(" \t\n") for part in pair.partition("="))
            if not separator or not key or "\n" in key or "\n" in value:
                raise scanner.error("an attribute that is not of the form KEY = value;", begin)
            if key in attributes:
                raise scanner.error(f"attribute {key[:EXCERPT]} is given twice", begin)
            if len(value) >= 2 and value[0] == value[-1] == '"':
                value = value[1:-1]
            attributes[key] = value
    return attributes


def _instructions(source: SourceText, section: _Section) -> tuple[Instruction, ...]:
    instructions: list[Instruction] = []
    selected: dict[str, int | None] = {"UFRAME_NUM": None, "UTOOL_NUM": None}
    for prefix, body, end in _statements(source, section):
        text = _joined(source.text[body:end])
        motion = _instruction_motion(source, body, end, text, selected)
        selection = _SELECTION.match(text)
        if selection is not None:
            selected[selection[1]] = None if selection[2] is None else int(selection[2])
        number = None if prefix[1] is None else int(prefix[1])
        instructions.append(Instruction(number, text, motion, source.place(body)))
    return tuple(instructions)


def _statements(source: SourceText, section: _Section) -> list[tuple[re.Match[str], int, int]]:
    """Return prefix, offset of the text, and offset of the closing ';' of every instruction."""
    statements: list[tuple[re.Match[str], int, int]] = []
    opened: re.Match[str] | None = None
    for start, end in source.lines(section.start, section.end):
        line_end = start + len(source.text[start:end].rstrip(" \t"))
        if line_end == start and opened is None:
            continue
        if opened is None:
            opened = _PREFIX.match(source.text, start, line_end)
        elif not _CONTINUED.match(source.text, start, line_end):
            raise InputError("an instruction does not end with ';'", source.place(opened.start()))
        if opened is None:
            continue
        semicolon = source.text.find(";", start, line_end)
        if semicolon < 0:
            continue
        if semicolon != line_end - 1:
            doubled = _TWO_ENDS.match(source.text, semicolon, line_end)
            raise InputError(
                "'; ;' is refused by controllers (ASBN-031)"
                if doubled
                else "';' inside an instruction",
                source.place(semicolon),
            )
        statements.append((opened, opened.end(), semicolon))
        opened = None
    if opened is not None:
        raise InputError("an instruction does not end with ';'", source.place(opened.start()))
    return statements


def _joined(text: str) -> str:
    """Return the text of an instruction on one line, continuations joined by a space."""
    first, *rest = text.split("\n")
    pieces = [first, *(line.lstrip(" \t").removeprefix(":") for line in rest)]
    return " ".join(piece.strip(" \t") if rest else piece.rstrip(" \t") for piece in pieces)


def _instruction_motion(
    source: SourceText, body: int, end: int, text: str, selected: dict[str, int | None]
) -> Motion | None:
    if text.startswith("!"):
        if "\n" in source.text[body:end]:
            raise InputError("a remark goes on in the next line", source.place(body))
        return None
    if looks_like_motion(text):
        return read_motion(source, body, end, selected["UFRAME_NUM"], selected["UTOOL_NUM"])
    if not _BEGINNING.match(text):
        raise InputError(f"expected an instruction, found {text[:EXCERPT]!r}", source.place(body))
    return None


def _check_targets(instructions: tuple[Instruction, ...], positions: dict[int, Position]) -> None:
    for one in instructions:
        for number in one.motion.positions if one.motion else ():
            if number not in positions:
                raise InputError(f"the move goes to P[{number}], which /POS lacks", one.place)


def _first_selection(instructions: tuple[Instruction, ...], what: str) -> int | None:
    for one in instructions:
        found = _SELECTION.match(one.text)
        if found is not None and found[1] == what:
            return None if found[2] is None else int(found[2])
    return None
