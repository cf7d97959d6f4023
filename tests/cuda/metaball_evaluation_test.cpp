#include "cuda/metaball_evaluation.h"

#include <vector>

#include "cuda/device.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

PreparedMetaballs random_body(int num_spheres) {
  CounterRandom random(11);
  MetaballBody body;
  body.a = body.b = 6.0;
  for (int i = 0; i < num_spheres; ++i) {
    body.spheres.push_back(
        {{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, random.uniform(0.05, 0.5)});
  }
  return prepare_metaballs(body);
}

// Sizes around the edges of a thread block.
TEST(MetaballEvaluationOnGpu, HasTheBitsOfTheCpu) {
  const DeviceStatus status = probe_device();
  if (!status.usable) GTEST_SKIP() << "no GPU here: " << status.reason;
  const PreparedMetaballs body = random_body(137);
  for (const std::size_t n : {0, 1, 31, 255, 256, 257, 100003}) {
    CounterRandom random(n);
    std::vector<float> x(n), y(n), z(n), gpu(n), cpu(n), gx(n), gy(n), gz(n);
    for (auto* axis : {&x, &y, &z}) {
      for (float& value : *axis) value = static_cast<float>(random.uniform(-1.5, 1.5));
    }
    evaluate_metaballs_on_gpu(body, x, y, z, gpu);
    evaluate_metaballs(body, static_cast<int>(n), x.data(), y.data(), z.data(), cpu.data(), gx.data(),
                       gy.data(), gz.data());
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(math::bits_of(gpu[i]), math::bits_of(cpu[i])) << i;
  }
}

}  // namespace
}  // namespace astrolith
