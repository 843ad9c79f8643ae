#include "semantics/labels/label_evidence.hpp"

#include <gtest/gtest.h>

#include <set>

#include "base/random.hpp"
#include "semantics/labels/label_agreement.hpp"
#include "tests/semantics/two_drives.hpp"

namespace roadbook {
namespace {

using test::kSpaces;
using test::TwoDrives;

TEST(LabelEvidence, ARepaintedRowIsFoundAndHardlyAnythingElse) {
  TwoDrives drives;
  Random random(3, "cars");
  for (int i = -kSpaces; i < kSpaces; ++i) {
    if (random.uniform() < 0.3) drives.first.cars[i] = random.uniform(20.0, 230.0);
    if (random.uniform() < 0.3) drives.second.cars[i] = random.uniform(20.0, 230.0);
  }
  for (int i = 4; i < 9; ++i) drives.second.repainted.insert(i);
  const auto images = drives.images(drives.poses());
  std::set<std::int64_t> gone;
  int found = 0;
  for (const Label& label : drives.spaces()) {
    const LabelEvidence evidence = look_again(drives.map, label, 1, images);
    if (evidence.status == EvidenceStatus::kGone) gone.insert(label.id);
    if (evidence.status == EvidenceStatus::kFound) {
      ++found;
      if (!drives.second.repainted.contains(static_cast<int>(label.id))) {
        EXPECT_LT(evidence.shift.norm(), 0.1) << label.id;
      }
    }
  }
  int right = 0;
  int wrong = 0;
  for (const std::int64_t id : gone)
    (drives.second.repainted.contains(static_cast<int>(id)) ? right : wrong) += 1;
  EXPECT_GE(right, 4);  // of 5
  EXPECT_LE(wrong, 1);  // of 23
  EXPECT_GE(found, 18);
}

TEST(LabelEvidence, LabelsFoundAgainShowABendOfTheMapByTheirImages) {
  TwoDrives drives;
  const auto truth = drives.poses();
  // The second session's wheel size was 2 % wrong: its poses in the map run ahead of the true
  // poses.
  for (std::size_t k = 0; k < drives.map.keyframes.size(); ++k)
    if (drives.map.keyframes[k].session == 1)
      drives.map.map_frames[k].T_map_frame.translation().x() +=
          0.02 * (truth[k].translation().x() + 4.0);
  const auto flagged = [&](const std::vector<Eigen::Isometry3d>& poses) {
    drives.rendered.clear();
    auto labels = drives.spaces();
    std::vector<Label> seen;
    for (std::size_t i = 4; i < labels.size(); i += 2) {
      const LabelEvidence evidence = look_again(drives.map, labels[i], 1, drives.images(poses));
      if (evidence.status != EvidenceStatus::kFound) continue;
      labels[i].sightings.push_back(sighting_of(drives.map, labels[i], evidence));
      seen.push_back(labels[i]);
    }
    EXPECT_GE(seen.size(), 8U);
    const LabelAgreement agreement = agreement_of(drives.map, seen);
    RecordProperty("median_m", std::to_string(agreement.median_m));
    return agreement.contradicts();
  };
  EXPECT_TRUE(flagged(truth));
  EXPECT_FALSE(flagged(drives.poses()));  // the images agree with the map: no label is reported
}

TEST(LabelEvidence, WithoutImagesOrViewsNothingIsSaid) {
  const TwoDrives drives;
  const auto label = drives.spaces().front();
  EXPECT_EQ(look_again(drives.map, label, 1, [](int, int) { return cv::Mat(); }).status,
            EvidenceStatus::kUnseen);
  EXPECT_EQ(look_again(drives.map, label, 7, drives.images(drives.poses())).status,
            EvidenceStatus::kUnseen);
}

}  // namespace
}  // namespace roadbook
