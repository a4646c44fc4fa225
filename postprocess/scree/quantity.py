"""Numbers of a run with their unit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin


class Quantity(NDArrayOperatorsMixin):
    """An array with the unit and the description that the run's file gives it.

    It goes wherever an array goes: numpy, matplotlib and pandas take it as it is, and `q[...]`, arithmetic and numpy's
    functions give plain arrays. A unit is not carried through arithmetic, where it would soon be wrong.
    """

    def __init__(self, values: np.ndarray, unit: str, description: str = "") -> None:
        self.values, self.unit, self.description = values, unit, description

    @property
    def shape(self) -> tuple[int, ...]:
        return self.values.shape

    @property
    def dtype(self) -> np.dtype:
        return self.values.dtype

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
