#include <cstdio>

#include "tests/apps/label_server/lot.hpp"
#include "tests/semantics/two_drives_files.hpp"

// make_two_drives MAP: writes a car park that was labelled with one drive, then driven a second
// time and bent by 3 %. Five spaces were painted again in between. Writes the recordings too, and
// prints the spaces by the numbers of their labels.
int main(int count, char** words) {
  if (count != 2) return 1;
  const std::filesystem::path file = words[1];
  roadbook::test::TwoDrives drives;
  for (int i = 4; i < 9; ++i) drives.second.repainted.insert(i);
  const auto truth = drives.poses();
  roadbook::test::write_recordings(drives, truth, file.parent_path());
  roadbook::test::write_first_drive(file, drives);
  roadbook::test::bend_second_drive(drives, 0.03);
  roadbook::MapFileBuilder(file, "both").finish(drives.map, {});
  roadbook::test::write_lot_picture(file, {.spaces_a_side = roadbook::test::kSpaces});
  for (const auto& label : roadbook::read_labels(file)) {
    const auto box = *roadbook::box_in_map(drives.map, label);
    std::printf("%.3f %.3f %.6f %.2f %.2f\n", box.centre.x(), box.centre.y(), box.heading,
                box.length_m, box.width_m);
  }
  return 0;
}
