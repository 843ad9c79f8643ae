#include "workflows/labels/round_replay.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "apps/label_server/learning.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "workflows/labels/label_place.hpp"
#include "workflows/labels/label_replay_run.hpp"

// Replays the rounds of a session from the map's list of events: after a restart of the server, and
// with one click left out.

namespace roadbook {
namespace {

using Json = nlohmann::json;

/// A server without its sockets, on a map file.
class Served {
 public:
  explicit Served(const std::filesystem::path& map)
      : place_(read_label_place(map)),
        store_(map),
        images_(&store_.map(), &drives_, PersonLearnerOptions(), 0.4),
        service_(&store_, &hub_, &images_, place_.classes),
        learning_(
            place_.image,
            BoxLearnerOptions(),
            &service_,
            &hub_,
            {},
            record_on(picture_version(place_.image), place_.learnt_picture, place_.learnt_record),
            [this](const LearningRecord& record) {
              store_.write_table(record_table(picture_version(place_.image), record));
            }) {}

  void draw(const OrientedBox& box, const std::string& kind = test::kSpace) {
    (void)service_.create(Json{{"shape", "box"},
                               {"x", box.centre.x()},
                               {"y", box.centre.y()},
                               {"heading", box.heading},
                               {"length", box.length_m},
                               {"width", box.width_m},
                               {"kind", kind},
                               {"source", kind == test::kSpace ? "drawn" : "accepted"},
                               {"who", "ann"}});
  }
  void nudge(std::int64_t id) {
    const Label label = *store_.find(id);
    OrientedBox box = *box_in_map(store_.map(), label);
    (void)service_.change(
        id, Json{{"version", label.version}, {"who", "ann"}, {"x", box.centre.x() + 0.05}});
  }
  void undo() { (void)service_.undo(Json{{"who", "ann"}}); }
  void learn() {
    const std::size_t before = learning_.progress().at("rounds").size();
    learning_.start(test::kSpace);
    for (int i = 0; i < 2000; ++i) {
      const Json progress = learning_.progress();
      if (progress.at("rounds").size() > before && !progress.at("running").get<bool>()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    FAIL() << "no round in 40 s";
  }

 private:
  LabelPlace place_;
  LabelStore store_;
  std::vector<std::optional<Drive>> drives_ = std::vector<std::optional<Drive>>(1);
  EventHub hub_;
  PeopleImages images_;
  LabelService service_;
  Learning learning_;
};

class RoundReplay : public ::testing::Test {
 protected:
  RoundReplay() {
    std::filesystem::create_directories(folder_);
    lot_.spaces_a_side = 4;
    test::write_lot(map_, lot_);
  }
  ~RoundReplay() override { std::filesystem::remove_all(folder_); }

  // A session of some clicks and three rounds. `restarts`: the server is restarted between any two
  // steps.
  void label(bool restarts) {
    auto server = std::make_unique<Served>(map_);
    const auto again = [&] {
      if (!restarts) return;
      server.reset();
      server = std::make_unique<Served>(map_);
    };
    auto spaces = test::spaces_of(lot_);
    server->draw(spaces[0]);
    again();
    server->draw(spaces[2]);
    again();
    server->learn();
    again();
    server->nudge(1);  // it is the first label still, and was put to the end once
    OrientedBox nothing = spaces[1];
    nothing.centre.y() = 0.0;
    server->draw(nothing, "not_parking_space");
    again();
    server->learn();
    again();
    spaces[5].length_m *= 1.1;  // the mean grows by 3 %, the window stays
    server->draw(spaces[5]);
    server->draw(spaces[6]);
    server->undo();
    again();
    server->learn();
  }
  [[nodiscard]] std::vector<LearningRound> rounds() const {
    return record_from_text(read_label_place(map_).learnt_record).rounds;
  }
  [[nodiscard]] std::string replayed(std::size_t number,
                                     const std::vector<LabelEvent>& events) const {
    return replayed_classifier(load_map(map_), read_label_place(map_).image, {}, {}, events,
                               rounds(), number);
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("round_replay." + std::to_string(getpid()) + "." +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::path map_ = folder_ / "lot.gpkg";
  test::Lot lot_;
};

TEST_F(RoundReplay, GivesTheClassifiersThatThePageHad) {
  label(false);
  const auto events = read_label_events(map_);
  const auto told = rounds();
  ASSERT_EQ(told.size(), 3U);
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].classifier.size(), 16U);
    EXPECT_EQ(replayed(i, events), told[i].classifier) << i;
  }
  EXPECT_NE(told[0].classifier, told[1].classifier);
  EXPECT_NE(told[1].classifier, told[2].classifier);
  EXPECT_EQ(told[0].event, 2);
  EXPECT_EQ(told[1].event, 4);
  EXPECT_EQ(told[2].event, 7);
  EXPECT_EQ(told[0].basis, round_basis(load_map(map_), read_label_place(map_).image, {}));
}

TEST_F(RoundReplay, AServerThatIsStartedAnewLearnsWhatItWouldHaveWithoutThat) {
  label(false);
  const auto told = rounds();
  std::filesystem::remove(map_);
  test::write_lot(map_, lot_);
  label(true);
  const auto again = rounds();
  ASSERT_EQ(again.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i)
    EXPECT_EQ(again[i].classifier, told[i].classifier) << i;
}

// What `roadbook label --replay` says: of the rounds as they are, of one that had another
// classifier, and of one on a picture that is no more.
TEST_F(RoundReplay, IsToldRoundByRound) {
  label(false);
  const auto replay = [&] {
    const Json told = run_replay(map_, {}, 1, NoMessages());
    const Json& rounds = told.at("rounds");
    EXPECT_EQ(told.at("same"), std::none_of(rounds.begin(), rounds.end(), [](const Json& round) {
                return round.at("same") == false;
              }));
    return told.at("rounds");
  };
  const auto write = [&](const LearningRecord& record) {
    MapUpdate update(map_);
    update.write_table(record_table("", record));
    update.commit();
  };
  for (const Json& round : replay()) EXPECT_EQ(round.at("same"), true) << round;
  LearningRecord record;
  record.rounds = rounds();
  record.rounds[1].classifier = "0123456789abcdef";
  record.rounds[2].basis = "0123456789abcdef";
  write(record);
  const Json told = replay();
  EXPECT_EQ(told[0].at("same"), true);
  EXPECT_EQ(told[1].at("same"), false);
  EXPECT_TRUE(told[2].at("same").is_null());
}

TEST_F(RoundReplay, WithAClickLeftOutGivesAnother) {
  label(false);
  const auto events = read_label_events(map_);
  const auto told = rounds();
  for (const LabelEvent& left_out : events) {
    // Drawn and undone before any round used it: the replay without it has no effect either.
    if (left_out.label.id == 5 && left_out.action == LabelAction::kCreate) continue;
    auto fewer = events;
    std::erase_if(fewer, [&](const LabelEvent& event) { return event.event == left_out.event; });
    std::size_t first = 0;  // the round that learnt from it first
    while (told[first].event < left_out.event) ++first;
    EXPECT_NE(replayed(first, fewer), told[first].classifier) << left_out.event;
  }
}

}  // namespace
}  // namespace roadbook
