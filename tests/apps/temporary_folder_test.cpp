#include "base/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

// Sets TMPDIR; the destructor restores the earlier value.
class TemporaryPlace {
 public:
  explicit TemporaryPlace(const std::string& folder) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryPlace() {
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
  }
  TemporaryPlace(const TemporaryPlace&) = delete;
  TemporaryPlace& operator=(const TemporaryPlace&) = delete;

 private:
  std::optional<std::string> before_;
};

TEST(TemporaryFolder, WithoutAPlaceForItTheReasonIsThatOfThePlaceAndNoOlderOne) {
  const test::ScratchFolder scratch;
  const TemporaryPlace absent((scratch.path() / "absent").string());
  errno = EAGAIN;  // left by an earlier call
  try {
    const TemporaryFolder folder;
    FAIL() << folder.path();
  } catch (const StorageError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find(std::strerror(EAGAIN)), std::string::npos) << line;
    EXPECT_EQ(line.rfind("error: TMPDIR: got ", 0), 0U) << line;
  }
}

TEST(TemporaryFolder, GoesWithTheObject) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    EXPECT_TRUE(std::filesystem::is_directory(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace roadbook
