"""Scenes: bodies that stay in memory, for cameras and lidars that ask again and again."""

from __future__ import annotations

import contextlib
import dataclasses
import threading
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._gravity import is_recipe
from astrolith._mesh import Mesh, MeshLike, surface_of
from astrolith._meshing import mesh as mesh_recipe
from astrolith._options import Progress
from astrolith._picture import linear_light
from astrolith._recipe import RecipeLike, json_of, records

RotationLike = Any
"""A (3, 3) rotation matrix, or a unit quaternion (w, x, y, z), the scalar first, as in SPICE."""


def _matrix(rotation: RotationLike, name: str) -> npt.NDArray[np.float64]:
    """The matrix of a rotation, which the extension module checks."""
    try:
        array = np.asarray(rotation, np.float64)
    except (TypeError, ValueError):
        array = np.zeros(0)
    if array.shape == (4,):
        if not abs(np.linalg.norm(array) - 1.0) < 1e-6:
            raise ValueError(f"{name}: the quaternion has the length {np.linalg.norm(array):.6g}; it must be 1, to 1e-6")
        w, x, y, z = array / np.linalg.norm(array)
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
    if array.shape != (3, 3) or not np.isfinite(array).all():
        raise ValueError(f"{name}: must be a (3, 3) matrix or a quaternion (w, x, y, z), and is {_arrays.shown(rotation)}")
    return array


def _normal_albedo(mesh: Mesh, recipe: RecipeLike) -> Optional[npt.NDArray[np.float64]]:
    """The normal albedo of a recipe's vertices, from the colours that show it for viewing (docs/recipe.md)."""
    document = records(json_of(recipe, "bodies")[0])
    stated = mesh.figures.get("albedo") or document.get("albedo")
    if not stated and any("albedo" in layer for layer in document.get("layers", [])):
        stated = {"normal": 0.1}  # of a ground that layers alone speak of
    if not stated or mesh.colors is None:
        return None
    shown = 0.36 * (stated["normal"] / 0.1) ** (1 / 3)
    albedo: npt.NDArray[np.float64] = stated["normal"] / shown * linear_light(mesh.colors).mean(axis=1)
    return albedo


@dataclasses.dataclass(frozen=True, eq=False)
class Camera:
    """A camera by its calibration and its pose.

    The camera's axes are x to the right of the picture, y down and z along the boresight. The point (X, Y, Z) of these
    axes is seen at column fx x' + skew y' + cx and row fy y' + cy, where (x', y') is (X / Z, Y / Z) after Brown's
    distortion as OpenCV has it. Whole numbers are the middles of pixels; (0, 0) is the middle of the top left one.

    Attributes
    ----------
    width, height
        Pixels, 1 to 16384.
    fx, fy
        The focal lengths in pixels. `fy` None: `fx`.
    cx, cy
        The principal point. None: the middle of the picture, (width - 1) / 2 and (height - 1) / 2.
    skew
        Pixels.
    distortion
        k1 k2 p1 p2 k3, OpenCV's order; missing ones are 0. Coefficients that fold the picture are an error.
    position
        The place of the camera in the axes and lengths of the scene.
    rotation
        A matrix, or a quaternion (w, x, y, z), the scalar first.
    axes
        What `rotation` does. "opencv": it takes vectors of the scene to those of the camera, as the R of
        ``cv2.solvePnP`` does. "spice": it takes vectors of the camera to those of the scene, as
        ``spiceypy.pxform(camera_frame, body_frame, et)`` does. An instrument whose kernel has other axes (x not to the
        right) needs its own turn before.

    Examples
    --------
    >>> camera = Camera(640, 480, 800.0).look_at((0, 0, 10), (0, 0, 0), up=(0, 1, 0))
    >>> camera.project([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]).tolist()
    [[319.5, 239.5], [399.5, 239.5]]
    """

    width: int
    height: int
    fx: float
    fy: Optional[float] = None
    cx: Optional[float] = None
    cy: Optional[float] = None
    skew: float = 0.0
    distortion: Sequence[float] = ()
    position: Sequence[float] = (0.0, 0.0, 0.0)
    rotation: RotationLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    axes: str = "opencv"

    def look_at(self, position: Sequence[float], target: Sequence[float], up: Sequence[float] = (0, 0, 1)) -> Camera:
        """Return this camera at `position`, its boresight to `target`, and `up` upwards in the picture.

        Raises
        ------
        ValueError
            The target is where the camera is, or `up` is along the boresight.
        """
        place, end, above = (
            np.array(_arrays.vector(v, name)) for v, name in ((position, "position"), (target, "target"), (up, "up"))
        )
        boresight = end - place
        right = np.cross(boresight, above)
        if not np.linalg.norm(right) > 1e-12 * np.linalg.norm(boresight) * np.linalg.norm(above):
            raise ValueError("up: is along the boresight, or the target is where the camera is; give another")
        down = np.cross(boresight, right)
        rows = np.stack([v / np.linalg.norm(v) for v in (right, down, boresight)])
        return dataclasses.replace(self, position=tuple(place.tolist()), rotation=rows, axes="opencv")

    def project(self, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return (n, 2) columns and rows of (n, 3) points of the scene; NaN for points behind the camera."""
        return _synthesis.project(*self._checked(), _arrays.rows(points, "points", empty=True))

    def _checked(self) -> tuple[int, int, list[float], tuple[float, ...], list[list[float]]]:
        width = _arrays.integer(self.width, "camera.width", 1, 16384)
        height = _arrays.integer(self.height, "camera.height", 1, 16384)
        distortion = [float(x) for x in np.asarray(self.distortion, np.float64).ravel()]
        if len(distortion) > 5:
            raise ValueError(f"camera.distortion: has {len(distortion)} coefficients; give k1 k2 p1 p2 k3")
        numbers = (
            self.fx,
            self.fx if self.fy is None else self.fy,
            0.5 * (width - 1) if self.cx is None else self.cx,
            0.5 * (height - 1) if self.cy is None else self.cy,
            self.skew,
            *distortion,
            *[0.0] * (5 - len(distortion)),
        )
        calibration = list(_arrays.vector(numbers, "camera", 10))
        matrix = _matrix(self.rotation, "camera.rotation")
        if _arrays.choice(self.axes, "camera.axes", ("opencv", "spice")) == "spice":
            matrix = matrix.T
        return width, height, calibration, _arrays.vector(self.position, "camera.position"), matrix.tolist()


@dataclasses.dataclass(eq=False)
class Image:
    """What each pixel of a camera shows, the top row first.

    Where the middle of a pixel shows no body, numbers are NaN, and `facet` and `body` are -1.

    Attributes
    ----------
    radiance
        (h, w) float32 I/F, the mean over the pixel; 0 in shadow and on the sky.
    depth
        (h, w) float64 along the boresight, in lengths of the scene.
    normal
        (h, w, 3) float32 unit vectors in the axes of the scene.
    facet
        (h, w) int32: the face of the body's mesh.
    body
        (h, w) int16: the number of the body.
    incidence, emission, phase
        (h, w) float32 degrees. Incidence is above 90 where the ground faces away from the sun.
    """

    radiance: npt.NDArray[np.float32]
    depth: npt.NDArray[np.float64]
    normal: npt.NDArray[np.float32]
    facet: npt.NDArray[np.int32]
    body: npt.NDArray[np.int16]
    incidence: npt.NDArray[np.float32]
    emission: npt.NDArray[np.float32]
    phase: npt.NDArray[np.float32]

    def __repr__(self) -> str:
        height, width = self.radiance.shape
        return f"<astrolith.Image: {width} x {height}, {(self.body >= 0).mean():.0%} covered, I/F up to {self.radiance.max():.3g}>"


@dataclasses.dataclass(eq=False)
class Ranges:
    """What rays meet first: NaN and -1 where they meet nothing.

    Attributes
    ----------
    range
        (n) float64 from the origins, in lengths of the scene.
    incidence
        (n) float32 degrees between the ray and the facet; above 90 where it is met from behind.
    facet
        (n) int32: the face of the body's mesh.
    body
        (n) int16: the number of the body.
    """

    range: npt.NDArray[np.float64]
    incidence: npt.NDArray[np.float32]
    facet: npt.NDArray[np.int32]
    body: npt.NDArray[np.int16]

    def __repr__(self) -> str:
        return f"<astrolith.Ranges: {len(self.range)}, of which {(self.body >= 0).sum()} meet a body>"


class Scene:
    """Bodies that stay in memory: pictures and ranges of them as arrays, as often as a simulation asks.

    Parameters
    ----------
    bodies
        A mesh or a recipe, or a list of them; a pair (vertices, faces) is a mesh. All have one unit of length, which is
        that of the scene. Each stands in the pose of its own axes until :meth:`pose` moves it.
    albedo
        The normal albedo: a number, (n) numbers for the vertices, a word of ``synth --albedo`` for recipes, such as
        "bennu", or a list of these, one for each body. None: that of the recipe, from the 8 bits of its colours; without
        one I/F is that of the law of reflection alone.
    detail
        Recipes are made for each camera: ground that the picture shows gets cells about `detail` pixels wide, .25 to 16,
        with all that the recipe has of that size, and other ground coarse ones. An albedo is then a number or a word. The
        `facet` of an image is one of that picture's mesh. None: each recipe is meshed once.
    options
        How recipes are meshed without `detail`: options of :func:`mesh`, such as ``triangles=1_000_000``.

    Raises
    ------
    ValueError
        A body or an albedo is wrong.

    Notes
    -----
    Calls may run in several threads of Python; they do not hold its lock, and with `detail` one waits for the other, :meth:`pose` too. A
    call takes the poses of its beginning. The same arguments give the same arrays for any number of threads; ranges with
    `detail` are those of the ground that the last picture, or :meth:`look`, needed.

    Examples
    --------
    >>> cube = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
    >>> faces = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5]
    >>> scene = Scene((cube, np.array(faces).reshape(-1, 3)), albedo=0.05)
    >>> scene.ranges([[0.0, 0.5, 10.0]], [[0.0, 0.0, -1.0]]).range.tolist()
    [9.0]
    """

    def __init__(
        self,
        bodies: Union[MeshLike, RecipeLike, Sequence[Union[MeshLike, RecipeLike]]],
        *,
        albedo: Any = None,
        detail: Optional[float] = None,
        threads: int = 0,
        progress: Progress = None,
        **options: Any,
    ) -> None:
        given = bodies if isinstance(bodies, list) else [bodies]
        albedos = albedo if isinstance(bodies, list) and isinstance(albedo, list) else [albedo] * len(given)
        if not given or len(albedos) != len(given):
            raise ValueError(f"albedo: has {len(albedos)} entries for {len(given)} bodies; give one for each body, of one at least")
        if detail is not None:
            detail = _arrays.number(detail, "detail", 0.25, 16.0)
            if options:
                raise ValueError(f"{', '.join(options)}: are for recipes that are meshed once; leave them or detail out")
            if not any(is_recipe(body) for body in given):
                raise ValueError("detail: is for recipes, and these are meshes; leave it out")
        self._scene = _synthesis.Scene()
        self._lock = threading.RLock()
        self._detailed: list[Any] = []
        for k, (body, value) in enumerate(zip(given, albedos)):
            name = f"bodies[{k}]" if isinstance(bodies, list) else "bodies"
            if is_recipe(body) and detail is not None:
                self._add_detailed(body, detail, value, threads, progress)
                continue
            if is_recipe(body):
                words = {"albedo": value} if isinstance(value, str) else {}
                made = mesh_recipe(body, threads=threads, progress=progress, **words, **options)
                value = _normal_albedo(made, body) if value is None or words else value
                body = made
            elif options and not any(is_recipe(b) for b in given):
                raise ValueError(f"{', '.join(options)}: are for recipes, and {name} is a mesh; leave them out")
            self._add(body, value, name, threads, progress)
        self._size = len(given)

    def _add(self, body: MeshLike, albedo: Any, name: str, threads: int, progress: Progress) -> None:
        arrays = surface_of(body, name)
        values = None
        if albedo is not None:
            if isinstance(albedo, str):
                raise ValueError(f"albedo: {_arrays.shown(albedo)} is a word for recipes, and {name} is a mesh; give numbers")
            values = np.asarray(albedo, np.float32)
            if values.ndim == 0:
                values = np.full(len(arrays.vertices), values)
            if values.shape != (len(arrays.vertices),):
                raise ValueError(f"albedo: has the shape {values.shape}; give a number, or one for each of {len(arrays.vertices)} vertices")
            values = np.ascontiguousarray(values)
        self._scene.add(arrays.vertices, arrays.faces, arrays.normals, values, _options.threads(threads), progress)

    def _add_detailed(self, body: RecipeLike, detail: float, albedo: Any, threads: int, progress: Progress) -> None:
        json, name = json_of(body, "bodies")
        word = albedo if isinstance(albedo, str) else ""
        number = 0.0 if albedo is None or word else _arrays.number(albedo, "albedo", 1e-6, 10.0)
        made = _synthesis.DetailedBody(json, name, detail, word, number)
        made.add_to(self._scene, _options.threads(threads), progress)
        self._detailed.append(made)

    def look(self, camera: Camera, *, threads: int = 0, progress: Progress = None) -> float:
        """Make the ground of recipes in `detail` what a camera needs, as :meth:`image` does before its picture.

        Returns
        -------
        float
            The edge of the finest cells, in lengths of the scene; NaN for a scene without `detail`.

        Raises
        ------
        ValueError
            The ground would have more than 3e7 triangles.
        """
        if not isinstance(camera, Camera):
            raise TypeError(f"camera: must be an astrolith.Camera, and is {type(camera).__name__}")
        with self._lock:
            return self._look(camera, threads, progress)

    def _look(self, camera: Camera, threads: int, progress: Progress) -> float:
        seen = camera._checked()
        return min(
            (body.look(self._scene, *seen, _options.threads(threads), progress) for body in self._detailed), default=float("nan")
        )

    def __repr__(self) -> str:
        return f"<astrolith.Scene: {self._size} {'body' if self._size == 1 else 'bodies'}>"

    def pose(
        self,
        body: int = 0,
        *,
        rotation: RotationLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        position: Sequence[float] = (0, 0, 0),
    ) -> None:
        """Move a body: its point p stands at ``rotation @ p + position``.

        Parameters
        ----------
        body
            The number of the body, from 0.
        rotation
            From the axes of the body to those of the scene, as ``spiceypy.pxform(body_frame, scene_frame, et)``: a
            matrix or a quaternion (w, x, y, z).
        position
            Where the origin of the body stands.
        """
        number = _arrays.integer(body, "body", 0, self._size - 1)
        with self._lock if self._detailed else contextlib.nullcontext():
            self._scene.place(number, _matrix(rotation, "rotation").tolist(), _arrays.vector(position, "position"))

    def image(
        self,
        camera: Camera,
        sun: Sequence[float],
        *,
        reflectance: str = "lommel-seeliger",
        oversampling: int = 1,
        smooth: bool = True,
        threads: int = 0,
        progress: Progress = None,
    ) -> Image:
        """Take a picture under sunlight with hard shadows and eclipses, without other light.

        Parameters
        ----------
        camera
            The camera in its pose.
        sun
            The direction to the sun in the axes of the scene, of any length.
        reflectance
            The law, in the words of :func:`render`, scaled to the albedo where sun and viewer are above the ground.
        oversampling
            n: I/F is the mean of n x n samples, 1 to 16. The other arrays are of the middle of the pixel.
        smooth
            Whether normals, and with them all angles, are interpolated from those of the vertices. False: those of the
            facets, as SPICE computes them.

        Raises
        ------
        ValueError
            An argument is wrong, the camera is inside a body, or its distortion folds.
        RuntimeError
            `progress` returned False.
        """
        if not isinstance(camera, Camera):
            raise TypeError(f"camera: must be an astrolith.Camera, and is {type(camera).__name__}")
        arguments = (
            *camera._checked(),
            _arrays.vector(sun, "sun"),
            _arrays.text(reflectance, "reflectance"),
            _arrays.integer(oversampling, "oversampling", 1, 16),
            _arrays.flag(smooth, "smooth"),
            _options.threads(threads),
            progress,
        )
        with self._lock if self._detailed else contextlib.nullcontext():
            if self._detailed:
                self._look(camera, threads, progress)
            return Image(**self._scene.image(*arguments))

    def ranges(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        noise: float = 0.0,
        beam: float = 0.0,
        seed: int = 1,
        threads: int = 0,
        progress: Progress = None,
    ) -> Ranges:
        """Measure the distances along rays, in double precision, as a lidar does.

        Parameters
        ----------
        origins
            (n, 3) places in the axes of the scene, or one place for all rays.
        directions
            (n, 3) directions of any length.
        noise
            The standard deviation of errors of the ranges, in lengths of the scene.
        beam
            The angle across a beam in degrees, 0 to 10: a range is then the mean over 19 rays.
        seed
            Decides the noise.

        Raises
        ------
        ValueError
            An argument is wrong.
        RuntimeError
            `progress` returned False.
        """
        towards = _arrays.rows(directions, "directions", empty=True)
        places = np.asarray(origins)
        if places.ndim == 1:
            places = np.array([_arrays.vector(origins, "origins")])
        elif places.dtype.kind in "iu":
            places = places.astype(np.float64)
        return Ranges(
            **self._scene.ranges(
                _arrays.rows(places, "origins", empty=True),
                towards,
                _arrays.number(noise, "noise", 0.0, 1e18),
                _arrays.number(beam, "beam", 0.0, 10.0),
                _options.seed(seed),
                _options.threads(threads),
                progress,
            )
        )
