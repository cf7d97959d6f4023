#!/usr/bin/env python3
"""VTK's flying edges and scikit-image's marching cubes, one thread, on a field that isosurface_benchmark or
dense_field_benchmark wrote: seconds of the processor.

    isosurface_peers.py FIELD.raw      needs: pip install vtk numpy; scikit-image is left out where it is missing
"""
import json
import sys
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk


def image_of(values):
    side = round(values.size ** (1 / 3))
    image = vtk.vtkImageData()
    image.SetDimensions(side, side, side)
    image.GetPointData().SetScalars(numpy_to_vtk(values, deep=True))
    return image


def flying_edges(image, normals, repeats=5):
    best, triangles = float("inf"), 0
    for _ in range(repeats):
        contour = vtk.vtkFlyingEdges3D()
        contour.SetInputData(image)
        contour.SetValue(0, 0.0)
        contour.ComputeScalarsOff()
        contour.ComputeGradientsOff()
        contour.SetComputeNormals(normals)
        start = time.process_time()
        contour.Update()
        best = min(best, time.process_time() - start)
        triangles = contour.GetOutput().GetNumberOfPolys()
    return {"triangles": triangles, "seconds": round(best, 3), "mtriangles_per_s": round(triangles / best / 1e6, 2)}


def marching_cubes(image):
    """scikit-image's, of Lewiner: with normals. None where the package is missing."""
    try:
        from skimage.measure import marching_cubes as lewiner
    except ImportError:
        return None
    start = time.process_time()
    triangles = len(lewiner(image, 0.0)[1])
    seconds = time.process_time() - start
    return {"triangles": triangles, "seconds": round(seconds, 3), "mtriangles_per_s": round(triangles / seconds / 1e6, 2)}


def main():
    vtk.vtkSMPTools.Initialize(1)
    values = np.fromfile(sys.argv[1], np.float32)
    image = image_of(values)
    version = vtk.vtkVersion().GetVTKVersion()
    print(json.dumps({"vtk": version, "flying_edges": flying_edges(image, False),
                      "flying_edges_with_normals": flying_edges(image, True),
                      "marching_cubes": marching_cubes(values.reshape(3 * [round(values.size ** (1 / 3))]))}))


if __name__ == "__main__":
    main()
