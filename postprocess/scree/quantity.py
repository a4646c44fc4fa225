"""Arrays of a run with their unit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin


class Quantity(NDArrayOperatorsMixin):
    """An array with the unit and the description from the file of the run.

    It can be used like an array: numpy, matplotlib and pandas accept it, and `q[...]`, arithmetic, numpy's functions
    and the methods of an array return plain arrays and numbers. Arithmetic drops the unit, because the unit of the
    result is not tracked.
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

    def max(self, *arguments: Any, **options: Any) -> Any:
        return self.values.max(*arguments, **options)

    def min(self, *arguments: Any, **options: Any) -> Any:
        return self.values.min(*arguments, **options)

    def mean(self, *arguments: Any, **options: Any) -> Any:
        return self.values.mean(*arguments, **options)

    def sum(self, *arguments: Any, **options: Any) -> Any:
        return self.values.sum(*arguments, **options)

    def std(self, *arguments: Any, **options: Any) -> Any:
        return self.values.std(*arguments, **options)

    def argmax(self, *arguments: Any, **options: Any) -> Any:
        return self.values.argmax(*arguments, **options)

    def argmin(self, *arguments: Any, **options: Any) -> Any:
        return self.values.argmin(*arguments, **options)

    def tolist(self) -> Any:
        return self.values.tolist()

    def astype(self, dtype: Any) -> np.ndarray:
        return self.values.astype(dtype)

    def copy(self) -> np.ndarray:
        """A copy of the values that may be changed."""
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
