"""Numbers of a run with their unit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin


class Quantity(NDArrayOperatorsMixin):
    """An array with the unit and the description that the run's file gives it.

    It goes wherever an array goes: numpy, matplotlib and pandas take it as it is, and `q[...]`, arithmetic, numpy's
    functions and the methods of an array give plain arrays and numbers. A unit is not carried through arithmetic, where
    it would soon be wrong.
    """

    def __init__(self, values: np.ndarray, unit: str, description: str = "") -> None:
        self.values, self.unit, self.description = values, unit, description

    @property
    def shape(self) -> tuple[int, ...]:
        return self.values.shape

    @property
    def dtype(self) -> np.dtype:
        return self.values.dtype

    @property
    def ndim(self) -> int:
        return self.values.ndim

    @property
    def size(self) -> int:
        return self.values.size

    @property
    def T(self) -> np.ndarray:
        return self.values.T

    def max(self, *words: Any, **options: Any) -> Any:
        return self.values.max(*words, **options)

    def min(self, *words: Any, **options: Any) -> Any:
        return self.values.min(*words, **options)

    def mean(self, *words: Any, **options: Any) -> Any:
        return self.values.mean(*words, **options)

    def sum(self, *words: Any, **options: Any) -> Any:
        return self.values.sum(*words, **options)

    def std(self, *words: Any, **options: Any) -> Any:
        return self.values.std(*words, **options)

    def argmax(self, *words: Any, **options: Any) -> Any:
        return self.values.argmax(*words, **options)

    def argmin(self, *words: Any, **options: Any) -> Any:
        return self.values.argmin(*words, **options)

    def tolist(self) -> Any:
        return self.values.tolist()

    def astype(self, dtype: Any) -> np.ndarray:
        return self.values.astype(dtype)

    def copy(self) -> np.ndarray:
        """Of the values, to be changed."""
        return self.values.copy()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.values, dtype=dtype) if copy else np.asarray(self.values, dtype=dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        plain = [value.values if isinstance(value, Quantity) else value for value in inputs]
        return getattr(ufunc, method)(*plain, **options)

    def __getitem__(self, index: Any) -> Any:
        return self.values[index]

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[Any]:
        return iter(self.values)

    def __repr__(self) -> str:
        shape = " x ".join(map(str, self.shape))
        return f"<{shape} values in {self.unit}: {self.description}>"
