#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "drive/writer.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/apps/shared_drives.hpp"

// An existing map contains a user's work. `map` names the content that it refuses to overwrite, and
// leaves the map unchanged.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Writes a drive of two images. Their content is irrelevant, because the command fails before it
// reads them.
void write_short_drive(const fs::path& folder) {
  constexpr std::int64_t kRecorded_ns = 1'400'000'000'000'000'000;
  DriveWriter writer(folder, test::fisheye_rig(), std::nullopt);
  for (int i = 0; i < 2; ++i)
    for (std::size_t c = 0; c < test::fisheye_rig().cameras.size(); ++c) {
      const auto& camera = test::fisheye_rig().cameras[c].camera;
      writer.write_image(c, kRecorded_ns + i * std::int64_t{80'000'000},
                         cv::Mat(camera.height, camera.width, CV_8U, cv::Scalar(90)));
    }
  writer.finish();
}

class MapVerb : public ::testing::Test {
 protected:
  MapVerb() {
    write_short_drive(folder_.path() / "drive");
    MapFileBuilder(map_, "lot").finish(test::lot_map({}), {});
  }
  void expect_refused(const std::string& line) const {
    const std::string before = test::read_text(map_);
    const auto result =
        test::run_command("roadbook map drive -m place.gpkg --replace -q", folder_.path());
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err.rfind(line, 0), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(test::read_text(map_) == before);
  }

  const test::ScratchFolder folder_;
  const fs::path map_ = folder_.path() / "place.gpkg";
};

TEST_F(MapVerb, LabelsOfOtherDrivesAreNotWrittenOver) {
  {
    LabelStore store(map_);
    const Map& map = store.map();
    Label label = label_of_box(map, {0, map.keyframes[8].t_ns, 1}, {{2.0, 5.5}, 1.57, 5.0, 2.5});
    label.kind = "parking_space";
    store.create(label, "ann");
    const Label deleted = store.create(label, "ann");
    store.remove(deleted.id, deleted.version, "ann");
  }
  expect_refused(
      "error: place.gpkg: labels: got 1 of drive lot, want these drives first, in this order "
      "(lot), or another map file (export and import keep the labels)");
}

TEST_F(MapVerb, ADamagedMapIsToldAndLeftAsItIs) {
  fs::resize_file(map_, fs::file_size(map_) / 2);
  expect_refused("error: place.gpkg: ");
  std::ofstream(map_) << "no map at all";
  expect_refused("error: place.gpkg: ");
}

TEST_F(MapVerb, AMapWhoseOwnDrivesAreNotAtHandIsNotBuiltAgain) {
  const std::string before = test::read_text(map_);
  const auto result =
      test::run_command("roadbook map drive -m place.gpkg --batch -q", folder_.path());
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("drive of session lot: got no such folder, want the drive"),
            std::string::npos)
      << result.err;
  EXPECT_TRUE(test::read_text(map_) == before);
}

void simulate_visit(int visit, const fs::path& folder) {
  const std::string number = std::to_string(visit);
  const auto made = test::simulate_drive(
      "zurich --size small --max-duration-s 6 --image-scale 0.5 --visit " + number,
      folder / ("visit" + number));
  ASSERT_EQ(made.status, 0) << made.err;
}

std::string digest_of_map(const std::string& arguments, const fs::path& folder) {
  const auto result = test::run_command("roadbook map " + arguments + " -q --json", folder);
  EXPECT_EQ(result.status, 0) << result.err;
  return nlohmann::json::parse(result.out).at("digest");
}

// Drives of three visits, the map of the first one and the map of the first two. They are made
// once, and each test may change its copies.
class MapOfFurtherDrives : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<test::ScratchFolder>();
    for (const int visit : {0, 1, 2}) simulate_visit(visit, made_->path());
    for (const char* arguments : {"visit0 -m place.gpkg", "visit0 visit1 -m all.gpkg"}) {
      const auto result =
          test::run_command(std::string("roadbook map ") + arguments + " -q --json", made_->path());
      ASSERT_EQ(result.status, 0) << result.err;
      built_ = nlohmann::json::parse(result.out);
    }
  }
  static void TearDownTestSuite() { made_.reset(); }

  void SetUp() override { fs::copy(made_->path(), folder_.path(), fs::copy_options::recursive); }

  static inline std::unique_ptr<test::ScratchFolder> made_;
  static inline nlohmann::json built_;  // the result of the map of two visits
  const test::ScratchFolder folder_;
};

TEST_F(MapOfFurtherDrives, OfABatchIsTheOneOfAllDrives) {
  const std::string all = built_.at("digest");
  EXPECT_NE(load_meta(folder_.path() / "place.gpkg").digest, all);
  fs::copy_file(folder_.path() / "place.gpkg", folder_.path() / "other_seed.gpkg");
  EXPECT_EQ(digest_of_map("visit1 -m place.gpkg --batch", folder_.path()), all);
  EXPECT_EQ(digest_of_map("visit0 visit1 -m place.gpkg", folder_.path()), all) << "built again";
  EXPECT_EQ(digest_of_map("visit1 -m place.gpkg --replace", folder_.path()),
            digest_of_map("visit1 -m one.gpkg", folder_.path()));
  // With another seed, the command builds the whole map with this seed and reports it.
  const auto seed =
      test::run_command("roadbook map visit1 -m other_seed.gpkg --batch --seed 5", folder_.path());
  EXPECT_EQ(seed.status, 0) << seed.err;
  EXPECT_NE(seed.err.find("options: got others than the map was made with"), std::string::npos)
      << seed.err;
  // The command refuses fewer drives than the map has, because they add none.
  const auto fewer = test::run_command("roadbook map visit0 -m all.gpkg -q", folder_.path());
  EXPECT_EQ(fewer.status, 2);
  EXPECT_NE(fewer.err.find("error: visit0: drive: got session visit0 of all.gpkg, want"),
            std::string::npos)
      << fewer.err;
}

// The recordings of earlier drives are gone, as in a car that keeps maps alone.
TEST_F(MapOfFurtherDrives, IsExtendedWithoutItsRecordings) {
  const auto run = [&](const std::string& arguments) {
    return test::run_command("roadbook map " + arguments + " -m place.gpkg -q --json",
                             folder_.path());
  };
  fs::copy_file(folder_.path() / "place.gpkg", folder_.path() / "before.gpkg");
  fs::rename(folder_.path() / "visit0", folder_.path() / "away");
  const auto both = run("visit1 visit2");
  ASSERT_EQ(both.status, 0) << both.err;
  const auto json = nlohmann::json::parse(both.out);
  EXPECT_EQ(json.at("sessions"), 3);
  EXPECT_GT(json.at("localised_share"), 0.9);
  // The same command again, and its last drive alone, have nothing to do.
  for (const char* again : {"visit1 visit2", "visit2"}) {
    const auto done = run(again);
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(nlohmann::json::parse(done.out).at("unchanged"), true) << again;
  }
  // A command that was stopped after its first drive continues with the second.
  fs::copy_file(folder_.path() / "before.gpkg", folder_.path() / "place.gpkg",
                fs::copy_options::overwrite_existing);
  ASSERT_EQ(run("visit1").status, 0);
  const auto rest = run("visit1 visit2");
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_EQ(nlohmann::json::parse(rest.out).at("digest"), json.at("digest"));
  EXPECT_EQ(test::run_command("roadbook check place.gpkg", folder_.path()).status, 0);

  const auto refused = [&](const std::string& arguments, int status, const std::string& line) {
    const std::string before = test::read_text(folder_.path() / "place.gpkg");
    const auto result = run(arguments);
    EXPECT_EQ(result.status, status) << arguments;
    EXPECT_NE(result.err.find(line), std::string::npos) << result.err;
    EXPECT_TRUE(test::read_text(folder_.path() / "place.gpkg") == before) << arguments;
  };
  refused("visit1", 2, "visit1: drive: got session visit1 of place.gpkg, want drives that the map");
  refused("visit2 --batch", 2, "drive of session visit0: got no such folder");
  refused("visit2 --adjust much", 1, "--adjust");
  refused("visit1 visit2 --as tuesday", 1, "--as: got tuesday, want a name for one drive");
  refused("visit2 --adjust all", 2, "added with other options, want a drive that the map lacks");
  refused("visit2 --adjust near --equal-rows", 1, "want --adjust all");
}

// Both visits are of one simulated place, so one alignment compares both with the truth.
TEST_F(MapOfFurtherDrives, IsComparedWithTheTruthOfAllTogether) {
  const auto json_of = [&](const std::string& arguments) {
    const auto result = test::run_command("roadbook " + arguments + " -q --json", folder_.path());
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const nlohmann::json& built = built_;
  EXPECT_LT(built.at("truth").at("ate_median_m"), 0.05);
  ASSERT_EQ(built.at("truth_sessions").size(), 2U);
  for (const auto& session : built.at("truth_sessions")) {
    EXPECT_LT(session.at("ate_median_m"), 0.05) << session;
    EXPECT_LT(session.at("offset").at("shift_m"), 0.05) << session;
    EXPECT_LT(std::abs(session.at("offset").at("heading_rad").get<double>()), 0.01) << session;
  }
  const auto again = json_of("map visit0 visit1 -m all.gpkg");
  EXPECT_EQ(again.at("truth_sessions"), built.at("truth_sessions"));
  const auto report = json_of("report -m all.gpkg -o report.html");
  EXPECT_EQ(report.at("truth_together").at("ate_median_m"), built.at("truth").at("ate_median_m"));
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_EQ(report.at("truth").at(s).at("offset"), built.at("truth_sessions").at(s).at("offset"));
  EXPECT_NE(test::read_text(folder_.path() / "report.html").find("One alignment of all sessions"),
            std::string::npos);

  // Recorded references have no common world: each drive has its own error, all together none.
  for (const std::string visit : {"visit0", "visit1"})
    fs::remove_all(folder_.path() / visit / "truth");
  const auto recorded = json_of("map visit0 visit1 -m recorded.gpkg");
  EXPECT_TRUE(recorded.at("truth").is_null()) << recorded.at("truth");
  for (const auto& session : recorded.at("truth_sessions")) {
    EXPECT_LT(session.at("ate_median_m"), 0.05) << session;
    EXPECT_TRUE(session.at("offset").is_null()) << session;
  }
}

// A finished map with an overhead image and with another program's table. It is made once, and each
// test may change its copy.
class MapGivenAgain : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<test::ScratchFolder>();
    simulate_visit(0, made_->path());
    for (const char* command : {"roadbook map visit0 -m place.gpkg -q",
                                "roadbook overhead -m place.gpkg --resolution-m 0.05 -q"}) {
      const auto result = test::run_command(command, made_->path());
      ASSERT_EQ(result.status, 0) << command << ": " << result.err;
    }
    MapUpdate update(made_->path() / "place.gpkg");
    update.write_table({"notes", {{"text", FieldType::kText}}, {{std::string("mine")}}});
    update.commit();
  }
  static void TearDownTestSuite() { made_.reset(); }

  void SetUp() override { fs::copy(made_->path(), folder_.path(), fs::copy_options::recursive); }

  nlohmann::json result_of(const std::string& arguments) {
    const auto result = test::run_command("roadbook " + arguments + " -q --json", folder_.path());
    EXPECT_EQ(result.status, 0) << arguments << ": " << result.err;
    err_ = result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }
  // Returns the command that makes a dropped layer again; empty if the result lists no such layer.
  static std::string command_for(const nlohmann::json& result, const std::string& name) {
    for (const auto& work : result.at("dropped"))
      if (work.at("name") == name)
        return work.at("command").is_null() ? "none" : std::string(work.at("command"));
    return {};
  }
  [[nodiscard]] bool has(const std::string& layer) const { return MapLayers(map_).has(layer); }

  static inline std::unique_ptr<test::ScratchFolder> made_;
  const test::ScratchFolder folder_;
  const fs::path map_ = folder_.path() / "place.gpkg";
  std::string err_;
};

TEST_F(MapGivenAgain, WithTheSameInputsIsLeftAsItIs) {
  const std::string before = test::read_text(map_);
  const auto first = test::run_command("roadbook map visit0 -m place.gpkg -q", folder_.path());
  EXPECT_EQ(first.status, 0);
  EXPECT_NE(first.out.find("nothing to do"), std::string::npos) << first.out << first.err;
  const auto again = result_of("map visit0 -m place.gpkg");
  EXPECT_TRUE(test::read_text(map_) == before);
  EXPECT_FALSE(fs::exists(folder_.path() / "place.gpkg.part"));
  EXPECT_EQ(again.at("unchanged"), true);
  EXPECT_TRUE(again.at("dropped").empty());
  EXPECT_EQ(again.at("digest"), load_meta(map_).digest);
  const auto fresh = result_of("map visit0 -m fresh.gpkg");
  EXPECT_EQ(fresh.at("unchanged"), false);
  for (const char* key :
       {"keyframes", "landmarks", "sessions", "loops", "reprojection_px", "scale", "truth"})
    EXPECT_EQ(again.at(key), fresh.at(key)) << key;
}

TEST_F(MapGivenAgain, WithFurtherDrivesNamesWhatItDropsAndHowItIsMadeAgain) {
  simulate_visit(1, folder_.path());
  const auto result = result_of("map visit1 -m place.gpkg");
  EXPECT_EQ(result.at("unchanged"), false);
  EXPECT_EQ(command_for(result, "overhead image"), "roadbook overhead -m place.gpkg");
  EXPECT_EQ(command_for(result, "layers of other programs"), "none");
  EXPECT_NE(err_.find("warning: place.gpkg: overhead image: got "), std::string::npos) << err_;
  EXPECT_NE(err_.find("`roadbook overhead -m place.gpkg`"), std::string::npos) << err_;
  EXPECT_FALSE(has("overhead"));
  EXPECT_FALSE(has("notes"));
  (void)result_of("overhead -m place.gpkg --resolution-m 0.05");
  EXPECT_TRUE(has("overhead"));
  // A map of one drive alone has other poses.
  EXPECT_EQ(command_for(result_of("map visit0 -m place.gpkg --replace"), "overhead image"),
            "roadbook overhead -m place.gpkg");
}

// The new build gives bit-identical poses, so layers made from the old poses remain valid.
TEST_F(MapGivenAgain, KeepsAllLayersWhereThePosesComeOutTheSame) {
  const auto result = result_of("map visit0 -m place.gpkg --replace");
  EXPECT_EQ(result.at("unchanged"), false);
  EXPECT_TRUE(result.at("dropped").empty()) << result.at("dropped");
  EXPECT_TRUE(has("overhead") && has("overhead_frames") && has("notes"));
  EXPECT_EQ(test::run_command("roadbook check place.gpkg", folder_.path()).status, 0);
}

// An unfinished build of other drives does not belong to this map, so the command keeps it.
TEST_F(MapGivenAgain, ABuildOfOtherDrivesStays) {
  { const MapFileBuilder waiting(map_, "other drives"); }
  EXPECT_EQ(result_of("map visit0 -m place.gpkg").at("unchanged"), true);
  EXPECT_TRUE(fs::exists(folder_.path() / "place.gpkg.part"));
}

TEST_F(MapGivenAgain, WithAnotherMaskOfTheOwnVehicleIsBuiltAgain) {
  const fs::path mask = folder_.path() / "visit0" / "cam0" / "mask.png";
  const auto hide_all_but = [&](char upper, char lower) {
    // The content decides the format: a PGM of 1 x 2 pixels, upper and lower half of the image.
    std::ofstream(mask, std::ios::binary) << "P5\n1 2\n255\n" << upper << lower;
  };
  hide_all_but('\xff', '\x00');
  const auto masked = result_of("map visit0 -m place.gpkg");
  EXPECT_EQ(masked.at("unchanged"), false);
  EXPECT_EQ(result_of("map visit0 -m place.gpkg").at("unchanged"), true);
  for (const std::string& faulty : {std::string("no image"), std::string("P5\n1 1\n255\n\0", 12),
                                    std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)}) {
    std::ofstream(mask, std::ios::binary) << faulty;
    const auto refused = test::run_command("roadbook map visit0 -m place.gpkg -q", folder_.path());
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("visit0/cam0/mask.png: mask: got "), std::string::npos)
        << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
  fs::remove(mask);
  EXPECT_EQ(result_of("map visit0 -m place.gpkg").at("unchanged"), false);
}

TEST_F(MapGivenAgain, LearnsWhereItsDrivesAreNow) {
  fs::rename(folder_.path() / "visit0", folder_.path() / "moved");
  EXPECT_EQ(test::run_command("roadbook overhead -m place.gpkg -q", folder_.path()).status, 2);
  EXPECT_EQ(result_of("map moved -m place.gpkg").at("unchanged"), true);
  EXPECT_EQ(load_map(map_).sessions.front().drive_path, "moved");
  (void)result_of("overhead -m place.gpkg --resolution-m 0.05");
}

}  // namespace
}  // namespace roadbook
