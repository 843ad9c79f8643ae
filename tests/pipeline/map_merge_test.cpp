#include <gtest/gtest.h>

#include "base/index.hpp"
#include "base/messages.hpp"
#include "base/random.hpp"
#include "mapping/checks/deep_check.hpp"
#include "mapping/pipeline/build_summary.hpp"
#include "mapping/sessions/merge_map.hpp"
#include "mapping/sessions/session_map.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/pipeline/session_residuals.hpp"
#include "tests/pipeline/visits.hpp"
#include "workflows/localisation/localise_in_map.hpp"
#include "workflows/merge_maps.hpp"
#include "workflows/removed_session.hpp"
#include "workflows/split_session.hpp"

// A session becomes a separate map, and maps of one place become one map, from stored observations.

namespace roadbook {
namespace {

using test::Visits;

std::string lines_of(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_line(problem) + "\n";
  return text;
}

// A crossing 6 m in front of a keyframe, drawn on its first image. Returns its place.
OrientedBox draw_crossing(const std::filesystem::path& file, const Map& map, int keyframe) {
  const Keyframe& k = map.keyframes[at(keyframe)];
  const Eigen::Isometry3d T = map.T_map_vehicle(keyframe);
  OrientedBox box;
  box.centre = (T * Eigen::Vector3d(6.0, 0.0, 0.0)).head<2>();
  box.heading = heading_of(T);
  box.length_m = 2.0;
  box.width_m = 1.0;
  Label label = label_of_box(map, {k.session, k.t_ns, 0}, box);
  label.kind = "crossing";
  LabelStore store(file);
  static_cast<void>(store.create(label, "somebody"));
  return *box_in_map(map, label);
}

int first_keyframe_of(const Map& map, int session) {
  int k = 0;
  while (map.keyframes[at(k)].session != session) ++k;
  return k;
}

// Median distance of all keyframes from the truth, after one alignment of all sessions.
double error_m(const Map& map, const std::vector<std::filesystem::path>& drives) {
  std::vector<DriveTruth> truths;
  for (const auto& drive : drives) truths.push_back(truth_of_drive(Drive::open(drive)));
  MapSummary summary;
  add_truth_errors(truths, map, summary);
  return summary.ate_median_m.value();
}

MergeResult merge(const std::filesystem::path& map,
                  const std::filesystem::path& other,
                  SessionAdjust adjust = SessionAdjust::kNear) {
  MergeRequest request;
  request.map = map;
  request.other = other;
  request.adjust = adjust;
  NoMessages messages;
  return merge_maps(request, messages);
}

TEST_F(Visits, BecomeMapsOfTheirOwn) {
  static_cast<void>(together());
  const auto file = folder() / "to_split.gpkg";
  std::filesystem::copy_file(folder() / "together.gpkg", file,
                             std::filesystem::copy_options::overwrite_existing);
  const Map whole = load_map(file);
  const int first = first_keyframe_of(whole, 1);
  const OrientedBox place = draw_crossing(file, whole, first + 40);
  static_cast<void>(draw_crossing(file, whole, 5));
  const std::string digest = load_meta(file).digest;

  const auto output = folder() / "split.gpkg";
  std::filesystem::remove(output);
  const SplitResult result = split_session({file, whole.sessions[1].name, output});
  EXPECT_EQ(load_meta(file).digest, digest) << "the map loses nothing";
  EXPECT_EQ(result.labels, 1U);
  EXPECT_EQ(result.pieces, 1);
  const Map own = load_map(output);
  ASSERT_EQ(own.sessions.size(), 1U);
  EXPECT_EQ(own.sessions[0].drive_digest, whole.sessions[1].drive_digest);
  for (std::size_t k = 0; k < own.keyframes.size(); ++k)
    EXPECT_EQ(own.T_map_vehicle(static_cast<int>(k)).matrix(),
              whole.T_map_vehicle(first + static_cast<int>(k)).matrix());
  EXPECT_EQ(own.keyframes.front().covariance.norm(), 0.0);
  EXPECT_TRUE(is_known(own.keyframes.back().covariance));
  EXPECT_EQ(lines_of(deep_map_problems(own)), "");
  const auto labels = read_labels(output);
  ASSERT_EQ(labels.size(), 1U);
  EXPECT_LT((box_in_map(own, labels[0])->centre - place.centre).norm(), 1e-9);

  // It is a map like any other: the next visit is localised in it.
  LocaliseRequest localise;
  localise.drive = drives()[2];
  localise.map = output;
  NoMessages messages;
  const auto figures = localise_in_map(localise, messages).figures;
  ASSERT_TRUE(figures.truth);
  EXPECT_LT(figures.truth->median_m, 0.03);

  // The part between two times, including both.
  const std::int64_t begin = own.keyframes[20].t_ns;
  const std::int64_t end = own.keyframes[80].t_ns;
  const std::string name = whole.sessions[1].name;
  std::filesystem::remove(output);
  const SplitResult part =
      split_session({file, name + "@" + std::to_string(begin) + "," + std::to_string(end), output});
  EXPECT_EQ(part.keyframes, 61U);
  const Map stretch = load_map(output);
  EXPECT_EQ(stretch.keyframes.front().t_ns, begin);
  EXPECT_EQ(stretch.keyframes.back().t_ns, end);
  EXPECT_EQ(stretch.keyframes.front().travelled_m, 0.0);
  EXPECT_FALSE(stretch.keyframes.front().wheels);
  EXPECT_EQ(lines_of(deep_map_problems(stretch)), "");

  // What cannot be split leaves nothing behind.
  EXPECT_THROW(static_cast<void>(split_session({file, name, output})), InvalidOption);
  std::filesystem::remove(output);
  const std::vector<std::string> wrong_parts{"sunday", name + "@5", name + "@5,4", name + "@a,b",
                                             "sunday@1,2"};
  for (const std::string& wrong : wrong_parts)
    EXPECT_THROW(static_cast<void>(split_session({file, wrong, output})), InvalidOption) << wrong;
  EXPECT_THROW(static_cast<void>(split_session({file, name + "@1,2", output})), Refused);
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Visits, MergeIntoOneMap) {
  const std::filesystem::path file = map_of_first("merged.gpkg");
  const Map first = load_map(file);
  const OrientedBox own_place = draw_crossing(file, first, 30);
  const auto other = folder() / "later_two.gpkg";
  static_cast<void>(build_map({drives()[1], drives()[2]}, other, {}));
  const Map later = load_map(other);
  static_cast<void>(draw_crossing(other, later, 40));
  const std::string digest_of_other = load_meta(other).digest;

  const MergeResult result = merge(file, other);
  EXPECT_EQ(result.sessions, 3U);
  EXPECT_EQ(result.labels, 1U);
  ASSERT_EQ(result.came.size(), 2U);
  for (const MergeRow& row : result.came) EXPECT_GT(row.localised_share, 0.9) << row.name;
  EXPECT_EQ(load_meta(other).digest, digest_of_other);
  const Map map = load_map(file);
  EXPECT_EQ(lines_of(deep_map_problems(map)), "");
  for (std::size_t f = 0; f < first.map_frames.size(); ++f)
    EXPECT_EQ(map.map_frames[f].T_map_frame.matrix(), first.map_frames[f].T_map_frame.matrix());

  // As exact as the map that is built from all recordings.
  std::vector<std::filesystem::path> in_order{drives()[0]};
  for (const MergeRow& row : result.came) in_order.push_back(folder() / row.name);
  static_cast<void>(together());
  EXPECT_LT(error_m(map, in_order),
            1.1 * error_m(load_map(folder() / "together.gpkg"), drives()) + 0.002);
  const test::Residuals residuals = test::residuals_of(map);
  EXPECT_GT(residuals.joined, 300);
  EXPECT_LT(residuals.off, 0.01 * residuals.joined);

  // Labels of both, on their images.
  const auto labels = read_labels(file);
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_LT((box_in_map(map, labels[0])->centre - own_place.centre).norm(), 0.05);
  const LabelAnchor& anchor = labels[1].anchor;
  EXPECT_EQ(map.sessions[at(anchor.session)].name, later.sessions[0].name);
  EXPECT_EQ(anchor.t_ns, later.keyframes[40].t_ns);

  // Names and drives are in a map once.
  const std::string digest = load_meta(file).digest;
  EXPECT_THROW(static_cast<void>(merge(file, other)), BadInput);
  EXPECT_EQ(load_meta(file).digest, digest);
}

TEST_F(Visits, MergeWithoutMovingTheMap) {
  const std::filesystem::path file = map_of_first("merged_frozen.gpkg");
  const Map before = load_map(file);
  static_cast<void>(together());
  const auto other = folder() / "split_for_merge.gpkg";
  std::filesystem::remove(other);
  const Map whole = load_map(folder() / "together.gpkg");
  static_cast<void>(split_session({folder() / "together.gpkg", whole.sessions[2].name, other}));
  static_cast<void>(merge(file, other, SessionAdjust::kNone));
  const Map after = load_map(file);
  ASSERT_EQ(after.sessions.size(), 2U);
  for (std::size_t k = 0; k < before.keyframes.size(); ++k) {
    EXPECT_EQ(after.keyframes[k].T_frame_vehicle.matrix(),
              before.keyframes[k].T_frame_vehicle.matrix());
    EXPECT_EQ(after.keyframes[k].covariance, before.keyframes[k].covariance);
  }
  for (std::size_t l = 0; l < before.landmarks.size(); ++l)
    EXPECT_EQ(after.landmarks[l].p_frame, before.landmarks[l].p_frame) << l;
  EXPECT_EQ(lines_of(deep_map_problems(after)), "");
  EXPECT_LT(error_m(after, {drives()[0], drives()[2]}), 0.03);
  // What came can go.
  static_cast<void>(remove_session({file, whole.sessions[2].name, false}));
  const Map again = load_map(file);
  ASSERT_EQ(again.keyframes.size(), before.keyframes.size());
  for (std::size_t k = 0; k < before.keyframes.size(); ++k)
    EXPECT_EQ(again.T_map_vehicle(static_cast<int>(k)).matrix(),
              before.T_map_vehicle(static_cast<int>(k)).matrix());
}

// Corners lie as in the map, but none looks like a corner of the map.
TEST_F(Visits, RefuseAMapWithoutOverlap) {
  const std::filesystem::path file = map_of_first("no_overlap.gpkg");
  static_cast<void>(together());
  const Map whole = load_map_with_corners(folder() / "together.gpkg");
  Map other = map_of_session(whole, 1, {}, {});
  Random random(5, "another place");
  const auto change = [&](Descriptor& descriptor) {
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.below(256));
  };
  for (Landmark& landmark : other.landmarks) change(landmark.descriptor);
  for (LoneCorner& corner : other.corners) change(corner.descriptor);
  EXPECT_THROW(static_cast<void>(merged_map(load_map_with_corners(file), other, {})), Refused);
}

}  // namespace
}  // namespace roadbook
