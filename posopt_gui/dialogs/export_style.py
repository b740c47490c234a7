"""What the export dialog needs besides the application's style sheet."""

from __future__ import annotations

from posopt_gui.theme import Theme


def style_sheet(theme: Theme) -> str:
    """Rules for the dialog's own parts in the colours of a theme."""
    return f"""
QLabel#paneTitle {{ color: {theme.muted}; font-weight: 600; }}
QLabel[tone="good"] {{ color: {theme.good}; }}
QLabel[tone="error"] {{ color: {theme.error}; }}
QLabel[tone="warning"] {{ color: {theme.warning}; }}
QLabel[tone="muted"] {{ color: {theme.muted}; }}
QLabel#headline {{ font-weight: 600; }}
QFrame#banner {{ background: {theme.surface}; border: 1px solid {theme.border};
  border-left: 5px solid {theme.muted}; border-radius: 4px; }}
QFrame#banner[tone="good"] {{ border-left-color: {theme.good}; }}
QFrame#banner[tone="error"] {{ border-left-color: {theme.error}; }}
QFrame#banner[tone="warning"] {{ border-left-color: {theme.warning}; }}
QFrame#form {{ border: 1px solid {theme.border}; border-radius: 4px;
  background: {theme.surface}; }}
QTableWidget, QPlainTextEdit {{ border: 1px solid {theme.border}; border-radius: 4px;
  padding: 0px; }}
QTableWidget:focus {{ border-color: {theme.accent}; }}
QTableWidget::item {{ padding: 5px 0px; border-bottom: 1px solid {theme.grid}; }}
QTableWidget::item:selected {{ background: {theme.selection}; }}
QHeaderView {{ background: {theme.raised}; border: none; }}
QHeaderView::section {{ background: {theme.raised}; color: {theme.muted}; border: none;
  border-bottom: 1px solid {theme.border}; padding: 5px 4px; }}
QLineEdit, QComboBox, QDoubleSpinBox {{ min-height: 20px; }}
QLineEdit[wrong="true"] {{ border-color: {theme.error}; }}
QPushButton {{ min-height: 18px; }}
QPushButton:focus {{ border-color: {theme.accent}; }}
QPushButton:disabled {{ color: {theme.muted}; background: {theme.window}; }}
QPushButton#primary:enabled {{ background: {theme.accent}; color: {theme.accent_text};
  border-color: {theme.accent}; font-weight: 600; }}
QPushButton#primary:enabled:focus {{ border: 2px solid {theme.text}; padding: 4px 13px; }}
QPushButton#careful:enabled {{ color: {theme.error}; border-color: {theme.error}; }}
QProgressBar {{ max-height: 4px; min-height: 4px; }}
"""
