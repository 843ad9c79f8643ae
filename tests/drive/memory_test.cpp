#include <malloc.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// What malloc has given out, small blocks and large ones.
std::size_t allocated_bytes() {
  const auto info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

// A camera whose images are all one file.
void write_long_drive(const fs::path& folder, int frames) {
  Rig rig = small_rig();
  rig.cameras.resize(1);
  DriveWriter writer(folder, rig, small_wheels());
  writer.write_image(0, kStart, noise_image(16, 12, 1));
  for (int i = 0; i < 4 * kFrames; ++i) writer.write_wheels(wheels_at(i));
  writer.finish();
  std::string table = "#timestamp [ns],filename\n";
  const auto name = [](int i) { return std::to_string(kStart + i * kFrame) + ".png"; };
  for (int i = 0; i < frames; ++i) {
    table += std::to_string(kStart + i * kFrame) + "," + name(i) + "\n";
    if (i > 0) fs::create_symlink(name(0), folder / "cam0/data" / name(i));
  }
  write_text(folder / "cam0/data.csv", table);
}

std::size_t bytes_of_open_drive(const fs::path& folder) {
  DriveOptions options;
  options.num_threads = 1;
  const std::size_t before = allocated_bytes();
  const Drive drive = Drive::open(folder, options);
  for (std::size_t i = 0; i < drive.frame_count(); i += 50) (void)drive.read_image(i, 0);
  drive.for_each_wheel_reading([](const WheelReading&) {});
  return allocated_bytes() - before;
}

TEST(Memory, OfADriveStaySixteenBytesAFrame) {
  const TemporaryFolder folder;
  write_long_drive(folder.path() / "short", 300);
  write_long_drive(folder.path() / "long", 2300);
  // Buffers that live as long as the thread come into being here.
  (void)bytes_of_open_drive(folder.path() / "short");
  const auto less = static_cast<double>(bytes_of_open_drive(folder.path() / "short"));
  const auto more = static_cast<double>(bytes_of_open_drive(folder.path() / "long"));
  // A stamp and one bit a camera in 64; half a byte for malloc's rounding of the two arrays.
  EXPECT_LE((more - less) / 2000.0, 16.5);
}

}  // namespace
}  // namespace roadbook::test
