#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/text_file.hpp"
#include "drive/drive.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "sim/simulate.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/workflows/thrown_problem.hpp"
#include "workflows/occupancy/beam_model_file.hpp"
#include "workflows/occupancy/make_occupancy.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::thrown_problem;

// A simulated drive with a range scanner and without images, and a map with its true poses.
struct ScannedPlace {
  Folder folder;
  fs::path drive = folder / "drive";
  fs::path map = folder / "place.gpkg";

  explicit ScannedPlace(double mapped_s = 8.0) {
    ScenarioOptions small;
    small.size = "small";
    SimulateOptions simulation;
    simulation.images = false;
    simulation.ranges = true;
    simulation.max_duration_s = 8.0;
    simulation.effects = {{"range0.short", 0.05}, {"range0.maximum", 0.03}};
    simulate(load_scenario("zurich", small), drive, simulation);
    write_map(mapped_s);
  }
  void write_map(double mapped_s) const {
    const Drive recorded = Drive::open(drive);
    Map content;
    Session session;
    session.name = "drive";
    session.drive_path = "drive";
    session.drive_digest = recorded.digest();
    content.sessions.push_back(session);
    const auto truth = recorded.truth();
    for (const TimedPose& pose : truth) {
      if (1e-9 * static_cast<double>(pose.t_ns - truth.front().t_ns) > mapped_s) break;
      Keyframe keyframe;
      keyframe.t_ns = pose.t_ns;
      keyframe.drive_frame = static_cast<int>(content.keyframes.size());
      keyframe.map_frame = static_cast<int>(content.map_frames.size());
      content.map_frames.push_back({pose.T_world_vehicle});
      content.keyframes.push_back(keyframe);
      content.sessions[0].t_end_ns = pose.t_ns;
    }
    content.sessions[0].t_begin_ns = truth.front().t_ns;
    MapFileBuilder(map, "key").finish(content, {});
  }
  [[nodiscard]] OccupancyRequest request() const {
    OccupancyRequest request;
    request.drives = {drive};
    request.map = map;
    return request;
  }
  [[nodiscard]] fs::path table() const { return drive / "range0" / "data.csv"; }
};

constexpr int kLastOfFirstScan = 42;  // line of beam 40; the header is line 1

// Replaces beam and range of that line. Beams of one stamp must ascend, so that only the last may
// have a larger number.
void write_reading(const fs::path& table, const std::string& beam, const std::string& range) {
  std::string text = read_regular_file(table, "a table");
  std::size_t line = 0;
  for (int i = 1; i < kLastOfFirstScan; ++i) line = text.find('\n', line) + 1;
  const auto stamp_end = text.find(',', line);
  const auto end = text.find('\n', line);
  text.replace(stamp_end, end - stamp_end, "," + beam + "," + range);
  std::ofstream(table, std::ios::binary) << text;
}

TEST(MakeOccupancy, AGridOfASimulatedDriveAgreesWithItsTruth) {
  const ScannedPlace place;
  NoMessages messages;
  const OccupancyResult result = make_occupancy(place.request(), messages);
  ASSERT_EQ(result.drives.size(), 1U);
  const OccupancyOfDrive& drive = result.drives[0];
  EXPECT_EQ(drive.drive.scans, 81);
  EXPECT_FALSE(drive.drive.localised);
  EXPECT_EQ(drive.without_pose, 0U);
  EXPECT_NEAR(drive.drive.mixture.share[kMaximum], 0.03, 0.02);
  EXPECT_GT(drive.drive.temper, 0.0);
  EXPECT_LE(drive.drive.temper, 1.0);
  ASSERT_TRUE(result.demands.truth);
  EXPECT_LT(result.demands.truth->calibration_error, 0.03);
  EXPECT_GT(result.demands.truth->free_recall, 0.95);
  EXPECT_LT(result.demands.truth->occupied_called_free, 0.005);
  EXPECT_GT(result.demands.truth->occupied_recall, 0.85);
  const auto read = read_occupancy_layers(MapLayers(place.map));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->patches.size(), drive.patches);
}

TEST(MakeOccupancy, IsTheSameOnAnyNumberOfThreadsAndWhenRepeated) {
  const ScannedPlace place;
  NoMessages messages;
  OccupancyRequest request = place.request();
  request.num_threads = 1;
  (void)make_occupancy(request, messages);
  const std::string once = load_meta(place.map).table_digests.at("occupancy_patches");
  request.num_threads = 3;
  const OccupancyResult again = make_occupancy(request, messages);
  EXPECT_EQ(load_meta(place.map).table_digests.at("occupancy_patches"), once);
  // The same drive again replaces its readings.
  EXPECT_EQ(again.stored.drives.size(), 1U);
  // Placed again without a drive: nothing moves.
  request.drives.clear();
  const OccupancyResult placed = make_occupancy(request, messages);
  EXPECT_EQ(placed.grid.moved, 0U);
  EXPECT_EQ(placed.grid.change, again.grid.change);
}

TEST(MakeOccupancy, BadReadingsAreNamedWithFileAndLine) {
  const ScannedPlace place;
  NoMessages messages;
  const std::string good = read_regular_file(place.table(), "a table");
  const auto problem_of = [&](const std::string& beam, const std::string& range) {
    write_reading(place.table(), beam, range);
    const Problem problem = thrown_problem([&] {
      place.write_map(8.0);  // the drive has another digest now
      (void)make_occupancy(place.request(), messages);
    });
    std::ofstream(place.table(), std::ios::binary) << good;
    return problem;
  };
  const Problem far = problem_of("40", "10.5");
  EXPECT_EQ(far.file, place.table().string());
  EXPECT_EQ(far.line, kLastOfFirstScan);
  EXPECT_EQ(far.field, "range");
  EXPECT_NE(far.want.find("10.000"), std::string::npos);
  const Problem beam = problem_of("41", "5.0");
  EXPECT_EQ(beam.field, "beam");
  EXPECT_EQ(beam.line, kLastOfFirstScan);
  EXPECT_EQ(problem_of("40", "nan").line, kLastOfFirstScan);
}

TEST(MakeOccupancy, RefusesWhatItCannotMap) {
  const ScannedPlace place(5.0);  // the map ends after five of eight seconds
  NoMessages messages;
  EXPECT_THROW((void)make_occupancy(place.request(), messages), Refused);
  OccupancyRequest none = place.request();
  none.drives.clear();
  EXPECT_THROW((void)make_occupancy(none, messages), Refused);
  place.write_map(8.0);
  (void)make_occupancy(place.request(), messages);
  OccupancyRequest other = place.request();
  other.cell_m = 0.2;
  EXPECT_EQ(thrown_problem([&] { (void)make_occupancy(other, messages); }).field, "--cell-m");
  other.replace = true;
  EXPECT_EQ(make_occupancy(other, messages).stored.cell_m, 0.2);
  OccupancyRequest naive = other;
  naive.replace = false;
  naive.update = OccupancyUpdate::kNaive;
  EXPECT_EQ(thrown_problem([&] { (void)make_occupancy(naive, messages); }).field, "--update");
  fs::remove_all(place.drive / "range0");
  place.write_map(8.0);
  EXPECT_EQ(thrown_problem([&] { (void)make_occupancy(place.request(), messages); }).field,
            "range0");
}

TEST(OccupancyScore, CountsCellsAsWorkedByHand) {
  OccupancyGrid grid;
  grid.shape = CellShape{{0.0, 0.0}, 1.0, 4, 1};
  grid.change = {-4.0F, 4.0F, -4.0F, 0.0F};
  grid.seen = {5, 5, 5, 0};
  grid.hits = {0, 5, 2, 0};
  grid.effective = {9.0F, 9.0F, 9.0F, 0.0F};
  const TrueCells truth =
      true_cells(grid.shape, {{{1.2, 0.3}, {1.8, 0.3}}, {{2.5, 0.1}, {2.5, 0.9}}});
  EXPECT_EQ(truth.occupied, (std::vector<std::uint8_t>{0, 1, 1, 0}));
  const OccupancyTruth score = score_occupancy(grid, 0.0, truth);
  EXPECT_EQ(score.free_recall, 1.0);
  EXPECT_EQ(score.occupied_recall, 1.0);  // the third cell has an occupied neighbour
  EXPECT_EQ(score.occupied_called_free, 0.0);
  const double p = 1.0 / (1.0 + std::exp(4.0));
  // Two cells of p: one of them occupied; one cell of 1 - p: occupied.
  EXPECT_NEAR(score.calibration_error, (2.0 * (0.5 - p) + p) / 3.0, 1e-6);
}

// Two of three free cells had echoes at least twice: something moved away.
TEST(OccupancyScore, FreeCellsWithEchoesAreCountedAsMovingThings) {
  OccupancyGrid grid;
  grid.shape = CellShape{{0.0, 0.0}, 1.0, 5, 1};
  grid.change = {-9.0F, 9.0F, -9.0F, -9.0F, 0.0F};
  grid.seen = {5, 5, 9, 9, 0};
  grid.hits = {1, 5, 2, 3, 0};
  grid.effective = {9.0F, 9.0F, 9.0F, 9.0F, 0.0F};
  const OccupancyFigures figures = occupancy_figures({}, grid);
  EXPECT_EQ(figures.cells, 4U);
  EXPECT_EQ(figures.free, 3U);
  EXPECT_EQ(figures.occupied, 1U);
  EXPECT_DOUBLE_EQ(figures.vanished_share, 2.0 / 3.0);
}

TEST(BeamModelFile, ReadsWhatItWritesAndRefusesSharesAboveOne) {
  const Folder folder;
  const RangeMixture m = mixture_of({0.1, 0.05, 0.02, 0.7}, 0.04);
  std::ofstream(folder / "beams.yaml") << beam_model_text(m);
  const RangeMixture read = read_beam_model(folder / "beams.yaml");
  EXPECT_EQ(read.share, m.share);
  EXPECT_EQ(read.sigma_m, 0.04);
  std::ofstream(folder / "beams.yaml") << "short: 0.5\nmaximum: 0.4\ncrosstalk: 0.2\n";
  const Problem sum = thrown_problem([&] { (void)read_beam_model(folder / "beams.yaml"); });
  EXPECT_EQ(sum.line, 1);
  std::ofstream(folder / "beams.yaml") << "shorts: 0.5\n";
  EXPECT_NE(
      thrown_problem([&] { (void)read_beam_model(folder / "beams.yaml"); }).want.find("short"),
      std::string::npos);
}

}  // namespace
}  // namespace roadbook
