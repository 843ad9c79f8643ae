#include "mapping/pipeline/map_gate.hpp"

#include <gtest/gtest.h>

#include "mapping/pipeline/short_segments.hpp"

namespace roadbook {
namespace {

const GateInputs kTwoDrives{{"monday", "tuesday"}, "place.gpkg"};

template <typename Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const Refused& refused) {
    return refused.what();
  }
  return "";
}

MappingInput keyframes_of(const std::vector<int>& sessions) {
  MappingInput input;
  input.session = sessions;
  input.odometry.keyframes.resize(sessions.size());
  input.half_rigs.resize(static_cast<std::size_t>(sessions.back()) + 1);
  return input;
}

TEST(MapGate, RefusesADriveOfAnotherPlace) {
  const MappingInput input = keyframes_of({0, 0, 0, 1, 1});
  Relaxed relaxed;
  relaxed.component = {0, 0, 0, 1, 1};
  relaxed.components = 2;
  EXPECT_EQ(refusal([&] { require_joined(input, relaxed, kTwoDrives, {}); }),
            "error: place.gpkg: sessions: got tuesday with 0 of 2 keyframes in the map, want a "
            "drive of its place (--apart keeps it as a map of its own)");
  MapGateOptions apart;
  apart.apart = true;
  EXPECT_EQ(refusal([&] { require_joined(input, relaxed, kTwoDrives, apart); }), "");
}

TEST(MapGate, RefusesPartsOfOneDrive) {
  const MappingInput input = keyframes_of({0, 0, 0, 0, 0});
  Relaxed relaxed;
  relaxed.component = {0, 0, 1, 1, 1};
  relaxed.components = 2;
  const std::string line = refusal([&] {
    require_joined(input, relaxed, {{"monday"}, "place.gpkg"}, {});
  });
  EXPECT_NE(line.find("error: monday: parts: got 2 that no loop joins, of 3 and 2 keyframes"),
            std::string::npos)
      << line;
}

TEST(MapGate, AcceptsJoinedDrives) {
  const MappingInput input = keyframes_of({0, 0, 1, 1});
  Relaxed relaxed;
  relaxed.component = {0, 0, 0, 0};
  EXPECT_EQ(refusal([&] { require_joined(input, relaxed, kTwoDrives, {}); }), "");
}

std::vector<LoopClosure> loops_of(int accepted, int contradicting, int unlike) {
  std::vector<LoopClosure> loops;
  const auto add = [&](int count, bool is_accepted, const char* reason) {
    for (int i = 0; i < count; ++i) {
      LoopClosure loop;
      loop.edge.accepted = is_accepted;
      loop.edge.reason = reason;
      loops.push_back(loop);
    }
  };
  add(accepted, true, "80 corners agree");
  add(contradicting, false, "contradicts odometry and the other loops");
  add(unlike, false, "only 7 corners look alike");
  return loops;
}

TEST(MapGate, RefusesAlikePlacesThatNearlyAllContradict) {
  const auto line = [](int accepted, int contradicting, int unlike) {
    return refusal(
        [&] { require_loops(loops_of(accepted, contradicting, unlike), kTwoDrives, {}); });
  };
  EXPECT_NE(line(2, 38, 0).find("monday: loops: got 2 accepted of 40 pairs"), std::string::npos);
  EXPECT_EQ(line(4, 36, 0), "");
  EXPECT_EQ(line(0, 19, 0), "");   // too few to judge
  EXPECT_EQ(line(0, 0, 500), "");  // a drive without revisits
  EXPECT_EQ(line(0, 0, 0), "");
}

// One drive of two cameras: `views` landmarks in view of each keyframe and camera.
struct Evidenced {
  MappingInput input;
  Adjusted adjusted;
  std::vector<CameraFigures> cameras;
};

Evidenced with_views(const std::vector<int>& views, int landmarks, double camera1_views) {
  Evidenced e;
  e.input = keyframes_of(std::vector<int>(views.size(), 0));
  e.input.half_rigs[0].cameras.resize(2);
  e.adjusted.stage.camera_base = {0};
  e.adjusted.stage.problem.points.resize(static_cast<std::size_t>(landmarks));
  int next = 0;
  for (std::size_t k = 0; k < views.size(); ++k)
    for (int v = 0; v < views[k]; ++v) {
      e.adjusted.stage.problem.observations.push_back(
          {static_cast<int>(k), next++ % landmarks, 0, Eigen::Vector2d::Zero(), 1.0});
      e.adjusted.result.inlier.push_back(1);
    }
  e.cameras.resize(2);
  e.cameras[0].camera = "cam0";
  e.cameras[0].views = 20.0;
  e.cameras[1].camera = "cam1";
  e.cameras[1].views = camera1_views;
  return e;
}

TEST(MapGate, RefusesTooFewLandmarksViewsAndCameras) {
  const GateInputs drive{{"monday"}, "place.gpkg"};
  const auto line = [&](const Evidenced& e, const MapGateOptions& options = {}) {
    return refusal([&] { require_evidence(e.input, e.adjusted, e.cameras, {}, drive, options); });
  };
  EXPECT_EQ(line(with_views({40, 40, 40, 40}, 100, 20.0)), "");
  EXPECT_NE(line(with_views({40, 40, 40, 40}, 29, 20.0)).find("monday: landmarks: got 29"),
            std::string::npos);
  EXPECT_NE(line(with_views({40, 7, 7, 7}, 50, 20.0))
                .find("views: got 1 of 4 keyframes with 8 landmarks or more in view"),
            std::string::npos);
  EXPECT_EQ(line(with_views({40, 40, 7, 7}, 60, 20.0)), "");
  EXPECT_EQ(line(with_views({40, 40, 40, 40}, 100, 0.2)), "");  // one of two: a warning
  MapGateOptions all;
  all.min_cameras_share = 1.0;
  EXPECT_NE(line(with_views({40, 40, 40, 40}, 100, 0.2), all)
                .find("cameras: got 1 of 2 in use, hardly a landmark in cam1"),
            std::string::npos);
}

TEST(MapGate, RefusesMotionsThatNoCarMakes) {
  MappingInput input = keyframes_of({0, 0, 1, 1, 1});
  input.has_wheels = {false, true};
  std::vector<Eigen::Isometry3d> poses(5, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < 5; ++k)
    input.odometry.keyframes[k].t_ns =
        static_cast<std::int64_t>(k) * 500'000'000 + (k > 1 ? 86'400'000'000'000 : 0);
  const auto line = [&] {
    return refusal([&] { require_possible_motions(input, poses, kTwoDrives); });
  };
  poses[4].translation().x() = 60.0;
  EXPECT_EQ(line(), "");
  poses[4].translation().x() = 400.0;
  EXPECT_NE(line().find("tuesday: poses: got 400 m in 0.50 s, 0.5 s after the start"),
            std::string::npos)
      << line();
  EXPECT_NE(line().find("cameras lost their scale"), std::string::npos);
  input.odometry.keyframes[4].wheels.emplace();
  EXPECT_EQ(line().find("cameras lost their scale"), std::string::npos);
  input.has_wheels[1] = false;  // a rig of unknown height: its unit is no metre
  EXPECT_EQ(line(), "");
  input.has_wheels[1] = true;
  input.odometry.keyframes[4].after_gap = true;
  EXPECT_EQ(line(), "");
}

TEST(MapGate, WarnsOfIdleCamerasAndOfOtherStamps) {
  Evidenced e = with_views({40, 40, 40, 40}, 100, 0.2);
  e.cameras[0].paired_share = 0.02;
  e.cameras[0].late_s = -0.02;
  const auto warnings = warnings_of_idle_cameras(e.cameras, e.input, {{"monday"}, "m"}, {});
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].file, "monday/cam0");
  EXPECT_EQ(warnings[0].field, "timestamp");
  EXPECT_NE(warnings[0].got.find("20 ms before"), std::string::npos) << warnings[0].got;
  EXPECT_EQ(warnings[1].file, "monday/cam1");
  EXPECT_EQ(warnings[1].field, "landmarks");
}

TEST(ShortSegments, AreRemovedWithTheirKeyPoints) {
  VoResult odometry;
  odometry.keyframes.resize(7);
  for (std::size_t k = 0; k < 7; ++k) {
    odometry.keyframes[k].frame = k;
    odometry.keyframes[k].tracks = {{}};
  }
  odometry.keyframes[1].after_gap = true;  // segments of 1, 4 and 2 keyframes
  odometry.keyframes[5].after_gap = true;
  odometry.tracks = {{0, {{5, 0}, {6, 0}}, {}}, {0, {{1, 0}, {2, 0}, {3, 0}}, {}}};
  for (const int k : {5, 6}) odometry.keyframes[static_cast<std::size_t>(k)].tracks = {{0}};
  for (const int k : {1, 2, 3}) odometry.keyframes[static_cast<std::size_t>(k)].tracks = {{1}};
  EXPECT_EQ(remove_short_segments(odometry, 3), 3);
  ASSERT_EQ(odometry.keyframes.size(), 4U);
  EXPECT_EQ(odometry.keyframes[0].frame, 1U);
  EXPECT_FALSE(odometry.keyframes[0].after_gap);
  ASSERT_EQ(odometry.tracks.size(), 1U);
  EXPECT_EQ(odometry.tracks[0].observations.front().keyframe, 0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(odometry.keyframes[k].tracks[0][0], 0);
  EXPECT_EQ(remove_short_segments(odometry, 3), 0);
}

}  // namespace
}  // namespace roadbook
