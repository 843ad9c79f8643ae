#include "speedmap/speeds/speed_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

// Straight lines between speeds `step_m` apart; the least between two places by its definition.
struct Profile {
  std::vector<double> speeds;
  double step_m = 0.25;
  [[nodiscard]] double at(double s) const {
    const double place = std::clamp(s / step_m, 0.0, static_cast<double>(speeds.size()) - 1.0);
    const auto i = std::min(static_cast<std::size_t>(place), speeds.size() - 2);
    return speeds[i] + (place - static_cast<double>(i)) * (speeds[i + 1] - speeds[i]);
  }
  [[nodiscard]] LeastSpeed least() const {
    return [this](double from, double to) {
      double least = std::min(at(from), at(to));
      for (std::size_t i = 0; i < speeds.size(); ++i)
        if (const double s = step_m * static_cast<double>(i); s > from && s < to)
          least = std::min(least, speeds[i]);
      return least;
    };
  }
};

Profile random_profile(std::uint64_t seed) {
  Random random(seed, "speed pieces");
  Profile profile;
  double v = random.uniform(1.0, 9.0);
  for (int i = 0, n = 10 + static_cast<int>(random.below(1200)); i < n; ++i) {
    if (random.uniform() < 0.02) v = random.uniform(0.5, 9.0);
    profile.speeds.push_back(v * random.uniform(0.9, 1.0));
  }
  return profile;
}

double travel_time_s(const std::vector<SpeedPiece>& pieces) {
  double time = 0.0;
  for (const SpeedPiece& piece : pieces) time += piece.length_m() / piece.speed;
  return time;
}

// A profile need not exist outside the way.
TEST(SpeedPieces, AskForSpeedsOfTheWayAlone) {
  for (const double length : {0.3, 7.0, 123.4}) {
    SpeedPieceOptions options;
    options.at_least = 2;
    const LeastSpeed least = [&](double from, double to) {
      EXPECT_GE(from, 2.0);
      EXPECT_LT(from, to);
      EXPECT_LE(to, 2.0 + length + 1e-9);
      return 4.0 + std::sin(from);
    };
    EXPECT_GE(speed_pieces(least, 2.0, 2.0 + length, options).size(), 2U);
  }
}

TEST(SpeedPieces, CoverTheWayWithoutGapsAndAreNowhereFasterThanTheProfile) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Profile profile = random_profile(seed);
    const double begin = seed % 3 == 0 ? 1.7 : 0.0;
    const double end = profile.step_m * static_cast<double>(profile.speeds.size() - 1) - 0.4;
    if (end - begin < 0.5) continue;
    SpeedPieceOptions options;
    if (seed % 2 == 1) options.longest_m = 50.0;
    if (seed % 5 == 0) options.at_least = 2;
    const auto pieces = speed_pieces(profile.least(), begin, end, options);
    ASSERT_GE(static_cast<int>(pieces.size()), options.at_least);
    EXPECT_EQ(pieces.front().begin_m, begin);
    EXPECT_EQ(pieces.back().end_m, end);
    const double possible = std::min(options.shortest_m, (end - begin) / options.at_least);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (i > 0) {
        EXPECT_EQ(pieces[i].begin_m, pieces[i - 1].end_m);
      }
      EXPECT_LE(pieces[i].length_m(), options.longest_m + 1e-9);
      // The grid is about half a metre.
      EXPECT_GE(pieces[i].length_m(), 0.5 * possible - 1e-9);
      if (end - begin >= 11.0) {
        EXPECT_GE(pieces[i].length_m(), options.shortest_m - 1e-9);
      }
      for (double s = pieces[i].begin_m; s <= pieces[i].end_m; s += 0.05)
        ASSERT_LE(pieces[i].speed, profile.at(s) + 1e-12);
    }
  }
}

// The reference tries every division of a short path on the same grid.
TEST(SpeedPieces, NoOtherCutsAreFaster) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Profile profile = random_profile(seed);
    profile.step_m = 0.5;
    profile.speeds.resize(15, 3.0);  // 7 m: 14 steps of the grid
    SpeedPieceOptions options;
    options.shortest_m = 1.0;
    const double best = [&] {
      double least = INFINITY;
      for (unsigned cuts = 0; cuts < (1U << 13U); ++cuts) {
        std::vector<SpeedPiece> pieces;
        double from = 0.0;
        for (int i = 1; i <= 14; ++i) {
          if (i < 14 && (cuts >> static_cast<unsigned>(i - 1) & 1U) == 0) continue;
          pieces.push_back({from, 0.5 * i, profile.least()(from, 0.5 * i)});
          from = 0.5 * i;
        }
        if (std::any_of(pieces.begin(), pieces.end(),
                        [](const SpeedPiece& p) { return p.length_m() < 1.0; }))
          continue;
        least = std::min(least, travel_time_s(pieces) +
                                    options.further_cut_s * static_cast<double>(pieces.size()));
      }
      return least;
    }();
    const auto pieces = speed_pieces(profile.least(), 0.0, 7.0, options);
    EXPECT_NEAR(travel_time_s(pieces) + options.further_cut_s * static_cast<double>(pieces.size()),
                best, 1e-9);
  }
}

TEST(SpeedPieces, AConstantSpeedIsOnePiece) {
  const auto pieces = speed_pieces([](double, double) { return 4.0; }, 0.0, 700.0);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces.front().speed, 4.0);
}

TEST(SpeedPieces, OptionsOutOfRangeAreNamed) {
  SpeedPieceOptions options;
  options.longest_m = 4.0;
  EXPECT_THROW((void)speed_pieces([](double, double) { return 4.0; }, 0.0, 9.0, options),
               InvalidOption);
}

TEST(SpeedPieces, EndOnlyWhereTheyMay) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Profile profile = random_profile(seed);
    const double end = profile.step_m * static_cast<double>(profile.speeds.size() - 1);
    if (end < 20.0) continue;
    SpeedPieceOptions options;
    options.may_cut = [](double s) { return std::fmod(s, 20.0) > 15.0; };
    const auto pieces = speed_pieces(profile.least(), 0.0, end, options);
    EXPECT_EQ(pieces.back().end_m, end);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i)
      EXPECT_GT(std::fmod(pieces[i].end_m, 20.0), 15.0);
    // Nowhere: one piece.
    options.may_cut = [](double) { return false; };
    EXPECT_EQ(speed_pieces(profile.least(), 0.0, end, options).size(), 1U);
    // A longest piece goes first.
    options.longest_m = 10.0;
    EXPECT_GT(speed_pieces(profile.least(), 0.0, end, options).size(), 1U);
  }
}

}  // namespace
}  // namespace roadbook
