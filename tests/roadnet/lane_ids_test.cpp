#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/random.hpp"
#include "roadnet/build_network.hpp"
#include "tests/roadnet/random_lots.hpp"

namespace roadbook::test {
namespace {

// Places of the lot that a lane begins and ends at, as a key that no update changes.
std::set<int> places_beside(const Lot& lot, const Lane& lane, const Eigen::Vector3d& shift) {
  std::set<int> places;
  for (std::size_t i = 0; i < lot.places.size(); ++i)
    for (const Eigen::Vector3d& p : lane.centre)
      if ((p - shift - lot.places[i]).norm() < 6.0) places.insert(static_cast<int>(i));
  return places;
}

// Seven versions of a map of the same place. Every version comes from a new drive (other offsets,
// other laps), and a new optimisation moves the whole map by some centimetres. Version 4 adds a
// dead end at the middle of an aisle. It changes only the lanes that it touches.
TEST(LaneIds, AreKeptForUnchangedLanesOverSevenVersionsDrivenAnew) {
  int same = 0;
  int total = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Lot old_lot = random_lot(0, seed);
    Lot new_lot = old_lot;
    const auto [a, b] = new_lot.roads.front();
    const Eigen::Vector3d middle = 0.5 * (new_lot.places[static_cast<std::size_t>(a)] +
                                          new_lot.places[static_cast<std::size_t>(b)]);
    const Eigen::Vector3d along =
        (new_lot.places[static_cast<std::size_t>(b)] - new_lot.places[static_cast<std::size_t>(a)])
            .normalized();
    const int at = static_cast<int>(new_lot.places.size());
    // Away from the other aisles, which all lie to one side of the first.
    const Eigen::Vector3d side(-along.y(), along.x(), 0.0);
    Eigen::Vector3d away = side;
    for (const auto& p : new_lot.places)
      if ((p - middle).dot(side) > 5.0) away = -side;
    new_lot.places.push_back(middle);
    new_lot.places.push_back(middle + 25.0 * away);
    new_lot.roads.front() = {a, at};
    new_lot.roads.emplace_back(at, b);
    new_lot.roads.emplace_back(at, at + 1);

    Random random(seed, "versions");
    RoadNetwork before;
    Eigen::Vector3d shift_before = Eigen::Vector3d::Zero();
    for (int version = 0; version < 7; ++version) {
      const Lot& lot = version < 4 ? old_lot : new_lot;
      const Eigen::Vector3d shift(random.normal(0.0, 0.05), random.normal(0.0, 0.05), 0.0);
      auto passes = drive_lot(lot, 2 + version % 3, 0.25, 0.2,
                              100 * seed + static_cast<std::uint64_t>(version));
      for (DrivenPass& pass : passes)
        for (auto& p : pass.positions) p += shift;
      const RoadNetwork now = build_road_network(passes, {}, version > 0 ? &before : nullptr);
      for (const Lane& lane : before.lanes) {
        // A lane is unchanged if a lane of the new version runs by the same places of the lot.
        const auto key = places_beside(new_lot, lane, shift_before);
        const auto twin = std::find_if(now.lanes.begin(), now.lanes.end(), [&](const Lane& other) {
          return places_beside(new_lot, other, shift) == key &&
                 std::abs(other.length_m - lane.length_m) < 6.0;
        });
        if (twin == now.lanes.end()) continue;
        ++total;
        same += std::any_of(now.lanes.begin(), now.lanes.end(), [&](const Lane& other) {
          return other.id == lane.id && places_beside(new_lot, other, shift) == key;
        });
      }
      before = now;
      shift_before = shift;
    }
  }
  EXPECT_GT(total, 250);
  EXPECT_GT(same, 0.98 * total) << same << " of " << total;
  RecordProperty("same", same);
  RecordProperty("total", total);
}

}  // namespace
}  // namespace roadbook::test
