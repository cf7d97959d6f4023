#include "cuda/mesher/mesh_steps.h"

#include <set>

namespace astrolith {
namespace {

TEST(HaloThread, VisitsEachSampleOfTheHaloOnce) {
  std::set<std::size_t> visited;
  for (std::size_t thread = 0; thread < HaloThread::kSamples; ++thread) {
    const HaloThread t(HaloThread::kSamples + thread);
    EXPECT_EQ(t.block, 1u);
    EXPECT_NE(owner_index(t.x, t.y, t.z), 0u);
    visited.insert(MeshBlock::sample(t.x, t.y, t.z));
  }
  EXPECT_EQ(visited.size(), HaloThread::kSamples);
  EXPECT_EQ(HaloThread::kSamples, MeshBlock::kSamples - MeshBatch::kRows * kBlockCells);
}

}  // namespace
}  // namespace astrolith
