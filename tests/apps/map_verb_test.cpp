#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "drive/writer.hpp"
#include "mapping/map_build.hpp"
#include "semantics/label_store.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/label_page/lot.hpp"

// A map that is there is somebody's work: `map` says what it will not write over, and leaves it.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Two images; what it shows does not matter, as it is not come to that.
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
    MapBuild(map_, "lot").finish(test::lot_map({}), {});
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
      "(lot), or another file for the map");
}

TEST_F(MapVerb, ADamagedMapIsToldAndLeftAsItIs) {
  fs::resize_file(map_, fs::file_size(map_) / 2);
  expect_refused("error: place.gpkg: ");
  std::ofstream(map_) << "no map at all";
  expect_refused("error: place.gpkg: ");
}

TEST_F(MapVerb, AMapWhoseOwnDrivesAreNotAtHandIsNotExtended) {
  const std::string before = test::read_text(map_);
  const auto result = test::run_command("roadbook map drive -m place.gpkg -q", folder_.path());
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("drive of session lot: got no such folder, want the drive"),
            std::string::npos)
      << result.err;
  EXPECT_TRUE(test::read_text(map_) == before);
}

std::string digest_of_map(const std::string& arguments, const fs::path& folder) {
  const auto result = test::run_command("roadbook map " + arguments + " -q --json", folder);
  EXPECT_EQ(result.status, 0) << result.err;
  return nlohmann::json::parse(result.out).at("digest");
}

TEST(MapOfFurtherDrives, IsTheOneOfAllDrives) {
  const test::ScratchFolder folder;
  for (const char* visit : {"0", "1"})
    ASSERT_EQ(
        test::run_command(std::string("roadbook simulate zurich --size small --visit ") + visit +
                              " --max-duration-s 6 --image-scale 0.5 -q -o visit" + visit,
                          folder.path())
            .status,
        0);
  const std::string all = digest_of_map("visit0 visit1 -m all.gpkg", folder.path());
  EXPECT_NE(digest_of_map("visit0 -m place.gpkg", folder.path()), all);
  fs::copy_file(folder.path() / "place.gpkg", folder.path() / "other_seed.gpkg");
  EXPECT_EQ(digest_of_map("visit1 -m place.gpkg", folder.path()), all);
  EXPECT_EQ(digest_of_map("visit0 visit1 -m place.gpkg", folder.path()), all) << "built again";
  EXPECT_EQ(digest_of_map("visit1 -m place.gpkg --replace", folder.path()),
            digest_of_map("visit1 -m one.gpkg", folder.path()));
  // With another seed all is of that seed, and that is said.
  const auto seed =
      test::run_command("roadbook map visit1 -m other_seed.gpkg --seed 5", folder.path());
  EXPECT_EQ(seed.status, 0) << seed.err;
  EXPECT_NE(seed.err.find("options: got others than the map was made with"), std::string::npos)
      << seed.err;
  // Fewer drives than the map has are no further ones.
  const auto fewer = test::run_command("roadbook map visit0 -m all.gpkg -q", folder.path());
  EXPECT_EQ(fewer.status, 2);
  EXPECT_NE(fewer.err.find("sessions: got a map of visit0, visit1, want"), std::string::npos)
      << fewer.err;
}

}  // namespace
}  // namespace roadbook
