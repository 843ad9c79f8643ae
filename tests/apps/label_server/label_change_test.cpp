#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "apps/console.hpp"
#include "apps/label_server/http/token_file.hpp"
#include "apps/label_server/label_wire.hpp"
#include "tests/apps/label_server/crowd.hpp"
#include "tests/apps/label_server/server_fixture.hpp"
#include "workflows/session_drives.hpp"

// How the server applies a change of a label, and how it treats what other programs wrote to the
// map file.

namespace roadbook {
namespace {

using Json = nlohmann::json;
using test::LabelServerTest;
using test::Lot;
namespace fs = std::filesystem;

class LabelChange : public LabelServerTest {
 protected:
  HttpResponse send(const std::string& method, const std::string& path, const Json& body) {
    return api_->answer({method, path, "", {}, body.dump()});
  }
  Json create(Json body) { return Json::parse(send("POST", "/api/labels", body).body); }
  Label put(Json body) {
    body["who"] = "bob";
    const HttpResponse answer = send("PUT", "/api/labels/1", body);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return *store_->find(1);
  }
};

TEST_F(LabelChange, AChangeMadeOnAnotherMapIsNotStored) {
  const Json start = Json::parse(send("GET", "/api/start", Json::object()).body);
  Json body = Json::parse(space(1.25));
  body["map"] = "0123456789abcdef";
  const HttpResponse refused = send("POST", "/api/labels", body);
  EXPECT_EQ(refused.status, 409);
  EXPECT_EQ(Json::parse(refused.body).at("error"),
            "map: got a change made on another map, want one made on lot as it is now");
  EXPECT_EQ(Json::parse(refused.body).at("map").at("map"), start.at("map"));
  EXPECT_EQ(send("POST", "/api/undo", {{"who", "ann"}, {"map", "other"}}).status, 409);
  EXPECT_TRUE(store_->labels().empty());
  body["map"] = start.at("map");
  EXPECT_EQ(send("POST", "/api/labels", body).status, 200);
  EXPECT_EQ(store_->labels().size(), 1U);
}

TEST(MapVersion, IsThatOfDrivesAndPosesAlone) {
  Map map = test::lot_map({});
  const std::string version = map_version(map);
  map.sessions.front().name = "another name";
  map.sessions.front().drive_path = "elsewhere";
  EXPECT_EQ(map_version(map), version);
  Map moved = map;
  moved.keyframes[3].T_frame_vehicle.translate(Eigen::Vector3d(0.0, 1e-9, 0.0));
  EXPECT_NE(map_version(moved), version);
  EXPECT_EQ(place_version(moved), place_version(map));
  Map of_another_drive = map;
  of_another_drive.sessions.front().drive_digest = "1";
  EXPECT_NE(map_version(of_another_drive), version);
  EXPECT_NE(place_version(of_another_drive), place_version(map));
}

// A user who turns or lengthens a found box has corrected it, as one who moves it has.
TEST_F(LabelChange, AFoundBoxIsAsExactAsADrawnOneOnceAHandHasShapedIt) {
  Json found = Json::parse(space(1.25));
  found["source"] = "accepted";
  found["score"] = 0.8;
  const Json first = create(found);
  const double found_m = store_->find(1)->sigma_m;
  EXPECT_GT(found_m, Label().sigma_m);
  EXPECT_EQ(put({{"version", 1}, {"note", "narrow"}}).sigma_m, found_m);
  EXPECT_EQ(put({{"version", 2}, {"x", first.at("x")}, {"y", first.at("y")}}).sigma_m, found_m);
  EXPECT_EQ(put({{"version", 3}, {"heading", 1.6}}).sigma_m, Label().sigma_m);
}

// Two files that were copied and labelled apart have the same numbers and versions of other things.
TEST_F(LabelChange, AChangeOfAFileThatWasLabelledApartIsAConflict) {
  const Json made = create(Json::parse(space(1.25)));
  const std::string when = made.at("when");
  const Json apart = {{"who", "bob"}, {"version", 1}, {"when", "2020-01-01T00:00:00.000Z"}};
  for (const char* method : {"PUT", "DELETE"}) {
    const HttpResponse refused = send(method, "/api/labels/1", apart);
    EXPECT_EQ(refused.status, 409) << method;
    EXPECT_EQ(Json::parse(refused.body).at("current").at("when"), when);
    EXPECT_EQ(Json::parse(refused.body).at("yours").at("version"), 1);
  }
  EXPECT_EQ(store_->find(1)->version, 1);
  EXPECT_EQ(put({{"version", 1}, {"when", when}, {"note", "here"}}).version, 2);
  // The same request again, as after a lost answer: the server recognises its name, not its base
  // version.
  const Json again = {{"who", "bob"},
                      {"version", 2},
                      {"note", "x"},
                      {"request", "r"},
                      {"when", utc_text(store_->find(1)->t_ns)}};
  EXPECT_EQ(send("PUT", "/api/labels/1", again).body, send("PUT", "/api/labels/1", again).body);

  Json classes = Json::parse(send("GET", "/api/start", Json::object()).body).at("classes");
  classes["who"] = "bob";
  EXPECT_EQ(send("PUT", "/api/classes", classes).status, 200);
  classes["version"] = 1;
  classes["when"] = "2020-01-01T00:00:00.000Z";
  EXPECT_EQ(send("PUT", "/api/classes", classes).status, 409);
  classes["when"] = utc_text(store_->classes().t_ns);
  EXPECT_EQ(send("PUT", "/api/classes", classes).status, 200);
}

// The current map places the vehicle elsewhere than the map on which the label was drawn: 3 m to
// the left and a quarter turn.
TEST_F(LabelChange, AShapeThatWasDrawnOnAnEarlierMapGoesAlongWithItsVehicle) {
  const Map& map = store_->map();
  const Keyframe& k = map.keyframes[4];
  const Eigen::Vector3d now = map.T_map_vehicle(4).translation();
  const Json pose = {{"session", 0},       {"t_ns", std::to_string(k.t_ns)},
                     {"camera", 0},        {"x", now.x()},
                     {"y", now.y() + 3.0}, {"heading", 0.5 * M_PI}};
  // What lies 5.5 m to the vehicle's left and 0.4 m ahead of it, then and now.
  Json then = Json::parse(space(0.0));
  then["x"] = now.x() - 5.5;
  then["y"] = now.y() + 3.4;
  then["heading"] = 0.5 * M_PI + 1.57;
  then["pose"] = pose;
  const Json box = create(then);
  EXPECT_NEAR(box.at("x"), now.x() + 0.4, 1e-6);
  EXPECT_NEAR(box.at("y"), now.y() + 5.5, 1e-6);
  EXPECT_NEAR(box.at("heading"), 1.57, 1e-6);
  const Json polygon = create({{"shape", "polygon"},
                               {"kind", "crossing"},
                               {"source", "drawn"},
                               {"who", "ann"},
                               {"pose", pose},
                               {"corners",
                                {{now.x() - 5.0, now.y() + 3.0},
                                 {now.x() - 6.0, now.y() + 3.0},
                                 {now.x() - 6.0, now.y() + 5.0}}}});
  const auto corner = polygon.at("corners").at(2);
  EXPECT_NEAR(corner.at(0), now.x() + 2.0, 1e-6);
  EXPECT_NEAR(corner.at(1), now.y() + 6.0, 1e-6);
  then["pose"]["t_ns"] = "17";
  const HttpResponse lost = send("POST", "/api/labels", then);
  EXPECT_EQ(lost.status, 422);
  EXPECT_NE(lost.body.find("pose: got a time without a pose in the map"), std::string::npos);
}

// The same user moves the box before accepting it: the page then shows no longer the found box.
TEST_F(LabelChange, AFoundBoxThatWasShapedBeforeItWasAcceptedIsAsExactAsADrawnOne) {
  Json found = Json::parse(space(1.25));
  found["source"] = "accepted";
  found["score"] = 0.8;
  create(found);
  found["shaped"] = false;
  create(found);
  found["shaped"] = true;
  create(found);
  EXPECT_EQ(store_->find(1)->sigma_m, kFoundSigma_m);
  EXPECT_EQ(store_->find(2)->sigma_m, kFoundSigma_m);
  EXPECT_EQ(store_->find(3)->sigma_m, Label().sigma_m);
  EXPECT_TRUE(was_found(*store_->find(3)));  // it still counts as an answer to the search
  found["shaped"] = 1;
  const HttpResponse refused = send("POST", "/api/labels", found);
  EXPECT_EQ(refused.status, 422);
  EXPECT_NE(refused.body.find("shaped: got 1, want true or false"), std::string::npos);
}

TEST_F(LabelChange, WhatFurtherImagesSawIsKeptForAsLongAsTheShapeIsTheSame) {
  create(Json::parse(space(1.25)));
  Label label = *store_->find(1);
  label.sightings = {{label.anchor, {1.0, 2.0, 0.0}, 0.05}};
  store_->change(label, "ann");
  EXPECT_EQ(put({{"version", 2}, {"kind", "bay"}}).sightings.size(), 1U);
  EXPECT_TRUE(put({{"version", 3}, {"width", 2.4}}).sightings.empty());
}

// The map is built again and the track of the drive is broken where the label hangs.
TEST_F(LabelChange, ALabelThatHasNoPlaceIsGivenAClassAndANoteAllTheSame) {
  Lot lot;
  const fs::path file = folder_ / "broken.gpkg";
  const Map before = test::lot_map(lot);
  MapFileBuilder(file, "lot").finish(before, {});
  Label label = label_of_box(before, {0, before.keyframes[2].t_ns, 1}, {{1.0, 5.5}, 1.5, 5.0, 2.5});
  label.kind = test::kSpace;
  LabelStore(file).create(label, "ann");
  Map after = before;
  after.keyframes.erase(after.keyframes.begin(), after.keyframes.begin() + 6);
  after.map_frames.erase(after.map_frames.begin(), after.map_frames.begin() + 6);
  for (Keyframe& keyframe : after.keyframes) keyframe.map_frame -= 6;
  MapFileBuilder(file, "lot").finish(after, {});
  LabelStore store(file);
  const auto stored = store.find(1);
  ASSERT_TRUE(stored);
  ASSERT_FALSE(vehicle_of(store.map(), stored->anchor));
  LabelService service(&store, &hub_, images_.get(), place_.classes);
  (void)service.change(1, {{"who", "bob"}, {"version", 1}, {"kind", "bay"}, {"note", "gone"}});
  const Label changed = *store.find(1);
  EXPECT_EQ(changed.kind, "bay");
  EXPECT_EQ(changed.note, "gone");
  EXPECT_EQ(changed.anchor.t_ns, label.anchor.t_ns);
  EXPECT_TRUE(changed.T_vehicle_label.isApprox(stored->T_vehicle_label));
  ASSERT_TRUE(changed.seen) << "where it was seen last is known still";
  const Json moves = {{"who", "bob"}, {"version", 2}, {"x", 1.0}};
  EXPECT_THROW((void)service.change(1, moves), RequestError);
}

TEST_F(LabelChange, LimitsOfTextCountCharactersAndWhatIsNoTextIsToldInOneLine) {
  Json body = Json::parse(space(1.25));
  const auto letters = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "ü";
    return text;
  };
  body["who"] = letters(64);
  body["kind"] = "not_" + letters(64);
  body["note"] = letters(1000);
  ASSERT_EQ(send("POST", "/api/labels", body).status, 200);
  body["note"] = letters(1001);
  EXPECT_EQ(Json::parse(send("POST", "/api/labels", body).body).at("error"),
            "note: got a longer text, want at most 1000 characters");
  body["note"] = "";
  body["who"] = letters(65);
  EXPECT_EQ(Json::parse(send("POST", "/api/labels", body).body).at("error"),
            "who: got a longer text, want at most 64 characters");
  body["who"] = "ann";
  body["kind"] = letters(65);  // one that is rejected alone may be longer
  EXPECT_EQ(send("POST", "/api/labels", body).status, 422);
  body["kind"] = "not_" + letters(65);
  EXPECT_EQ(send("POST", "/api/labels", body).status, 422);
  for (const char* kind : {"   ", "not_", "not_not_parking_space"}) {
    body["kind"] = kind;
    EXPECT_EQ(send("POST", "/api/labels", body).status, 422) << kind;
  }
  std::string bytes = Json::parse(space(1.25)).dump();
  bytes.insert(bytes.size() - 1, ",\"note\":\"caf\xE9\"");
  const HttpResponse answer = api_->answer({"POST", "/api/labels", "", {}, bytes});
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(Json::parse(answer.body).at("error"),
            "body: got bytes that are not UTF-8, want UTF-8 text");
  Label label = *store_->find(1);
  label.note = "caf\xE9";
  try {
    store_->create(label, "ann");
    FAIL() << "stored";
  } catch (const BadInput& fault) {
    EXPECT_EQ(std::string(fault.what()),
              "error: label: note: got bytes that are not UTF-8, want UTF-8 text");
  }
}

// The disk is full: half a token would stop every later start.
TEST(TokenFile, IsWholeOrNotThere) {
  const fs::path file = fs::temp_directory_path() / ("token." + std::to_string(getpid()));
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{10, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW((void)kept_token(file), StorageError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(fs::exists(file));
  const std::string token = kept_token(file);
  EXPECT_EQ(kept_token(file), token);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  fs::remove(file);
}

TEST(SessionDrives, OneThatWasChangedIsLeftOutWithAWarning) {
  const fs::path folder = fs::temp_directory_path() / ("changed." + std::to_string(getpid()));
  fs::create_directories(folder);
  const fs::path map = folder / "lot.gpkg";
  test::write_crowd(map);
  const Console console(false, true);
  const Map stored = load_map(map);
  EXPECT_TRUE(open_session_drives(map, stored, {}, console).front());
  for (const auto& entry : fs::recursive_directory_iterator(folder / "drive"))
    if (entry.path().extension() == ".png") {
      fs::rename(entry.path(), fs::path(entry.path()).replace_filename("1500000000000000000.png"));
      break;
    }
  testing::internal::CaptureStderr();
  EXPECT_FALSE(open_session_drives(map, stored, {}, console).front());
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("the session is left out"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
  EXPECT_THROW((void)open_session_drives(map, stored, {folder / "drive"}, console), BadInput);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace roadbook
