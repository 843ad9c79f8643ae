#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "apps/report/label_section.hpp"
#include "apps/report/page.hpp"
#include "exchange/layers/occupancy_layers.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

// A square of four keyframes, each with one landmark in front, which is seen 3 px off.
Map small_map() {
  Map map;
  Session session;
  session.name = "<first> & only";
  session.drive_path = "nowhere";
  session.drive_digest = "0";
  MountedCamera camera;
  camera.name = "cam0";
  camera.camera.model = CameraModel::kPinholeRadtan;
  camera.camera.parameters = {100.0, 100.0, 50.0, 50.0};
  camera.camera.width = camera.camera.height = 101;
  camera.T_vehicle_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  session.rig.cameras = {camera};
  session.t_end_ns = 4'000'000'000;
  map.sessions = {session};
  for (int i = 0; i < 4; ++i) {
    MapFrame frame;
    frame.T_map_frame = pose_from_planar(i % 2 == 0 ? 0.0 : 5.0, i < 2 ? 0.0 : 5.0, 0.0);
    map.map_frames.push_back(frame);
    Keyframe keyframe;
    keyframe.t_ns = std::int64_t{1'000'000'000} * (i + 1);
    keyframe.drive_frame = keyframe.map_frame = i;
    keyframe.travelled_m = 5.0 * i;
    keyframe.covariance.setZero();  // exact
    map.keyframes.push_back(keyframe);
    Landmark landmark;
    landmark.map_frame = i;
    landmark.p_frame = {2.0, 0.0, 0.0};
    landmark.covariance.setZero();
    map.landmarks.push_back(landmark);
    Observation observation;
    observation.landmark = observation.keyframe = i;
    observation.pixel = {53.0F, 50.0F};
    map.observations.push_back(observation);
  }
  LoopEdge loop;
  loop.from = 0;
  loop.to = 3;
  loop.reason = "too few <inliers>";
  map.loops = {loop};
  return map;
}

class Report : public ::testing::Test {
 protected:
  Report() {
    MapFileBuilder build(map_, "inputs");
    build.finish(small_map(), {{"place.summary",
                                R"({"stages":[{"name":"loops","seconds":1.5,"peak_rss_mb":12.0}],)"
                                R"("warnings":[{"severity":"warning","file":"cam0","line":3,)"
                                R"("field":"image","got":"none","want":"one"}]})"}});
  }
  test::ScratchFolder folder_;
  std::filesystem::path map_ = folder_.path() / "place.gpkg";
};

TEST_F(Report, MeasuresWhatTheMapSays) {
  const ReportData data = collect_report(map_);
  // The landmark lies on the axis: pixel (50, 50); it was seen at (53, 50).
  ASSERT_EQ(data.quality.residuals_px.size(), 4U);
  for (const float residual : data.quality.residuals_px) EXPECT_NEAR(residual, 3.0, 1e-5);
  EXPECT_EQ(data.quality.observations_of_keyframe, (std::vector<int>{1, 1, 1, 1}));
  EXPECT_EQ(data.quality.views_of_landmark, (std::vector<int>{1, 1, 1, 1}));
  ASSERT_EQ(data.stages.size(), 1U);
  EXPECT_EQ(data.stages[0].seconds, 1.5);
  EXPECT_EQ(data.warnings, std::vector<std::string>{"warning: cam0:3: image: got none, want one"});
  EXPECT_TRUE(data.truth.sessions.empty());
  EXPECT_EQ(data.truth.without_truth.size(), 1U);
}

TEST_F(Report, DoesNotTakeThePlaceOfTheMapOrOfADevice) {
  const std::string before = test::read_text(map_);
  const auto onto_map =
      test::run_command("roadbook report -m place.gpkg -o ./place.gpkg", folder_.path());
  EXPECT_EQ(onto_map.status, 1);
  EXPECT_EQ(onto_map.err, "error: --output: got ./place.gpkg, the map itself, want another file\n");
  EXPECT_EQ(test::read_text(map_), before);
  const auto onto_pipe = test::run_command(
      "mkfifo pipe; cat pipe > page & roadbook report -m place.gpkg -o pipe; wait; test -p pipe",
      folder_.path());
  EXPECT_EQ(onto_pipe.status, 0) << onto_pipe.err;
  EXPECT_NE(test::read_text(folder_.path() / "page").find("</html>"), std::string::npos);
}

TEST_F(Report, IsOnePageThatNeedsNothingElse) {
  const std::string page = report_page(collect_report(map_));
  const std::regex reference("(src|href|url|@import)\\s*[=(]\\s*[\"']?([^\"')]*)");
  for (auto it = std::sregex_iterator(page.begin(), page.end(), reference);
       it != std::sregex_iterator(); ++it) {
    const std::string target = (*it)[2];
    EXPECT_TRUE(target.rfind("data:", 0) == 0 || target.rfind('#', 0) == 0) << target.substr(0, 60);
  }
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_LT(page.size(), 500'000U);
}

TEST_F(Report, ClosesEveryTagItOpens) {
  const std::string page = report_page(collect_report(map_));
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-zA-Z][a-zA-Z0-9]*)[^>]*?(/?)>");
  for (auto it = std::sregex_iterator(page.begin(), page.end(), tag); it != std::sregex_iterator();
       ++it) {
    const std::string name = (*it)[2];
    if ((*it)[3].length() > 0 || name == "meta") continue;
    if ((*it)[1].length() == 0) {
      open.push_back(name);
    } else {
      ASSERT_FALSE(open.empty()) << name;
      EXPECT_EQ(open.back(), name);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
}

// Writes a grid of two cells, stored relative to the first keyframe. The map has no truth.
void write_two_cells(const std::filesystem::path& map) {
  StoredOccupancy stored;
  stored.prior = 0.3;  // the cell without a change of its log odds is undecided
  OccupancyDrive drive;
  drive.drive = "<drive>";
  drive.digest = "0";
  drive.sensor = "cameras";
  drive.model = "fitted";
  drive.scans = 4;
  drive.updates = 10;
  stored.drives = {drive};
  OccupancyPatch patch;
  patch.session = "<first> & only";
  patch.t_ns = 1'000'000'000;
  patch.drive = drive.drive;
  patch.columns = 2;
  patch.rows = 1;
  patch.log_odds = {-8000, 0};
  patch.seen = {30, 2};
  patch.hits = {2, 0};
  stored.patches = {patch};
  const OccupancyGrid grid = place_patches(
      stored.patches, [](const std::string&, std::int64_t) { return std::optional(PlanePose{}); },
      {});
  MapUpdate update(map);
  write_occupancy_layers(update, stored, grid);
  update.commit();
}

// Each landmark of the map is seen once.
TEST_F(Report, LandmarksSeenInOneImageHaveABarOfTheirHistogram) {
  const std::string page = report_page(collect_report(map_));
  const std::size_t name = page.find("images that see a landmark");
  ASSERT_NE(name, std::string::npos);
  const std::size_t begin = page.rfind("<svg", name);
  const std::string svg = page.substr(begin, page.find("</svg>", name) - begin);
  const std::regex bar("<rect class=\"bar\"[^>]*height=\"([0-9.]+)\"");
  std::vector<double> heights;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), bar); it != std::sregex_iterator();
       ++it)
    heights.push_back(std::stod((*it)[1]));
  ASSERT_EQ(heights.size(), 10U);
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_EQ(heights[i] > 0.0, i == 1) << i;
}

TEST_F(Report, ScoresTheGridAgainstTheSevenDemands) {
  EXPECT_EQ(report_page(collect_report(map_)).find("Free space"), std::string::npos);
  write_two_cells(map_);
  const ReportData data = collect_report(map_);
  ASSERT_TRUE(data.occupancy);
  EXPECT_EQ(data.occupancy->figures.cells, 2U);
  EXPECT_EQ(data.occupancy->free_share(), 0.5);
  EXPECT_EQ(data.occupancy->figures.vanished_share, 1.0);
  EXPECT_EQ(data.occupancy->updates_a_scan(), 2.5);
  EXPECT_EQ(data.occupancy->driven.seen, 2U);
  EXPECT_FALSE(data.occupancy->truth);
  const std::string page = report_page(data);
  for (const char* demand :
       {"1 complete", "2 compact", "3 real time", "4 suppresses detail", "5 free space",
        "6 moving things", "7 uncertainty", "unknown: no true surfaces", "&lt;drive&gt;"})
    EXPECT_NE(page.find(demand), std::string::npos) << demand;
}

TEST_F(Report, ShowsNamesFromOutsideAsText) {
  const std::string page = report_page(collect_report(map_));
  EXPECT_NE(page.find("&lt;first&gt; &amp; only"), std::string::npos);
  EXPECT_NE(page.find("too few &lt;inliers&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<first>"), std::string::npos);
}

TEST_F(Report, OfTheSameMapIsTheSameBytes) {
  EXPECT_EQ(report_page(collect_report(map_)), report_page(collect_report(map_)));
}

TEST_F(Report, TheVerbWritesThePageAndOneJsonObject) {
  const auto result =
      test::run_command("roadbook report -m place.gpkg -o r.html --json", folder_.path());
  EXPECT_EQ(result.status, 0) << result.err;
  const auto object = nlohmann::json::parse(result.out);
  EXPECT_EQ(object.at("keyframes"), 4);
  EXPECT_EQ(object.at("loops"), 1);
  EXPECT_EQ(test::read_text(folder_.path() / "r.html"), report_page(collect_report(map_)));
}

TEST_F(Report, CannotBeWrittenWhereThereIsNoFolder) {
  const auto result =
      test::run_command("roadbook report -m place.gpkg -o none/r.html", folder_.path());
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_EQ(result.err.rfind("error: none/r.html", 0), 0U) << result.err;
}

TEST(LabelSection, CountsTheLabelsThatWereLookedForByWhatWasFound) {
  LabelReport report;
  report.shifts.shifts.resize(1);
  report.outlines.resize(1);
  report.outlines_before.resize(1);
  for (const auto& [status, count] : {std::pair{EvidenceStatus::kFound, 4},
                                      {EvidenceStatus::kGone, 1},
                                      {EvidenceStatus::kCovered, 2},
                                      {EvidenceStatus::kUnseen, 3}})
    for (int i = 0; i < count; ++i) {
      LabelEvidence& one = report.evidence.emplace_back();
      one.id = static_cast<std::int64_t>(report.evidence.size());
      one.status = status;
    }
  const std::string html = label_section(report, {});
  EXPECT_NE(html.find("4 found, 1 gone, 2 covered, 0 without paint, 3 in no image."),
            std::string::npos);
  EXPECT_NE(html.find("The paint of these labels is gone, a person should look: 5."),
            std::string::npos);
}

}  // namespace
}  // namespace roadbook
