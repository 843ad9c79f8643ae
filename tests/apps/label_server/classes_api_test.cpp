#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/label_server/server_fixture.hpp"

// Classes of labels, as pages change them and take changes back.

namespace roadbook {
namespace {

using Json = nlohmann::json;
using test::LabelServerTest;

TEST_F(LabelServerTest, AClassWithLabelsStaysAndWrongOnesAreNamed) {
  EXPECT_EQ(post("/api/labels", space(1.25), writing()), 200);
  const auto put = [&](const Json& classes) {
    const Json body = {{"who", "ann"}, {"version", 0}, {"classes", classes}};
    return api_->answer({"PUT", "/api/classes", "", {}, body.dump()});
  };
  const Json space_class = {
      {"kind", "parking_space"}, {"title", "space"}, {"colour", "#010203"}, {"shape", "box"}};
  Json bay = space_class;
  bay["kind"] = "bay";
  EXPECT_EQ(put(Json::array({bay})).status, 422);
  EXPECT_NE(put(Json::array({bay})).body.find("parking_space"), std::string::npos);
  EXPECT_EQ(put({space_class, bay}).status, 200);
  bay["colour"] = "red;}";
  EXPECT_NE(put({space_class, bay}).body.find("colour"), std::string::npos);
  const Json start = Json::parse(api_->answer({"GET", "/api/start", "", {}, ""}).body);
  const Json& list = start.at("classes").at("classes");
  EXPECT_EQ(list.size(), 2U);
  EXPECT_EQ(list.at(0).at("colour"), "#010203");
}

TEST_F(LabelServerTest, AChangeOfClassesIsTakenBackInItsTurnAndStandsInTheMap) {
  const auto ask = [&](const char* method, const char* path, const Json& body) {
    return Json::parse(api_->answer({method, path, "", {}, body.dump()}).body);
  };
  const auto titles = [&] {
    std::vector<std::string> list;
    for (const LabelClass& c : read_label_classes(MapLayers(folder_ / "lot.gpkg")))
      list.push_back(c.title);
    return list;
  };
  const Json bay = {
      {"kind", "parking_space"}, {"title", "bay"}, {"colour", "#010203"}, {"shape", "box"}};
  const Json change = {
      {"who", "ann"}, {"request", "c"}, {"version", 0}, {"classes", Json::array({bay})}};
  const auto list_of = [](const Json& answer) { return answer.at("classes").at("classes"); };
  EXPECT_EQ(list_of(ask("PUT", "/api/classes", change)).size(), 1U);
  EXPECT_EQ(list_of(ask("PUT", "/api/classes", change)).size(), 1U);  // sent again
  EXPECT_EQ(titles(), std::vector<std::string>{"bay"});
  EXPECT_EQ(post("/api/labels", space(1.25), writing()), 200);
  EXPECT_EQ(ask("POST", "/api/undo", {{"who", "ann"}}).at("labels").size(), 1U);
  EXPECT_TRUE(ask("POST", "/api/undo", {{"who", "bob"}}).at("labels").empty());
  const Json undone = ask("POST", "/api/undo", {{"who", "ann"}, {"request", "u"}});
  EXPECT_TRUE(undone.at("labels").empty());
  EXPECT_EQ(list_of(undone).size(), 2U);
  EXPECT_EQ(undone.at("classes").at("version"), 2);
  EXPECT_EQ(titles(), (std::vector<std::string>{"parking space", "crossing"}));
  EXPECT_EQ(list_of(ask("POST", "/api/redo", {{"who", "ann"}})).at(0).at("title"), "bay");
  EXPECT_EQ(ask("GET", "/api/history", Json::object()).at("events").at(0).at("action"), "classes");
  // Undo does not revert a later change of another user.
  Json others = change;
  others["who"] = "bob";
  others["version"] = 3;
  others["classes"][0]["title"] = "lot";
  ask("PUT", "/api/classes", others);
  EXPECT_EQ(post("/api/undo", R"({"who": "ann"})", writing()), 409);
  EXPECT_EQ(titles(), std::vector<std::string>{"lot"});
}

TEST_F(LabelServerTest, AClassOfWhichThereAreLabelsIsNotTakenBack) {
  const auto ask = [&](const char* path, const Json& body) {
    return api_->answer({"POST", path, "", {}, body.dump()});
  };
  Json classes = Json::parse(api_->answer({"GET", "/api/start", "", {}, ""}).body).at("classes");
  classes["who"] = "ann";
  classes["classes"].push_back(
      {{"kind", "pond"}, {"title", "pond"}, {"colour", "#010203"}, {"shape", "box"}});
  EXPECT_EQ(api_->answer({"PUT", "/api/classes", "", {}, classes.dump()}).status, 200);
  Json pond = Json::parse(space(1.25));
  pond["kind"] = "pond";
  pond["who"] = "bob";
  EXPECT_EQ(ask("/api/labels", pond).status, 200);
  const HttpResponse refused = ask("/api/undo", {{"who", "ann"}});
  EXPECT_EQ(refused.status, 409);
  const Json standing = Json::parse(refused.body).at("current");
  const Json passed = Json::array({{{"id", 0}, {"version", standing.at("version")}}});
  const HttpResponse before = ask("/api/undo", {{"who", "ann"}, {"passed", passed}});
  EXPECT_EQ(before.status, 200);
  EXPECT_TRUE(Json::parse(before.body).at("labels").empty());
  EXPECT_EQ(ask("/api/undo", {{"who", "bob"}}).status, 200);
  EXPECT_EQ(ask("/api/undo", {{"who", "ann"}}).status, 200);
}

TEST_F(LabelServerTest, AClassThatLabelsHaveAndNoListHadDoesNotHoldAChangeOfOthers) {
  const auto ask = [&](const char* method, const char* path, const Json& body) {
    return api_->answer({method, path, "", {}, body.dump()});
  };
  Json pond = Json::parse(space(1.25));
  pond["kind"] = "pond";
  EXPECT_EQ(ask("POST", "/api/labels", pond).status, 200);
  const auto shown = [&] {
    return Json::parse(ask("GET", "/api/start", Json::object()).body).at("classes");
  };
  const Json before = shown();
  Json classes = before;
  ASSERT_EQ(classes.at("classes").size(), 3U);
  classes["who"] = "ann";
  classes["classes"][0]["title"] = "bay";
  EXPECT_EQ(ask("PUT", "/api/classes", classes).status, 200);
  EXPECT_EQ(ask("POST", "/api/undo", {{"who", "ann"}}).status, 200);
  EXPECT_EQ(shown().at("classes"), before.at("classes"));
}

TEST_F(LabelServerTest, AChangeOfOlderClassesIsNotStoredAndBothAreTold) {
  const auto put = [&](const std::string& who, std::int64_t version, const std::string& colour) {
    const Json space_class = {
        {"kind", "parking_space"}, {"title", "space"}, {"colour", colour}, {"shape", "box"}};
    const Json body = {{"who", who}, {"version", version}, {"classes", Json::array({space_class})}};
    const HttpResponse answer = api_->answer({"PUT", "/api/classes", "", {}, body.dump()});
    return std::pair{answer.status, Json::parse(answer.body)};
  };
  const auto colour = [](const Json& list) { return list.at("classes").at(0).at("colour"); };
  EXPECT_EQ(put("ann", 0, "#111111").second.at("classes").at("version"), 1);
  const auto [status, both] = put("bob", 0, "#222222");  // has not heard of ann's
  EXPECT_EQ(status, 409);
  EXPECT_EQ(both.at("current").at("who"), "ann");
  EXPECT_EQ(both.at("current").at("version"), 1);
  EXPECT_EQ(colour(both.at("current")), "#111111");
  EXPECT_EQ(colour(both.at("yours")), "#222222");
  EXPECT_EQ(read_label_classes(MapLayers(folder_ / "lot.gpkg")).front().colour, "#111111");
  EXPECT_EQ(put("bob", 1, "#222222").first, 200);  // bob has seen both
  EXPECT_EQ(read_label_classes(MapLayers(folder_ / "lot.gpkg")).front().colour, "#222222");
  EXPECT_EQ(put("ann", 7, "#333333").first, 409) << "a version that never was";
  EXPECT_EQ(store_->events().size(), 2U);
  // The server refuses a list that lacks a class with labels. It reports a newer list first.
  Json bay = Json::parse(space(1.25));
  bay["kind"] = "bay";
  EXPECT_EQ(post("/api/labels", bay.dump(), writing()), 200);
  EXPECT_EQ(put("ann", 0, "#444444").first, 409);
  EXPECT_EQ(put("ann", 2, "#444444").first, 422);
}

}  // namespace
}  // namespace roadbook
