#include "diagnosis/landmarks_gone.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "diagnosis/group_counts.hpp"

namespace roadbook {
namespace {

constexpr const char* kName = "map.landmarks_gone";
constexpr std::size_t kFewestLandmarks = 50;
constexpr std::size_t kOffsets = 4;  // by half a side along x, y or both
constexpr std::size_t kSteps = 30;   // squares tried
constexpr std::size_t kVain = 3;     // that fail, one after the other
constexpr double kApart = 1.0;       // [m] between things

// Squares of one side and offset.
using Cells = std::map<std::pair<int, int>, std::vector<std::size_t>>;

Cells cells_of(const std::vector<LandmarkChance>& chances, double side_m, std::size_t offset) {
  const double x = offset % 2 == 0 ? 0.0 : 0.5;
  const double y = offset < 2 ? 0.0 : 0.5;
  Cells cells;
  for (std::size_t i = 0; i < chances.size(); ++i)
    cells[{static_cast<int>(std::floor(chances[i].p_map.x() / side_m + x)),
           static_cast<int>(std::floor(chances[i].p_map.y() / side_m + y))}]
        .push_back(i);
  return cells;
}

struct Square {
  std::vector<std::size_t> landmarks;
  double scatter = 0.0;  // of squares of its size
};

GroupCount count_of(const std::vector<std::size_t>& landmarks,
                    const std::vector<LandmarkChance>& chances) {
  GroupCount group;
  double expected = 0.0;
  for (const std::size_t i : landmarks) {
    ++group.items;
    group.count += chances[i].found ? 1 : 0;
    expected += chances[i].chance;
  }
  group.mean = expected / std::max(group.items, 1);
  return group;
}

double expected(const GroupCount& group) { return group.items * group.mean; }

// Squares of one size by those landmarks that are taken to stand, and how much they scatter.
std::vector<Square> squares_of(const std::vector<LandmarkChance>& chances,
                               const std::vector<std::uint8_t>& stands,
                               double side_m,
                               double least_expected) {
  std::vector<Square> squares;
  std::vector<GroupCount> groups;  // of one offset: each landmark once
  for (std::size_t offset = 0; offset < kOffsets; ++offset)
    for (auto& [cell, landmarks] : cells_of(chances, side_m, offset)) {
      std::erase_if(landmarks, [&](std::size_t i) { return stands[i] == 0; });
      const GroupCount group = count_of(landmarks, chances);
      if (expected(group) < least_expected) continue;
      if (offset == 0) groups.push_back(group);
      squares.push_back({std::move(landmarks), 0.0});
    }
  const double scatter = scatter_of(groups);
  for (Square& square : squares) square.scatter = scatter;
  return squares;
}

// Probability of so few under chance and scatter; 1 where the square is not nearly empty.
double chance_of(const Square& square, const std::vector<LandmarkChance>& chances) {
  const GroupCount g = count_of(square.landmarks, chances);
  if (g.count > kMostLeft * expected(g)) return 1.0;
  return group_tail(g, square.scatter);
}

struct Fallen {
  Square square;
  std::size_t size = 0;  // of the square, in `sides_m`
  double p = 1.0;
};

// All squares by those landmarks that stand, by size.
using SquaresBySize = std::vector<std::vector<Square>>;

SquaresBySize all_squares(const std::vector<std::uint8_t>& stands,
                          const LandmarksGoneOptions& options,
                          std::vector<LandmarkChance>& chances) {
  judge_chances(stands, chances);
  SquaresBySize all;
  for (const double side : options.sides_m)
    all.push_back(squares_of(chances, stands, side, options.least_expected));
  return all;
}

Fallen surest(const SquaresBySize& squares, const std::vector<LandmarkChance>& chances) {
  Fallen best;
  for (std::size_t size = 0; size < squares.size(); ++size)
    for (const Square& square : squares[size])
      if (const double p = chance_of(square, chances); p < best.p) best = {square, size, p};
  return best;
}

// Takes the surest square for fallen, then the surest of what it leaves, and so on; each by chance
// and scatter of what is left without it, for what is gone tells nothing of what stands, and alike
// ones hide each other.
std::vector<Fallen> fallen_squares(std::vector<LandmarkChance>& chances,
                                   const LandmarksGoneOptions& options,
                                   LandmarksGone& all) {
  std::vector<std::uint8_t> stands(chances.size(), 1);
  SquaresBySize squares = all_squares(stands, options, chances);
  for (const auto& one : squares) all.tests += one.size();
  std::vector<Fallen> tried;
  std::size_t sure = 0;
  while (tried.size() < kSteps && tried.size() < sure + kVain) {
    Fallen next = surest(squares, chances);
    if (next.p >= 1.0) break;
    for (const std::size_t i : next.square.landmarks) stands[i] = 0;
    SquaresBySize left = all_squares(stands, options, chances);
    if (left[next.size].empty()) break;  // nothing is left to tell by
    squares = std::move(left);
    next.square.scatter = squares[next.size].front().scatter;
    next.p = chance_of(next.square, chances);
    tried.push_back(std::move(next));
    if (tried.back().p < options.try_at) sure = tried.size();
  }
  tried.resize(sure);
  return tried;
}

Eigen::Vector3d middle_of_lost(const Square& square, const std::vector<LandmarkChance>& chances) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const std::size_t i : square.landmarks) {
    if (chances[i].found) continue;
    sum += chances[i].p_map;
    count += 1.0;
  }
  return sum / count;
}

bool touch(const Square& a, const Square& b, const std::vector<LandmarkChance>& chances) {
  for (const std::size_t i : a.landmarks)
    for (const std::size_t j : b.landmarks)
      if (!chances[i].found && !chances[j].found &&
          (chances[i].p_map - chances[j].p_map).head<2>().norm() < kApart)
        return true;
  return false;
}

// Squares whose lost landmarks touch are one thing, of one luck: judged as a single square is.
std::vector<Fallen> joined(std::vector<Fallen> fallen, const std::vector<LandmarkChance>& chances) {
  for (std::size_t a = 0; a < fallen.size(); ++a)
    for (std::size_t b = a + 1; b < fallen.size();) {
      if (!touch(fallen[a].square, fallen[b].square, chances)) {
        ++b;
        continue;
      }
      auto& all = fallen[a].square.landmarks;
      const auto& more = fallen[b].square.landmarks;
      all.insert(all.end(), more.begin(), more.end());
      fallen.erase(fallen.begin() + static_cast<std::ptrdiff_t>(b));
      b = a + 1;
    }
  return fallen;
}

FoundPlace place_of(const Fallen& fallen,
                    const std::vector<LandmarkChance>& chances,
                    double tests) {
  FoundPlace place;
  const GroupCount group = count_of(fallen.square.landmarks, chances);
  place.middle = middle_of_lost(fallen.square, chances);
  for (const std::size_t i : fallen.square.landmarks) {
    place.expected_sightings += chances[i].expected;
    place.sightings += static_cast<std::size_t>(chances[i].sightings);
    if (!chances[i].found)
      place.reach_m = std::max(place.reach_m, (chances[i].p_map - place.middle).head<2>().norm());
  }
  place.landmarks = static_cast<std::size_t>(group.items);
  place.expected = expected(group);
  place.found = static_cast<std::size_t>(group.count);
  place.p = std::min(1.0, tests * fallen.p);
  return place;
}

// Adds a place; its share of gone landmarks with the error of a binomial.
void add(const Fallen& fallen, const std::vector<LandmarkChance>& chances, LandmarksGone& all) {
  const FoundPlace place = place_of(fallen, chances, static_cast<double>(all.tests));
  const auto items = static_cast<double>(place.landmarks);
  const double left = static_cast<double>(place.found) / place.expected;
  all.gone += items * (1.0 - left);
  all.sigma = std::hypot(
      all.sigma, items * std::sqrt((static_cast<double>(place.found) + 1.0)) / place.expected);
  const GroupCount group = count_of(fallen.square.landmarks, chances);
  // The places were chosen by the same counts: less the logarithm of how many there were.
  all.gain += fallen_log(group) - group_log(group, fallen.square.scatter) -
              std::log(static_cast<double>(std::max<std::size_t>(1, all.tests)));
  all.places.push_back(place);
}

FoundCause found(const LandmarksGone& g, double known) {
  FoundCause cause;
  const auto n = static_cast<double>(g.landmarks);
  cause.effect = kName;
  cause.unit = "1";
  cause.size = g.gone / n - known;
  cause.low = std::max(0.0, cause.size - 1.96 * g.sigma / n);
  cause.high = cause.size + 1.96 * g.sigma / n;
  cause.p = g.places.front().p;
  cause.evidence = g.gain;
  cause.gain.total = g.gain;
  cause.gain.per_sample = g.gain / n;
  // As of noise: z^2 / 2 scatters by z.
  const double scatter = std::sqrt(2.0 * std::max(0.0, g.gain));
  cause.gain.low = g.gain - 1.96 * scatter;
  cause.gain.high = g.gain + 1.96 * scatter;
  cause.gain.interleaved = true;
  cause.note =
      "of landmarks that should be seen again, at the places below alone: a lower bound; gone, or "
      "hidden by what is new; the gain is of the counts that chose the places, less their number";
  cause.places = g.places;
  return cause;
}

}  // namespace

LandmarksGone landmarks_gone(std::vector<LandmarkChance> chances,
                             const LandmarksGoneOptions& options) {
  LandmarksGone g;
  g.landmarks = chances.size();
  if (chances.empty()) return g;
  std::vector<Fallen> fallen = fallen_squares(chances, options, g);
  for (const LandmarkChance& c : chances) g.chance += c.chance / static_cast<double>(g.landmarks);
  std::vector<std::uint8_t> stands(chances.size(), 1);
  for (const Fallen& f : fallen)
    for (const std::size_t i : f.square.landmarks) stands[i] = 0;
  const SquaresBySize left = all_squares(stands, options, chances);
  for (const auto& squares : left)
    if (!squares.empty()) g.scatter = std::max(g.scatter, squares.front().scatter);
  const double level = options.level / static_cast<double>(std::max<std::size_t>(1, g.tests));
  for (Fallen& thing : joined(std::move(fallen), chances)) {
    thing.square.scatter = g.scatter;
    thing.p = chance_of(thing.square, chances);
    if (thing.p < level) add(thing, chances, g);
  }
  std::stable_sort(g.places.begin(), g.places.end(),
                   [](const FoundPlace& a, const FoundPlace& b) { return a.p < b.p; });
  return g;
}

Diagnosis diagnose_gone(const Map& map,
                        int session,
                        const std::vector<LandmarkTwin>& twins,
                        const EffectSizes& known,
                        const std::vector<std::string>& without) {
  Diagnosis d;
  if (map.sessions.size() < 2 || std::find(without.begin(), without.end(), kName) != without.end())
    return d;
  d.looked_for.emplace_back(kName);
  const LandmarksGone g = landmarks_gone(landmark_chances(map, session, twins));
  d.samples = g.landmarks;
  if (g.landmarks < kFewestLandmarks || g.tests == 0) {
    d.not_observable.emplace_back(kName);
    d.notes.push_back(
        "too few landmarks of other sessions of the map should be seen again to say what is "
        "gone: " +
        std::to_string(g.landmarks));
    return d;
  }
  const double already = effect_size(known, "map", "landmarks_gone");
  if (g.places.empty() || g.gone - already * static_cast<double>(g.landmarks) < 2.0 * g.sigma)
    return d;
  d.causes.push_back(found(g, already));
  d.extended[kName] = d.causes.back().size;
  return d;
}

}  // namespace roadbook
