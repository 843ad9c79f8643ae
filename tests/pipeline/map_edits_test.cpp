#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <optional>

#include "base/index.hpp"
#include "base/messages.hpp"
#include "base/random.hpp"
#include "mapping/edits/edited_map.hpp"
#include "mapping/pieces.hpp"
#include "mapping/pipeline/build_summary.hpp"
#include "mapping/sessions/extend_map.hpp"
#include "tests/pipeline/visits.hpp"
#include "workflows/edits/edit_file.hpp"
#include "workflows/edits/edit_map.hpp"
#include "workflows/edits/edit_record.hpp"
#include "workflows/map_drives.hpp"

// Corrections by hand. The judge is the truth of the simulation.

namespace roadbook {
namespace {

using test::Visits;
namespace fs = std::filesystem;

EditResult edited_by(const fs::path& map, const std::string& yaml) {
  const fs::path file = map.string() + ".edits.yaml";
  std::ofstream(file) << yaml;
  NoMessages messages;
  return edit_map({map, file, 0, 0}, messages);
}

EditResult taken_back(const fs::path& map, int number) {
  NoMessages messages;
  return edit_map({map, {}, number, 0}, messages);
}

EditPlace place_of(const Map& map, int keyframe) {
  const Keyframe& k = map.keyframes[at(keyframe)];
  return {map.sessions[at(k.session)].name, k.t_ns};
}

// Median error of all poses after one alignment [m].
double truth_error_of(const Map& map, const std::vector<fs::path>& drives) {
  MapSummary summary;
  std::vector<DriveTruth> truths;
  for (const fs::path& drive : drives) truths.push_back(truth_of_drive(Drive::open(drive)));
  add_truth_errors(truths, map, summary);
  return summary.ate_median_m.value();
}

// The map without what its closed ring tells: its loops are gone, each pass has landmarks of its
// own, and the poses turn by `turn_rad` more with each step.
Map bent(const Map& sound, double turn_rad) {
  Map map = sound;
  map.loops.clear();
  map.landmark_sessions.clear();
  const int middle = static_cast<int>(map.keyframes.size()) / 2;
  std::vector<int> first(map.landmarks.size(), -1);
  std::map<int, int> second_pass;
  for (Observation& o : map.observations) {
    if (first[at(o.landmark)] < 0) first[at(o.landmark)] = o.keyframe;
    if (o.keyframe - first[at(o.landmark)] < middle) continue;
    const auto [found, is_new] =
        second_pass.try_emplace(o.landmark, static_cast<int>(map.landmarks.size()));
    if (is_new) {
      map.landmarks.push_back(map.landmarks[at(o.landmark)]);
      first.push_back(o.keyframe);
    }
    o.landmark = found->second;
  }
  std::vector<Eigen::Isometry3d> before;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    before.push_back(map.T_map_vehicle(static_cast<int>(k)));
  std::vector<Eigen::Isometry3d> after{before[0]};
  for (std::size_t k = 1; k < before.size(); ++k) {
    after.push_back(after.back() * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()) *
                    (before[k - 1].inverse() * before[k]));
    if (map.keyframes[k].wheels) map.keyframes[k].wheels->motion.z() += turn_rad;
  }
  for (std::size_t l = 0; l < map.landmarks.size(); ++l) {
    Landmark& landmark = map.landmarks[l];
    const Eigen::Vector3d p =
        sound.map_frames[at(landmark.map_frame)].T_map_frame * landmark.p_frame;
    landmark.map_frame = map.keyframes[at(first[l])].map_frame;
    landmark.p_frame = before[at(first[l])].inverse() * p;
  }
  for (std::size_t k = 0; k < after.size(); ++k) {
    map.map_frames[at(map.keyframes[k].map_frame)].T_map_frame = after[k];
    map.keyframes[k].T_frame_vehicle = Eigen::Isometry3d::Identity();
  }
  return map;
}

// Pixels of one camera that show the same landmarks in two keyframes of different passes.
std::optional<MapEdit> points_that_two_passes_share(const Map& map) {
  const int middle = static_cast<int>(map.keyframes.size()) / 2;
  std::map<std::tuple<int, int>, std::vector<const Observation*>> of_image;
  for (const Observation& o : map.observations) of_image[{o.keyframe, o.camera}].push_back(&o);
  for (const LoopEdge& loop : map.loops) {
    if (!loop.accepted || loop.to - loop.from < middle) continue;
    for (int camera = 0; camera < 4; ++camera) {
      MapEdit edit;
      edit.kind = EditKind::kSamePoints;
      edit.a = place_of(map, loop.from);
      edit.b = place_of(map, loop.to);
      const auto& cameras = map.sessions[0].rig.cameras;
      edit.camera_a = edit.camera_b = cameras[at(camera)].name;
      for (const Observation* a : of_image[{loop.from, camera}])
        for (const Observation* b : of_image[{loop.to, camera}])
          if (a->landmark == b->landmark && edit.pixels_a.size() < 6) {
            edit.pixels_a.emplace_back(std::round(a->pixel.x()), std::round(a->pixel.y()));
            edit.pixels_b.emplace_back(std::round(b->pixel.x()), std::round(b->pixel.y()));
          }
      if (edit.pixels_a.size() >= 4) return edit;
    }
  }
  return std::nullopt;
}

TEST_F(Visits, AreStraightenedByThePointsThatAPersonFinds) {
  const fs::path file = map_of_first("edited.gpkg");
  const Map sound = load_map_with_corners(file);
  const auto edit = points_that_two_passes_share(sound);
  ASSERT_TRUE(edit);
  const std::vector<fs::path> drive{drives()[0]};
  const double best = truth_error_of(sound, drive);
  {
    const Map wrong = bent(sound, -0.002);
    EXPECT_GT(truth_error_of(wrong, drive), 5.0 * best);
    MapOptions poses_alone;
    poses_alone.covariances = false;
    const Map mended = edited_map(wrong, {*edit}, poses_alone);
    EXPECT_LT(truth_error_of(mended, drive), 1.2 * best);
    ASSERT_EQ(mended.map_frames.size(), wrong.map_frames.size());
    for (std::size_t f = 0; f < wrong.map_frames.size(); ++f)
      EXPECT_EQ(mended.map_frames[f].T_map_frame.matrix(),
                wrong.map_frames[f].T_map_frame.matrix());
  }
}

// Two visits that nothing joins become one map by one loop, with an error of a few centimetres.
TEST_F(Visits, AreJoinedByTheLoopThatAPersonGives) {
  const fs::path file = folder() / "joined_by_hand.gpkg";
  fs::remove(file);
  MapOptions apart;
  apart.loops.min_inliers = 100000;
  apart.gate.apart = true;
  const std::vector<fs::path> both{drives()[0], drives()[1]};
  build_map(both, file, apart);
  const Map map = load_map_with_corners(file);
  ASSERT_EQ(piece_count(map), 2);
  // The truth of two poses near each other, read off to 5 cm and 1 degree.
  const Drive first = Drive::open(both[0]);
  const Drive second = Drive::open(both[1]);
  const auto truth_a = test::truth_of(map, first);
  const auto truth_b = test::truth_of(map, second);
  std::optional<std::pair<int, int>> nearest;
  double least = 1.5;
  for (std::size_t a = 0; a < map.keyframes.size(); ++a)
    for (std::size_t b = 0; b < map.keyframes.size(); ++b) {
      if (map.keyframes[a].session != 0 || map.keyframes[b].session != 1) continue;
      if (!truth_a[a] || !truth_b[b]) continue;
      const Eigen::Isometry3d T = truth_a[a]->inverse() * *truth_b[b];
      if (std::abs(heading_of(T)) > 0.3 || T.translation().norm() >= least) continue;
      least = T.translation().norm();
      nearest = {static_cast<int>(a), static_cast<int>(b)};
    }
  ASSERT_TRUE(nearest);
  const Eigen::Isometry3d T =
      truth_a[at(nearest->first)]->inverse() * *truth_b[at(nearest->second)];
  MapEdit edit;
  edit.a = place_of(map, nearest->first);
  edit.b = place_of(map, nearest->second);
  edit.motion = {T.translation().x() + 0.05, T.translation().y() - 0.05, heading_of(T) + 0.017};
  const EditResult result = edited_by(file, edit_yaml(edit));
  ASSERT_EQ(result.edits.size(), 1U);
  EXPECT_GT(result.moved_max_m, 0.01);
  const Map joined = load_map(file);
  EXPECT_EQ(piece_count(joined), 1);
  EXPECT_LT(truth_error_of(joined, both), 0.02);
}

// What an edit did goes with it, to the digest; and a map that is built again gets it again.
TEST_F(Visits, AreAsBeforeWhenTheEditIsTakenBack) {
  const fs::path file = map_of_first("taken_back.gpkg");
  NoMessages messages;
  MapRequest request;
  request.drives = {drives()[0]};
  request.map = file;
  const std::string plain = load_meta(file).digest;
  const Map map = load_map(file);
  MapEdit anchor;
  anchor.kind = EditKind::kAnchor;
  anchor.a = place_of(map, 40);
  const Eigen::Isometry3d T = map.T_map_vehicle(40);
  anchor.motion = {T.translation().x() + 2.0, T.translation().y() - 1.0, heading_of(T)};
  anchor.sigma_m = 0.01;
  const std::string digest = edited_by(file, edit_yaml(anchor)).digest;
  EXPECT_NE(digest, plain);
  const Map moved = load_map(file);
  EXPECT_NEAR(moved.T_map_vehicle(40).translation().x(), anchor.motion.x(), 0.03);
  EXPECT_NEAR(moved.T_map_vehicle(40).translation().y(), anchor.motion.y(), 0.03);
  EXPECT_EQ(moved.map_frames[40].T_map_frame.matrix(), map.map_frames[40].T_map_frame.matrix());

  // An edit that the map contradicts is refused, and nothing changes.
  MapEdit wrong;
  wrong.a = place_of(map, 30);
  wrong.b = place_of(map, 60);
  wrong.motion = {0.5, 3.0, 0.0};
  try {
    static_cast<void>(edited_by(file, edit_yaml(wrong)));
    ADD_FAILURE() << "a step to the side of 3 m was taken up";
  } catch (const Refused& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("contradiction to"), std::string::npos)
        << refusal.what();
  }
  EXPECT_EQ(load_meta(file).digest, digest);
  EXPECT_EQ(stored_edits(file).size(), 1U);

  request.options.replace = true;  // builds it again, although it is there
  static_cast<void>(map_drives(request, messages));
  EXPECT_EQ(stored_edits(file).size(), 1U);
  EXPECT_EQ(load_meta(file).digest, digest);
  EXPECT_EQ(taken_back(file, 1).digest, plain);
  EXPECT_TRUE(stored_edits(file).empty());
  EXPECT_THROW(static_cast<void>(taken_back(file, 1)), InvalidOption);
}

// A session that came after an edit stays when the edit is taken back.
TEST_F(Visits, StayWhenAnEditBeforeThemIsTakenBack) {
  const fs::path file = map_of_first("later_session.gpkg");
  const Map map = load_map(file);
  MapEdit anchor;
  anchor.kind = EditKind::kAnchor;
  anchor.a = place_of(map, 40);
  const Eigen::Isometry3d T = map.T_map_vehicle(40);
  anchor.motion = {T.translation().x() + 1.0, T.translation().y(), heading_of(T)};
  static_cast<void>(edited_by(file, edit_yaml(anchor)));
  NoMessages messages;
  MapRequest request;
  request.drives = {drives()[1]};
  request.map = file;
  request.adjust = SessionAdjust::kNone;
  static_cast<void>(map_drives(request, messages));
  ASSERT_EQ(stored_edits(file).size(), 1U);
  EXPECT_FALSE(stored_map_before_edits(file));
  // A further edit does not take the map with the first one for a map without edits.
  MapEdit loop;
  loop.a = place_of(map, 30);
  loop.b = place_of(map, 60);
  const Eigen::Isometry3d motion = map.T_map_vehicle(30).inverse() * map.T_map_vehicle(60);
  loop.motion = {motion.translation().x(), motion.translation().y(), heading_of(motion)};
  EXPECT_EQ(edited_by(file, edit_yaml(loop)).edits.size(), 2U);
  EXPECT_FALSE(stored_map_before_edits(file));
  loop.b.session = "sunday";
  try {
    static_cast<void>(edited_by(file, edit_yaml(loop)));
    ADD_FAILURE() << "the map has no such session";
  } catch (const BadInput& bad) {
    EXPECT_NE(to_line(bad.problems().front()).find(".edits.yaml: session: got sunday"),
              std::string::npos);
  }
  EXPECT_TRUE(taken_back(file, 2).undone_later);
  EXPECT_TRUE(taken_back(file, 1).undone_later);
  EXPECT_EQ(load_map(file).sessions.size(), 2U);
  EXPECT_TRUE(stored_edits(file).empty());
}

// Edits are written as they were read; what cannot be read is named with its line.
TEST(EditFile, IsReadBackToTheBit) {
  const auto edits = parse_edits(R"(edits:
  - loop: {a: monday@1400000000123456789, b: tues day@7, motion: [0.1, -0.2, 0.30000000000000004]}
  - same_points: {a: monday@5, camera: cam0, pixels: [[1, 2], [3, 4.5]], b: x@9, pixels_b: [[5, 6], [7, 8]]}
  - not_a_loop: {a: monday@5, b: tuesday@6}
  - anchor: {at: monday@5, place: [1, 2, 3], sigma: [0.05, 0.01]}
)",
                                 "edits.yaml");
  ASSERT_EQ(edits.size(), 4U);
  EXPECT_EQ(edits[0].a.t_ns, 1400000000123456789);
  EXPECT_EQ(edits[0].b.session, "tues day");
  EXPECT_EQ(edits[1].camera_b, "cam0");
  EXPECT_EQ(edits[3].sigma_m, 0.05);
  for (const MapEdit& edit : edits) {
    const auto again = parse_edits(edit_yaml(edit), "again");
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(edit_yaml(again[0]), edit_yaml(edit));
    EXPECT_EQ(again[0].motion, edit.motion);
    EXPECT_EQ(again[0].pixels_b, edit.pixels_b);
  }
}

// Bytes changed at random: each text is read, or refused as bad input. What is read can be stored.
TEST(EditFile, SurvivesChangedBytes) {
  const std::string whole = R"(edits:
  - loop: {a: monday@1400000000123456789, b: "tues day@7", motion: [0.1, -0.2, 0.3], sigma: [1, 2]}
  - same_points: {a: m@5, camera: cam0, pixels: [[1, 2], [3, 4.5]], b: x@9, pixels_b: [[5, 6], [7, 8]]}
  - anchor: {at: monday@5, place: [1, 2, 3]}
)";
  Random random(7, "changed edits");
  int read = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n)
      text[random.below(text.size())] = static_cast<char>(32 + random.below(95));
    if (random.below(10) == 0) text.resize(random.below(text.size()));
    try {
      for (const MapEdit& edit : parse_edits(text, "edits.yaml")) {
        const auto again = parse_edits(edit_yaml(edit), "again");
        ASSERT_EQ(again.size(), 1U) << text;
        EXPECT_EQ(edit_yaml(again[0]), edit_yaml(edit));
        ++read;
      }
    } catch (const BadInput&) {
      continue;
    }
  }
  EXPECT_GT(read, 100);
}

TEST(EditFile, NamesWhatItCannotRead) {
  const auto fault = [](const std::string& text) {
    try {
      static_cast<void>(parse_edits(text, "edits.yaml"));
    } catch (const BadInput& bad) {
      return to_line(bad.problems().front());
    }
    return std::string("no fault");
  };
  EXPECT_NE(fault("loop: {a: monday, b: x@1, motion: [1, 2, 3]}").find("SESSION@TIME"),
            std::string::npos);
  EXPECT_NE(fault("loop: {a: m@1, b: x@2}").find("motion"), std::string::npos);
  EXPECT_NE(fault("loop: {a: m@1, b: x@2, motion: [1, 2]}").find("motion"), std::string::npos);
  EXPECT_NE(fault("loop: {a: m@1, b: x@2, motion: [1, 2, 3], sigma: [0, 1]}").find("sigma"),
            std::string::npos);
  EXPECT_NE(fault("same_points: {a: m@1, camera: c, pixels: [[1, 2], [3, 4]], b: x@2, pixels_b: "
                  "[[1, 2]]}")
                .find("one for each"),
            std::string::npos);
  EXPECT_NE(fault("lop: {a: m@1}").find("edits.yaml:1"), std::string::npos);
  EXPECT_NE(fault("").find("no edit"), std::string::npos);
}

}  // namespace
}  // namespace roadbook
