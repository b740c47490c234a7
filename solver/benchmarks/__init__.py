"""Benchmarks: medians and ratios within one run; nothing here asserts a time."""
