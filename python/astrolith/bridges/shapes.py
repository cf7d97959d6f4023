"""The shape of a body as spherical harmonics of its radius, as programs of geodesy have it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from astrolith import _arrays
from astrolith._mesh import Mesh, MeshLike, arrays_of
from astrolith._scene import Scene

_MOST_DEGREE = 300


def _legendre(degree: int, x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """(degree + 1, degree + 1, n): P_lm(x), 4 pi normalised, without the sign of Condon and Shortley.

    Recursion in the degree (Holmes and Featherstone 2002, eqs 11 to 13).
    """
    p = np.zeros((degree + 1, degree + 1, len(x)))
    u = np.sqrt(1.0 - x * x)
    p[0, 0] = 1.0
    for m in range(1, degree + 1):
        p[m, m] = (np.sqrt(3.0) if m == 1 else np.sqrt((2.0 * m + 1.0) / (2.0 * m))) * u * p[m - 1, m - 1]
    for m in range(degree + 1):
        for n in range(m + 1, degree + 1):
            a = np.sqrt((2.0 * n - 1.0) * (2.0 * n + 1.0) / ((n - m) * (n + m)))
            p[n, m] = a * x * p[n - 1, m]
            if n > m + 1:
                b = (2.0 * n + 1.0) * (n + m - 1.0) * (n - m - 1.0) / ((n - m) * (n + m) * (2.0 * n - 3.0))
                p[n, m] -= np.sqrt(b) * p[n - 2, m]
    return p


def shape_harmonics(mesh: MeshLike, degree: int, *, threads: int = 0) -> npt.NDArray[np.float64]:
    """Expand the radius of a closed body about the origin of its frame in spherical harmonics.

    The radius is taken by rays, at the nodes of Gauss and Legendre in latitude and at even longitudes: 180 x 360 or more.

    Parameters
    ----------
    mesh
        The body. Each ray from the origin must leave it once.
    degree
        The highest degree, 0 to 300.

    Returns
    -------
    ndarray
        (2, degree + 1, degree + 1): C[l, m] and S[l, m] in the mesh's unit, 4 pi normalised, without the sign of Condon and
        Shortley, as those of pyshtools. C[0, 0] is the mean radius.

    Raises
    ------
    ValueError
        The body is open, does not hold the origin of its frame, or has several surfaces along a ray.
    """
    top = _arrays.integer(degree, "degree", 0, _MOST_DEGREE)
    arrays = arrays_of(mesh, "mesh")
    nodes = max(180, 2 * (top + 1))
    z, weights = np.polynomial.legendre.leggauss(nodes)
    angles = 2.0 * np.pi * np.arange(2 * nodes) / (2 * nodes)
    across = np.sqrt(1.0 - z * z)
    rays = np.stack([np.outer(across, np.cos(angles)), np.outer(across, np.sin(angles)),
                     np.repeat(z[:, None], len(angles), axis=1)], axis=-1).reshape(-1, 3)  # fmt: skip
    scene = Scene(Mesh(arrays.vertices, arrays.faces, length_unit="m"))
    far = 2.0 * float(np.sqrt((arrays.vertices**2).sum(axis=1).max()))
    from_outside = far - np.asarray(scene.ranges(far * rays, -rays, threads=threads).range)
    from_inside = np.asarray(scene.ranges(np.zeros(3), rays, threads=threads).range)
    if not np.allclose(from_inside, from_outside, rtol=1e-6, atol=1e-9 * far):
        raise ValueError("mesh: does not have one surface along each ray from the origin of its frame")
    radii = from_outside.reshape(nodes, -1)
    m = np.arange(top + 1)
    cosines = radii @ np.cos(np.outer(angles, m)) / len(angles)
    sines = radii @ np.sin(np.outer(angles, m)) / len(angles)
    p = _legendre(top, z)
    half = 0.5 * weights
    return np.stack([np.einsum("lmn,nm,n->lm", p, part, half) for part in (cosines, sines)])
