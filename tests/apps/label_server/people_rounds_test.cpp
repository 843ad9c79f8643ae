#include <gtest/gtest.h>

#include "apps/label_server/people_wire.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/people/person_labels.hpp"
#include "tests/apps/label_server/people_served.hpp"
#include "workflows/labels/label_replay_run.hpp"
#include "workflows/labels/people_training.hpp"
#include "workflows/labels/taught_people.hpp"
#include "workflows/people/people_detect.hpp"
#include "workflows/people/people_store.hpp"

// What rounds about people learn without a question, and that they can be played again.

namespace roadbook {
namespace {

using Json = nlohmann::json;

class PeopleRounds : public test::PeopleServed {
 protected:
  PeopleRounds() : PeopleServed(PeopleDetectOptions().learner) {}  // the program's

  [[nodiscard]] PeopleRecord record() const { return read_people_record(MapLayers(map_)); }

  std::vector<LabelAnchor> teach_next(std::size_t count) {
    std::vector<LabelAnchor> taught;
    const Json queue = get("/api/people").at("queue");
    for (std::size_t i = 0; i < count; ++i) {
      taught.push_back(image_from_wire(queue.at(i)));
      teach(taught.back());
    }
    return taught;
  }
  void undo(const std::string& request) {
    EXPECT_EQ(ask("POST", "/api/undo", {{"who", "ann"}, {"request", request}}).first, 200);
  }
  /// The window in the image at full resolution, not in its stored thumbnail.
  void add_window(const LabelAnchor& image, const PersonBox& box, PersonExamples& examples) const {
    const auto& drive = *drives_.front();
    const PersonCamera camera(
        store_->map().sessions.front().rig.cameras[static_cast<std::size_t>(box.camera)],
        cv::Mat());
    const cv::Mat grey =
        drive.read_image(*frame_at(drive, image.t_ns), static_cast<std::size_t>(box.camera));
    add_example(PersonWindow(), camera.cut(image_pyramid(grey), PersonWindow::patch(box)), false,
                examples);
  }
  [[nodiscard]] GpClassifier learnt_of(const PersonExamples& examples) const {
    PersonLearner learner({}, options_);
    learner.start_from(examples);
    EXPECT_TRUE(learner.learn());
    return *learner.classifier();
  }
  /// Six images, a round; one answer undone, four more, a round; two more, a round.
  void label(bool restarts) {
    const auto again = [&] {
      if (!restarts) return;
      close();
      open();
    };
    teach_next(6);
    learn();
    again();
    undo("u");
    again();
    teach_next(4);
    again();
    learn();
    again();
    teach_next(2);
    again();
    learn();
  }
};

TEST_F(PeopleRounds, LearnFromWhatTheyTakeForSomebodyWhereNobodyIs) {
  const auto taught = teach_next(6);
  learn();
  const PeopleRecord told = record();
  const PersonExamples answers = examples_of(read_image_labels(map_));
  const GpClassifier first = learnt_of(answers);
  PersonExamples all = answers;
  double before = 0.0;
  ASSERT_EQ(told.looks.size(), taught.size());
  std::size_t alarms = 0;
  for (std::size_t i = 0; i < taught.size(); ++i) {
    EXPECT_EQ(told.looks[i].image, taught[i]);
    std::vector<PersonBox> wrong;
    for (const PersonHypothesis& h : images_->search(taught[i], first)) {
      const auto people = people_in(taught[i]);
      if (h.prediction.probability < 0.1 ||
          std::any_of(people.begin(), people.end(), [&](const PersonBox& person) {
            return intersection_over_union(person, h.box) > 0.2;
          }))
        continue;
      wrong.push_back(h.box);
      before += h.prediction.mean;
      add_window(taught[i], h.box, all);
    }
    ASSERT_EQ(told.looks[i].alarms.size(), wrong.size()) << i;
    for (std::size_t k = 0; k < wrong.size(); ++k)
      EXPECT_GT(intersection_over_union(told.looks[i].alarms[k].box, wrong[k]), 0.999);
    alarms += wrong.size();
  }
  ASSERT_GT(alarms, 3U);
  EXPECT_EQ(told.rounds.front().again, alarms);
  EXPECT_EQ(get("/api/people").at("rounds").at(0).at("again"), alarms);
  const GpClassifier second = learnt_of(all);
  EXPECT_EQ(told.rounds.front().classifier, second.digest());
  double after = 0.0;
  for (std::size_t i = answers.size(); i < all.size(); ++i)
    after += second.predict(all.features[i].cast<double>()).mean;
  EXPECT_LT(after, before - 0.1 * static_cast<double>(alarms));
  EXPECT_EQ(taught_examples(map_).features, all.features);             // what `detect` begins with
  EXPECT_EQ(read_image_labels(map_).size(), store_->labels().size());  // nothing is an answer
}

TEST_F(PeopleRounds, ForgetWhatTheySawInAnImageThatIsNoMoreDone) {
  auto taught = teach_next(6);
  learn();
  const auto count = [&](const LabelAnchor& image) {
    for (const SecondLook& look : record().looks)
      if (look.image == image) return static_cast<int>(look.alarms.size());
    return -1;
  };
  // Answers from the last image with a false alarm on are undone.
  int taken_back = 0;
  while (count(taught.back()) <= 0) {
    undo("u" + std::to_string(taken_back++));
    taught.pop_back();
    ASSERT_FALSE(taught.empty());
  }
  const LabelAnchor image = taught.back();
  const int alarms = count(image);
  const std::size_t answers = examples_of(read_image_labels(map_)).size();
  const std::size_t before = taught_examples(map_).size() - answers;
  undo("the image");
  const std::size_t fewer = examples_of(read_image_labels(map_)).size();
  EXPECT_EQ(taught_examples(map_).size() - fewer, before - static_cast<std::size_t>(alarms));
  learn();
  EXPECT_EQ(count(image), -1);
  EXPECT_EQ(taught_examples(map_).size() - fewer, before - static_cast<std::size_t>(alarms));
  EXPECT_EQ(ask("POST", "/api/redo", {{"who", "ann"}, {"request", "redo"}}).first, 200);
  learn();
  EXPECT_GE(count(image), 0);
}

TEST_F(PeopleRounds, DoNotTakeForNobodyWhoIsShownThereLater) {
  teach_next(6);
  learn();
  const auto looks = record().looks;
  const auto look = std::find_if(looks.begin(), looks.end(),
                                 [](const SecondLook& one) { return !one.alarms.empty(); });
  ASSERT_NE(look, looks.end());
  const PersonBox& box = look->alarms.front().box;
  const std::size_t before = taught_examples(map_).size();
  Json body = window(look->image, "person");
  body.update({{"azimuth", box.azimuth}, {"foot_slope", box.foot_slope}, {"size", box.size}});
  EXPECT_EQ(ask("POST", "/api/labels", body).first, 200);
  EXPECT_EQ(taught_examples(map_).size(), before + 2 - 1);  // with a mirror image
}

TEST_F(PeopleRounds, LookAtSoManyImagesThatTheyStayQuickAndAtTheOthersNextTime) {
  const auto all = images_->all();
  ASSERT_GT(all.size(), 24U);
  for (const LabelAnchor& image : all) teach(image);
  learn();
  const auto first = record().looks;
  ASSERT_EQ(first.size(), 24U);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].image, all[i]);
  learn();
  EXPECT_EQ(record().looks.size(), all.size());
}

TEST_F(PeopleRounds, LearnTheSameWhereTheServerIsStartedAnew) {
  label(false);
  const auto told = record().rounds;
  ASSERT_EQ(told.size(), 3U);
  close();
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_);
  test::write_crowd(map_);
  open();
  label(true);
  const auto again = record().rounds;
  ASSERT_EQ(again.size(), 3U);
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].classifier.size(), 16U);
    EXPECT_EQ(again[i].classifier, told[i].classifier) << i;
  }
}

TEST_F(PeopleRounds, PlayedAgainGiveTheClassifiersThatThePageHad) {
  label(false);
  const auto told = record().rounds;
  const auto events = read_label_events(map_);
  const auto replayed = [&](const std::vector<LabelEvent>& history) {
    return replayed_people(*images_, place_.people, options_, history, told);
  };
  const auto again = replayed(events);
  ASSERT_EQ(again.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(again[i].classifier, told[i].classifier) << i;
    EXPECT_EQ(again[i].basis, told[i].basis) << i;
  }
  EXPECT_NE(told[0].classifier, told[1].classifier);
  EXPECT_NE(told[1].classifier, told[2].classifier);
  auto fewer = events;  // without the first of all clicks
  fewer.erase(fewer.begin());
  const auto without = replayed(fewer);
  for (std::size_t i = 0; i < told.size(); ++i)
    EXPECT_NE(without[i].classifier, told[i].classifier) << i;
}

// What `roadbook label --replay` says: of rounds as they are, of one that had another classifier,
// and of one that knew something else, with that after it.
TEST_F(PeopleRounds, AreToldOneByOne) {
  label(false);
  close();
  const auto replay = [&] {
    const Json told = run_replay(map_, {}, 1, NoMessages());
    const Json& rounds = told.at("people");
    EXPECT_EQ(told.at("same"), std::none_of(rounds.begin(), rounds.end(), [](const Json& round) {
                return round.at("same") == false;
              }));
    EXPECT_TRUE(told.at("rounds").empty());
    return told.at("people");
  };
  const auto write = [&](const PeopleRecord& changed) {
    MapUpdate update(map_);
    update.write_table(people_record_table(changed));
    update.commit();
  };
  for (const Json& round : replay()) EXPECT_EQ(round.at("same"), true) << round;
  PeopleRecord changed = record();
  changed.rounds[2].classifier = "0123456789abcdef";
  write(changed);
  const Json one_other = replay();
  EXPECT_EQ(one_other[1].at("same"), true);
  EXPECT_EQ(one_other[2].at("same"), false);
  changed.rounds[1].basis = "0123456789abcdef";
  write(changed);
  const Json broken = replay();
  EXPECT_EQ(broken[0].at("same"), true);
  EXPECT_TRUE(broken[1].at("same").is_null());
  EXPECT_TRUE(broken[2].at("same").is_null());
}

}  // namespace
}  // namespace roadbook
