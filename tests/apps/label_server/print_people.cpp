#include <cinttypes>
#include <cstdio>

#include "mapping/store/map_file.hpp"
#include "vo/own_car_mask.hpp"
#include "workflows/people/people_truth.hpp"

// print_people MAP SESSION DRIVE: everybody in the images of a simulated drive, for
// people_labeller.py: stamp, camera, azimuth, slope of the feet, size, 1 for who must be found.
int main(int count, char** words) {
  using namespace roadbook;
  if (count != 4) return 1;
  const Map map = load_map(words[1]);
  const Drive drive = Drive::open(words[3]);
  const auto masks = find_own_car(drive, {}, 0).masks;
  std::vector<PersonCamera> cameras;
  const Rig& rig = map.sessions.at(static_cast<std::size_t>(std::atoi(words[2]))).rig;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c)
    cameras.emplace_back(rig.cameras[c], masks[c]);
  const PeopleTruth truth(drive);
  const PersonSearchOptions search;
  for (std::size_t f = 0; f < drive.frame_count(); ++f) {
    const std::int64_t t_ns = drive.frame_stamp_ns(f);
    for (const TruePerson& one :
         truth.at(t_ns, cameras, search.min_range_m, search.max_range_m).people)
      std::printf("%" PRId64 " %d %.9f %.9f %.9f %d\n", t_ns, one.box.camera, one.box.azimuth,
                  one.box.foot_slope, one.box.size, one.clear ? 1 : 0);
  }
  return 0;
}
