"""Ends Python code that runs in another thread."""

from __future__ import annotations

import ctypes


def raise_in(thread: int, exception: type[BaseException]) -> None:
    """Raises an exception in a thread, by its identifier, as soon as it runs Python code."""
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(exception))
