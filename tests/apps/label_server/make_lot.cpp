#include <cstdio>
#include <cstdlib>

#include "tests/apps/label_server/lot.hpp"

// make_lot MAP [AISLES SPACES_A_SIDE SIDE_PX [MOVED_M TURNED]]: a map to label; its spaces on
// standard output.
int main(int count, char** words) {
  if (count != 2 && count != 5 && count != 7) return 1;
  roadbook::test::Lot lot;
  if (count >= 5) {
    lot.aisles = std::atoi(words[2]);
    lot.spaces_a_side = std::atoi(words[3]);
    lot.side_px = std::atoi(words[4]);
  }
  if (count == 7) {
    lot.moved_m = std::atof(words[5]);
    lot.turned = std::atof(words[6]);
  }
  roadbook::test::write_lot(words[1], lot);
  for (const auto& box : roadbook::test::spaces_of(lot))
    std::printf("%.3f %.3f %.6f %.2f %.2f\n", box.centre.x(), box.centre.y(), box.heading,
                box.length_m, box.width_m);
  return 0;
}
