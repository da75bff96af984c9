"""Measured 3D models of objects in murky water, from a camera and a line laser.

The names below are loaded when they are first used, so that importing costs nothing.
"""

import os

import lazy_loader

# OpenCV reads it when it is loaded: a small file that claims a huge picture is not decoded.
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(2**27))

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
