#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// One of: a flipped bit, a zeroed sector, random bytes, a cut.
std::string damaged(std::string bytes, Random& random) {
  const std::size_t at = random.below(bytes.size());
  switch (random.below(4)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      break;
    case 1:
      bytes.replace(at & ~std::size_t{511}, 512, std::string(512, '\0'));
      break;
    case 2:
      for (std::size_t i = at; i < std::min(at + 16, bytes.size()); ++i)
        bytes[i] = static_cast<char>(random.below(256));
      break;
    default:
      bytes.resize(at);
  }
  return bytes;
}

std::string row_of(const Map& map) {
  std::string text;
  for (const Keyframe& k : map.keyframes)
    text.append(reinterpret_cast<const char*>(k.T_frame_vehicle.data()), 128)
        .append(reinterpret_cast<const char*>(k.covariance.data()), 288)
        .append(std::to_string(k.t_ns));
  for (const Landmark& l : map.landmarks)
    text.append(reinterpret_cast<const char*>(l.p_frame.data()), 24)
        .append(l.descriptor.begin(), l.descriptor.end());
  for (const Observation& o : map.observations)
    text.append(reinterpret_cast<const char*>(o.pixel.data()), 8)
        .append(std::to_string(o.landmark));
  for (const Session& s : map.sessions) text += s.name + s.drive_path;
  return text;
}

// If the file is accepted, it must be the saved map. Otherwise the result is one error line.
TEST(MapDamage, IsFoundWhereverTheContentChanged) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  const Map map = small_map(5);
  MapFileBuilder(path, "key").finish(map, {});
  const std::string good = read_bytes(path);
  const std::string content = row_of(map);
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed, "damage");
    write_bytes(path, damaged(good, random));
    bool accepted = false;
    try {
      EXPECT_EQ(row_of(load_map(path)), content);
      accepted = true;
    } catch (const Error&) {
      ++refused;
    }
    try {
      const MapReport report = check_map(path);
      if (!accepted) {
        EXPECT_FALSE(report.problems.empty());
      }
    } catch (const StorageError&) {
      EXPECT_FALSE(accepted);
    }
  }
  // Changes of bytes that no table uses are harmless, but most bytes are in use.
  EXPECT_GT(refused, 200);
}

TEST(MapDamage, LayersAndMetaAreCovered) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(5), {{"note", "a marker in the meta table"}});
  const std::string good = read_bytes(path);
  // The date of a pose layer's row, a key of the meta table, a stored digest.
  for (const std::string marker : {"2014-06-24T", "a marker in", "digest.keyframes"}) {
    const std::size_t at = good.find(marker);
    ASSERT_NE(at, std::string::npos) << marker;
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    write_bytes(path, bad);
    EXPECT_THROW((void)load_map(path), BadInput) << marker;
    EXPECT_THROW(MapLayers{path}, BadInput) << marker;
    EXPECT_FALSE(check_map(path).problems.empty()) << marker;
  }
}

}  // namespace
}  // namespace roadbook
