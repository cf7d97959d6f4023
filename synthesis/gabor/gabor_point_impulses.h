// The impulses of surface noise around one point, for points so far apart that they share hardly any impulse.
#pragma once

#include <span>
#include <vector>

#include "synthesis/gabor/gabor_cells.h"
#include "synthesis/gabor/gabor_chunk.h"

namespace astrolith {

// Draws the impulses of one band around one point after another. The memory is kept from point to point.
class GaborPointImpulses {
 public:
  // Both arguments must outlive the object.
  GaborPointImpulses(const SurfaceBand& band, const BodyGround& ground) : band_(band), ground_(ground) {}

  // The impulses that may reach the point, in the order in which bricks hold them. The chunks have no boxes,
  // and are valid until the next call.
  std::span<const ImpulseChunk> around(float x, float y, float z);

 private:
  void find_cells(const std::array<float, 3>& point);
  void append(const GaborImpulse& impulse);

  const SurfaceBand& band_;
  const BodyGround& ground_;
  std::vector<GaborCell> cells_;  // those that may hold an impulse that reaches the point
  GaborCellCenters centers_;
  std::vector<ImpulseChunk> chunks_;
  std::size_t impulses_ = 0;  // number of impulses in the chunks
};

}  // namespace astrolith
