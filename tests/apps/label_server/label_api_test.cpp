#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/label_server/server_fixture.hpp"

// Answers of the server to clients that it admits.

namespace roadbook {
namespace {

using Json = nlohmann::json;
using test::LabelServerTest;

TEST_F(LabelServerTest, SeveralLabelsAreStoredTogetherOrNotAtAll) {
  Json body = {{"who", "ann"}, {"request", "r"}, {"labels", Json::array()}};
  for (const double x : {1.25, 3.75}) body["labels"].push_back(Json::parse(space(x)));
  body["labels"].push_back(Json::parse(space(6.25)));
  body["labels"][2]["width"] = -1.0;
  const auto send = [&] { return api_->answer({"POST", "/api/labels", "", {}, body.dump()}); };
  EXPECT_EQ(send().status, 422);
  EXPECT_TRUE(store_->labels().empty());
  body["labels"][2]["width"] = 2.5;
  EXPECT_EQ(Json::parse(send().body).at("labels").size(), 3U);
  EXPECT_EQ(Json::parse(send().body).at("labels").size(), 3U);  // the same request again
  EXPECT_EQ(store_->labels().size(), 3U);
  body["labels"] = Json::array();
  body["request"] = "q";
  EXPECT_EQ(send().status, 422);
  body["labels"] = Json(1001, Json::parse(space(1.25)));  // 1000 are stored at once, at most
  EXPECT_EQ(send().status, 422);
  body["labels"] = Json::parse(space(1.25));
  EXPECT_EQ(send().status, 422);
  EXPECT_EQ(store_->labels().size(), 3U);
}

// Two pages of one user: the name of a request shows each page which step it did last.
TEST_F(LabelServerTest, AStepBackIsNotTakenOverWhatAnotherPageDidSince) {
  const auto ask = [&](const char* path, Json body) {
    body["who"] = "ann";
    return api_->answer({"POST", path, "", {}, body.dump()});
  };
  for (const char* request : {"of one", "of the other"}) {
    Json body = Json::parse(space(request == std::string("of one") ? 1.25 : 3.75));
    body["request"] = request;
    EXPECT_EQ(ask("/api/labels", body).status, 200);
  }
  const HttpResponse refused = ask("/api/undo", {{"request", "u1"}, {"last", "of one"}});
  EXPECT_EQ(refused.status, 412);
  EXPECT_EQ(Json::parse(refused.body).at("error"),
            "your last change (label 2) was made in another page");
  EXPECT_EQ(store_->labels().size(), 2U);
  EXPECT_EQ(ask("/api/undo", {{"request", "u2"}, {"last", "of the other"}}).status, 200);
  ASSERT_EQ(store_->labels().size(), 1U);
  EXPECT_EQ(ask("/api/undo", {{"request", "u3"}, {"last", "of one"}}).status, 200);
  EXPECT_TRUE(store_->labels().empty());
  EXPECT_EQ(ask("/api/redo", {{"request", "r1"}, {"last", "u2"}}).status, 412);
  EXPECT_EQ(ask("/api/redo", {{"request", "r2"}, {"last", "u3"}}).status, 200);
  EXPECT_EQ(ask("/api/redo", {{"request", "r3"}}).status, 200);  // whatever was last
  EXPECT_EQ(store_->labels().size(), 2U);
  // A page that was loaded again learns the prefix of its request names.
  EXPECT_EQ(ask("/api/undo", {{"request", "u4"}, {"last", "of one"}}).status, 412);
  EXPECT_EQ(ask("/api/undo", {{"request", "u5"}, {"last", "r"}}).status, 200);
  EXPECT_EQ(store_->labels().size(), 1U);
}

TEST_F(LabelServerTest, AChangeIsOfTheFieldsItNamesAndTheRestStays) {
  const Json first = Json::parse(
      api_->answer({"POST", "/api/labels", "", {}, Json::parse(space(1.25)).dump()}).body);
  const auto put = [&](Json body) {
    body["who"] = "ann";
    const HttpResponse answer = api_->answer({"PUT", "/api/labels/1", "", {}, body.dump()});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return Json::parse(answer.body);
  };
  put({{"version", 1}, {"kind", "crossing"}});
  put({{"version", 2}, {"note", "narrow"}});
  put({{"version", 3}, {"x", first.at("x").get<double>() + 0.05}});
  const Json last = put({{"version", 4}, {"width", 2.25}});
  EXPECT_EQ(last.at("kind"), "crossing");
  EXPECT_EQ(last.at("note"), "narrow");
  EXPECT_EQ(last.at("source"), first.at("source"));
  const auto differs = [&](const char* field) {
    return last.at(field).get<double>() - first.at(field).get<double>();
  };
  EXPECT_NEAR(differs("x"), 0.05, 1e-9);
  EXPECT_NEAR(last.at("width").get<double>(), 2.25, 1e-9);
  for (const char* field : {"y", "heading", "length"}) EXPECT_NEAR(differs(field), 0.0, 1e-9);
}

TEST_F(LabelServerTest, WithoutAnOverheadImageNothingIsLookedForOnTheGround) {
  const auto file = folder_ / "bare.gpkg";
  MapFileBuilder(file, "bare").finish(test::lot_map({}), {});
  const LabelPlace bare = read_label_place(file);
  EXPECT_FALSE(bare.has_picture());
  EXPECT_TRUE(picture_version(bare.image).empty());
  const TilePyramid tiles(bare.image);
  Learning learning(bare.image, BoxLearnerOptions(), service_.get(), &hub_);
  const LabelApi api({&bare, "", &tiles, views_.get(), service_.get(), &learning, people_.get(),
                      paint_.get(), &hub_, "ann"});
  const auto start = Json::parse(api.answer({"GET", "/api/start", "", {}, ""}).body);
  EXPECT_TRUE(start.at("picture").is_null());
  EXPECT_FALSE(start.at("poses").at(0).empty());
  EXPECT_EQ(api.answer({"GET", "/tiles/0/0/0.png", "", {}, ""}).status, 404);
  EXPECT_EQ(post("/api/labels", space(1.25), writing()), 200);
  const HttpResponse learn =
      api.answer({"POST", "/api/learn", "", {}, R"({"kind": "parking_space"})"});
  EXPECT_EQ(learn.status, 422);
  EXPECT_NE(learn.body.find("roadbook overhead"), std::string::npos) << learn.body;
}

TEST_F(LabelServerTest, IdsAreNumbersAndNeverPaths) {
  for (const char* path :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/tiles/0/0/../../../etc/passwd.png",
        "/tiles/0/0/0", "/tiles/-1/0/0.png", "/tiles/99/0/0.png", "/tiles/0/99999999999/0.png",
        "/api/image/0/0/0", "/api/image/9/1400000000000000000/0", "/api/image/-1/0/0",
        "/api/image/0/..%2f..%2fetc/0", "/page_files.cpp"})
    EXPECT_EQ(get(path, allowed()), 404) << path;
  EXPECT_EQ(get("/tiles/0/0/0.png", allowed()), 200);
}

TEST_F(LabelServerTest, WrongFieldsAreNamedAndNothingIsStored) {
  const auto refused = [&](const std::string& field, const Json& value) {
    Json body = Json::parse(space(1.25));
    body[field] = value;
    const HttpResponse answer = api_->answer({"POST", "/api/labels", "", {}, body.dump()});
    EXPECT_EQ(answer.status, 422) << field << " " << value;
    return Json::parse(answer.body).at("error").get<std::string>();
  };
  EXPECT_NE(refused("x", "1").find("x: got \"1\", want a number"), std::string::npos);
  EXPECT_NE(refused("x", 5000.0).find("place"), std::string::npos);
  EXPECT_NE(refused("width", -1.0).find("length, width"), std::string::npos);
  EXPECT_NE(refused("shape", "circle").find("shape"), std::string::npos);
  EXPECT_NE(refused("who", "").find("who"), std::string::npos);
  EXPECT_NE(refused("kind", std::string(100, 'k')).find("kind"), std::string::npos);
  const Json crossed = {{"shape", "polygon"},
                        {"kind", "crossing"},
                        {"source", "drawn"},
                        {"who", "ann"},
                        {"corners", {{1, 4}, {3, 6}, {3, 4}, {1, 6}}}};
  const HttpResponse answer = api_->answer({"POST", "/api/labels", "", {}, crossed.dump()});
  EXPECT_EQ(answer.status, 422);
  EXPECT_NE(answer.body.find("crosses itself"), std::string::npos);
  EXPECT_TRUE(store_->labels().empty());
}

TEST_F(LabelServerTest, TilesAreThePictureAndTheOutlineIsWhereTheCameraSeesTheBox) {
  const int finest = tiles_->levels() - 1;
  EXPECT_DOUBLE_EQ(tiles_->resolution_m(finest), place_.image.resolution_m);
  EXPECT_EQ(tiles_->tile(finest, 1000, 0), nullptr);
  const Json view = Json::parse(api_->answer({"POST", "/api/view", "", {}, space(1.25)}).body);
  EXPECT_TRUE(view.at("image").is_null());
  const Label label = label_of_box(store_->map(),
                                   {0, std::stoll(view.at("t_ns").get<std::string>()),
                                    view.at("camera").get<std::string>().back() - '0'},
                                   {{1.25, 5.5}, 1.57, 5.0, 2.5});
  const auto& mounted =
      store_->map().sessions[0].rig.cameras[static_cast<std::size_t>(label.anchor.camera)];
  // The first point is the corner ahead on the right.
  const auto pixel =
      mounted.camera.project(mounted.T_vehicle_camera.inverse() *
                             (label.T_vehicle_label * Eigen::Vector3d(2.5, -1.25, 0)));
  ASSERT_TRUE(pixel.has_value());
  EXPECT_NEAR(view.at("outline")[0][0].get<double>(), pixel->x(), 1e-6);
  EXPECT_NEAR(view.at("outline")[0][1].get<double>(), pixel->y(), 1e-6);
}

// Small steps move a label out of the image it was drawn in. Its anchor then changes to an image
// that shows it well.
TEST_F(LabelServerTest, ALabelThatWalksAwayHangsOnAnImageNearIt) {
  nlohmann::json body = nlohmann::json::parse(space(1.25));
  const auto first = service_->create(body);
  const LabelAnchor begin = store_->find(1)->anchor;
  double x = 1.25;
  for (int version = 1; version <= 6; ++version) {
    x += 0.9;
    (void)service_->change(1, {{"who", "ann"},
                               {"version", version},
                               {"x", x},
                               {"y", 5.5},
                               {"heading", 1.57},
                               {"length", 5.0},
                               {"width", 2.5},
                               {"shape", "box"}});
    if (version == 1) {
      EXPECT_EQ(store_->find(1)->anchor, begin) << "a nudge";
    }
  }
  body["x"] = x;
  (void)service_->create(body);
  const Label walked = *store_->find(1);
  const Label afresh = *store_->find(2);
  EXPECT_FALSE(walked.anchor == begin);
  const auto place = [&](const Label& label) -> Eigen::Vector3d {
    return vehicle_of(store_->map(), label.anchor)->T_map_vehicle.translation();
  };
  EXPECT_LT((place(walked) - place(afresh)).norm(), 1.5);
}

}  // namespace
}  // namespace roadbook
