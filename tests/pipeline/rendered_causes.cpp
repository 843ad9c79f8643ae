#include "tests/pipeline/rendered_causes.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "diagnosis/brightness/brightness_samples.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/streams/drive_session.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook::test {
namespace {

constexpr double kHinge = 0.07;  // 0.035 up on either side, as the scenario says

Diagnosis diagnosis_of(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const Drive drive = Drive::open(folder);
  const Map map = load_map(file);
  return diagnose_through_map(map, session_of(map, drive, file), drive);
}

// Returns the causes other than the place's own bend, which must have the size that the scenario
// states.
std::vector<FoundCause> beside_the_hinge(const Diagnosis& d) {
  EXPECT_TRUE(d.unknown.empty()) << d.unknown.front().stream << " " << d.unknown.front().hook;
  std::vector<FoundCause> others;
  bool bent = false;
  for (const FoundCause& c : d.causes) {
    if (c.effect != "ground.hinge") {
      others.push_back(c);
      continue;
    }
    bent = true;
    EXPECT_NEAR(c.size, kHinge, c.high - c.low);
    EXPECT_LT(c.high - c.low, 0.3 * kHinge);
  }
  EXPECT_TRUE(bent);
  return others;
}

void expect_same_samples_on_any_number_of_threads(const std::filesystem::path& folder,
                                                  const std::filesystem::path& file) {
  const Drive drive = Drive::open(folder);
  const Map map = load_map(file);
  const auto greys = [&](int num_threads) {
    BrightnessOptions options;
    options.num_threads = num_threads;
    std::vector<double> all;
    for (const BrightnessSample& s :
         brightness_samples(map, session_of(map, drive, file), drive, options))
      all.push_back(s.log_grey);
    return all;
  };
  const std::vector<double> one = greys(1);
  EXPECT_GT(one.size(), 100U);
  EXPECT_EQ(one, greys(3));
}

}  // namespace

void expect_nothing_but_the_hinge(const std::filesystem::path& drive,
                                  const std::filesystem::path& map) {
  expect_same_samples_on_any_number_of_threads(drive, map);
  const auto others = beside_the_hinge(diagnosis_of(drive, map));
  EXPECT_TRUE(others.empty()) << others.front().effect << " " << others.front().size;
}

void shorten_focal_length(const std::filesystem::path& drive) {
  const auto file = drive / "cam1" / "sensor.yaml";
  std::string text;
  {
    std::ifstream in(file);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::string key = "intrinsics: [";
  const auto begin = text.find(key);
  ASSERT_NE(begin, std::string::npos);
  std::size_t read = 0;
  const std::string values = text.substr(begin + key.size());
  const double fx = std::stod(values, &read);
  std::size_t more = 0;
  const double fy = std::stod(values.substr(read + 1), &more);
  text.replace(begin + key.size(), read + 1 + more,
               std::to_string(fx / 1.01) + ", " + std::to_string(fy / 1.01));
  std::ofstream(file) << text;
}

void expect_cause(const std::filesystem::path& drive,
                  const std::filesystem::path& map,
                  const std::string& effect,
                  double size) {
  const auto others = beside_the_hinge(diagnosis_of(drive, map));
  ASSERT_EQ(others.size(), 1U);
  EXPECT_EQ(others[0].effect, effect);
  EXPECT_NEAR(others[0].size, size, others[0].high - others[0].low);
}

}  // namespace roadbook::test
