"""Measured 3D models of objects in murky water, from a camera and a line laser."""
