// The colours and the albedo of the surface of a recipe's body (recipe/albedo.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/arrays.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/surface_paints.h"

namespace astrolith {

// The albedo of the recipe's ground: the default where layers alone state one; none where nothing does.
std::optional<GroundAlbedo> stated_albedo(const Recipe& recipe);

// Whether the recipe states an albedo, or a layer of it paints its body.
bool has_colors(const Recipe& recipe);

// The colour of a surface without albedo that no layer has painted: half of the light, in sRGB.
inline constexpr VertexColor kBareColor{188, 188, 188};

// How colours show a ground of a normal albedo for viewing: its linear light is .36 (albedo / .1)^(1/3), so
// that dark bodies are darker than bright ones, and neither is black.
double viewing_light(double normal_albedo);

// Layers act in the recipe's order: an image paints over the colours before it with the layer's weight (mask
// and locality), and albedos as recipe/albedo.h says. An image that is too fine for the coordinates paints
// its mean colour. Points of a boulder without an albedo of its own take the colour of the ground below them.
// Colours are computed on the host for meshes of every device, and have the same bytes for any number of
// threads.
class SurfaceColors {
 public:
  // `field` is the field of the recipe and must outlive this object; `name` begins the messages of errors.
  SurfaceColors(const Recipe& recipe, const std::string& name, const ImplicitField& field);
  SurfaceColors(const SurfaceColors&) = delete;
  SurfaceColors& operator=(const SurfaceColors&) = delete;
  ~SurfaceColors();

  // Writes colors[i] of the point origin + vertices[i].position, which lies near the surface, for viewing.
  // The origin is the centre of the field's patch, if there is one. Normals serve albedos by slope; a normal
  // of length 0 means even ground. Both spans have one size.
  void paint(const Vec3d& origin, std::span<const MeshVertex> vertices, std::span<VertexColor> colors) const;

  // The colours of a whole mesh.
  std::vector<VertexColor> evaluate_colors(const Vec3d& origin, const TriangleMesh& mesh) const;

  // Whether the recipe states an albedo.
  bool has_albedo() const { return albedo_.has_value(); }
  // Writes the normal albedo in red, green and blue at the points; see paint().
  void find_albedo(const Vec3d& origin, std::span<const MeshVertex> vertices, std::span<Vec3f> albedo) const;
  // The colour that paint() gives a point of this albedo.
  VertexColor for_viewing(const Vec3f& albedo) const;

 private:
  // Calls use(i, point) with what is painted at the points origin + vertices[i].position.
  template <class Use>
  void for_each_point(const Vec3d& origin, std::span<const MeshVertex> vertices, const Use& use) const;
  // The linear light for viewing at a point with this normal.
  Vec3f light_at(const PaintedPoint& point, const Vec3f& normal) const;

  const ImplicitField& field_;
  ArrayStore textures_;
  SurfacePaints paints_;
  std::optional<GroundAlbedo> albedo_;
  Vec3f bare_;  // encoded as sRGB
};

}  // namespace astrolith
