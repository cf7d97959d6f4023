// A sheet of pictures of bodies with baked maps, for whoever chooses among them: a row for each body shows
// its finest mesh, its coarsest one, the same with its maps on it, and these maps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>

#include "geometry/io/mesh_io.h"
#include "synthesis/bake/baked_maps.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {

inline constexpr std::uint64_t kMostOnSheet = 60;

class MapsSheet {
 public:
  enum Column { kFinest, kCoarsest, kMapped, kNormal, kHeight, kOcclusion, kCurvature, kColor, kColumns };

  // Adds the pictures of one level of a body, the finest first. Bodies are told by their numbers, which stand
  // on the sheet where there are several. Several threads may add bodies.
  void add(std::uint64_t member, std::size_t level, std::size_t levels, const TriangleMesh& mesh,
           const MeshSkin& skin, const BakedMaps& maps);

  // Writes the rows in the order of the bodies' numbers; nothing where there are none.
  void write(const std::filesystem::path& file) const;

 private:
  using Row = std::array<RgbImage, kColumns>;  // without pixels where a body has no such map

  std::mutex mutex_;
  std::map<std::uint64_t, Row> rows_;
};

}  // namespace astrolith
