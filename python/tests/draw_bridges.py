"""Draws the sheet of docs/python_packages.md: a body as trimesh, PyVista and Open3D show it, without a window.

draw_bridges.py RECIPE.json SHEET.jpg [RESOLUTION]

Takes matplotlib beside the three. Open3D's own renderer needs a GPU or Vulkan, so its rays draw the picture instead.
"""

import sys

import astrolith
import matplotlib
import numpy as np
from astrolith import bridges

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

VIEW = np.array([1.0, -2.2, 1.1]) / np.linalg.norm([1.0, -2.2, 1.1])  # from the body to the eye
ACROSS = np.cross([0, 0, 1.0], VIEW) / np.linalg.norm(np.cross([0, 0, 1.0], VIEW))
UP = np.cross(VIEW, ACROSS)


def draw_sections(axes, mesh):
    """Contour lines: the sections of a Trimesh by planes of equal height, seen from +z."""
    body = bridges.to_trimesh(mesh)
    heights = np.linspace(*body.bounds[:, 2], 26)[1:-1]
    for height in heights:
        section = body.section(plane_origin=[0, 0, height], plane_normal=[0, 0, 1])
        color = pyplot.get_cmap("viridis")((height - heights[0]) / np.ptp(heights))
        for line in section.discrete if section else []:
            axes.plot(line[:, 0], line[:, 1], color=color, linewidth=0.8)
    half = 0.52 * np.ptp(body.bounds[:, 0])
    middle = body.bounds.mean(axis=0)
    axes.set(xlim=middle[0] + half * np.array([-1, 1]), ylim=middle[1] + 0.75 * half * np.array([-1, 1]), aspect="equal")
    axes.set_title(f"trimesh: sections every {np.diff(heights)[0]:.3g} {body.units}", fontsize=10)


def draw_slopes(axes, mesh):
    """The slopes of the facets, on a PolyData."""
    import pyvista

    slopes = astrolith.gravity(mesh, 1900.0, period=12.1324).slope
    plotter = pyvista.Plotter(off_screen=True, window_size=(800, 600))
    plotter.set_background("white")
    bar = {"title": "slope, degrees", "color": "black", "fmt": "%.0f", "n_labels": 4}
    plotter.add_mesh(bridges.to_pyvista(mesh, {"slope": slopes}), scalars="slope", clim=(0, 60), cmap="inferno",
                     scalar_bar_args=bar)  # fmt: skip
    plotter.camera_position = [tuple(10 * np.ptp(mesh.vertices) * VIEW), (0, 0, 0), (0, 0, 1)]
    plotter.reset_camera()
    plotter.camera.zoom(1.6)
    axes.imshow(plotter.screenshot(return_img=True))
    axes.set_title("PyVista: slopes of astrolith.gravity", fontsize=10)


def draw_rays(axes, mesh):
    """Light from one side with its shadows: rays of a scene of Open3D."""
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(bridges.to_open3d(mesh)))
    half = 0.52 * np.ptp(mesh.vertices @ ACROSS)
    x, y = np.meshgrid(np.linspace(-half, half, 800), np.linspace(0.75 * half, -0.75 * half, 600))
    middle = (mesh.vertices.max(axis=0) + mesh.vertices.min(axis=0)) / 2
    starts = middle + 4 * half * VIEW + x[..., None] * ACROSS + y[..., None] * UP
    rays = np.concatenate([starts, np.broadcast_to(-VIEW, starts.shape)], axis=-1).astype(np.float32)
    hit = scene.cast_rays(open3d.core.Tensor(rays))
    normals, distance = hit["primitive_normals"].numpy(), hit["t_hit"].numpy()
    met = np.isfinite(distance)
    light = (VIEW + 1.2 * ACROSS + 0.7 * UP) / np.linalg.norm(VIEW + 1.2 * ACROSS + 0.7 * UP)
    points = starts - np.where(met, distance, 0)[..., None] * VIEW + 1e-3 * half * normals
    to_light = np.concatenate([points, np.broadcast_to(light, points.shape)], axis=-1).astype(np.float32)
    shadow = scene.test_occlusions(open3d.core.Tensor(to_light)).numpy()
    grey = 0.06 + 0.94 * np.clip(normals @ light, 0, 1) * ~shadow
    axes.imshow(np.where(met, grey, 1.0), cmap="gray", vmin=0, vmax=1)
    axes.set_title("Open3D: rays of a RaycastingScene", fontsize=10)


def main():
    recipe, sheet, *resolution = sys.argv[1:]
    mesh = astrolith.mesh(recipe, resolution=int(resolution[0]) if resolution else 192)
    figure, panels = pyplot.subplots(1, 3, figsize=(13, 3.6))
    for axes, draw in zip(panels, (draw_sections, draw_slopes, draw_rays)):
        draw(axes, mesh)
        axes.axis("off")
    figure.tight_layout()
    figure.savefig(sheet, dpi=110, pil_kwargs={"quality": 85})


if __name__ == "__main__":
    main()
