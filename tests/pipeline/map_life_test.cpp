#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/index.hpp"
#include "base/messages.hpp"
#include "mapping/checks/deep_check.hpp"
#include "mapping/sessions/curate_map.hpp"
#include "mapping/sessions/extend_map.hpp"
#include "mapping/store/map_check.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/pipeline/visits.hpp"
#include "workflows/deep_map_check.hpp"
#include "workflows/localisation/localise_in_map.hpp"
#include "workflows/removed_session.hpp"

// A map over its life: curated, checked, and with a session taken out.

namespace roadbook {
namespace {

using test::Visits;

std::string text_of(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_line(problem) + "\n";
  return text;
}

LocalisationFigures figures_of(const std::filesystem::path& drive,
                               const std::filesystem::path& map) {
  LocaliseRequest request;
  request.drive = drive;
  request.map = map;
  NoMessages messages;
  return localise_in_map(request, messages).figures;
}

// Ten faults, each planted into a sound map, are found and named.
TEST_F(Visits, HaveTheirPlantedFaultsFound) {
  static_cast<void>(together());
  const Map sound = load_map(folder() / "together.gpkg");
  EXPECT_EQ(text_of(deep_map_problems(sound)), "");
  const auto found = [&](const std::function<void(Map&)>& plant) {
    Map map = sound;
    plant(map);
    return text_of(deep_map_problems(map));
  };
  const auto expect = [&](const std::string& word, const std::function<void(Map&)>& plant) {
    const std::string text = found(plant);
    EXPECT_NE(text.find(word), std::string::npos) << "want " << word << ", got " << text;
  };
  const std::string name = sound.sessions[1].name;
  expect("pieces of the map", [](Map& map) {
    for (Keyframe& keyframe : map.keyframes)
      if (keyframe.session == 1) keyframe.piece = 1;
  });
  expect("parts that nothing joins", [](Map& map) {
    std::erase_if(map.loops, [](const LoopEdge& loop) { return loop.accepted; });
    std::erase_if(map.observations,
                  [&](const Observation& o) { return map.keyframes[at(o.keyframe)].session == 1; });
  });
  expect("camera cam1 of session " + name, [](Map& map) {
    std::swap(map.sessions[1].rig.cameras[1].T_vehicle_camera,
              map.sessions[1].rig.cameras[3].T_vehicle_camera);
  });
  expect("wheels of session " + name, [](Map& map) { map.sessions[1].wheel_scale *= 1.05; });
  expect("wheels of session " + name, [](Map& map) { map.sessions[1].wheel_scale *= 0.95; });
  expect("poses of session " + sound.sessions[0].name + ": got 10 keyframes", [](Map& map) {
    for (std::size_t k = 20; k < 30; ++k) map.keyframes[k].T_frame_vehicle.translation().y() += 0.5;
  });
  expect("behind or beside a camera", [](Map& map) {
    const Observation& o = map.observations[1000];
    const Keyframe& keyframe = map.keyframes[at(o.keyframe)];
    const MountedCamera& mounted = map.sessions[at(keyframe.session)].rig.cameras[at(o.camera)];
    Landmark& landmark = map.landmarks[at(o.landmark)];
    landmark.p_frame =
        map.map_frames[at(landmark.map_frame)].T_map_frame.inverse() *
        (map.T_map_vehicle(o.keyframe) * mounted.T_vehicle_camera * Eigen::Vector3d(0, 0, -5.0));
  });
  expect("two observations in one image",
         [](Map& map) { map.observations.push_back(map.observations[500]); });
  expect("from what the poses say", [](Map& map) {
    for (LoopEdge& loop : map.loops)
      if (loop.accepted) {
        loop.T_from_to.translation().x() += 1.5;
        return;
      }
  });
  expect("covariances of poses of session " + name, [](Map& map) {
    for (Keyframe& keyframe : map.keyframes)
      if (keyframe.session == 1) keyframe.covariance.setZero();
  });
  expect("covariances of poses of session " + name, [](Map& map) {
    for (Keyframe& keyframe : map.keyframes) keyframe.covariance *= 1e-4;  // sigma: 100 times
  });
  expect("covariances of landmarks", [](Map& map) { map.landmarks[700].covariance *= 1e-4; });
  Map without_gauge = sound;
  without_gauge.map_frames.emplace_back();
  EXPECT_EQ(map_problems(without_gauge).size(), 1U) << "no pose holds the frame";

  // Descriptors are compared with the recordings.
  const Drive first = Drive::open(drives()[0]);
  const Drive second = Drive::open(drives()[1]);
  const Drive third = Drive::open(drives()[2]);
  Map swapped = sound;
  std::swap(swapped.landmarks[40].descriptor, swapped.landmarks[900].descriptor);
  EXPECT_NE(text_of(descriptor_problems(swapped, {&first, &second, &third}))
                .find("landmarks 40, 900: got 2 descriptors"),
            std::string::npos);
}

// The landmarks that stay must localise a visit as well as all did.
TEST_F(Visits, AreLocalisedInACuratedMapAsWell) {
  const std::filesystem::path file = map_of_first("curated.gpkg");
  extend_map(drives()[1], file, {});
  const auto before = figures_of(drives()[2], file);
  const std::string digest = load_meta(file).digest;
  CurateOptions options;
  options.per_place = 30;  // images of 320 x 240 pixels have few more
  const CurateSummary dry = curate_map(file, options, true);
  EXPECT_EQ(load_meta(file).digest, digest);
  const CurateSummary summary = curate_map(file, options, false);
  EXPECT_EQ(summary.curation.kept, dry.curation.kept);
  const Map map = load_map_with_corners(file);
  EXPECT_EQ(map.landmarks.size(), summary.curation.kept);
  EXPECT_LT(static_cast<double>(map.landmarks.size()),
            0.9 * static_cast<double>(summary.landmarks_before));
  EXPECT_LT(summary.bytes, summary.bytes_before);
  const auto after = figures_of(drives()[2], file);
  EXPECT_GE(after.localised, before.localised);
  ASSERT_TRUE(after.truth && before.truth);
  EXPECT_LT(after.truth->median_m, 1.1 * before.truth->median_m);
  EXPECT_EQ(text_of(deep_map_problems(map)), "");
  // A curated map is extended like any other.
  EXPECT_GT(extend_map(drives()[2], file, {}).localised_share.value(), 0.95);
  // Fewer, where a limit says so.
  options.most = 800;
  EXPECT_LE(curate_map(file, options, false).curation.kept, 800U);
}

TEST_F(Visits, LeaveNothingBehindWhenTheyAreRemoved) {
  const std::filesystem::path file = map_of_first("removed.gpkg");
  const Map before = load_map_with_corners(file);
  MapOptions none;
  none.adjust = SessionAdjust::kNone;
  extend_map(drives()[1], file, none);
  extend_map(drives()[2], file, none);
  // A label drawn on an image of each later visit.
  const Map whole = load_map(file);
  std::vector<OrientedBox> places;
  {
    LabelStore store(file);
    for (const int session : {1, 2})
      for (std::size_t k = 0; k < whole.keyframes.size(); ++k) {
        if (whole.keyframes[k].session != session || whole.keyframes[k].t_ns % 5 != 0) continue;
        const LabelAnchor anchor{session, whole.keyframes[k + 10].t_ns, 0};
        const Eigen::Isometry3d T = whole.T_map_vehicle(static_cast<int>(k) + 10);
        OrientedBox box;
        box.centre = (T * Eigen::Vector3d(6.0, 0.0, 0.0)).head<2>();
        box.heading = heading_of(T);
        box.length_m = 2.0;
        box.width_m = 1.0;
        Label label = label_of_box(whole, anchor, box);
        label.kind = "crossing";
        static_cast<void>(store.create(label, "somebody"));
        places.push_back(*box_in_map(whole, label));
        break;
      }
  }
  ASSERT_EQ(places.size(), 2U);
  const RemoveResult removed = remove_session({file, whole.sessions[1].name, false});
  EXPECT_EQ(removed.labels_moved, 2U);
  EXPECT_EQ(removed.pieces, 1);
  const Map two = load_map(file);
  ASSERT_EQ(two.sessions.size(), 2U);
  EXPECT_EQ(two.sessions[1].name, whole.sessions[2].name);
  EXPECT_EQ(text_of(deep_map_problems(two)), "");
  const auto labels = read_labels(file);
  ASSERT_EQ(labels.size(), 2U);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_EQ(labels[i].anchor.session, 0);
    const auto box = box_in_map(two, labels[i]);
    ASSERT_TRUE(box);
    EXPECT_LT((box->centre - places[i].centre).norm(), 1e-9);
  }
  static_cast<void>(remove_session({file, two.sessions[1].name, false}));
  const Map after = load_map_with_corners(file);
  ASSERT_EQ(after.keyframes.size(), before.keyframes.size());
  for (std::size_t k = 0; k < after.keyframes.size(); ++k)
    EXPECT_EQ(after.T_map_vehicle(static_cast<int>(k)).matrix(),
              before.T_map_vehicle(static_cast<int>(k)).matrix());
  ASSERT_EQ(after.map_frames.size(), before.map_frames.size());
  EXPECT_GE(after.landmarks.size(), before.landmarks.size());
  for (std::size_t l = 0; l < before.landmarks.size(); ++l)
    EXPECT_LT((after.p_map(after.landmarks[l]) - before.p_map(before.landmarks[l])).norm(), 1e-9);
  EXPECT_TRUE(after.landmark_sessions.empty());
  // The only session stays; and the removed drives can come again.
  EXPECT_THROW(static_cast<void>(remove_session({file, whole.sessions[0].name, false})), Refused);
  EXPECT_THROW(static_cast<void>(remove_session({file, "sunday", false})), InvalidOption);
  EXPECT_GT(extend_map(drives()[1], file, none).localised_share.value(), 0.95);
}

// A label that no earlier session shows is named, and deleted only on demand.
TEST_F(Visits, KeepLabelsThatNoOtherShows) {
  const std::filesystem::path file = map_of_first("homeless.gpkg");
  extend_map(drives()[1], file, {});
  const Map map = load_map(file);
  {
    LabelStore store(file);
    OrientedBox box;
    box.centre = (map.T_map_vehicle(10) * Eigen::Vector3d(6.0, 0.0, 0.0)).head<2>();
    box.length_m = 2.0;
    box.width_m = 1.0;
    Label label = label_of_box(map, {0, map.keyframes[10].t_ns, 0}, box);
    label.kind = "crossing";
    static_cast<void>(store.create(label, "somebody"));
  }
  const std::string digest = load_meta(file).digest;
  EXPECT_THROW(static_cast<void>(remove_session({file, map.sessions[0].name, false})), Refused);
  EXPECT_EQ(load_meta(file).digest, digest);
  EXPECT_EQ(remove_session({file, map.sessions[0].name, true}).labels_dropped, 1U);
  EXPECT_TRUE(read_labels(file).empty());
  const Map after = load_map(file);
  EXPECT_EQ(after.sessions.size(), 1U);
  EXPECT_EQ(text_of(deep_map_problems(after)), "");
}

}  // namespace
}  // namespace roadbook
