"""Whoever compiles a loop, it gives the same bytes."""

import importlib
import pkgutil

from numba.core.dispatcher import Dispatcher

import murkscan._kernels


def _loops():
    for found in pkgutil.iter_modules(murkscan._kernels.__path__, "murkscan._kernels."):
        module = vars(importlib.import_module(found.name))
        for loop in module.values():
            if isinstance(loop, Dispatcher) and loop.py_func.__module__ == found.name:
                names = loop.py_func.__code__.co_names
                calls = {module[n] for n in names if isinstance(module.get(n), Dispatcher)}
                yield loop, calls


def test_sums_may_be_put_in_another_order_only_where_nothing_else_is_compiled_with_them():
    """A loop that another is compiled into comes out another way by who was compiled first."""
    loops = dict(_loops())
    called = set().union(*loops.values())
    assert len(loops) > 50
    for loop, calls in loops.items():
        if loop.targetoptions.get("fastmath"):
            assert not calls, loop
            assert loop not in called, loop
