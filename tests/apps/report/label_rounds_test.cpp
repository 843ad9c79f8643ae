#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mapping/store/map_file.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/semantics/label_store_fixture.hpp"
#include "workflows/labels/learning_record.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {
namespace {

class LabelRoundsReport : public test::LabelStoreTest {
 protected:
  nlohmann::json report() {
    const auto run = test::run_command("roadbook report -m map.gpkg -o r.html --json", folder_);
    EXPECT_EQ(run.status, 0) << run.err;
    page_ = test::read_text(folder_ / "r.html");
    return run.status == 0 ? nlohmann::json::parse(run.out).at("labels") : nlohmann::json();
  }

  std::string page_;
};

// Rounds of the page with the names of their classifiers. An older program wrote the last one
// without a name.
TEST_F(LabelRoundsReport, TellsEachRoundAndTheNameOfItsClassifier) {
  {
    LabelStore store(map_);
    store.create(space(store, 1.0), "ann");
  }
  EXPECT_TRUE(report().at("rounds").empty());
  EXPECT_EQ(page_.find("Rounds of learning"), std::string::npos);
  LearningRecord ground;
  ground.rounds.push_back({1, "parking_space", 77, 0.5, 3, 4, 1, 1, 0, 3, "", "0123456789abcdef"});
  PeopleRecord people;
  people.rounds.push_back({1, 78, 1.5, 5, 30, 24, 7, 9, 3, "", "fedcba9876543210"});
  people.rounds.push_back({2, 79, 1.5, 6, 31, 24, 8});
  MapUpdate update(map_);
  update.write_table(record_table("a picture", ground));
  update.write_table(people_record_table(people));
  update.commit();
  const nlohmann::json rounds = report().at("rounds");
  ASSERT_EQ(rounds.size(), 3U);
  EXPECT_EQ(rounds[0].at("class"), "parking_space");
  EXPECT_EQ(rounds[0].at("classifier"), "0123456789abcdef");
  EXPECT_EQ(rounds[1].at("class"), "person");
  EXPECT_EQ(rounds[1].at("classifier"), "fedcba9876543210");
  EXPECT_EQ(rounds[1].at("examples"), 5);
  EXPECT_EQ(rounds[1].at("none"), 30);
  EXPECT_EQ(rounds[1].at("again"), 9);
  EXPECT_TRUE(rounds[2].at("classifier").is_null());
  for (const char* told : {">01234567<", ">fedcba98<", ">not told<"})
    EXPECT_NE(page_.find(told), std::string::npos) << told;
}

}  // namespace
}  // namespace roadbook
