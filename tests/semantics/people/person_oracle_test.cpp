#include "semantics/people/person_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/apps/label_server/crowd.hpp"

namespace roadbook {
namespace {

// The recording of the car park with its pedestrians, in memory: one instant a frame.
struct Recording {
  std::vector<PersonCamera> cameras;
  std::vector<PeopleFrame> frames;
  std::vector<std::vector<TruePerson>> people;
};

Recording recorded(const std::string& name) {
  Recording recording;
  const Rig rig = test::fisheye_rig();
  for (const MountedCamera& mounted : rig.cameras)
    recording.cameras.emplace_back(mounted, cv::Mat());
  const auto crowd = test::crowd();
  for (int instant = 0; instant < test::kInstants; ++instant) {
    PeopleFrame frame;
    frame.name = name + ' ' + std::to_string(instant);
    recording.people.emplace_back();
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      const MountedCamera& mounted = rig.cameras[c];
      cv::Mat image = test::crowd_background(
          mounted.camera.width, mounted.camera.height,
          static_cast<std::uint64_t>(instant) * 10 + static_cast<std::uint64_t>(c));
      for (const test::Somebody& one : crowd)
        if (one.image.t_ns == test::crowd_stamp(instant) &&
            one.image.camera == static_cast<int>(c)) {
          test::paint_somebody(mounted, one.box, &image);
          recording.people.back().push_back({one.box, true});
        }
      cv::GaussianBlur(image, image, {3, 3}, 0.0);
      frame.images.push_back(image_pyramid(image));
    }
    recording.frames.push_back(std::move(frame));
  }
  return recording;
}

// Plays rounds of two instants each.
PersonExamples played(const Recording& recording, PersonExamples before) {
  PersonLearner learner(recording.cameras, {});
  learner.start_from(std::move(before));
  (void)learner.learn();
  PersonRound total;
  for (std::size_t i = 0; i + 2 <= recording.frames.size(); i += 2)
    total = play_person_round({recording.frames.begin() + static_cast<std::ptrdiff_t>(i),
                               recording.frames.begin() + static_cast<std::ptrdiff_t>(i + 2)},
                              {recording.people.begin() + static_cast<std::ptrdiff_t>(i),
                               recording.people.begin() + static_cast<std::ptrdiff_t>(i + 2)},
                              {}, learner, total);
  return learner.examples();
}

// Number of hypotheses with a probability of at least `least` that overlap no pedestrian.
std::size_t false_alarms(const Recording& recording, const PersonLearner& learner, double least) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < recording.frames.size(); ++i)
    for (const PersonHypothesis& h : learner.find(recording.frames[i]))
      if (h.prediction.probability >= least &&
          std::none_of(recording.people[i].begin(), recording.people[i].end(),
                       [&](const TruePerson& person) {
                         return intersection_over_union(h.box, person.box) >= 0.2;
                       }))
        ++wrong;
  return wrong;
}

// A mark "no other people" covers the whole image, also for the classifier that this round trains.
// The first round begins without a classifier, so its only false alarms are those of the classifier
// that it trains.
TEST(PersonOracle, ARoundLearnsFromTheFalseAlarmsOfItsOwnClassifier) {
  Recording recording = recorded("lot");
  recording.frames.resize(2);
  recording.people.resize(2);
  const auto play = [&](double likely_negative) {
    PersonLearner learner(recording.cameras, {});
    PersonOracleOptions options;
    options.likely_negative = likely_negative;
    (void)play_person_round(recording.frames, recording.people, options, learner, {});
    return learner;
  };
  const PersonLearner without = play(1.1);  // no hypothesis is likely enough to become an example
  const std::size_t alarms = false_alarms(recording, without, 0.1);
  ASSERT_GT(alarms, 4U);
  EXPECT_EQ(play(0.1).examples().size(), without.examples().size() + alarms);
}

TEST(PersonOracle, AnswersAboutImagesThatWereLearntFromDoNotCountAgain) {
  const Recording recording = recorded("lot");
  const PersonExamples once = played(recording, {});
  ASSERT_GT(once.answers.size(), 20U);
  EXPECT_EQ(once.instants.size(), 6U) << "the seventh fills no round";
  const PersonExamples twice = played(recording, once);
  EXPECT_EQ(twice.answers, once.answers);
  EXPECT_EQ(twice.instants, once.instants);
  // No window becomes an example twice.
  std::set<std::vector<float>> windows;
  for (const Eigen::VectorXf& f : twice.features) windows.insert({f.data(), f.data() + f.size()});
  EXPECT_EQ(windows.size(), twice.size());
  // Another recording counts as new, even with the same content.
  EXPECT_GT(played(recorded("other"), once).answers.size(), once.answers.size());
}

}  // namespace
}  // namespace roadbook
