#include <cstdio>

#include "tests/apps/label_server/crowd.hpp"

// make_crowd MAP [bare]: writes a map and its recording (bare: without an overhead image), and
// prints its people: instant, camera, pixels of feet and head.
int main(int count, char** words) {
  if (count != 2 && count != 3) return 1;
  roadbook::test::write_crowd(words[1], count == 2);
  for (const auto& one : roadbook::test::crowd())
    std::printf("%d %d %.2f %.2f %.2f %.2f\n",
                static_cast<int>((one.image.t_ns - roadbook::test::kCrowdBegin) / 500'000'000),
                one.image.camera, one.foot.x(), one.foot.y(), one.head.x(), one.head.y());
  return 0;
}
