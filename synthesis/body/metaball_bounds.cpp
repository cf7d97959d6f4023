#include "synthesis/body/compact_kernel_bounds.h"

namespace astrolith {
namespace {

MetaballList all_of(const MetaballsView& metaballs) {
  return {metaballs.spheres.data(), nullptr, static_cast<std::uint32_t>(metaballs.spheres.size())};
}

// A scratch array of this thread. It is reused, since thousands of boxes are bounded.
KernelInterval* scratch_for(const MetaballsView& metaballs) {
  thread_local std::vector<KernelInterval> scratch;
  if (scratch.size() < metaballs.spheres.size()) scratch.resize(metaballs.spheres.size());
  return scratch.data();
}

}  // namespace

MetaballInterval bound_metaballs(const MetaballsView& metaballs, const Box& box, double height) {
  return bound_metaballs(metaballs.parameters, all_of(metaballs), box, height, scratch_for(metaballs));
}

double smallest_gradient(const MetaballsView& metaballs, const Box& box) {
  return smallest_gradient(metaballs.parameters, all_of(metaballs), box, scratch_for(metaballs));
}

}  // namespace astrolith
