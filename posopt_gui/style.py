"""The style sheet of the window, made from a theme."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QColor, QFontDatabase, QFontInfo, QPalette
from PySide6.QtWidgets import QApplication, QWidget

from posopt_gui.theme import DARK, LIGHT, THEMES, Theme

CHINESE_FONTS: Final = (
    "Microsoft YaHei UI", "PingFang SC", "Noto Sans CJK SC", "Source Han Sans SC",
    "WenQuanYi Micro Hei",
)  # fmt: skip
"""Fonts with the characters in their mainland forms; others would be taken from any font."""

STYLED: Final = "posopt_theme"
"""Property of the application and of its windows: the theme that they have."""

RULE: Final = re.compile(r"([^{}]+)\{([^{}]*)\}")
"""Selectors and declarations of one rule of a style sheet."""


def prepare_fonts() -> None:
    """Let Chinese characters come from a font that has them in their mainland forms.

    Call it once, before the first text is drawn; Latin letters stay those of the system's font.
    """
    font = QApplication.font()
    # Substitutes alone are not asked in order: brackets would come from another font than words.
    known = [one for one in CHINESE_FONTS if QFontDatabase.hasFamily(one)]
    font.setFamilies([QFontInfo(font).family(), *known])
    QApplication.setFont(font)


def prepare_style(application: QApplication) -> None:
    """Give the application the rules of all themes, once: setting them goes through all widgets."""
    if application.property(STYLED) is None:
        application.setStyle("Fusion")
        application.setStyleSheet(of_all_themes(style_sheet))
        application.setProperty(STYLED, "")


def of_all_themes(sheet: Callable[[Theme], str]) -> str:
    """The rules of all themes in one style sheet.

    The light ones hold where no others do. Those of another theme hold in the main windows that
    have its name as a property, and win there: each is like a light one with a condition more.
    """
    return sheet(LIGHT) + in_windows(sheet(DARK), DARK)


def in_windows(sheet: str, theme: Theme) -> str:
    """The rules of a style sheet for what is in a main window with that theme."""
    window = f'QMainWindow[{STYLED}="{theme.name}"]'

    def inside(selector: str) -> str:
        of_window = selector.startswith("QMainWindow")
        return selector.replace("QMainWindow", window) if of_window else f"{window} {selector}"

    return "\n".join(
        f"{', '.join(inside(one.strip()) for one in selectors.split(','))} {{{declarations}}}"
        for selectors, declarations in RULE.findall(sheet)
    )


def apply_theme(application: QApplication, window: QWidget, theme: Theme) -> None:
    """Let the widgets of a window have the colours of a theme, when they are styled the next time.

    Widgets that are not on screen yet are styled by Qt, all others by `follow_theme`.
    """
    if application.property(STYLED) != theme.name:
        application.setPalette(palette(theme))
        application.setProperty(STYLED, theme.name)
    window.setProperty(STYLED, theme.name)


def follow_theme(widget: QWidget) -> None:
    """Look up again which rules hold for a widget; those in it are left as they are."""
    style = widget.style()
    style.unpolish(widget)
    style.polish(widget)


def style_popup(popup: QWidget | None) -> None:
    """Give a list that Qt opens outside of all windows the colours of the theme."""
    application = QCoreApplication.instance()
    theme = THEMES.get(str(application.property(STYLED)), LIGHT) if application else LIGHT
    sheet = style_sheet(theme) if theme.dark else ""
    if popup is not None and popup.styleSheet() != sheet:
        popup.setStyleSheet(sheet)


def palette(theme: Theme) -> QPalette:
    """Qt's palette for a theme: what style sheets do not reach follows it."""
    made = QPalette()
    roles = {
        QPalette.ColorRole.Window: theme.window,
        QPalette.ColorRole.WindowText: theme.text,
        QPalette.ColorRole.Base: theme.surface,
        QPalette.ColorRole.AlternateBase: theme.raised,
        QPalette.ColorRole.Text: theme.text,
        QPalette.ColorRole.Button: theme.raised,
        QPalette.ColorRole.ButtonText: theme.text,
        QPalette.ColorRole.ToolTipBase: theme.raised,
        QPalette.ColorRole.ToolTipText: theme.text,
        QPalette.ColorRole.Highlight: theme.accent,
        QPalette.ColorRole.HighlightedText: theme.accent_text,
        QPalette.ColorRole.PlaceholderText: theme.muted,
        QPalette.ColorRole.Link: theme.accent,
        QPalette.ColorRole.Mid: theme.border,
    }
    for role, colour in roles.items():
        made.setColor(role, QColor(colour))
    for role in (
        QPalette.ColorRole.Text,
        QPalette.ColorRole.ButtonText,
        QPalette.ColorRole.WindowText,
    ):
        made.setColor(QPalette.ColorGroup.Disabled, role, QColor(theme.muted))
    return made


def style_sheet(theme: Theme) -> str:
    """Rules for the frame, fields, tables and what else Qt draws."""
    return _frame(theme) + _fields(theme) + _tables(theme)


def _frame(theme: Theme) -> str:
    """Menu, tool bar, panels, tabs, status bar."""
    return f"""
QMainWindow::separator {{ background: {theme.border}; width: 1px; height: 1px; }}
QSplitter::handle {{ background: transparent; image: none; }}
QSplitter#middle::handle {{ background: {theme.border}; margin: 1px 0; }}
QSplitter::handle:hover {{ background: {theme.border}; }}
QSplitter#middle::handle:hover {{ background: {theme.accent}; }}
QMenuBar, QStatusBar {{ background: {theme.window}; }}
QMenuBar {{ padding: 2px 6px 0 6px; }}
QMenuBar::item {{ background: transparent; padding: 4px 8px; border-radius: 4px; }}
QMenuBar::item:selected {{ background: {theme.selection}; color: {theme.text}; }}
QMenu {{ background: {theme.surface}; border: 1px solid {theme.border}; padding: 4px 0; }}
QMenu::item {{ padding: 5px 28px 5px 24px; }}
QMenu::item:selected {{ background: {theme.selection}; color: {theme.text}; }}
QMenu::item:disabled {{ color: {theme.muted}; }}
QMenu::separator {{ height: 1px; background: {theme.border}; margin: 4px 8px; }}
QToolBar {{ background: {theme.window}; border: none; border-bottom: 1px solid {theme.border};
    spacing: 3px; padding: 3px 6px 5px 6px; }}
QToolBar::separator {{ background: {theme.border}; width: 1px; margin: 4px 6px; }}
QToolBar QLabel {{ color: {theme.muted}; padding: 0 4px 0 2px; }}
QToolButton {{ padding: 4px 8px; border: 1px solid transparent; border-radius: 4px; }}
QToolButton:hover {{ background: {theme.raised}; border-color: {theme.border}; }}
QToolButton:focus {{ border-color: {theme.accent}; }}
QToolButton:checked {{ background: {theme.selection}; border-color: {theme.accent}; }}
QToolButton:disabled {{ color: {theme.muted}; }}
QToolButton[popupMode="2"] {{ padding-right: 18px; }}
QToolButton::menu-indicator {{ image: none; width: 0; height: 0; subcontrol-origin: padding;
    subcontrol-position: right center; right: 6px; border-left: 4px solid {theme.window};
    border-right: 4px solid {theme.window}; border-top: 5px solid {theme.muted}; }}
QToolButton::menu-indicator:hover {{ border-left-color: {theme.raised};
    border-right-color: {theme.raised}; }}
QToolButton#primary {{ background: {theme.accent}; color: {theme.accent_text};
    font-weight: bold; padding: 4px 16px; }}
QToolButton#primary:hover, QToolButton#primary:focus {{ border-color: {theme.text}; }}
QToolButton#primary:disabled {{ background: {theme.raised}; color: {theme.muted}; }}
QToolButton#panelButton {{ padding: 2px; }}
QLabel#panelTitle {{ font-weight: bold; color: {theme.text}; }}
QStatusBar {{ border-top: 1px solid {theme.border}; }}
QStatusBar::item {{ border: none; }}
QStatusBar QLabel {{ padding: 0 6px; }}
QStatusBar QToolButton {{ padding: 1px 8px; color: {theme.muted}; }}
QTabWidget::pane {{ border: none; border-top: 1px solid {theme.border}; }}
QTabBar::tab {{ background: transparent; color: {theme.muted}; padding: 6px 8px; border: none;
    border-bottom: 2px solid transparent; }}
QTabBar::tab:selected {{ color: {theme.text}; border-bottom-color: {theme.accent}; }}
QTabBar::tab:hover {{ color: {theme.text}; }}
QTabBar::tab:focus {{ color: {theme.accent}; }}
QProgressBar {{ background: {theme.raised}; border: none; border-radius: 2px; }}
QProgressBar::chunk {{ background: {theme.accent}; border-radius: 2px; }}
QToolTip {{ background: {theme.surface}; color: {theme.text}; border: 1px solid {theme.border};
    padding: 4px; }}
"""


def _fields(theme: Theme) -> str:
    """Fields, choices and buttons; arrows are corners of thick borders, as flat triangles."""
    return f"""
QLineEdit, QAbstractSpinBox, QComboBox, QPlainTextEdit, QTextEdit {{ background: {theme.surface};
    border: 1px solid {theme.border}; border-radius: 3px; padding: 3px 5px;
    selection-background-color: {theme.accent}; selection-color: {theme.accent_text}; }}
QLineEdit:focus, QAbstractSpinBox:focus, QComboBox:focus, QPlainTextEdit:focus {{
    border-color: {theme.accent}; }}
QComboBox:hover {{ border-color: {theme.muted}; }}
QComboBox:disabled {{ color: {theme.muted}; }}
QComboBox::drop-down {{ border: none; width: 18px; }}
QComboBox QAbstractItemView {{ background: {theme.surface}; border: 1px solid {theme.border};
    selection-background-color: {theme.selection}; selection-color: {theme.text}; }}
QAbstractSpinBox::up-button, QAbstractSpinBox::down-button {{ border: none; width: 16px;
    background: transparent; }}
QAbstractSpinBox::up-arrow, QAbstractSpinBox::down-arrow, QComboBox::down-arrow {{
    image: none; width: 0; height: 0; border-left: 4px solid {theme.surface};
    border-right: 4px solid {theme.surface}; }}
QAbstractSpinBox::up-arrow {{ border-bottom: 5px solid {theme.muted}; }}
QAbstractSpinBox::down-arrow, QComboBox::down-arrow {{ border-top: 5px solid {theme.muted}; }}
QAbstractSpinBox::up-arrow:off, QAbstractSpinBox::up-arrow:disabled {{
    border-bottom-color: {theme.border}; }}
QAbstractSpinBox::down-arrow:off, QAbstractSpinBox::down-arrow:disabled {{
    border-top-color: {theme.border}; }}
QPushButton {{ background: {theme.raised}; border: 1px solid {theme.border}; border-radius: 4px;
    padding: 5px 14px; }}
QPushButton:hover, QPushButton:focus {{ border-color: {theme.accent}; }}
QPushButton:default {{ background: {theme.accent}; color: {theme.accent_text}; }}
QPushButton:disabled {{ color: {theme.muted}; }}
"""


def _tables(theme: Theme) -> str:
    """Tables, lists and scroll bars."""
    return f"""
QTableView, QTreeView, QListView {{ background: {theme.surface}; border: 1px solid {theme.border};
    gridline-color: {theme.grid}; alternate-background-color: {theme.window}; outline: 0;
    selection-background-color: {theme.selection}; selection-color: {theme.text}; }}
QHeaderView::section {{ background: {theme.raised}; color: {theme.muted}; border: none;
    border-right: 1px solid {theme.border}; padding: 4px 6px; font-weight: bold; }}
QHeaderView::up-arrow, QHeaderView::down-arrow {{ image: none; width: 0; height: 0;
    subcontrol-origin: border; subcontrol-position: top center;
    border-left: 4px solid {theme.raised}; border-right: 4px solid {theme.raised}; }}
QHeaderView::up-arrow {{ border-bottom: 4px solid {theme.accent}; }}
QHeaderView::down-arrow {{ border-top: 4px solid {theme.accent}; }}
QTableCornerButton::section {{ background: {theme.raised}; border: none;
    border-bottom: 1px solid {theme.border}; }}
QScrollBar:vertical {{ background: {theme.window}; width: 11px; margin: 0; }}
QScrollBar::handle:vertical {{ background: {theme.border}; min-height: 24px; border-radius: 5px; }}
QScrollBar:horizontal {{ background: {theme.window}; height: 11px; margin: 0; }}
QScrollBar::handle:horizontal {{ background: {theme.border}; min-width: 24px;
    border-radius: 5px; }}
QScrollBar::handle:hover {{ background: {theme.muted}; }}
QAbstractScrollArea::corner {{ background: {theme.window}; border: none; }}
QScrollBar::add-line, QScrollBar::sub-line {{ width: 0; height: 0; }}
QScrollBar::add-page, QScrollBar::sub-page {{ background: transparent; }}
"""
