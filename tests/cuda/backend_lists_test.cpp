#include "cuda/backend_lists.h"

#include <algorithm>

#include "tests/cuda/host_backend.h"

namespace astrolith {
namespace {

// List i has i * i candidates, of which the multiples of three are its items.
struct Multiples {
  template <typename Writer>
  void operator()(std::size_t i, ListShare share, Writer& write) const {
    for (std::uint64_t k = share.begin(i * i); k < share.end(i * i); ++k) {
      if (k % 3 == 0) write(static_cast<std::uint32_t>(k));
    }
  }
};

TEST(BackendLists, AreTheSameForAnyNumberOfShares) {
  constexpr std::size_t kLists = 12;
  HostBackend backend;
  const auto whole = write_lists<std::uint32_t>(backend, "one thread a list", kLists, Multiples{});
  for (const std::uint32_t shares : {2u, 5u, 32u}) {
    const auto shared = write_lists<std::uint32_t>(backend, "more threads", kLists, Multiples{}, shares);
    ASSERT_EQ(shared.items.size(), whole.items.size());
    EXPECT_TRUE(std::equal(whole.items.data(), whole.items.data() + whole.items.size(), shared.items.data()));
    EXPECT_TRUE(std::equal(whole.first.data(), whole.first.data() + kLists + 1, shared.first.data()));
  }
}

TEST(BackendLists, HaveMoreThreadsWhereTheyAreFew) {
  EXPECT_EQ(share_count(1), kMostShares);
  EXPECT_EQ(share_count(kFullLaunch / 2), 2u);
  EXPECT_EQ(share_count(2 * kFullLaunch), 1u);
}

}  // namespace
}  // namespace astrolith
