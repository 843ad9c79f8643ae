#include "apps/label_server/label_answers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "semantics/detector/gp_classifier.hpp"
#include "tests/apps/label_server/server_fixture.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;
using test::LabelServerTest;

constexpr std::int64_t kEver = std::numeric_limits<std::int64_t>::max();

Label said(const std::string& kind, LabelSource source, double score, std::int64_t t_ns) {
  Label label;
  label.kind = kind;
  label.source = source;
  label.score = score;
  label.t_ns = t_ns;
  return label;
}

TEST(LabelAnswers, PrecisionIsToldFromWhatASearchHadFoundAlone) {
  const std::vector<Label> labels{
      said(test::kSpace, LabelSource::kAccepted, 0.9, 10),
      said(test::kSpace, LabelSource::kAccepted, 0.4, 20),  // not held for likely
      said("not_parking_space", LabelSource::kDetected, 0.8, 30),
      said(test::kSpace, LabelSource::kAccepted, 1.0, 40),  // without a probability
      said("not_parking_space", LabelSource::kDetected, 1.0, 50),
      said("not_parking_space", LabelSource::kDrawn, 1.0, 60),  // a user rejects an own box
      said(test::kSpace, LabelSource::kDrawn, 1.0, 70),
      said("crossing", LabelSource::kAccepted, 0.9, 80)};
  std::vector<LabelAnswer> answers;
  for (const Label& label : labels)
    if (const auto answer = answer_of(label, test::kSpace)) answers.push_back(*answer);
  EXPECT_EQ(answers.size(), 7U);
  const AnswerCounts all = count_answers(answers, 0.5, 0, kEver);
  EXPECT_EQ(all.accepted, 1U);
  EXPECT_EQ(all.rejected, 1U);
  EXPECT_EQ(all.drawn, 1U);
  const AnswerCounts later = count_answers(answers, 0.3, 20, 30);
  EXPECT_EQ(later.accepted, 1U);
  EXPECT_EQ(later.rejected, 0U);
}

TEST(LabelAnswers, WhatSearchesFoundIsAnsweredInTheOrderOfTime) {
  const auto of_searches = search_answers({{30, false, false, 0.2},
                                           {10, true, false, 0.8},
                                           {20, true, false, std::nullopt},
                                           {25, true, true, std::nullopt}});
  ASSERT_EQ(of_searches.size(), 2U);
  EXPECT_NEAR(of_searches[0].logit, std::log(4.0), 1e-12);
  EXPECT_TRUE(of_searches[0].positive);
  EXPECT_NEAR(of_searches[1].logit, -std::log(4.0), 1e-12);
  EXPECT_FALSE(of_searches[1].positive);
}

// A move or a note is no new answer: the label keeps the answer to its round.
TEST_F(LabelServerTest, AnAnswerIsOfWhenItWasGivenFirst) {
  Json body = Json::parse(space(1.25));
  body["source"] = "accepted";
  body["score"] = 0.8;
  ASSERT_EQ(post("/api/labels", body.dump(), writing()), 200);
  const auto when = [&] { return service_->answers(test::kSpace).at(0).t_ns; };
  const std::int64_t first = when();
  EXPECT_EQ(first, store_->find(1)->t_ns);
  (void)service_->change(1, {{"who", "ann"}, {"version", 1}, {"note", "narrow"}});
  EXPECT_EQ(when(), first);
  EXPECT_GT(store_->find(1)->t_ns, first);
  const LabelService again(store_.get(), &hub_, images_.get(), {});
  EXPECT_EQ(again.answers(test::kSpace).at(0).t_ns, first);
  (void)service_->change(1, {{"who", "ann"}, {"version", 2}, {"kind", "not_parking_space"}});
  EXPECT_EQ(when(), store_->find(1)->t_ns) << "another answer";
}

// The check of the paint searches for these labels.
TEST_F(LabelServerTest, GroundLabelsAreWithoutDeletedAndRejectedOnes) {
  for (const double x : {1.25, 3.75, 6.25}) (void)service_->create(Json::parse(space(x)));
  EXPECT_EQ(service_->ground_labels().size(), 3U);
  (void)service_->remove(1, {{"who", "ann"}, {"version", 1}});
  (void)service_->change(2, {{"who", "ann"}, {"version", 1}, {"kind", "not_parking_space"}});
  const std::vector<Label> left = service_->ground_labels();
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].id, 3);
  EXPECT_TRUE(service_->image_labels().empty());
}

TEST_F(LabelServerTest, ALabelWithoutScoreTellsNothingOfSearches) {
  const auto create = [&](double x, const char* kind, const char* source, const Json& score) {
    Json body = Json::parse(space(x));
    body["kind"] = kind;
    body["source"] = source;
    if (!score.is_null()) body["score"] = score;
    EXPECT_EQ(post("/api/labels", body.dump(), writing()), 200);
  };
  create(1.25, test::kSpace, "accepted", nullptr);
  create(3.75, "not_parking_space", "detected", nullptr);
  create(6.25, test::kSpace, "accepted", 0.75);
  const AnswerCounts counts = count_answers(service_->answers(test::kSpace), 0.5, 0, kEver);
  EXPECT_EQ(counts.accepted, 1U);
  EXPECT_EQ(counts.rejected, 0U);
}

// Until it was given another class it was an answer about parking spaces.
TEST_F(LabelServerTest, AFoundLabelOfAnotherClassTellsNothingOfSearchesAndUndoBringsItsAnswerBack) {
  Json body = Json::parse(space(1.25));
  body["source"] = "accepted";
  body["score"] = 0.9;
  const Json found = service_->create(body);
  const auto counts = [&](const char* kind) {
    return count_answers(service_->answers(kind), 0.5, 0, kEver);
  };
  EXPECT_EQ(counts(test::kSpace).accepted, 1U);
  body.update(found);  // as the page sends it: with all that it knows of the label
  body["kind"] = "crossing";
  const Json changed = service_->change(found.at("id"), body);
  EXPECT_EQ(changed.at("score"), 1.0);
  EXPECT_EQ(changed.at("source"), "drawn");
  EXPECT_EQ(counts(test::kSpace).accepted, 0U);
  EXPECT_EQ(counts("crossing").accepted, 0U);
  EXPECT_TRUE(search_answers(service_->answers(test::kSpace)).empty());
  EXPECT_TRUE(search_answers(service_->answers("crossing")).empty());
  (void)service_->undo({{"who", "ann"}});
  EXPECT_EQ(counts(test::kSpace).accepted, 1U);
  EXPECT_EQ(store_->find(found.at("id"))->score, 0.9);
}

// A user who changes an answer answers the same search.
TEST_F(LabelServerTest, AnAnswerTurnedRoundKeepsHowLikelyItWasFound) {
  Json body = Json::parse(space(1.25));
  body["source"] = "accepted";
  body["score"] = 0.9;
  const Json found = service_->create(body);
  body.update(found);
  body["kind"] = "not_parking_space";
  EXPECT_EQ(service_->change(found.at("id"), body).at("score"), 0.9);
  const AnswerCounts counts = count_answers(service_->answers(test::kSpace), 0.5, 0, kEver);
  EXPECT_EQ(counts.accepted, 0U);
  EXPECT_EQ(counts.rejected, 1U);
}

// Of nine hypotheses with probability 0.9, three were right. The most likely shift s solves, by
// hand, 3 - 9 p(ln 9 + s) = 10 / 3 s / 4 with the logistic function p: s = -2.0898, where p =
// 0.52683. (Ten answers of the rarer kind would make the prior s / 4.) Drawn labels, answers
// without a score, and labels of other classes do not count. Stored probabilities and the threshold
// of likely hypotheses stay unchanged.
TEST_F(LabelServerTest, AnswersShiftWhatThePageSaysOfAHypothesis) {
  const double by_hand = -2.0898;
  const auto create = [&](double x, double y, const char* kind, const char* source, double score) {
    Json body = Json::parse(space(x));
    body["y"] = y;
    body["kind"] = kind;
    body["source"] = source;
    body["score"] = score;
    EXPECT_EQ(post("/api/labels", body.dump(), writing()), 200);
  };
  create(1.25, 5.5, test::kSpace, "drawn", 0.99);
  create(6.25, 5.5, test::kSpace, "accepted", 1.0);
  create(6.25, -5.5, "crossing", "accepted", 0.02);
  for (int i = 0; i < 6; ++i) create(0.5 + i, 0.0, "not_parking_space", "detected", 0.9);
  for (int i = 0; i < 3; ++i) create(1.25 + 0.02 * i, -5.5, test::kSpace, "accepted", 0.9);
  EXPECT_EQ(post("/api/learn", R"({"kind": "parking_space"})", writing()), 202);
  do std::this_thread::sleep_for(std::chrono::milliseconds(20));
  while (learning_->progress().at("running").get<bool>());
  const Json list = learning_->hypotheses().at("hypotheses");
  int told = 0;
  for (const Json& h : list) {
    if (h.at("probability") < 1e-9) continue;  // as good as none: no logit is farther out
    EXPECT_NEAR(logit_of(h.at("calibrated")), logit_of(h.at("probability")) + by_hand, 1e-3);
    ++told;
  }
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace roadbook
