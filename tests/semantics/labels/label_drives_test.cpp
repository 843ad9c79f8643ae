#include "semantics/labels/label_drives.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/semantics/label_map.hpp"

namespace roadbook {
namespace {

// Two drives with the same stamps. If only the session number identified the drive, a label of one
// drive could move to the other.
Map map_of_two() {
  Map map = test::label_map(10);
  map.sessions.push_back(map.sessions[0]);
  map.sessions[0].name = map.sessions[0].drive_digest = "monday";
  map.sessions[1].name = map.sessions[1].drive_digest = "tuesday";
  const auto first = map.keyframes;
  for (Keyframe keyframe : first) {
    keyframe.session = 1;
    map.keyframes.push_back(keyframe);
  }
  return map;
}

TEST(LabelDrives, LabelsStayWhereTheirDrivesDoAndElseTheDrivesAreNamed) {
  const test::Folder folder;
  const auto file = folder / "map.gpkg";
  MapFileBuilder(file, "key").finish(map_of_two(), {});
  const auto fault = [&](const std::vector<std::string>& digests) -> std::string {
    try {
      check_labels_stay(file, read_existing_map(file, digests));
    } catch (const BadInput& bad) {
      return bad.what();
    }
    return {};
  };
  EXPECT_EQ(fault({"friday"}), "");  // the map has no labels yet
  {
    LabelStore store(file);
    for (const int session : {0, 1, 1}) {
      const auto t_ns = store.map().keyframes[3].t_ns;
      Label label = label_of_box(store.map(), {session, t_ns, 1}, {{1.0, 5.0}, 0.0, 5.0, 2.5});
      label.kind = "parking_space";
      store.create(label, "ann");
    }
  }
  EXPECT_EQ(fault({"monday", "tuesday", "friday"}), "");
  EXPECT_NE(fault({"monday", "friday"}).find("labels: got 2 of drive tuesday, want"),
            std::string::npos)
      << fault({"monday", "friday"});
  EXPECT_NE(fault({"tuesday", "monday"})
                .find("got 1 of drive monday, 2 of drive tuesday, want "
                      "these drives first, in this order (monday, tuesday)"),
            std::string::npos)
      << fault({"tuesday", "monday"});
}

}  // namespace
}  // namespace roadbook
