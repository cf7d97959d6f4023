"""Screened Poisson reconstruction (Kazhdan and Hoppe 2013, as MeshLab has it) of an oriented point cloud:
poisson_reconstruction.py POINTS.ply MESH.ply DEPTH. Prints seconds, sizes and what is wrong with the mesh as JSON."""
import json
import sys
import time

import pymeshlab

points, mesh, depth = sys.argv[1:]
meshes = pymeshlab.MeshSet()
meshes.load_new_mesh(points)
start = time.perf_counter()
meshes.generate_surface_reconstruction_screened_poisson(depth=int(depth), threads=2)
seconds = time.perf_counter() - start
topology = meshes.get_topological_measures()
meshes.save_current_mesh(mesh)
print(json.dumps({"seconds": seconds, "vertices": topology["vertices_number"], "triangles": topology["faces_number"],
                  "boundary_edges": topology["boundary_edges"], "non_two_manifold_edges": topology["non_two_manifold_edges"],
                  "components": topology["connected_components_number"], "genus": topology["genus"]}))
