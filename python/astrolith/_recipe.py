"""Recipes as Python objects: dictionaries whose keys are attributes, too."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Literal, Mapping, Union

from astrolith import _arrays, _synthesis
from astrolith._arrays import PathLike as PathLike

# Methods of dictionaries that give way to a field of the same name. `items` does not: json and pickle call it.
_GIVE_WAY = {name for name in vars(dict) if not name.startswith("_")} - {"items", "copy"}


class Record(dict[str, Any]):
    """A JSON object whose members are items and attributes alike.

    A field wins over a method of dictionaries: `figures.values` is the field where there is one. An attribute that the
    object does not have cannot be set: a misspelt name is an AttributeError. Items can be added.
    """

    if TYPE_CHECKING:
        values: Any

    def __getattribute__(self, name: str) -> Any:
        if name in _GIVE_WAY and name in self:
            return self[name]
        return super().__getattribute__(name)

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"{name}: no such field; there are {', '.join(self) or 'none'}") from None

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self:
            raise AttributeError(f"{name}: no such field; there are {', '.join(self) or 'none'}")
        self[name] = value


def records(text: str) -> Any:
    """The JSON text with its objects as records."""
    return json.loads(text, object_hook=Record)


def change_reliefs(recipe: Any, name: str, **fields: Any) -> None:
    """Sets fields of all reliefs of a recipe. Raises ValueError where it has none; `name` is the recipe's in the message."""
    reliefs = [layer for layer in recipe.get("layers", []) if layer["type"] == "relief"]
    if not reliefs:
        raise ValueError(f"{name}: has no relief, whose heights {', '.join(fields)} would change; fit_shape makes one")
    for relief in reliefs:
        relief.update(fields)


class Recipe(Record):
    """A body and its layers: what ``synth`` turns into meshes, and what the fits write.

    ``docs/recipe.md`` describes the fields. They are attributes that can be read and set at any depth, such as
    ``recipe.seed = 7`` or ``recipe.layers[0].amplitude *= 2``. Every function that takes a recipe checks it first;
    :meth:`validate` does so at once.

    Examples
    --------
    >>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    >>> recipe = Recipe.from_dict({"format_version": 1, "length_unit": "m", "body": ball})
    >>> recipe.length_unit, len(recipe.body.spheres)
    ('m', 1)
    >>> recipe.seeed = 7
    Traceback (most recent call last):
    ...
    AttributeError: seeed: no such field; there are ...
    """

    def __init__(self, *fields: Any, **more: Any) -> None:
        if fields and _arrays.is_file_name(fields[0]):
            raise ValueError("recipe: a file is read by Recipe.read(file), a text by Recipe.from_json(text)")
        super().__init__(*fields, **more)

    @classmethod
    def from_json(cls, text: str, name: str = "recipe") -> "Recipe":
        """Read a JSON text.

        Parameters
        ----------
        text
            The recipe as JSON.
        name
            What messages call the recipe.

        Raises
        ------
        ValueError
            The text breaks a rule of recipes; the message is the programs' own.
        """
        return cls(records(_synthesis.check_recipe(_arrays.text(text, "text"), _arrays.text(name, "name"))))

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any], name: str = "recipe") -> "Recipe":
        """Take a dictionary. Fields that are absent get their defaults. Raises ValueError as :meth:`from_json`."""
        return cls.from_json(_dumped(fields, _arrays.text(name, "name")), name)

    @classmethod
    def read(cls, file: PathLike) -> "Recipe":
        """Read a JSON file, a compact recipe of at most 64 MB, or a body of the :func:`library` by its name.

        Raises ValueError as :meth:`from_json`.

        The image of a layer lies relative to the file; its path becomes one relative to the current folder, where every
        function looks for it.
        """
        file = _arrays.file_name(file, "file")
        recipe = cls(records(_synthesis.read_recipe(file)))
        for layer in recipe._layers_with_images():
            layer["image"] = os.path.relpath(os.path.join(os.path.dirname(file), layer["image"]))
        return recipe

    def _layers_with_images(self) -> list[Any]:
        return [layer for layer in self.get("layers", []) if "image" in layer]

    def validate(self, name: str = "recipe") -> None:
        """Raise ValueError at the first field that breaks a rule."""
        self.to_json(name)

    def to_json(self, name: str = "recipe") -> str:
        """Return the text that the programs write, with every field. Raises ValueError as :meth:`from_json`."""
        return _synthesis.check_recipe(_dumped(self, _arrays.text(name, "name")), name)

    def to_dict(self) -> dict[str, Any]:
        """Return plain dictionaries and lists, with every field. Raises ValueError as :meth:`from_json`."""
        plain: dict[str, Any] = json.loads(self.to_json())
        return plain

    def write(self, file: PathLike) -> None:
        """Write the file whole or not at all, with the bytes that the programs write.

        A name that ends in .astro makes a compact recipe, any other one JSON. Paths of images become relative to the file.

        Raises
        ------
        ValueError
            The recipe breaks a rule, or the file cannot be written.
        RuntimeError
            The disk is full.
        """
        file = _arrays.file_name(file, "file")
        written = Recipe.from_json(self.to_json()) if self._layers_with_images() else self
        for layer in written._layers_with_images():
            layer["image"] = os.path.relpath(layer["image"], os.path.dirname(file) or os.curdir)
        _synthesis.write_recipe(_dumped(written, "recipe"), "recipe", file)

    def copy(self) -> "Recipe":
        """Return a copy that shares nothing with this recipe."""
        return type(self)(records(json.dumps(self)))

    def laid_on(self, base: "RecipeLike", lengths: Literal["units", "body", "edges"] = "units") -> "Recipe":
        """Return `base` with this recipe's layers after its own, as ``synth --base --base-lengths`` does.

        Parameters
        ----------
        base
            The recipe whose body gets the layers.
        lengths
            What keeps its size: lengths in their units, shares of the bodies, or lengths in edges of the measured models.
        """
        details_name, base_name = "recipe", "base"
        details, body = _dumped(self, details_name), json_of(base, base_name)[0]
        word = _arrays.choice(lengths, "lengths", ("units", "body", "edges"))
        return Recipe(records(_synthesis.lay_on_base(details, details_name, body, base_name, word)))

    def like(self, seed: int) -> "Recipe":
        """Return another body of the kind, as ``synth --like --seed``: measured heights drawn for other places.

        Raises
        ------
        ValueError
            The recipe has no relief.
        """
        made = self.copy()
        change_reliefs(made, "recipe", arrangement="like")
        made["seed"] = seed
        return made

    def finished(self, body: str, to: float, start: float | None = None) -> "Recipe":
        """Return the recipe with the craters and boulders of a known body below its finest size.

        As ``synth --finish``: published counts of the body say how many there are. They are drawn by cells, so that a
        patch has them down to `to`.

        Parameters
        ----------
        body
            ``"itokawa"``, ``"bennu"``, ``"eros"``, ``"ryugu"`` or ``"dimorphos"``.
        to
            Least diameter, in the recipe's unit.
        start
            Greatest diameter; the finest size of the recipe if None.

        Raises
        ------
        ValueError
            The body is not known, the recipe has no body or no physical unit, or no size is left.
        """
        least = _arrays.positive(to, "to", 1e18)
        most = None if start is None else _arrays.positive(start, "start", 1e18)
        return Recipe(records(_synthesis.finish_recipe(_dumped(self, "recipe"), "recipe", _arrays.text(body, "body"), least, most)))


def library() -> list[str]:
    """Return the names of the measured bodies that come with the package, in alphabetical order.

    Every function that takes the name of a recipe's file takes such a name, too.

    Examples
    --------
    >>> "eros" in library()
    True
    >>> Recipe.read("eros").length_unit
    'km'
    """
    return _synthesis.library_bodies()


RecipeLike = Union[Recipe, Mapping[str, Any], PathLike]


def _dumped(fields: Mapping[str, Any], name: str) -> str:
    try:
        return json.dumps(fields, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: cannot be written as JSON: {error}") from None


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is no number, text, list or dictionary")


def json_of(recipe: RecipeLike, name: str = "recipe") -> tuple[str, str]:
    """The JSON text of a recipe, a dictionary or a file, and what messages call it."""
    if isinstance(recipe, Mapping):
        return _dumped(recipe, name), name
    if _arrays.is_file_name(recipe):
        file = _arrays.file_name(recipe, name)
        return _synthesis.check_recipe(_dumped(Recipe.read(file), file), file), file
    raise ValueError(f"{name}: must be a Recipe, a dictionary or a file, and is {type(recipe).__name__}")
