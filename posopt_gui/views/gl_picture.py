"""A widget that OpenGL draws off the screen and that is shown as a plain picture."""

from __future__ import annotations

import time
from typing import Any

from OpenGL import GL
from OpenGL.error import Error as GlError
from pyqtgraph.opengl.GLViewWidget import GLViewMixin
from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QImage,
    QKeyEvent,
    QOffscreenSurface,
    QOpenGLContext,
    QPainter,
    QPaintEvent,
    QSurfaceFormat,
)
from PySide6.QtOpenGL import QOpenGLFramebufferObject, QOpenGLFramebufferObjectFormat
from PySide6.QtWidgets import QWidget


class GlPicture(GLViewMixin, QWidget):
    """A scene of pyqtgraph's OpenGL items, drawn again only where it has changed.

    A window that holds a QOpenGLWidget is composed with OpenGL as a whole: without a graphics
    card every painting of it, of a map or a tool tip, takes tens of milliseconds, and the window
    is made anew when its first OpenGL panel appears. Here OpenGL draws into a buffer of its own,
    which is read back once; all of the window is painted as if there were no OpenGL. The drawing
    has a turn of the event loop of its own: what else has changed is on screen before.
    """

    failed = Signal(str)

    _fresh = False
    """Whether the picture shows the scene; pyqtgraph asks for an update in its constructor."""

    _later: QTimer | None = None

    def __init__(self, form: QSurfaceFormat, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self._form = form
        self._context: QOpenGLContext | None = None
        self._surface: QOffscreenSurface | None = None
        self._buffer: QOpenGLFramebufferObject | None = None
        self._picture = QImage()
        self._broken = False
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(0)
        self._later.timeout.connect(self._draw_again)
        self.seconds = 0.0
        """How long the last drawing took [s]."""

    def isValid(self) -> bool:  # noqa: N802 - as a QOpenGLWidget calls it
        """Whether there is an OpenGL context to draw with."""
        return self._context is not None and self._context.isValid()

    def context(self) -> QOpenGLContext | None:
        """The context to draw with, None before the first picture."""
        return self._context

    def makeCurrent(self) -> None:  # noqa: N802 - as a QOpenGLWidget calls it
        """Let OpenGL calls go to this scene."""
        if self._context is not None and self._surface is not None:
            self._context.makeCurrent(self._surface)

    def doneCurrent(self) -> None:  # noqa: N802 - as a QOpenGLWidget calls it
        """End what `makeCurrent` began."""
        if self._context is not None:
            self._context.doneCurrent()

    def update(self, *_: Any) -> None:
        """Draw the scene again in one of the next turns."""
        self._fresh = False
        if self._later is not None and not self._later.isActive():
            self._later.start()

    def _draw_again(self) -> None:
        if self.isVisible() and not self._fresh:
            self.grabFramebuffer()
            super().update()

    def grabFramebuffer(self) -> QImage:  # noqa: N802 - as a QOpenGLWidget calls it
        """The picture of the scene as it is now; null where OpenGL fails."""
        wanted = self.size() * self.devicePixelRatioF()
        if not self._fresh or self._picture.size() != wanted:
            self._draw(wanted)
        # Whoever paints on it paints on a copy.
        return QImage(self._picture)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Show the picture; one that is no longer true is drawn again after this."""
        if self._picture.size() != self.size() * self.devicePixelRatioF():
            self.grabFramebuffer()
        elif not self._fresh:
            self.update()
        picture = self._picture
        painter = QPainter(self)
        if picture.isNull():
            painter.fillRect(event.rect(), self.palette().window())
        else:
            painter.drawImage(0, 0, picture)
        painter.end()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        """Leave all keys to the window: arrows step through the waypoints."""
        event.ignore()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        """Leave all keys to the window."""
        event.ignore()

    def draw_over(self, painter: QPainter) -> None:
        """Paint what lies over the scene, in pixels of the widget."""

    def _draw(self, size: QSize) -> None:
        begin = time.perf_counter()
        self._fresh = True
        self._picture = QImage()
        if self._broken or size.isEmpty():
            return
        try:
            buffer = self._begin(size)
            ratio = self.devicePixelRatioF()
            GL.glViewport(0, 0, size.width(), size.height())
            self.paintGL()
            self._picture = buffer.toImage()
            # The scene's opacity is of no meaning: what is behind it is the window.
            self._picture.reinterpretAsFormat(QImage.Format.Format_RGB32)
            self._picture.setDevicePixelRatio(ratio)
        except (RuntimeError, GlError) as error:
            self._broken = True
            self._picture = QImage()
            self.failed.emit(str(error))
            return
        finally:
            self.doneCurrent()
        painter = QPainter(self._picture)
        self.draw_over(painter)
        painter.end()
        self.seconds = time.perf_counter() - begin

    def _begin(self, size: QSize) -> QOpenGLFramebufferObject:
        """Make the context current, and the buffer its target."""
        if self._context is None:
            self._make_context()
        self.makeCurrent()
        buffer = self._buffer
        if buffer is None or buffer.size() != size:
            form = QOpenGLFramebufferObjectFormat()
            form.setAttachment(QOpenGLFramebufferObject.Attachment.CombinedDepthStencil)
            form.setSamples(max(self._form.samples(), 0))
            self._buffer = buffer = QOpenGLFramebufferObject(size, form)
        if not buffer.isValid() or not buffer.bind():
            raise RuntimeError("no frame buffer")
        return buffer

    def _make_context(self) -> None:
        surface = QOffscreenSurface(parent=self)
        surface.setFormat(self._form)
        surface.create()
        context = QOpenGLContext(self)
        context.setFormat(self._form)
        context.setShareContext(QOpenGLContext.globalShareContext())
        if not context.create() or not surface.isValid() or not context.makeCurrent(surface):
            raise RuntimeError("no context")
        self._context, self._surface = context, surface
        self.initializeGL()
