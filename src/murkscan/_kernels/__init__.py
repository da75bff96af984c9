"""Compiled loops: arrays in, arrays out, no decisions, nothing of murkscan imported."""
