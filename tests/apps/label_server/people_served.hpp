#pragma once

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/apps/label_server/crowd.hpp"
#include "tests/apps/label_server/served_map.hpp"

namespace roadbook::test {

using Json = nlohmann::json;

/// The labelling server on a lot with a recording of people.
class PeopleServed : public ServedMap {
 protected:
  explicit PeopleServed(const PersonLearnerOptions& options = {}) : ServedMap(options) {
    write_crowd(map_);
    drives_.emplace_back(Drive::open(folder_ / "drive"));
    open();
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
  /// Answers a whole image in one request: the people in it, the hypotheses that are no people, and
  /// that no other person is there.
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
};

}  // namespace roadbook::test
