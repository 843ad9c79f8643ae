#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "apps/label_server/label_api.hpp"
#include "tests/label_page/crowd.hpp"

namespace roadbook::test {

using Json = nlohmann::json;

/// The labelling server without its sockets, on a lot with a recording of people.
class PeopleServed : public ::testing::Test {
 protected:
  explicit PeopleServed(const PersonLearnerOptions& options = {}) : options_(options) {
    folder_ = std::filesystem::temp_directory_path() /
              ("people_served." + std::to_string(getpid()) + "." +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    map_ = folder_ / "lot.gpkg";
    write_crowd(map_);
    drives_.emplace_back(Drive::open(folder_ / "drive"));
    open();
  }
  ~PeopleServed() override {
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
        images_.get(), book_.get(), &hub_, place_.people, options_, place_.people_record,
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
  static Json drawn(const Somebody& one) {
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
    for (const auto& one : crowd())
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
    for (const auto& one : crowd())
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

}  // namespace roadbook::test
