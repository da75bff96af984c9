"""Array types by meaning; the shape is part of the type and is checked in the tests.

Letters: n items, m faces, h rows, w columns.
"""

import numpy as np
from jaxtyping import Bool, Float, Float32, Int, Int32, Shaped, UInt8, UInt32

Points = Float[np.ndarray, "n 3"]
"""3D points [m], one a row, x y z."""
Directions = Float[np.ndarray, "n 3"]
"""3D directions, one a row."""
Pixels = Float[np.ndarray, "n 2"]
"""Image points [px], one a row, u (right) v (down); (0, 0) is the centre of the top-left pixel."""
Scalars = Float[np.ndarray, "n"]
"""One number an item."""
Ratios = Float32[np.ndarray, "n"]
"""One number an item, in single precision as files keep it."""
FrameNumbers = UInt32[np.ndarray, "n"]
"""Index of a frame in its recording, one an item."""
SignedFrameNumbers = Int32[np.ndarray, "n"]
"""The same as a cloud's file keeps it."""
ScanLineNumbers = Int32[np.ndarray, "n"]
"""Number of a scan line: an image row or column across which a stripe is looked for."""
SmallNumbers = UInt8[np.ndarray, "n"]
"""A number from 0 to 255, one an item."""
Normals = Float32[np.ndarray, "n 3"]
"""Unit directions in single precision, one a row."""
Indices = Int[np.ndarray, "n"]
"""One whole number an item."""
Mask = Bool[np.ndarray, "n"]
"""One yes or no an item."""
Faces = Int[np.ndarray, "m 3"]
"""Triangles: three vertex numbers a row, counter-clockwise seen from outside."""
FaceMask = Bool[np.ndarray, "m"]
"""One yes or no a triangle."""
Colours = UInt8[np.ndarray, "n 3"]
"""Red, green and blue from 0 to 255, one colour a row."""
Quaternions = Float[np.ndarray, "n 4"]
"""Unit quaternions, one a row, w x y z."""
Image = Shaped[np.ndarray, "h w"]
"""Grey image, row 0 on top; 8 or 16 bit."""
ColourImage = UInt8[np.ndarray, "h w 3"]
"""Colour image, channels red, green, blue."""
BinaryImage = Bool[np.ndarray, "h w"]
"""Black-and-white image, row 0 on top."""
Vector = Float[np.ndarray, "3"]
Matrix3 = Float[np.ndarray, "3 3"]
