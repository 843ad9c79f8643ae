#include "drive/wheel_counter.hpp"

#include <cmath>
#include <numbers>

#include "tests/drive/foreign_recordings.hpp"

namespace roadbook::test {
namespace {

constexpr double kTicks = 4096;
constexpr double kPerTick = 2.0 * std::numbers::pi / kTicks;

// Ticks of a wheel that turns `step` a row of 10 ms for 300 rows, as `counter` shows them.
template <typename Counter>
std::string encoder_table(std::int64_t step, const Counter& counter) {
  std::string text;
  for (std::int64_t i = 0; i < 300; ++i) {
    const std::string ticks = std::to_string(counter(i, step * i));
    text += std::to_string(1'544'578'500'000'000'000 + i * 10'000'000) + "," + ticks + "," + ticks +
            "\n";
  }
  return text;
}

struct Imported {
  double turned_ticks = 0.0;  ///< of the left wheel, first to last row
  double largest_step = 0.0;
  std::string text;
};

Imported import_encoder(const std::string& text) {
  const TemporaryFolder f;
  const auto made = try_import("kaist", write_kaist(f.path() / "s", text), f.path() / "out");
  Imported result{0.0, 0.0, made.text};
  if (made.refused) return result;
  const auto rows = Drive::open(f.path() / "out").wheel_readings();
  result.turned_ticks = (rows.back().left_angle_rad - rows.front().left_angle_rad) / kPerTick;
  for (std::size_t i = 1; i < rows.size(); ++i)
    result.largest_step =
        std::max(result.largest_step,
                 std::abs(rows[i].left_angle_rad - rows[i - 1].left_angle_rad) / kPerTick);
  return result;
}

TEST(WheelCounter, KaistCountersThatWrapGoOnWithoutAWord) {
  for (const std::int64_t range : {std::int64_t{1} << 16, std::int64_t{1} << 32})
    for (const std::int64_t step : {40, 3, -40}) {
      const auto got = import_encoder(encoder_table(step, [&](std::int64_t, std::int64_t ticks) {
        return ((range - 1500 * (step > 0 ? 1 : -1) + ticks) % range + range) % range;
      }));
      EXPECT_NEAR(got.turned_ticks, 299.0 * static_cast<double>(step), 1e-3) << range;
      EXPECT_EQ(got.text, "");
    }
}

TEST(WheelCounter, SignedCountersWrapFromTheirLargestToTheirSmallestValue) {
  const auto got = import_encoder(encoder_table(40, [](std::int64_t, std::int64_t ticks) {
    return static_cast<std::int64_t>(static_cast<std::int16_t>(32'000 + ticks));
  }));
  EXPECT_NEAR(got.turned_ticks, 299.0 * 40, 1e-3);
}

TEST(WheelCounter, AResetKeepsTheDistanceWithAWord) {
  for (const std::int64_t start : {5'000, 60'000, 3'000'000}) {
    const auto got = import_encoder(encoder_table(40, [&](std::int64_t i, std::int64_t ticks) {
      return i < 150 ? start + ticks : ticks - 150 * 40 + 11;
    }));
    // Constant speed: the bridge is exact.
    EXPECT_NEAR(got.turned_ticks, 299.0 * 40, 1e-3) << start;
    ROADBOOK_EXPECT_TEXT(got.text,
                         "encoder.csv:151: left: got a counter that begins again at zero "
                         "once; bridged with the speed before");
    ROADBOOK_EXPECT_TEXT(got.text, ": right: got ");
  }
}

TEST(WheelCounter, ZerosAmidACountAreNoReset) {
  const auto got = import_encoder(encoder_table(40, [](std::int64_t i, std::int64_t ticks) {
    return i >= 100 && i < 105 ? 0 : 50'000 + ticks;
  }));
  EXPECT_NEAR(got.turned_ticks, 299.0 * 40, 1e-3);
  ROADBOOK_EXPECT_TEXT(got.text, "zeros amid its count once");
  EXPECT_EQ(got.text.find("begins again"), std::string::npos) << got.text;
}

TEST(WheelCounter, ASingleWildValueIsNoPartOfTheDistance) {
  const auto got = import_encoder(encoder_table(40, [](std::int64_t i, std::int64_t ticks) {
    return i == 100 ? 900'000'000 : 50'000 + ticks;
  }));
  EXPECT_NEAR(got.turned_ticks, 299.0 * 40, 1e-3);
}

// The wheel speeds up, stops and reverses through the first count. The counter does not restart.
TEST(WheelCounter, ADriveThroughZeroIsLeftAlone) {
  WheelCounter counter(0.31, tick_ranges_rad(kTicks));
  Random random(3, "jitter");
  for (int i = 0; i < 3000; ++i) {
    const double ticks = std::round(3000.0 * std::cos(0.004 * i) + random.uniform(-2.0, 2.0));
    EXPECT_EQ(counter.add(ticks * kPerTick, 0.01), ticks * kPerTick);
    EXPECT_EQ(counter.event(), CounterEvent::kNone);
  }
}

TEST(WheelCounter, AnglesOfOneTurnGoOn) {
  const TemporaryFolder f;
  std::string text = "#timestamp [ns],rear_left_angle [rad],rear_right_angle [deg]\n";
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.3 * i;
    text +=
        std::to_string(std::int64_t{i} * 20'000'000) + "," +
        std::to_string(std::fmod(angle, 2.0 * std::numbers::pi)) + "," +
        std::to_string(std::remainder(angle, 2.0 * std::numbers::pi) * 180.0 / std::numbers::pi) +
        "\n";
  }
  write_text(f.path() / "wheels0/data.csv", text);
  write_text(f.path() / "wheels0/sensor.yaml",
             "sensor_type: wheels\nwheel_radius_left: 0.3\nwheel_radius_right: 0.3\n"
             "track_width: 1.5\n");
  EXPECT_EQ(all_lines(check_drive(f.path())), "");
  const auto rows = Drive::open(f.path()).wheel_readings();
  EXPECT_NEAR(rows.back().left_angle_rad, 0.3 * 199, 1e-5);
  EXPECT_NEAR(rows.back().right_angle_rad, 0.3 * 199, 1e-5);
}

// For any counts, the angles are finite. Where an event explains a step, the step is plausible for
// a car.
TEST(WheelCounter, RandomCountsGiveFiniteAngles) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, "counts");
    WheelCounter counter(0.31, tick_ranges_rad(kTicks));
    double before = 0.0;
    for (int i = 0; i < 200; ++i) {
      const double dt_s = random.uniform(0.0, 0.1);
      const double now = std::round(std::pow(10.0, random.uniform(0.0, 10.0))) * kPerTick;
      const double angle = counter.add(now, dt_s);
      ASSERT_TRUE(std::isfinite(angle));
      if (i > 0 && counter.event() == CounterEvent::kWrap) {
        ASSERT_LE(std::abs(angle - before) * 0.31, kFastestCar_m_s * dt_s + 1e-6);
      }
      before = angle;
    }
  }
}

}  // namespace
}  // namespace roadbook::test
