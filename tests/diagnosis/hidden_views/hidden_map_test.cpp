#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/map_changes/moved_landmarks.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/streams/drive_session.hpp"
#include "mapping/localisation/register_drive.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/diagnosis/hidden_views/study_case.hpp"
#include "tests/diagnosis/hidden_views/visits.hpp"
#include "tests/mapping/store/small_map.hpp"

// Errors of a map from an earlier drive, as a later drive sees them.

namespace roadbook::test {
namespace {

HiddenViewOptions revisit(std::uint64_t seed, const Secret& secret = {}) {
  HiddenViewOptions o;
  o.seed = seed;
  o.length_m = 60.0;
  o.outliers = 0.01;
  o.earlier = true;
  o.secret = secret;
  return o;
}

TEST(HiddenMap, NamesNothingWhereTheMapIsRight) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Folder folder;
    const ViewOutcome o = run_hidden_map(revisit(seed), folder / "views");
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
    EXPECT_FALSE(o.found.looked_for.empty());
  }
}

TEST(HiddenMap, LandmarksThatMovedAreCountedAndPlaced) {
  const Folder folder;
  const ViewOutcome o =
      run_hidden_map(revisit(11, {{"map.moved_landmarks", 0.08}}), folder / "views");
  const FoundCause* moved = o.cause("map.moved_landmarks");
  ASSERT_NE(moved, nullptr) << o.to_line();
  EXPECT_EQ(o.extra(), 0U) << o.to_line();
  EXPECT_LE(moved->low, 0.08) << o.to_line();
  EXPECT_GE(moved->high, 0.08) << o.to_line();
  EXPECT_NE(moved->note.find("within"), std::string::npos) << moved->note;
}

TEST(HiddenMap, ScaleAndBendComeOutWithTheirSign) {
  const Secret causes[] = {{{"map.scale", 0.01}}, {{"map.scale", -0.006}}, {{"map.bend", -3e-4}}};
  std::uint64_t seed = 20;
  for (const Secret& secret : causes) {
    const Folder folder;
    const ViewOutcome o = run_hidden_map(revisit(++seed, secret), folder / "views");
    const auto& [name, size] = *secret.begin();
    const FoundCause* cause = o.cause(name);
    ASSERT_NE(cause, nullptr) << o.to_line();
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
    EXPECT_NEAR(cause->size, size, cause->high - cause->low) << o.to_line();
  }
}

// Number of landmarks in a square of 2 m inside the clump. At 30 landmarks, half of them should be
// redetected. The probability that none is redetected is 3e-7, even if the rate varies between
// places by 0.3 in log odds. The limit per square is 3e-6, because many squares are tested.
double in_a_square(const GoneClump& c) {
  return static_cast<double>(c.landmarks) * 4.0 / (3.14159 * c.radius_m * c.radius_m);
}

// Checks that regions with enough landmarks are found, and no others. The seed decides where, how
// many and how large they are. Half of the present landmarks are not redetected, with variation
// from place to place. Returns the number of regions that must be found.
std::size_t expect_places(const ViewOutcome& o, const std::filesystem::path& folder) {
  EXPECT_EQ(o.extra(), 0U) << o.to_line();
  const std::vector<GoneClump> clumps = read_gone(folder / "gone.csv");
  const FoundCause* cause = o.cause("map.landmarks_gone");
  const std::vector<FoundPlace> places =
      cause != nullptr ? cause->places : std::vector<FoundPlace>();
  const auto near = [](const GoneClump& c, const FoundPlace& p) {
    return std::hypot(c.x - p.middle.x(), c.y - p.middle.y()) < c.radius_m + 1.0;
  };
  for (const FoundPlace& p : places)
    EXPECT_TRUE(
        std::any_of(clumps.begin(), clumps.end(), [&](const GoneClump& c) { return near(c, p); }))
        << p.middle.transpose() << ", " << o.to_line();
  std::size_t plain = 0;
  for (const GoneClump& c : clumps) {
    if (c.radius_m < 1.42 || in_a_square(c) < 30.0) continue;
    ++plain;
    EXPECT_TRUE(
        std::any_of(places.begin(), places.end(), [&](const FoundPlace& p) { return near(c, p); }))
        << c.x << " " << c.y << ": " << c.landmarks << ", " << o.to_line();
  }
  return plain;
}

TEST(HiddenMap, LandmarksThatAreGoneAreMissedWhereTheyStood) {
  std::size_t plain = 0;
  for (const std::uint64_t seed : {61U}) {
    const Folder folder;
    HiddenViewOptions hidden = revisit(seed);
    hidden.landmarks_per_m = 100.0;
    hidden.lost = 0.5;
    hidden.secret["map.landmarks_gone"] = Random(seed, "share").uniform(0.02, 0.04);
    plain += expect_places(run_hidden_map(hidden, folder / "views"), folder / "views");
  }
  EXPECT_GT(plain, 0U);
}

TEST(HiddenMap, NothingIsGoneWhereHalfOfWhatStandsIsNotRecognised) {
  for (const std::uint64_t seed : {71U}) {
    const Folder folder;
    HiddenViewOptions hidden = revisit(seed);
    hidden.landmarks_per_m = 100.0;
    hidden.lost = 0.5;
    const ViewOutcome o = run_hidden_map(hidden, folder / "views");
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
    EXPECT_EQ(std::count(o.found.not_observable.begin(), o.found.not_observable.end(),
                         "map.landmarks_gone"),
              0);
  }
}

// The map of `session` alone, in its own frame.
Map only(const Map& map, int session, const Eigen::Isometry3d& T_new_old) {
  Map alone;
  alone.sessions.push_back(map.sessions[static_cast<std::size_t>(session)]);
  alone.map_frames = map.map_frames;
  for (MapFrame& frame : alone.map_frames) frame.T_map_frame = T_new_old * frame.T_map_frame;
  std::vector<int> keyframe_of(map.keyframes.size(), -1);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].session != session) continue;
    keyframe_of[k] = static_cast<int>(alone.keyframes.size());
    alone.keyframes.push_back(map.keyframes[k]);
    alone.keyframes.back().session = 0;
  }
  std::vector<int> landmark_of(map.landmarks.size(), -1);
  for (Observation o : map.observations) {
    const auto seen = static_cast<std::size_t>(o.landmark);
    const int keyframe = keyframe_of[static_cast<std::size_t>(o.keyframe)];
    if (keyframe < 0) continue;
    if (landmark_of[seen] < 0) {
      landmark_of[seen] = static_cast<int>(alone.landmarks.size());
      Landmark landmark = map.landmarks[seen];
      const Eigen::Vector3d p = T_new_old * map.p_map(landmark);
      landmark.map_frame = alone.keyframes[static_cast<std::size_t>(keyframe)].map_frame;
      landmark.p_frame =
          alone.map_frames[static_cast<std::size_t>(landmark.map_frame)].T_map_frame.inverse() * p;
      alone.landmarks.push_back(landmark);
    }
    o.keyframe = keyframe;
    o.landmark = landmark_of[seen];
    alone.observations.push_back(o);
  }
  return alone;
}

// Diagnosis against an unchanged map of the first drive. The second drive's own map has another
// frame.
Diagnosis against_frozen(const HiddenViewOptions& hidden, const std::filesystem::path& folder) {
  HiddenViewOptions plain = hidden;
  for (const char* shape : {"map.scale", "map.bend"}) plain.secret.erase(shape);
  write_hidden_views(plain, folder);
  const Drive drive = Drive::open(folder / "drive");
  const Map both = load_map(folder / "map.gpkg");
  const int session = session_of(both, drive, folder / "map.gpkg");
  Eigen::Isometry3d T_own_both(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()));
  T_own_both.translation() = Eigen::Vector3d(30.0, -12.0, 0.4);
  Map frozen = both;
  bend_map(hidden, frozen);
  frozen = only(frozen, 1 - session, Eigen::Isometry3d::Identity());
  const auto localised = localise_in(frozen, only(both, session, T_own_both));
  if (!localised) {
    ADD_FAILURE() << "not found in the map";
    return {};
  }
  // The map must not change.
  for (std::size_t k = 0; k < frozen.keyframes.size(); ++k)
    EXPECT_EQ(localised->map.T_map_vehicle(static_cast<int>(k)).matrix(),
              frozen.T_map_vehicle(static_cast<int>(k)).matrix());
  return diagnose_through_map(localised->map, localised->session, drive);
}

TEST(FrozenMap, ALaterDriveFindsWhatIsWrongWithAMapThatItIsNotPartOf) {
  const Secret causes[] = {{}, {{"map.moved_landmarks", 0.08}}, {{"map.scale", 0.012}}};
  std::uint64_t seed = 40;
  for (const Secret& secret : causes) {
    const Folder folder;
    ViewOutcome o;
    o.hidden = revisit(++seed, secret);
    o.found = against_frozen(o.hidden, folder / "views");
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
    for (const auto& [name, size] : secret) {
      const FoundCause* cause = o.cause(name);
      ASSERT_NE(cause, nullptr) << o.to_line();
      EXPECT_NEAR(cause->size, size, cause->high - cause->low) << o.to_line();
    }
  }
}

TEST(FrozenMap, ADriveOfAnotherPlaceIsNotFoundInTheMap) {
  const Folder folder;
  write_hidden_views(revisit(51), folder / "here");
  write_hidden_views(revisit(52), folder / "there");
  const Map here = load_map(folder / "here" / "map.gpkg");
  const Map there = load_map(folder / "there" / "map.gpkg");
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  EXPECT_FALSE(localise_in(only(here, 0, same), only(there, 1, same)).has_value());
  EXPECT_TRUE(localise_in(only(here, 0, same), only(here, 1, same)).has_value());
}

}  // namespace
}  // namespace roadbook::test
