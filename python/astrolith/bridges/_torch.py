"""The dataset of PyTorch. Workers of a loader import this module by its name."""

from __future__ import annotations

from typing import Any, Callable, Optional

import numpy as np

from astrolith.bridges._optional import required

torch = required("torch", "torch")
_Dataset: Any = torch.utils.data.Dataset


def _tensors(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _tensors(part) for name, part in value.items()}
    return torch.from_numpy(value) if isinstance(value, np.ndarray) else value


class TorchBodies(_Dataset):  # type: ignore[misc]
    """The items of ``Bodies`` or of a ``FinishedSet``, whose arrays become tensors."""

    def __init__(self, bodies: Any, transform: Optional[Callable[[dict[str, Any]], Any]]) -> None:
        self._bodies = bodies
        self._transform = transform

    def __len__(self) -> int:
        return len(self._bodies)

    def __getitem__(self, index: int) -> Any:
        item = _tensors(self._bodies[index])
        return item if self._transform is None else self._transform(item)
