#include "mapping/store/map_file.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.hpp"
#include "mapping/store/file_digest.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_digest.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_seal.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;

void save(const std::filesystem::path& path, const Map& map) {
  MapFileBuilder(path, "key").finish(map, {{"seed", "7"}, {"place.host", "here"}});
}

// Compares bit for bit, because the file must restore the exact values.
void expect_equal(const Map& a, const Map& b) {
  ASSERT_EQ(a.sessions.size(), b.sessions.size());
  for (std::size_t i = 0; i < a.sessions.size(); ++i) {
    const Session& s = a.sessions[i];
    const Session& t = b.sessions[i];
    EXPECT_EQ(s.name, t.name);
    EXPECT_EQ(s.drive_path, t.drive_path);
    EXPECT_EQ(s.drive_digest, t.drive_digest);
    EXPECT_EQ(s.scale_source, t.scale_source);
    EXPECT_EQ(s.wheel_scale, t.wheel_scale);
    EXPECT_EQ(s.scale_sigma, t.scale_sigma);
    EXPECT_EQ(s.t_begin_ns, t.t_begin_ns);
    EXPECT_EQ(s.t_end_ns, t.t_end_ns);
    if (std::isnan(s.localised_share))
      EXPECT_TRUE(std::isnan(t.localised_share));
    else
      EXPECT_EQ(s.localised_share, t.localised_share);
    ASSERT_EQ(s.wheels.has_value(), t.wheels.has_value());
    if (s.wheels) {
      EXPECT_EQ(s.wheels->radius_left_m, t.wheels->radius_left_m);
      EXPECT_EQ(s.wheels->radius_right_m, t.wheels->radius_right_m);
      EXPECT_EQ(s.wheels->track_width_m, t.wheels->track_width_m);
      EXPECT_EQ(s.wheels->wheelbase_m, t.wheels->wheelbase_m);
      EXPECT_EQ(s.wheels->steering_ratio, t.wheels->steering_ratio);
      EXPECT_EQ(s.wheels->ticks_per_turn, t.wheels->ticks_per_turn);
      EXPECT_EQ(s.wheels->time_offset_s, t.wheels->time_offset_s);
      EXPECT_EQ(s.wheels->sigma_distance_per_sqrt_m, t.wheels->sigma_distance_per_sqrt_m);
      EXPECT_EQ(s.wheels->sigma_heading_per_sqrt_m, t.wheels->sigma_heading_per_sqrt_m);
      EXPECT_EQ(s.wheels->sigma_lateral_per_sqrt_m, t.wheels->sigma_lateral_per_sqrt_m);
      EXPECT_EQ(s.wheels->sigma_angle_rad, t.wheels->sigma_angle_rad);
    }
    EXPECT_EQ(s.vehicle, t.vehicle);
    EXPECT_EQ(s.vehicle_source, t.vehicle_source);
    ASSERT_EQ(s.rig.cameras.size(), t.rig.cameras.size());
    for (std::size_t c = 0; c < s.rig.cameras.size(); ++c) {
      EXPECT_EQ(s.rig.cameras[c].name, t.rig.cameras[c].name);
      EXPECT_EQ(s.rig.cameras[c].camera.model, t.rig.cameras[c].camera.model);
      EXPECT_EQ(s.rig.cameras[c].camera.parameters, t.rig.cameras[c].camera.parameters);
      EXPECT_EQ(s.rig.cameras[c].camera.height, t.rig.cameras[c].camera.height);
      EXPECT_EQ(s.rig.cameras[c].time_offset_s, t.rig.cameras[c].time_offset_s);
      EXPECT_EQ(s.rig.cameras[c].exposed_after_s, t.rig.cameras[c].exposed_after_s);
      EXPECT_EQ(s.rig.cameras[c].rolling_shutter_s, t.rig.cameras[c].rolling_shutter_s);
      EXPECT_EQ(s.rig.cameras[c].T_vehicle_camera.matrix(),
                t.rig.cameras[c].T_vehicle_camera.matrix());
    }
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) {
    EXPECT_EQ(a.keyframes[i].t_ns, b.keyframes[i].t_ns);
    EXPECT_EQ(a.keyframes[i].session, b.keyframes[i].session);
    EXPECT_EQ(a.keyframes[i].drive_frame, b.keyframes[i].drive_frame);
    EXPECT_EQ(a.keyframes[i].T_frame_vehicle.matrix(), b.keyframes[i].T_frame_vehicle.matrix());
    EXPECT_EQ(a.keyframes[i].covariance, b.keyframes[i].covariance);
    EXPECT_EQ(a.keyframes[i].travelled_m, b.keyframes[i].travelled_m);
    EXPECT_EQ(a.keyframes[i].reversing, b.keyframes[i].reversing);
    EXPECT_EQ(a.keyframes[i].after_gap, b.keyframes[i].after_gap);
    const auto& wheels = a.keyframes[i].wheels;
    ASSERT_EQ(wheels.has_value(), b.keyframes[i].wheels.has_value());
    if (wheels) {
      EXPECT_EQ(wheels->motion, b.keyframes[i].wheels->motion);
      EXPECT_EQ(wheels->covariance, b.keyframes[i].wheels->covariance);
      EXPECT_EQ(wheels->distance_m, b.keyframes[i].wheels->distance_m);
      EXPECT_EQ(wheels->reversing, b.keyframes[i].wheels->reversing);
    }
    const int k = static_cast<int>(i);
    EXPECT_EQ(a.T_map_vehicle(k).matrix(), b.T_map_vehicle(k).matrix());
  }
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t i = 0; i < a.landmarks.size(); ++i) {
    EXPECT_EQ(a.landmarks[i].map_frame, b.landmarks[i].map_frame);
    EXPECT_EQ(a.landmarks[i].p_frame, b.landmarks[i].p_frame);
    EXPECT_EQ(a.landmarks[i].covariance, b.landmarks[i].covariance);
    EXPECT_EQ(a.landmarks[i].descriptor, b.landmarks[i].descriptor);
    EXPECT_EQ(a.landmarks[i].ground, b.landmarks[i].ground);
  }
  ASSERT_EQ(a.observations.size(), b.observations.size());
  for (std::size_t i = 0; i < a.observations.size(); ++i) {
    EXPECT_EQ(a.observations[i].landmark, b.observations[i].landmark);
    EXPECT_EQ(a.observations[i].keyframe, b.observations[i].keyframe);
    EXPECT_EQ(a.observations[i].camera, b.observations[i].camera);
    EXPECT_EQ(a.observations[i].pixel, b.observations[i].pixel);
    EXPECT_EQ(a.observations[i].sigma_px, b.observations[i].sigma_px);
  }
  ASSERT_EQ(a.corners.size(), b.corners.size());
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    EXPECT_EQ(a.corners[i].keyframe, b.corners[i].keyframe);
    EXPECT_EQ(a.corners[i].camera, b.corners[i].camera);
    EXPECT_EQ(a.corners[i].pixel, b.corners[i].pixel);
    EXPECT_EQ(a.corners[i].descriptor, b.corners[i].descriptor);
  }
  ASSERT_EQ(a.landmark_sessions.size(), b.landmark_sessions.size());
  for (std::size_t i = 0; i < a.landmark_sessions.size(); ++i) {
    EXPECT_EQ(a.landmark_sessions[i].landmark, b.landmark_sessions[i].landmark);
    EXPECT_EQ(a.landmark_sessions[i].session, b.landmark_sessions[i].session);
    EXPECT_EQ(a.landmark_sessions[i].expected, b.landmark_sessions[i].expected);
    EXPECT_EQ(a.landmark_sessions[i].seen, b.landmark_sessions[i].seen);
    EXPECT_EQ(a.landmark_sessions[i].last_ns, b.landmark_sessions[i].last_ns);
  }
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) {
    EXPECT_EQ(a.loops[i].to, b.loops[i].to);
    EXPECT_EQ(a.loops[i].T_from_to.matrix(), b.loops[i].T_from_to.matrix());
    EXPECT_EQ(a.loops[i].information, b.loops[i].information);
    EXPECT_EQ(a.loops[i].accepted, b.loops[i].accepted);
    EXPECT_EQ(a.loops[i].weight, b.loops[i].weight);
    EXPECT_EQ(a.loops[i].reason, b.loops[i].reason);
  }
}

TEST(MapFile, ComesBackBitForBit) {
  const Folder folder;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Map map = small_map(seed);
    save(folder / "a.gpkg", map);
    expect_equal(map, load_map_with_corners(folder / "a.gpkg"));
    EXPECT_TRUE(load_map(folder / "a.gpkg").corners.empty());
    EXPECT_EQ(load_sessions(folder / "a.gpkg").back().drive_digest,
              map.sessions.back().drive_digest);
    const MapReport report = check_map(folder / "a.gpkg");
    EXPECT_TRUE(report.problems.empty()) << to_line(report.problems.front());
    EXPECT_EQ(report.rows.at("keyframes"), map.keyframes.size());
    EXPECT_EQ(report.rows.at("poses"), map.keyframes.size());
    EXPECT_EQ(report.digest, map_digest(folder / "a.gpkg"));
    EXPECT_EQ(report.digest, load_meta(folder / "a.gpkg").digest);
    std::filesystem::remove(folder / "a.gpkg");
  }
}

TEST(MapFile, OfAnEarlierProgramKnowsNothingOfTheVehicle) {
  const Folder folder;
  save(folder / "a.gpkg", small_map(1));
  SqlDatabase(folder / "a.gpkg", SqlMode::kReadWrite).run("DROP TABLE vehicles");
  seal_map_file(folder / "a.gpkg");
  const Map map = load_map(folder / "a.gpkg");
  ASSERT_FALSE(map.sessions.empty());
  EXPECT_TRUE(map.sessions.front().vehicle.is_empty());
  EXPECT_EQ(map.sessions.front().vehicle_source, VehicleSource::kNone);
}

// Gives a map file the tables of schema version 1, as the program of that version sealed it.
void make_version_one(const std::filesystem::path& path) {
  {
    const SqlDatabase database(path, SqlMode::kReadWrite);
    for (const char* table : {"keyframe_motions", "keyframe_corners", "landmark_sessions"})
      database.run(std::string("DROP TABLE ") + table);
    database.run("ALTER TABLE sessions DROP COLUMN localised_share");
    database.run("UPDATE map_meta SET value = '1' WHERE key = 'schema_version'");
    store_digests(database, compute_digests(database));
    reserve_file_digest(database);
  }
  write_file_digest(path);
}

TEST(MapFile, OfSchemaVersionOneIsReadAndMigratedByTheFirstChange) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  Map map = small_map(1);
  save(path, map);
  make_version_one(path);
  EXPECT_TRUE(check_map(path).problems.empty());
  EXPECT_EQ(load_meta(path).schema_version, 1);
  for (Keyframe& keyframe : map.keyframes) keyframe.wheels.reset();
  for (Session& session : map.sessions)
    session.localised_share = std::numeric_limits<double>::quiet_NaN();
  map.corners.clear();
  map.landmark_sessions.clear();
  expect_equal(map, load_map_with_corners(path));
  MapUpdate update(path);
  update.set_meta("note", "a change");
  update.commit();
  EXPECT_EQ(load_meta(path).schema_version, 2);
  EXPECT_TRUE(check_map(path).problems.empty());
  expect_equal(map, load_map_with_corners(path));
}

TEST(MapFile, AVehicleThatCannotBeIsRefused) {
  const Folder folder;
  save(folder / "a.gpkg", small_map(1));
  SqlDatabase(folder / "a.gpkg", SqlMode::kReadWrite).run("UPDATE vehicles SET length_m = -1.0");
  seal_map_file(folder / "a.gpkg");
  EXPECT_THROW((void)load_map(folder / "a.gpkg"), BadInput);
}

TEST(MapFile, AnEmptyMapIsAMap) {
  const Folder folder;
  save(folder / "a.gpkg", Map{});
  EXPECT_TRUE(load_map(folder / "a.gpkg").keyframes.empty());
}

TEST(MapFile, LeavesOneFileAndSaysComplete) {
  const Folder folder;
  save(folder / "a.gpkg", small_map(1));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.part"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.new"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg-journal"));
  const MapMeta meta = load_meta(folder / "a.gpkg");
  EXPECT_EQ(meta.state, "complete");
  EXPECT_EQ(meta.schema_version, 2);
  EXPECT_EQ(meta.values.at("seed"), "7");
}

TEST(MapFile, DigestIsOfTheContentAlone) {
  const Folder folder;
  Map map = small_map(1);
  save(folder / "a.gpkg", map);
  const std::string digest = map_digest(folder / "a.gpkg");
  // Another place on the disk, another page layout.
  map.sessions[0].drive_path = "/elsewhere/drive";
  save(folder / "b.gpkg", map);
  const SqlDatabase database(folder / "b.gpkg", SqlMode::kReadWrite);
  database.run("PRAGMA page_size = 1024; VACUUM");
  EXPECT_EQ(map_digest(folder / "b.gpkg"), digest);
  // One bit of one covariance.
  map.keyframes[3].covariance(2, 2) =
      std::nextafter(map.keyframes[3].covariance(2, 2), std::numeric_limits<double>::max());
  save(folder / "c.gpkg", map);
  EXPECT_NE(map_digest(folder / "c.gpkg"), digest);
}

TEST(MapFile, UnknownIsNullAndReadAsUnknown) {
  const Folder folder;
  Map map = small_map(1);
  map.keyframes[2].covariance = unknown_covariance<Matrix6d>();
  map.landmarks[4].covariance = unknown_covariance<Eigen::Matrix3d>();
  map.sessions[0].scale_sigma = std::numeric_limits<double>::quiet_NaN();
  save(folder / "a.gpkg", map);
  const SqlDatabase database(folder / "a.gpkg", SqlMode::kRead);
  EXPECT_EQ(database.value("SELECT id FROM keyframes WHERE covariance IS NULL"), "2");
  EXPECT_EQ(database.value("SELECT id FROM landmarks WHERE covariance IS NULL"), "4");
  EXPECT_EQ(database.value("SELECT id FROM sessions WHERE scale_sigma IS NULL"), "0");
  EXPECT_EQ(database.value("SELECT keyframe FROM poses WHERE sigma_m IS NULL"), "2");
  EXPECT_EQ(database.value("SELECT landmark FROM landmark_points WHERE sigma_m IS NULL"), "4");
  const Map read = load_map(folder / "a.gpkg");
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    EXPECT_EQ(is_known(read.keyframes[i].covariance), i != 2) << i;
  EXPECT_FALSE(is_known(read.landmarks[4].covariance));
  EXPECT_TRUE(std::isnan(read.sessions[0].scale_sigma));
  EXPECT_TRUE(check_map(folder / "a.gpkg").problems.empty());
}

// The tables of earlier programs, which wrote zero for unknown and did not allow NULL.
TEST(MapFile, ZerosOfEarlierProgramsAreUnknown) {
  const Folder folder;
  Map map = small_map(1);
  for (const std::size_t i : {0U, 3U}) map.keyframes[i].covariance.setZero();
  map.landmarks[1].covariance.setZero();
  save(folder / "a.gpkg", map);
  EXPECT_TRUE(is_known(load_map(folder / "a.gpkg").keyframes[3].covariance));  // exact today
  {
    const SqlDatabase database(folder / "a.gpkg", SqlMode::kReadWrite);
    database.run("ALTER TABLE keyframes RENAME TO before");
    database.run(
        "CREATE TABLE keyframes(id INTEGER PRIMARY KEY, session INTEGER NOT NULL, "
        "t_ns INTEGER NOT NULL, drive_frame INTEGER NOT NULL, map_frame INTEGER NOT NULL, "
        "T_frame_vehicle BLOB NOT NULL, covariance BLOB NOT NULL, travelled_m REAL NOT NULL, "
        "reversing INTEGER NOT NULL, after_gap INTEGER NOT NULL) STRICT");
    database.run(
        "INSERT INTO keyframes SELECT id, session, t_ns, drive_frame, map_frame, T_frame_vehicle, "
        "covariance, travelled_m, reversing, after_gap FROM before");
    database.run("DROP TABLE before");
  }
  seal_map_file(folder / "a.gpkg");
  const Map read = load_map(folder / "a.gpkg");
  EXPECT_EQ(read.keyframes[0].covariance, Matrix6d::Zero());  // the gauge of the others
  EXPECT_FALSE(is_known(read.keyframes[3].covariance));
  EXPECT_TRUE(is_known(read.keyframes[4].covariance));
  EXPECT_FALSE(is_known(read.landmarks[1].covariance));
}

TEST(MapFile, ContradictionsAreRefusedBeforeTheOldMapIsTouched) {
  const Folder folder;
  save(folder / "a.gpkg", small_map(1));
  const std::string digest = map_digest(folder / "a.gpkg");
  Map nan = small_map(2);
  nan.landmarks[3].p_frame.x() = std::numeric_limits<double>::quiet_NaN();
  Map stray = small_map(2);
  stray.observations[5].landmark = 4000;
  Map skewed = small_map(2);
  skewed.keyframes[1].T_frame_vehicle.linear()(0, 0) += 0.01;
  Map reversed = small_map(2);
  std::swap(reversed.keyframes[2].t_ns, reversed.keyframes[3].t_ns);
  for (const Map& bad : {nan, stray, skewed, reversed}) {
    EXPECT_THROW(save(folder / "a.gpkg", bad), Refused);
    EXPECT_EQ(map_digest(folder / "a.gpkg"), digest);
  }
}

void set_meta(const std::filesystem::path& path, const std::string& key, const std::string& value) {
  const SqlDatabase database(path, SqlMode::kReadWrite);
  database.prepare("UPDATE map_meta SET value = ? WHERE key = ?")
      .bind_text(1, value)
      .bind_text(2, key)
      .run();
}

std::string refusal(const std::filesystem::path& path) {
  try {
    (void)load_map(path);
  } catch (const BadInput& bad) {
    return bad.what();
  }
  return "not refused";
}

TEST(MapFile, OtherSchemasStatesAndFilesAreRefusedInPlainWords) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  EXPECT_NE(refusal(path).find("no such file"), std::string::npos);
  save(path, small_map(1));
  set_meta(path, "schema_version", "3");
  EXPECT_NE(refusal(path).find("schema_version: got 3, of a newer roadbook, want at most 2"),
            std::string::npos);
  set_meta(path, "schema_version", "0");
  EXPECT_NE(refusal(path).find("schema_version: got 0"), std::string::npos);
  set_meta(path, "schema_version", "2");
  set_meta(path, "state", "part");
  EXPECT_NE(refusal(path).find("state: got part, want complete"), std::string::npos);
  std::FILE* file = std::fopen((folder / "b.gpkg").c_str(), "w");
  ASSERT_NE(file, nullptr);
  std::fputs("no database at all", file);
  std::fclose(file);
  EXPECT_NE(refusal(folder / "b.gpkg").find("b.gpkg"), std::string::npos);
}

TEST(MapFile, AHalfDoneTransactionIsRolledBackBeforeReading) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  save(path, small_map(1));
  const std::string digest = map_digest(path);
  {
    // A writer is killed in the middle of a transaction; its file and its journal remain on the
    // disk.
    const SqlDatabase writer(path, SqlMode::kReadWrite);
    writer.run("PRAGMA cache_size = 1; PRAGMA cache_spill = 1; BEGIN");
    writer.run(
        "UPDATE landmarks SET x = 0; UPDATE keyframes SET travelled_m = 1; "
        "UPDATE observations SET data = zeroblob(160)");
    std::filesystem::copy_file(path, folder / "b.gpkg");
    std::filesystem::copy_file(folder / "a.gpkg-journal", folder / "b.gpkg-journal");
    writer.run("ROLLBACK");
  }
  EXPECT_EQ(map_digest(folder / "b.gpkg"), digest);
}

// 10,000 keyframes of 4 cameras and 100 observations each is 250 times this.
TEST(MapFile, SavesFastEnoughForLongDrives) {
  const Folder folder;
  const Map map = small_map(
      1, {.sessions = 1, .keyframes = 40, .cameras = 4, .observations = 100, .landmarks = 4000});
  const auto begin = std::chrono::steady_clock::now();
  save(folder / "a.gpkg", map);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  RecordProperty("seconds", std::to_string(taken.count()));
  EXPECT_EQ(load_map(folder / "a.gpkg").observations.size(), 16'000U);
}

}  // namespace
}  // namespace roadbook
