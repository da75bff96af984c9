"""Measured 3D models of objects in murky water, from a camera and a line laser.

The names below are loaded when they are first used, so that importing costs nothing.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
