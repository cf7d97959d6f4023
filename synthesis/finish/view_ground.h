// The surface of a recipe as a camera needs it: fine near the camera, coarse far away and beside the picture.
//
// Space is divided into cubes of 63^3 cells, level by level. The cubes of a level have half the side of those
// of the level before, and cells half as wide. Ground that the camera sees with cells wider than asked for
// is made again in the cubes of the next level, and what that hides of the coarser mesh is left out. Meshes
// of two levels overlap by a coarse cell.
//
// Landforms that are drawn by cells, and are wider than 1.5 cells, are those of a level; so a level has a
// field of its own, made for the cubes that are seen.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/picture/scene_camera.h"

namespace astrolith {
namespace view_ground {
class Cubes;
}

struct GroundLook {
  TriangleMesh mesh;          // with normals, in the frame of the recipe's file
  std::vector<float> albedo;  // normal albedo of the vertices; empty where the recipe states none
  int levels = 0;
  double finest = 0.0;  // edge of the finest cells, length units
};

class ViewGround {
 public:
  // `cell` is how wide cells may look, in pixels, .25 .. 16. Throws InputError for a recipe that
  // ImplicitField refuses, for one without a surface, and for one that erodes: that acts on a whole mesh.
  ViewGround(const Recipe& recipe, const std::string& name, double cell, const Progress& progress = {});
  ~ViewGround();

  // The ground for a camera in the frame of the recipe's file: that of the call before where nothing changes.
  // Cubes that both calls need are made once. The mesh depends on the camera alone. Throws InputError where
  // it would have more than 3e7 triangles, WorkError where progress asks to stop.
  std::shared_ptr<const GroundLook> look(const SceneCamera& camera, const Progress& progress = {});

 private:
  std::unique_ptr<view_ground::Cubes> cubes_;
};

}  // namespace astrolith
