#include <gtest/gtest.h>

#include "apps/label_server/people_wire.hpp"
#include "semantics/detector/gp_classifier.hpp"
#include "semantics/people/person_labels.hpp"
#include "tests/apps/label_server/people_served.hpp"
#include "workflows/labels/taught_people.hpp"
#include "workflows/people/people_store.hpp"

// Teaching people through the server's requests.

namespace roadbook {
namespace {

using Json = nlohmann::json;

class PeopleApi : public test::PeopleServed {};

TEST_F(PeopleApi, SomebodyDrawnWithTwoClicksIsAWindowWithItsPictureAndNothingOnTheGround) {
  const test::Somebody one = test::crowd().front();
  const auto [status, label] = ask("POST", "/api/labels", drawn(one));
  ASSERT_EQ(status, 200) << label;
  EXPECT_NEAR(label.at("azimuth"), one.box.azimuth, 1e-6);
  EXPECT_NEAR(label.at("foot_slope"), one.box.foot_slope, 1e-6);
  EXPECT_NEAR(label.at("size"), one.box.size, 1e-6);
  EXPECT_NEAR(label.at("head")[1], one.head.y(), 1e-6);
  EXPECT_TRUE(read_labels(map_).empty());
  const auto stored = read_image_labels(map_);
  ASSERT_EQ(stored.size(), 1U);
  EXPECT_EQ(stored.front().who, "ann");
  EXPECT_EQ(stored.front().pictures, std::vector{images_->picture(one.image, one.box)});
  EXPECT_TRUE(get("/api/progress").at("counts").empty());
  EXPECT_EQ(get("/api/start").at("classes").at("classes").size(), 2U);
  // Another user corrected it. A user who saw only the old version cannot correct it again.
  Json body = drawn(one);
  body["version"] = 1;
  body["who"] = "bob";
  body["head"][1] = one.head.y() - 4.0;
  EXPECT_EQ(ask("PUT", "/api/labels/1", body).first, 200);
  body["who"] = "ann";
  const auto [late, answer] = ask("PUT", "/api/labels/1", body);
  EXPECT_EQ(late, 409);
  EXPECT_EQ(answer.at("current").at("who"), "bob");
  EXPECT_GT(read_image_labels(map_).front().window.size, one.box.size);
}

TEST_F(PeopleApi, AnImageIsDoneAndTakenBackAsOneStep) {
  const LabelAnchor image = test::crowd().front().image;
  const Json labels = teach(image);
  EXPECT_EQ(labels.size(), 3U);
  EXPECT_TRUE(get(path_of(image)).at("done"));
  // Two people, each with a mirror image, and windows that show neither.
  const PersonExamples taught = taught_examples(map_);
  EXPECT_EQ(taught.positives(), 4U);
  EXPECT_GE(taught.size(), 6U);
  EXPECT_EQ(ask("POST", "/api/undo", {{"who", "ann"}, {"request", "u"}}).second.at("labels").size(),
            3U);
  EXPECT_TRUE(read_image_labels(map_).empty());
  EXPECT_FALSE(get(path_of(image)).at("done"));
  EXPECT_EQ(ask("POST", "/api/redo", {{"who", "ann"}, {"request", "r"}}).second.at("labels").size(),
            3U);
  EXPECT_EQ(taught_examples(map_).features, taught.features);
}

TEST_F(PeopleApi, WhatIsTaughtFindsPeopleInOtherImagesAndOutlivesTheServer) {
  EXPECT_EQ(ask("POST", "/api/people/learn", Json::object()).first, 422);
  const Json first = get("/api/people");
  EXPECT_EQ(first.at("images"), 28U);
  EXPECT_EQ(first.at("queue").size(), 24U);
  std::set<std::string> taught;
  const auto teach_first = [&](std::size_t count) {
    const Json queue = get("/api/people").at("queue");
    for (std::size_t i = 0; i < count; ++i) {
      const LabelAnchor image = image_from_wire(queue.at(i));
      EXPECT_FALSE(get(path_of(image)).at("done").get<bool>());
      teach(image);
      taught.insert(path_of(image));
    }
  };
  teach_first(6);
  learn();
  teach_first(6);
  learn();
  teach_first(4);
  const Json overview = learn();
  EXPECT_EQ(overview.at("round"), 3);
  EXPECT_EQ(overview.at("done"), 16U);
  EXPECT_EQ(overview.at("queue").size(), 12U);
  std::size_t right = 0;
  std::size_t wrong = 0;
  std::size_t people = 0;
  for (const LabelAnchor& image : images_->all()) {
    if (taught.contains(path_of(image))) continue;
    const auto there = people_in(image);
    people += there.size();
    const Json shown = get(path_of(image));
    for (const Json& h : shown.at("hypotheses"))
      if (h.at("probability") >= 0.5) ++(is_on(h, image.camera, there, 0.5) ? right : wrong);
  }
  ASSERT_GT(people, 8U);
  EXPECT_GE(right, people * 9 / 10);
  EXPECT_LE(wrong, people / 10);
  const Json before = get("/api/people");
  const std::string asked = path_of(images_->all().back());
  const Json shown = get(asked);
  close();
  open();
  EXPECT_EQ(get("/api/people"), before);
  EXPECT_EQ(get(asked), shown);
}

// Eight of ten hypotheses were no people: the page shifts the log-odds of the next ones by one
// value.
TEST_F(PeopleApi, AnswersShiftWhatThePageSaysOfAHypothesis) {
  for (int round = 0; round < 2; ++round) {
    const Json queue = get("/api/people").at("queue");
    for (std::size_t i = 0; i < 6; ++i) teach(image_from_wire(queue.at(i)));
    learn();
  }
  // By how much the logit of the least sure one is shifted; it must be that of all.
  const auto shift_of_all = [&] {
    std::vector<std::pair<double, double>> said;
    for (const LabelAnchor& image : images_->all()) {
      const Json shown = get(path_of(image));
      for (const Json& h : shown.at("hypotheses"))
        said.emplace_back(logit_of(h.at("probability")), h.at("calibrated"));
    }
    EXPECT_GT(said.size(), 5U);
    const auto [logit, calibrated] = *std::min_element(
        said.begin(), said.end(),
        [](const auto& a, const auto& b) { return std::abs(a.first) < std::abs(b.first); });
    const double shift = logit_of(calibrated) - logit;
    for (const auto& [l, p] : said) EXPECT_NEAR(p, 1.0 / (1.0 + std::exp(-l - shift)), 1e-11);
    return shift;
  };
  EXPECT_NEAR(shift_of_all(), 0.0, 1e-9);
  for (int i = 0; i < 10; ++i) {
    Json body = window(images_->all().back(), i < 2 ? "person" : "not_person");
    body.update({{"source", i < 2 ? "accepted" : "detected"}, {"score", 0.9}});
    body.update({{"azimuth", 0.2 * i - 1.0}, {"foot_slope", -0.3}, {"size", 0.2}});
    EXPECT_EQ(ask("POST", "/api/labels", body).first, 200);
  }
  EXPECT_LT(shift_of_all(), -1.0);
}

TEST_F(PeopleApi, WrongWindowsAndImagesAreNamed) {
  const auto refused = [&](const char* field, const Json& value, const char* word) {
    Json body = drawn(test::crowd().front());
    body[field] = value;
    const auto [status, answer] = ask("POST", "/api/labels", body);
    EXPECT_EQ(status, 422) << field;
    EXPECT_NE(answer.at("error").get<std::string>().find(word), std::string::npos) << answer;
  };
  refused("t_ns", "1400000000000000001", "image");
  refused("t_ns", "../../etc/passwd", "t_ns");
  refused("t_ns", 1.4e18, "t_ns");
  refused("session", 1, "image");
  refused("session", -1, "session");
  refused("camera", 4, "image");
  refused("foot", {-5.0, 10.0}, "foot");
  refused("foot", "here", "foot");
  refused("head", {10.0, 470.0}, "head");
  refused("kind", "dog", "kind");
  refused("score", 2.0, "score");
  refused("shape", "image", "kind");
  for (const char* path :
       {"/api/people/0/0/0", "/api/people/0/1400000000000000000/9", "/api/people/9/1/0",
        "/api/people/0/..%2f/0", "/api/people/-1/1400000000000000000/0"})
    EXPECT_EQ(ask("GET", path, Json::object()).first, 404) << path;
  EXPECT_TRUE(store_->labels().empty());
}

}  // namespace
}  // namespace roadbook
