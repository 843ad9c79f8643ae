#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "apps/label_server/label_api.hpp"
#include "apps/label_server/people_wire.hpp"
#include "apps/people_store.hpp"
#include "semantics/gp_classifier.hpp"
#include "semantics/person_labels.hpp"
#include "tests/label_page/crowd.hpp"

// Teaching people through the server's requests.

namespace roadbook {
namespace {

using Json = nlohmann::json;

class PeopleApi : public ::testing::Test {
 protected:
  PeopleApi() {
    folder_ = std::filesystem::temp_directory_path() /
              ("people_api." + std::to_string(getpid()) + "." +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    map_ = folder_ / "lot.gpkg";
    test::write_crowd(map_);
    drives_.emplace_back(Drive::open(folder_ / "drive"));
    open();
  }
  ~PeopleApi() override {
    close();
    std::filesystem::remove_all(folder_);
  }
  void open() {
    place_ = read_label_place(map_);
    store_ = std::make_unique<LabelStore>(map_);
    views_ = std::make_unique<AnchorViews>(&store_->map(), &drives_);
    tiles_ = std::make_unique<TilePyramid>(place_.image);
    images_ = std::make_unique<PeopleImages>(&store_->map(), &drives_, options_, 0.4);
    book_ = std::make_unique<LabelBook>(store_.get(), &hub_, images_.get(), place_.classes);
    learning_ = std::make_unique<Learning>(place_.image, BoxLearnerOptions(), book_.get(), &hub_);
    people_ = std::make_unique<PeopleLearning>(
        images_.get(), book_.get(), &hub_, place_.people, options_,
        people_record_from_text(place_.people_record),
        [this](const PeopleRecord& record) { store_->write_table(people_record_table(record)); });
    paint_ = std::make_unique<PaintWatch>(book_.get(), KeyframeImages(), &hub_);
    api_ = std::make_unique<LabelApi>(LabelApi::Parts{&place_, "1", tiles_.get(), views_.get(),
                                                      book_.get(), learning_.get(), people_.get(),
                                                      paint_.get(), &hub_, "ann"});
  }
  void close() {
    api_.reset();
    people_.reset();
    paint_.reset();
    learning_.reset();
    book_.reset();
    images_.reset();
    store_.reset();
  }

  std::pair<int, Json> ask(const std::string& method, const std::string& path, const Json& body) {
    const HttpResponse answer = api_->answer({method, path, "", {}, body.dump()});
    return {answer.status, Json::parse(answer.body)};
  }
  Json get(const std::string& path) { return ask("GET", path, Json::object()).second; }
  static Json window(const LabelAnchor& image, const std::string& kind) {
    return {{"shape", "upright"}, {"session", image.session},
            {"kind", kind},       {"t_ns", std::to_string(image.t_ns)},
            {"source", "drawn"},  {"camera", image.camera},
            {"who", "ann"}};
  }
  static Json drawn(const test::Somebody& one) {
    Json body = window(one.image, "person");
    body["foot"] = {one.foot.x(), one.foot.y()};
    body["head"] = {one.head.x(), one.head.y()};
    return body;
  }
  static std::string path_of(const LabelAnchor& image) {
    return "/api/people/" + std::to_string(image.session) + "/" + std::to_string(image.t_ns) + "/" +
           std::to_string(image.camera);
  }
  static std::vector<PersonBox> people_in(const LabelAnchor& image) {
    std::vector<PersonBox> boxes;
    for (const auto& one : test::crowd())
      if (one.image.t_ns == image.t_ns && one.image.camera == image.camera)
        boxes.push_back(one.box);
    return boxes;
  }
  static bool is_on(const Json& h, int camera, const std::vector<PersonBox>& people, double least) {
    const PersonBox box{camera, h.at("azimuth"), h.at("foot_slope"), h.at("size")};
    return std::any_of(people.begin(), people.end(), [&](const PersonBox& other) {
      return intersection_over_union(box, other) > least;
    });
  }
  /// Says all there is to say about an image, as one request: who is there, which hypotheses are
  /// nobody, and that nobody else is.
  Json teach(const LabelAnchor& image) {
    Json labels = Json::array();
    for (const auto& one : test::crowd())
      if (one.image.t_ns == image.t_ns && one.image.camera == image.camera)
        labels.push_back(drawn(one));
    const Json shown = get(path_of(image));
    for (const Json& h : shown.at("hypotheses")) {
      if (is_on(h, image.camera, people_in(image), 0.2)) continue;
      labels.push_back(window(image, "not_person"));
      for (const char* field : {"azimuth", "foot_slope", "size"})
        labels.back()[field] = h.at(field);
    }
    labels.push_back(window(image, "not_person"));
    labels.back()["shape"] = "image";
    const Json body = {{"who", "ann"}, {"labels", labels}, {"request", path_of(image)}};
    return ask("POST", "/api/labels", body).second.at("labels");
  }
  Json learn() {
    EXPECT_EQ(ask("POST", "/api/people/learn", Json::object()).first, 202);
    Json overview;
    do {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      overview = get("/api/people");
    } while (overview.at("running").get<bool>());
    return overview;
  }

  PersonLearnerOptions options_;
  std::filesystem::path folder_;
  std::filesystem::path map_;
  std::vector<std::optional<Drive>> drives_;
  LabelPlace place_;
  EventHub hub_;
  std::unique_ptr<LabelStore> store_;
  std::unique_ptr<AnchorViews> views_;
  std::unique_ptr<TilePyramid> tiles_;
  std::unique_ptr<PeopleImages> images_;
  std::unique_ptr<LabelBook> book_;
  std::unique_ptr<Learning> learning_;
  std::unique_ptr<PeopleLearning> people_;
  std::unique_ptr<PaintWatch> paint_;
  std::unique_ptr<LabelApi> api_;
};

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
  // Put right by somebody else, and no more by whoever has seen the old one only.
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

// Eight hypotheses in ten were nobody: what the page tells of the next ones is by one shift of the
// logit less than what they are held for.
TEST_F(PeopleApi, AnswersShiftWhatThePageSaysOfAHypothesis) {
  for (int round = 0; round < 2; ++round) {
    const Json queue = get("/api/people").at("queue");
    for (std::size_t i = 0; i < 6; ++i) teach(image_from_wire(queue.at(i)));
    learn();
  }
  const auto shifts = [&] {
    std::vector<double> logits;
    for (const LabelAnchor& image : images_->all()) {
      const Json shown = get(path_of(image));
      for (const Json& h : shown.at("hypotheses"))
        logits.push_back(logit_of(h.at("calibrated")) - logit_of(h.at("probability")));
    }
    return logits;
  };
  for (const double shift : shifts()) EXPECT_NEAR(shift, 0.0, 1e-9);
  for (int i = 0; i < 10; ++i) {
    Json body = window(images_->all().back(), i < 2 ? "person" : "not_person");
    body.update({{"source", i < 2 ? "accepted" : "detected"}, {"score", 0.9}});
    body.update({{"azimuth", 0.2 * i - 1.0}, {"foot_slope", -0.3}, {"size", 0.2}});
    EXPECT_EQ(ask("POST", "/api/labels", body).first, 200);
  }
  const auto after = shifts();
  ASSERT_GT(after.size(), 5U);
  EXPECT_LT(after.front(), -1.0);
  for (const double shift : after) EXPECT_NEAR(shift, after.front(), 1e-9);
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
