#include "cuda/device.h"

namespace astrolith {
namespace {

TEST(Device, ProbeNamesAReasonOrADevice) {
  const DeviceStatus status = probe_device();
  EXPECT_NE(status.usable, !status.reason.empty());
  EXPECT_EQ(status.usable, status.compute_capability > 0 && status.reason.empty());
}

}  // namespace
}  // namespace astrolith
