"""The style sheet of the window, made from a theme."""

from __future__ import annotations

from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication

from posopt_gui.theme import Theme


def apply_theme(application: QApplication, theme: Theme) -> None:
    """Give the whole application the colours of a theme."""
    application.setStyle("Fusion")
    application.setPalette(palette(theme))
    application.setStyleSheet(style_sheet(theme))


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
    """Rules for docks, tabs, tool bars, fields and tables."""
    return f"""
QMainWindow::separator {{ background: {theme.border}; width: 1px; height: 1px; }}
QDockWidget {{ font-weight: 600; color: {theme.text}; }}
QDockWidget::title {{ background: {theme.window}; padding: 6px 10px; border: none; }}
QToolBar {{ background: {theme.window}; border: none; border-bottom: 1px solid {theme.border};
    spacing: 4px; padding: 4px 8px; }}
QToolButton {{ padding: 4px 8px; border: 1px solid transparent; border-radius: 4px; }}
QToolButton:hover {{ background: {theme.raised}; border-color: {theme.border}; }}
QToolButton:checked {{ background: {theme.selection}; border-color: {theme.accent}; }}
QToolButton#primary {{ background: {theme.accent}; color: {theme.accent_text};
    font-weight: 600; padding: 4px 14px; }}
QToolButton#primary:disabled {{ background: {theme.raised}; color: {theme.muted}; }}
QMenuBar, QStatusBar {{ background: {theme.window}; }}
QStatusBar {{ border-top: 1px solid {theme.border}; }}
QMenu {{ background: {theme.surface}; border: 1px solid {theme.border}; }}
QMenu::item {{ padding: 5px 28px 5px 20px; }}
QMenu::item:selected {{ background: {theme.selection}; color: {theme.text}; }}
QTabWidget::pane {{ border: none; border-top: 1px solid {theme.border}; }}
QTabBar::tab {{ background: transparent; color: {theme.muted}; padding: 6px 12px; border: none;
    border-bottom: 2px solid transparent; }}
QTabBar::tab:selected {{ color: {theme.text}; border-bottom-color: {theme.accent}; }}
QTabBar::tab:hover {{ color: {theme.text}; }}
QLineEdit, QAbstractSpinBox, QComboBox, QPlainTextEdit, QTextEdit {{ background: {theme.surface};
    border: 1px solid {theme.border}; border-radius: 3px; padding: 3px 5px;
    selection-background-color: {theme.accent}; selection-color: {theme.accent_text}; }}
QLineEdit:focus, QAbstractSpinBox:focus, QComboBox:focus, QPlainTextEdit:focus {{
    border-color: {theme.accent}; }}
QTableView, QTreeView, QListView {{ background: {theme.surface}; border: 1px solid {theme.border};
    gridline-color: {theme.grid}; alternate-background-color: {theme.window};
    selection-background-color: {theme.selection}; selection-color: {theme.text}; }}
QHeaderView::section {{ background: {theme.raised}; color: {theme.muted}; border: none;
    border-right: 1px solid {theme.border}; padding: 4px 6px; font-weight: 600; }}
QPushButton {{ background: {theme.raised}; border: 1px solid {theme.border}; border-radius: 4px;
    padding: 5px 14px; }}
QPushButton:hover {{ border-color: {theme.accent}; }}
QPushButton:default {{ background: {theme.accent}; color: {theme.accent_text}; }}
QPushButton:disabled {{ color: {theme.muted}; }}
QProgressBar {{ background: {theme.raised}; border: none; border-radius: 2px; }}
QProgressBar::chunk {{ background: {theme.accent}; border-radius: 2px; }}
QToolTip {{ background: {theme.raised}; color: {theme.text}; border: 1px solid {theme.border};
    padding: 4px; }}
QScrollBar:vertical {{ background: {theme.window}; width: 11px; margin: 0; }}
QScrollBar::handle:vertical {{ background: {theme.border}; min-height: 24px; border-radius: 5px; }}
QScrollBar:horizontal {{ background: {theme.window}; height: 11px; margin: 0; }}
QScrollBar::handle:horizontal {{ background: {theme.border}; min-width: 24px;
    border-radius: 5px; }}
QScrollBar::add-line, QScrollBar::sub-line {{ width: 0; height: 0; }}
"""
