"""What happens when a person acts; no widgets."""
