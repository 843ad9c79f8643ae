#include "base/files/disk_space.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>

namespace roadbook {
namespace {

// /proc has no blocks, so it is never full: the system's own reason counts there.
TEST(WriteFault, APlaceWithoutBlocksIsNotCalledFull) {
  EXPECT_EQ(write_fault("/proc/none", EACCES), std::strerror(EACCES));
  EXPECT_EQ(write_fault("/proc/none"), "a failed write");
}

TEST(WriteFault, AFullDeviceIsNamedWithTheFile) {
  EXPECT_EQ(write_fault("/proc/none", ENOSPC), "no space left on the device holding /proc/none");
  EXPECT_EQ(write_fault("/proc/none", EDQUOT), "no space left on the device holding /proc/none");
}

}  // namespace
}  // namespace roadbook
