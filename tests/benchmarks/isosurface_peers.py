#!/usr/bin/env python3
"""VTK's flying edges with normals, one thread, on a field that dense_field_benchmark wrote: seconds of the processor.

    isosurface_peers.py FIELD.raw      needs: pip install vtk numpy
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


def flying_edges(image, repeats=5):
    best, triangles = float("inf"), 0
    for _ in range(repeats):
        contour = vtk.vtkFlyingEdges3D()
        contour.SetInputData(image)
        contour.SetValue(0, 0.0)
        contour.ComputeScalarsOff()
        contour.ComputeGradientsOff()
        contour.ComputeNormalsOn()
        start = time.process_time()
        contour.Update()
        best = min(best, time.process_time() - start)
        triangles = contour.GetOutput().GetNumberOfPolys()
    return {"triangles": triangles, "seconds": round(best, 3)}


def main():
    vtk.vtkSMPTools.Initialize(1)
    image = image_of(np.fromfile(sys.argv[1], np.float32))
    print(json.dumps({"vtk": vtk.vtkVersion().GetVTKVersion(), "flying_edges_with_normals": flying_edges(image)}))


if __name__ == "__main__":
    main()
