#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "mapping/store/map_file.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/semantics/label_map.hpp"
#include "tests/semantics/label_store_fixture.hpp"
#include "workflows/labels/learning_record.hpp"
#include "workflows/labels/people_record.hpp"

// What `roadbook report --before` reports about labels, from two map files to page and result.

namespace roadbook {
namespace {

using nlohmann::json;

class LabelReportVerb : public test::LabelStoreTest {
 protected:
  void draw_three() {
    LabelStore store(map_);
    store.create_all({space(store, 1.0), space(store, 3.5), space(store, 6.0)}, "ann");
  }
  // The map is solved again: the keyframe of all label anchors turns, rises and moves.
  void solve_again() {
    before_ = load_map(map_);
    std::filesystem::copy_file(map_, folder_ / "old.gpkg");
    Map map = before_;
    map.map_frames[3].T_map_frame = pose_from_planar(0.4, -0.3, 0.0) *
                                    map.map_frames[3].T_map_frame *
                                    pose_from_planar(0.0, 0.0, 0.02);
    map.map_frames[3].T_map_frame.translation().z() += 0.25;
    MapFileBuilder(map_, "again").finish(map, {});
    after_ = load_map(map_);
  }
  json report(const std::string& options) {
    const auto run =
        test::run_command("roadbook report -m map.gpkg -o r.html --json " + options, folder_);
    EXPECT_EQ(run.status, 0) << run.err;
    page_ = test::read_text(folder_ / "r.html");
    return run.status == 0 ? json::parse(run.out).at("labels") : json();
  }

  Map before_;
  Map after_;
  std::string page_;
};

TEST_F(LabelReportVerb, TellsHowFarEachLabelHasMovedWithTheMap) {
  draw_three();
  solve_again();
  const json shift = report("--before old.gpkg").at("shift");
  ASSERT_EQ(shift.at("each").size(), 3U);
  double sum = 0.0;
  double largest = 0.0;
  for (const Label& label : read_labels(map_)) {
    const json& row = shift.at("each").at(static_cast<std::size_t>(label.id - 1));
    const Eigen::Vector3d middle = label.T_vehicle_label.translation();
    const Eigen::Vector3d way =
        after_.T_map_vehicle(3) * middle - before_.T_map_vehicle(3) * middle;
    EXPECT_EQ(row.at("label"), label.id);
    EXPECT_EQ(row.at("class"), "parking_space");
    EXPECT_NEAR(row.at("dx_m"), way.x(), 1e-9);
    EXPECT_NEAR(row.at("dy_m"), way.y(), 1e-9);
    EXPECT_NEAR(row.at("dz_m"), way.z(), 1e-9);
    EXPECT_NEAR(row.at("distance_m"), way.head<2>().norm(), 1e-9);
    EXPECT_NEAR(row.at("turn_rad"), 0.02, 1e-5);  // the vehicle leans by 17 mrad
    // 3 cm of the drawing, 3 cm of the pose, and 3.5 mrad over the 4 to 7 m to the vehicle.
    EXPECT_NEAR(row.at("sigma_m"), 0.046, 0.004);
    EXPECT_GT(row.at("sigmas"), way.head<2>().norm() / row.at("sigma_m").get<double>() - 1e-6);
    sum += way.head<2>().norm();
    largest = std::max(largest, way.head<2>().norm());
  }
  EXPECT_NEAR(shift.at("mean_m"), sum / 3.0, 1e-9);
  EXPECT_NEAR(shift.at("largest_m"), largest, 1e-9);
  EXPECT_GT(largest, 1.01 * sum / 3.0);
}

TEST_F(LabelReportVerb, ListsTheFarthestLabelFirstInThePage) {
  draw_three();
  solve_again();
  const json shift = report("--before old.gpkg").at("shift");
  std::vector<std::pair<double, std::int64_t>> farthest;
  for (const json& row : shift.at("each"))
    farthest.emplace_back(-row.at("distance_m").get<double>(), row.at("label"));
  std::sort(farthest.begin(), farthest.end());
  const auto folded = page_.find("<details><summary>The shift of each label (3)");
  ASSERT_NE(folded, std::string::npos);
  std::size_t at = folded;
  for (const auto& [metres, id] : farthest) {
    at = page_.find("<tr><td>" + std::to_string(id) + "</td><td>parking_space</td>", at + 1);
    EXPECT_NE(at, std::string::npos) << id;
  }
  EXPECT_LT(at, page_.find("</details>", folded));
}

// Each label knows from above only where it was seen. Unknown values are reported as unknown, not
// as zero.
TEST_F(LabelReportVerb, WithoutAnEarlierMapTellsWhatIsKnownOfShiftsSinceLabelsWereSeen) {
  draw_three();
  const json told = report("");
  EXPECT_EQ(told.at("shift").at("since"), "last seen");
  for (const json& row : told.at("shift").at("each")) {
    EXPECT_EQ(row.at("distance_m"), 0.0);
    EXPECT_TRUE(row.at("dz_m").is_null());
    EXPECT_TRUE(row.at("turn_rad").is_null());
  }
}

// A map that moved and was edited: the report lists moved labels as shifted and edited ones as
// changed.
TEST_F(LabelReportVerb, TellsByWhomWhichLabelWasChangedSinceAnEarlierMap) {
  draw_three();
  solve_again();
  {
    LabelStore store(map_);
    Label crossing = *store.find(2);
    crossing.kind = "crossing";
    store.change(crossing, "bob <b>");
    store.remove(3, 1, "cid");
  }
  const json told = report("--before old.gpkg");
  const json& diff = told.at("diff");
  EXPECT_EQ(diff.at("since"), "old.gpkg");
  EXPECT_EQ(diff.at("added"), 0);
  EXPECT_EQ(diff.at("deleted"), 1);
  EXPECT_EQ(diff.at("restored"), 0);
  EXPECT_EQ(diff.at("changed"), 1);
  ASSERT_EQ(diff.at("each").size(), 2U);
  const json& changed = diff.at("each").at(0);
  EXPECT_EQ(changed.at("label"), 2);
  EXPECT_EQ(changed.at("who"), "bob <b>");
  ASSERT_EQ(changed.at("fields").size(), 1U);
  EXPECT_EQ(changed.at("fields").at(0).at("field"), "class");
  EXPECT_EQ(changed.at("fields").at(0).at("from"), "parking_space");
  EXPECT_EQ(changed.at("fields").at(0).at("to"), "crossing");
  EXPECT_EQ(told.at("shift").at("each").size(), 2U);  // both that are left have moved
  EXPECT_NE(
      page_.find("By hand: labels since old.gpkg: 1 deleted, 1 changed by bob &lt;b&gt;, cid"),
      std::string::npos);
  EXPECT_NE(page_.find("class: 'parking_space', now 'crossing'"), std::string::npos)
      << page_.substr(page_.find("By hand"), 1200);
  EXPECT_FALSE(report("").contains("diff"));
}

// A drive of a map, and how far its poses are moved there.
struct Driven {
  std::string name;
  Eigen::Vector2d moved;
};

// All drives have the same stamps, as recordings whose clock restarts have.
Map map_of(const std::vector<Driven>& drives) {
  Map map;
  for (std::size_t s = 0; s < drives.size(); ++s) {
    Map one = test::label_map(10);
    Session session = one.sessions.front();
    session.name = session.drive_path = session.drive_digest = drives[s].name;
    map.sessions.push_back(session);
    for (std::size_t k = 0; k < one.keyframes.size(); ++k) {
      one.keyframes[k].session = static_cast<int>(s);
      one.keyframes[k].map_frame = static_cast<int>(map.map_frames.size());
      one.map_frames[k].T_map_frame.translation().head<2>() += drives[s].moved;
      map.keyframes.push_back(one.keyframes[k]);
      map.map_frames.push_back(one.map_frames[k]);
    }
  }
  return map;
}

// The third drive was the second one of the earlier map: shifts are those of its poses, not the way
// from one drive to another.
TEST_F(LabelReportVerb, ComparesEachDriveWithItselfWhateverItsNumber) {
  MapFileBuilder(folder_ / "old.gpkg", "old")
      .finish(map_of({{"first", {0, 0}}, {"east", {3, 20}}, {"gone", {9, 9}}}), {});
  MapFileBuilder(map_, "new")
      .finish(map_of({{"first", {0, 0}}, {"new", {-7, 5}}, {"east", {3.3, 20.4}}}), {});
  {
    LabelStore store(map_);
    std::vector<Label> labels{space(store, 1.0), space(store, 3.5), space(store, 6.0)};
    for (int s = 0; s < 3; ++s) labels[static_cast<std::size_t>(s)].anchor.session = s;
    store.create_all(labels, "ann");
  }
  const json shift = report("--before old.gpkg").at("shift");
  ASSERT_EQ(shift.at("each").size(), 2U);
  EXPECT_EQ(shift.at("each").at(0).at("label"), 1);
  EXPECT_NEAR(shift.at("each").at(0).at("distance_m"), 0.0, 1e-9);
  EXPECT_EQ(shift.at("each").at(1).at("label"), 3);
  EXPECT_NEAR(shift.at("each").at(1).at("dx_m"), 0.3, 1e-9);
  EXPECT_NEAR(shift.at("each").at(1).at("dy_m"), 0.4, 1e-9);
  EXPECT_EQ(shift.at("without_pose"), 1);
  EXPECT_EQ(shift.at("drives_not_in_before"), json({"new"}));
  EXPECT_EQ(shift.at("drives_in_before_alone"), json({"gone"}));
  EXPECT_NE(page_.find("labels on these drives are not compared: new (not in old.gpkg); gone (in "
                       "old.gpkg alone)"),
            std::string::npos);
}

TEST_F(LabelReportVerb, RefusesAMapOfOtherDrivesAsTheEarlierOne) {
  MapFileBuilder(map_, "new").finish(map_of({{"first", {0, 0}}, {"east", {3, 20}}}), {});
  draw_three();
  const auto refusal = [&](const std::vector<Driven>& drives) {
    MapFileBuilder(folder_ / "old.gpkg", "old").finish(map_of(drives), {});
    const auto run =
        test::run_command("roadbook report -m map.gpkg --before old.gpkg -o r.html", folder_);
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r.html"));
    return run.err;
  };
  const std::string other = refusal({{"west", {0, 0}}, {"south", {0, 0}}});
  EXPECT_NE(
      other.find("old.gpkg: drives of --before: got west, south, want an earlier state of the "
                 "map, which is of first, east"),
      std::string::npos)
      << other;
  // Its places refer to another first pose.
  const std::string turned = refusal({{"east", {0, 0}}, {"first", {0, 0}}});
  EXPECT_NE(turned.find("got east, first, want a map that begins with the same drive, first"),
            std::string::npos)
      << turned;
}

// Two drawn in the page, a row filled there; one is deleted and comes back by the import verb.
TEST_F(LabelReportVerb, TellsImportedLabelsApartFromDrawnOnes) {
  const std::string place = " --latitude-deg 47.4 --longitude-deg 8.5 ";
  {
    LabelStore store(map_);
    store.create(space(store, 1.0), "ann", "page/1");
    store.create(space(store, 3.5), "ann", "page/2");
  }
  const auto run = [&](const std::string& command) {
    const auto result = test::run_command(command, folder_);
    EXPECT_EQ(result.status, 0) << result.err;
  };
  run("roadbook export -m map.gpkg --format geojson --layer parking_spaces -o l.geojson" + place);
  {
    LabelStore store(map_);
    store.remove(2, 1, "ann", "page/3");
  }
  run("roadbook import geojson l.geojson -m map.gpkg --who ann" + place);
  {
    LabelStore store(map_);
    store.create_all({space(store, 20.0), space(store, 22.5)}, "ann", "page/4");
  }
  const json told = report("");
  const json& spaces = told.at("classes").at(0);
  EXPECT_EQ(spaces.at("class"), "parking_space");
  EXPECT_EQ(spaces.at("labels"), 4);
  EXPECT_EQ(spaces.at("drawn"), 2);
  EXPECT_EQ(spaces.at("filled"), 2);
  EXPECT_EQ(spaces.at("imported"), 1);
  EXPECT_EQ(spaces.at("clicks_by_step").at("draw"), 6);
  EXPECT_EQ(spaces.at("clicks_by_step").at("delete"), 1);
  EXPECT_EQ(spaces.at("clicks"), 8);
  const auto seconds = [](const Label& from, const Label& to) {
    return static_cast<double>(to.t_ns - from.t_ns) * 1e-9;
  };
  const auto events = read_label_events(map_);
  EXPECT_NEAR(told.at("effort").at("seconds"),
              seconds(events.front().label, events[events.size() - 2].label), 1e-6);
  EXPECT_EQ(told.at("effort").at("longest_pause_s"), 60.0);
  EXPECT_NE(page_.find("<tr><td>all</td><td>4</td><td>2</td><td>2</td><td>1</td>"),
            std::string::npos);
}

// Who did it goes into the map and into every page made of it.
TEST_F(LabelReportVerb, ANameThatIsNoneIsRefused) {
  draw_three();
  for (const std::string& name : {std::string(70, 'x'), std::string("'two\nlines'")}) {
    const auto run = test::run_command(
        "roadbook import geojson l.geojson -m map.gpkg --latitude-deg "
        "47.4 --longitude-deg 8.5 --who " +
            name,
        folder_);
    EXPECT_NE(run.status, 0);
    EXPECT_NE(run.err.find("--who: got"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("want"), std::string::npos) << run.err;
  }
  EXPECT_EQ(read_labels(map_).size(), 3U);
}

}  // namespace
}  // namespace roadbook
