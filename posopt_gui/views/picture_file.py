"""Writing a picture to a file, whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QBuffer, QByteArray, QIODevice
from PySide6.QtGui import QImage, QImageWriter

from posopt_gui.controllers.session import Message
from posopt_gui.viewmodels.check_sentences import sentence
from solver.errors import InputError, Place
from solver.io.atomic import write_atomically

Translate = Callable[..., str]


def save_picture(image: QImage, file: Path, translate: Translate) -> Message:
    """Write a picture to a file; the sentence that says how that went."""
    try:
        write_picture(image, file)
    except InputError as error:
        reason = sentence(error.message, translate)
        words = "The picture {file} was not saved: {reason}"
        return Message("error", translate(words, file=file, reason=reason))
    return Message("info", translate("The picture was saved: {file}", file=file))


def write_picture(image: QImage, file: Path) -> None:
    """Write a picture in the kind that its suffix names.

    Raises
    ------
    InputError
        When its kind is not known or it cannot be written; the file keeps what it held.
    """
    data = QByteArray()
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    writer = QImageWriter(buffer, QByteArray(file.suffix.removeprefix(".").lower().encode()))
    if not writer.write(image):
        raise InputError(f"cannot be written ({writer.errorString()})", Place(str(file)))
    buffer.close()
    write_atomically(file, bytes(data.data()))
