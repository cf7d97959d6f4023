// The colours that a recipe's layers paint on the surface of its body.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/arrays.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

// Whether a layer of the recipe paints its body.
bool has_colors(const Recipe& recipe);

// The colour of a surface that no layer has painted: half of the light, in sRGB.
inline constexpr VertexColor kBareColor{188, 188, 188};

// Layers paint in the recipe's order, each over the colours before it with its weight (mask and locality). A
// layer that is too fine for the coordinates paints its mean colour. Points take the colour of the bare
// surface below them, so that craters and boulders are painted as the ground is. Colours are computed on the
// host for meshes of every device, and have the same bytes for any number of threads.
class SurfaceColors {
 public:
  // `field` is the field of the recipe and must outlive this object; `name` begins the messages of errors.
  SurfaceColors(const Recipe& recipe, const std::string& name, const ImplicitField& field);
  SurfaceColors(const SurfaceColors&) = delete;
  SurfaceColors& operator=(const SurfaceColors&) = delete;
  ~SurfaceColors();

  // Writes colors[i] of the point origin + vertices[i].position, which lies near the surface. The origin is
  // the centre of the field's patch, if there is one. Both spans have one size.
  void paint(const Vec3d& origin, std::span<const MeshVertex> vertices, std::span<VertexColor> colors) const;

  // The colours of a whole mesh.
  std::vector<VertexColor> colors_of(const Vec3d& origin, const TriangleMesh& mesh) const;

 private:
  // Paints the points origin + local(i).
  template <class Local>
  void paint_points(const Vec3d& origin, const Local& local, std::span<VertexColor> colors) const;

  const ImplicitField& field_;
  ArrayStore textures_;
  std::vector<LayerPaint> paints_;
};

}  // namespace astrolith
