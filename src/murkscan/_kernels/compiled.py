"""How loops are compiled: what Python calls, and what only other loops call.

Each is compiled on its first use and kept on disk. Numba makes an entry for C and one for Python
beside each; to leave out those that nobody uses saves an eighth of that first time. A part is kept
within the loops that call it, and by itself nowhere.

What NumPy does in one line, Numba compiles from Python of its own, each in .1 to 2 s: an array or a
row that is set by another or by a tuple (its error builds a sentence), `argsort`, `searchsorted`,
`max` along a slice.
"""

from functools import partial

from numba import njit

loop = partial(njit, cache=True, nogil=True, no_cfunc_wrapper=True)
part = partial(njit, nogil=True, no_cpython_wrapper=True, no_cfunc_wrapper=True)
