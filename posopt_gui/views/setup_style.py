"""Style sheet of the setup panel and its dialogs, besides the application's own."""

from __future__ import annotations

from posopt_gui.theme import Theme


def setup_style(theme: Theme) -> str:
    """Rules for the panel's own parts in the colours of a theme."""
    return f"""
QWidget#setup, QWidget#setupBody, QScrollArea#setupScroll {{ background: {theme.window}; }}
QScrollArea#setupScroll {{ border: none; }}
QLabel#muted, QLabel#summary {{ color: {theme.muted}; }}
QLabel#sentence {{ color: {theme.error}; }}
QLabel#hint {{ color: {theme.muted}; background: {theme.surface};
    border-top: 1px solid {theme.border}; padding: 5px 10px; }}
QPushButton#problem {{ color: {theme.error}; background: {theme.surface}; border: none;
    border-radius: 0; border-bottom: 1px solid {theme.error}; padding: 7px 10px;
    text-align: left; }}
QPushButton#problem:hover {{ background: {theme.raised}; }}
QFrame#header {{ background: {theme.raised}; border-bottom: 1px solid {theme.border}; }}
QFrame#header[wrong="true"] {{ border-left: 3px solid {theme.error}; }}
QToolButton#title {{ color: {theme.text}; background: transparent; border: none;
    font-weight: 600; padding: 4px 2px; }}
QToolButton#title:focus {{ color: {theme.accent}; }}
QLineEdit, QAbstractSpinBox, QComboBox {{ padding: 2px 4px; min-height: 18px; }}
QComboBox QLineEdit, QAbstractSpinBox QLineEdit {{ border: none; padding: 0; }}
QLineEdit[wrong="true"], QAbstractSpinBox[wrong="true"], QComboBox[wrong="true"] {{
    border: 1px solid {theme.error}; }}
QCheckBox[wrong="true"] {{ color: {theme.error}; }}
QAbstractSpinBox[slim="true"] {{ padding-right: 8px; }}
QAbstractSpinBox[slim="true"]::up-button, QAbstractSpinBox[slim="true"]::down-button {{
    width: 0; }}
QAbstractSpinBox[slim="true"]::up-arrow, QAbstractSpinBox[slim="true"]::down-arrow {{
    border: none; }}
QToolButton#subset {{ color: {theme.muted}; background: {theme.surface};
    border: 1px solid {theme.border}; border-radius: 3px; padding: 3px 2px; }}
QToolButton#subset:checked {{ color: {theme.text}; background: {theme.selection};
    border-color: {theme.accent}; }}
QToolButton#subset:hover {{ border-color: {theme.accent}; }}
QToolButton#subset:focus {{ border: 1px solid {theme.text}; }}
QToolButton#browse {{ color: {theme.text}; background: {theme.raised};
    border: 1px solid {theme.border}; border-radius: 3px; padding: 1px 6px; min-height: 18px; }}
QToolButton#browse:hover, QToolButton#browse:focus {{ border-color: {theme.accent}; }}
QPushButton {{ padding: 4px 10px; }}
QPushButton:focus {{ border-color: {theme.accent}; }}
QPushButton#primary:enabled {{ background: {theme.accent}; color: {theme.accent_text};
    border-color: {theme.accent}; font-weight: 600; }}
QPushButton#primary:disabled {{ background: {theme.raised}; color: {theme.muted};
    border-color: {theme.border}; }}
QFrame#drop {{ background: {theme.surface}; border: 1px dashed {theme.muted};
    border-radius: 4px; }}
QFrame#drop[over="true"] {{ border: 2px solid {theme.accent}; }}
"""
