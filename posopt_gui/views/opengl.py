"""What OpenGL can do on this screen, asked before anything is drawn with it."""

from __future__ import annotations

from PySide6.QtGui import QGuiApplication, QOffscreenSurface, QOpenGLContext, QSurfaceFormat

SCREENLESS = ("offscreen", "minimal", "vnc", "linuxfb")
"""Platforms of Qt on which there is no OpenGL to draw with."""

SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "software", "gdi generic", "basic render")
"""Words in the names of renderers that draw without a graphics card."""

SAMPLES = 4
"""Samples a pixel against jagged edges; a renderer without a card takes twice as long for them."""


def is_available() -> bool:
    """Whether there is an OpenGL to draw with."""
    if QGuiApplication.platformName() in SCREENLESS:
        return False
    context, surface = QOpenGLContext(), QOffscreenSurface()
    surface.create()
    made = context.create() and surface.isValid() and context.makeCurrent(surface)
    context.doneCurrent()
    return bool(made)


def renderer() -> str:
    """Name of what draws; '' where it has none."""
    from OpenGL import GL  # noqa: PLC0415 - loading it takes a while

    context, surface = QOpenGLContext(), QOffscreenSurface()
    surface.create()
    name = None
    if context.create() and context.makeCurrent(surface):
        name = GL.glGetString(GL.GL_RENDERER)
        context.doneCurrent()
    return name.decode("ascii", "replace") if name else ""


def surface_format() -> QSurfaceFormat:
    """The format to draw with: smooth edges where that costs little, or where it is asked for.

    Samples that the application's default format asks for are always kept.
    """
    form = QSurfaceFormat(QSurfaceFormat.defaultFormat())
    form.setDepthBufferSize(24)
    if form.samples() <= 0:
        name = renderer().lower()
        form.setSamples(0 if any(word in name for word in SOFTWARE) else SAMPLES)
    return form
