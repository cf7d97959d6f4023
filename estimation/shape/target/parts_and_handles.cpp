#include "estimation/shape/target/parts_and_handles.h"

namespace astrolith {
namespace {

std::string counted_things(std::int64_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace

std::string PartsAndHandles::words() const {
  return counted_things(parts, "part") + " and " + counted_things(handles, "handle");
}

PartsAndHandles parts_and_handles(const TargetBody& target) {
  return {target.components, analyze_topology(target.mesh).genus};
}

PartsAndHandles parts_and_handles(const MeshTopology& topology) {
  return {topology.components, topology.genus};
}

}  // namespace astrolith
