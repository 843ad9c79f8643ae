#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_codec.hpp"
#include "mapping/store/map_file_seal.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "tests/mapping/store/file_bytes.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::read_bytes;
using test::small_map;
using test::write_bytes;

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

// All bytes count, room between rows and the inside of R-trees included. The only exceptions are
// twelve bytes of SQLite's header that a reader of the file may change. ROADBOOK_DAMAGES sets the
// number of changes, ROADBOOK_DAMAGED_MAP the map.
TEST(MapDamage, EveryChangedByteIsFound) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  const char* const number = std::getenv("ROADBOOK_DAMAGES");
  const char* const map = std::getenv("ROADBOOK_DAMAGED_MAP");
  MapFileBuilder(path, "key").finish(small_map(5), {});
  const std::string good = read_bytes(map == nullptr ? path : std::filesystem::path(map));
  Random random(11, "changed bytes");
  const int changes = number == nullptr ? 100 : std::atoi(number);
  for (int i = 0; i < changes; ++i) {
    const std::size_t at = 100 + random.below(good.size() - 100);
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ static_cast<char>(1 + random.below(255)));
    write_bytes(path, bad);
    EXPECT_FALSE(check_map(path).problems.empty()) << at;
  }
}

TEST(MapDamage, EveryChangedByteOfAnRtreeIsFound) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(5, {.landmarks = 400}), {});
  const std::string good = read_bytes(path);
  std::size_t found = 0;
  std::vector<std::string> nodes;
  {
    const SqlDatabase database(path, SqlMode::kRead);
    SqlStatement rows = database.prepare("SELECT data FROM rtree_landmark_points_geom_node");
    while (rows.step()) nodes.push_back(rows.text(0));
  }
  ASSERT_GT(nodes.size(), 3U);  // a root with inner bounds, not one leaf
  Random random(7, "rtree");
  constexpr int kChanges = 60;
  for (int i = 0; i < kChanges; ++i) {
    // A node of this size spills over pages: its first part is looked for.
    const std::string node = nodes[random.below(nodes.size())].substr(0, 60);
    const std::size_t at = good.find(node);
    if (at == std::string::npos) continue;
    std::string bad = good;
    const std::size_t byte = at + random.below(node.size());
    bad[byte] = static_cast<char>(bad[byte] ^ static_cast<char>(1 + random.below(255)));
    write_bytes(path, bad);
    EXPECT_FALSE(check_map(path).problems.empty()) << byte;
    ++found;
  }
  EXPECT_EQ(found, kChanges);
}

// A program may change an R-tree and compute all digests again.
TEST(MapDamage, AnRtreeWithOtherBoundsThanItsFeaturesIsFound) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  const auto problem_after = [&](const std::string& sql) {
    std::filesystem::remove(path);
    MapFileBuilder(path, "key").finish(small_map(5), {});
    SqlDatabase(path, SqlMode::kReadWrite).run(sql);
    seal_map_file(path);
    const auto problems = check_map(path).problems;
    return problems.empty() ? std::string() : problems.front().field + " " + problems.front().got;
  };
  const std::string tree = "rtree_landmark_points_geom";
  EXPECT_EQ(problem_after("SELECT 1"), "");
  EXPECT_EQ(problem_after("UPDATE " + tree + " SET maxx = maxx + 0.5 WHERE id = 3"),
            tree + " other bounds than feature 3");
  EXPECT_EQ(problem_after("DELETE FROM " + tree + " WHERE id = 3"),
            tree + " no entry of feature 3");
  EXPECT_EQ(problem_after("INSERT INTO " + tree + " VALUES(9999, 0, 1, 0, 1)"),
            tree + " entries of no feature");
}

// A view without end in the place of a table, and a trigger without end, with digests that fit.
TEST(MapDamage, ForeignViewsAndTriggersAreRefusedAtOnce) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  const std::string endless =
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*) FROM n";
  for (const std::string& sql :
       {"CREATE VIEW extra AS " + endless,
        "DROP TABLE landmarks; CREATE VIEW landmarks AS " + endless,
        "CREATE TRIGGER rtree_poses_geom_update9 AFTER UPDATE ON poses BEGIN INSERT INTO audit "
        "SELECT 1, 'a', 'b' FROM (" +
            endless + "); END",
        std::string("CREATE TRIGGER mine AFTER INSERT ON audit BEGIN DELETE FROM audit; END")}) {
    std::filesystem::remove(path);
    MapFileBuilder(path, "key").finish(small_map(5), {});
    SqlDatabase(path, SqlMode::kReadWrite).run(sql);
    const MapReport report = check_map(path);
    ASSERT_EQ(report.problems.size(), 1U) << sql;
    EXPECT_EQ(report.problems.front().field, "schema") << sql;
    EXPECT_THROW((void)load_map(path), BadInput) << sql;
    EXPECT_THROW(MapUpdate{path}, BadInput) << sql;
  }
}

TEST(MapDamage, AQueryWithoutEndIsBadInput) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(small_map(5), {});
  const SqlDatabase database(folder / "a.gpkg", SqlMode::kRead);
  EXPECT_THROW(
      (void)database.value("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
                           "SELECT count(*) FROM n"),
      BadInput);
  EXPECT_EQ(database.value("SELECT count(*) FROM sessions"),
            "2");  // each statement has its own limit
}

TEST(MapDamage, ACheckEndsAtTheFirstWrongDigest) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(5), {});
  SqlDatabase(path, SqlMode::kReadWrite)
      .run("UPDATE keyframes SET t_ns = 1; UPDATE landmarks SET x = 7.0");
  const MapReport report = check_map(path);
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems.front().field, "digest.keyframes");
  EXPECT_EQ(report.digest, "");
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

// A query of the speeds need not read images and landmarks. What it reads must be what was stored,
// and so must the tables and digests that say what that is.
TEST(MapDamage, AReaderOfALayerIsStoppedByDamageInItAndNotElsewhere) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(5), {{"note", "a marker in the meta table"}});
  const std::string good = read_bytes(path);
  const VectorLayer poses = MapLayers(path).read_layer("poses");
  const auto field_refused = [&]() -> std::string {
    EXPECT_THROW(MapLayers{path}, BadInput);
    try {
      const MapLayers layers(path, VerifiedPart::kWhatIsRead);
      EXPECT_EQ(layers.read_layer("poses").features.size(), poses.features.size());
    } catch (const BadInput& error) {
      return error.problems().front().field;
    }
    return "";
  };
  const auto refusal = [&](const std::string& sql) {
    write_bytes(path, good);
    SqlDatabase(path, SqlMode::kReadWrite).run(sql);
    return field_refused();
  };
  EXPECT_EQ(refusal("UPDATE landmarks SET x = 7.0"), "");
  EXPECT_EQ(refusal("UPDATE gpkg_contents SET description = 'mine'"), "digest.gpkg_contents");
  EXPECT_EQ(refusal("UPDATE map_meta SET value = 'mine' WHERE key = 'note'"), "digest");
  EXPECT_EQ(refusal("UPDATE map_meta SET value = 'mine' WHERE key = 'digest.landmarks'"), "digest");
  EXPECT_EQ(refusal("CREATE TABLE mine(x)"), "schema_digest");
  // The last bit of a number, as SQLite stores it.
  std::string number;
  pack(number, std::get<double>(poses.features[3].values[poses.field("heading_rad").value()]));
  std::reverse(number.begin(), number.end());
  std::string bad = good;
  ASSERT_NE(good.find(number), std::string::npos);
  bad[good.find(number) + 7] = static_cast<char>(bad[good.find(number) + 7] ^ 1);
  write_bytes(path, bad);
  EXPECT_EQ(field_refused(), "digest.poses");
}

// Bytes anywhere: the layer is the one that was stored, or the result is one error line.
TEST(MapDamage, OfALayerThatIsReadIsFoundWhereverItIs) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(5), {});
  const std::string good = read_bytes(path);
  const auto text_of = [&] {
    std::string text;
    for (const Feature& f :
         MapLayers(path, VerifiedPart::kWhatIsRead).read_layer("poses").features) {
      text.append(reinterpret_cast<const char*>(f.points.front().data()), 32);
      for (const FieldValue& value : f.values)
        if (const auto* number = std::get_if<double>(&value)) text += std::to_string(*number);
    }
    return text;
  };
  const std::string content = text_of();
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, "damage of a layer");
    write_bytes(path, damaged(good, random));
    try {
      EXPECT_EQ(text_of(), content) << seed;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_LT(refused, 300);
}

}  // namespace
}  // namespace roadbook
