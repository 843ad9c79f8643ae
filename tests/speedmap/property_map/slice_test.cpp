#include "speedmap/property_map/slice.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/random.hpp"
#include "tests/speedmap/small_property_map.hpp"

namespace roadbook {
namespace {

PropertyMap driven_map(bool closed) {
  PropertyMap map = test::small_map({}, closed);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
    map.add_label(v, v.s_m < 8.0 ? 0 : v.e_m > 0.0 ? 1 : 2);
    if (i % 4 == 0) map.add_value(0, v, v.s_m < 8.0 ? 0.6 : v.e_m > 0.0 ? 0.9 : 0.4);
  }
  return map;
}

// Over the seam on the ring.
std::pair<double, double> range_of(bool closed) {
  return closed ? std::pair{16.0, 25.0} : std::pair{5.0, 12.0};
}

TEST(Slice, GivesTheMapsNumbers) {
  for (const bool closed : {false, true}) {
    const PropertyMap map = driven_map(closed);
    const auto [begin, end] = range_of(closed);
    const SliceView view(make_slice(map, 0, begin, end));
    Random random(2);
    for (int i = 0; i < 500; ++i) {
      const PathPlace v{random.uniform(begin, end), random.uniform(-4.0, 4.0)};
      const auto want = map.moments_with_derivatives(0, v);
      const auto got = view.moments_with_derivatives(v);
      ASSERT_EQ(got.has_value(), want.has_value());
      if (!want) continue;
      EXPECT_NEAR(got->mean, want->mean, 1e-12);
      EXPECT_NEAR(got->variance, want->variance, 1e-12);
      EXPECT_LT((got->d_mean - want->d_mean).norm(), 1e-12);
      EXPECT_LT((got->d_variance - want->d_variance).norm(), 1e-12);
      EXPECT_LT((got->dd_mean - want->dd_mean).norm(), 1e-11);
      EXPECT_EQ(view.moments(v)->mean, got->mean);
      if (closed) {
        EXPECT_NEAR(view.moments({v.s_m - 20.0, v.e_m})->mean, got->mean, 1e-12);
      }
    }
    EXPECT_FALSE(view.moments({begin - 0.1, 0.0}));
    EXPECT_FALSE(view.moments({end + 0.1, 0.0}));
  }
}

TEST(Slice, SurvivesJsonBitByBit) {
  const PropertySlice slice = make_slice(driven_map(true), 0, 16.0, 25.0, {"place.gpkg", 123});
  const std::string text = slice_json(slice);
  const PropertySlice back = parse_slice(text, "slice.json");
  EXPECT_EQ(slice_json(back), text);
  EXPECT_EQ(back.digest(), slice.digest());
  EXPECT_EQ(back.source.map, "place.gpkg");
  EXPECT_EQ(back.source.date_ns, 123);
}

std::string message_of(const std::string& text) {
  try {
    (void)parse_slice(text, "slice.json");
  } catch (const BadInput& error) {
    return error.what();
  }
  return "read";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Slice, FilesThatAreNotOursAreRefusedWithTheField) {
  const std::string good = slice_json(make_slice(driven_map(false), 0, 5.0, 12.0));
  EXPECT_EQ(message_of(good), "read");
  EXPECT_EQ(message_of(with(good, "\"version\": 1", "\"version\": 2")),
            "error: slice.json: version: got 2, want 1");
  EXPECT_EQ(message_of("{"), "error: slice.json: got no JSON object, want a slice");
  EXPECT_EQ(message_of("{}"), "error: slice.json: format: got nothing, want a value");
  EXPECT_TRUE(
      message_of(with(good, "\"left\"", "\"right\"")).starts_with("error: slice.json: e_p"));
  EXPECT_TRUE(message_of(with(good, "\"width_s_m\": 2.0", "\"width_s_m\": -2.0"))
                  .starts_with("error: slice.json: kernel"));
  EXPECT_TRUE(message_of(with(good, "\"width_s_m\": 2.0", "\"width_s_m\": 2.5"))
                  .starts_with("error: slice.json: digest"));
  EXPECT_TRUE(message_of(good.substr(0, good.size() / 2)).starts_with("error: slice.json: got no"));
}

// The test compiles and runs the header as C, without any other code of roadbook.
TEST(Slice, TheHeaderAloneGivesTheMapsNumbersInC) {
  namespace fs = std::filesystem;
  ASSERT_EQ(std::system("cc --version > /dev/null 2>&1"), 0) << "no C compiler; g++ brings one";
  const PropertyMap map = driven_map(true);
  const fs::path folder = fs::temp_directory_path() / "roadbook_slice_test";
  fs::create_directories(folder);
  std::ofstream(folder / "slice.h") << slice_header(make_slice(map, 0, 16.0, 25.0), "grip");
  std::ofstream program(folder / "main.c");
  program << "#include \"slice.h\"\n#include <stdio.h>\nint main(void) { double s, e, o[6];\n"
             "while (scanf(\"%lf %lf\", &s, &e) == 2)\n"
             "  if (grip_evaluate(s, e, o)) printf(\"%.17g %.17g %.17g %.17g %.17g %.17g\\n\", "
             "o[0], o[1], o[2], o[3], o[4], o[5]);\n  else printf(\"none\\n\");\nreturn 0; }\n";
  program.close();
  std::vector<PathPlace> places = {{17.0, 1.0}, {15.9, 0.0}, {18.0, 6.0}};
  Random random(3);
  for (int i = 0; i < 200; ++i)
    places.push_back({random.uniform(16.0, 25.0), random.uniform(-3.0, 3.0)});
  std::ofstream input(folder / "in");
  input.precision(17);
  for (const PathPlace& v : places) input << v.s_m << ' ' << v.e_m << '\n';
  input.close();
  const std::string in = "cd '" + folder.string() + "' && ";
  ASSERT_EQ(std::system((in + "cc -std=c99 -Wall -Wextra -Werror -pedantic -O1 main.c -o main -lm"
                              " && ./main < in > out")
                            .c_str()),
            0);
  std::ifstream output(folder / "out");
  for (const PathPlace& v : places) {
    std::string line;
    ASSERT_TRUE(std::getline(output, line));
    const bool inside = v.s_m >= 16.0 && v.s_m <= 25.0;
    const auto want = inside ? map.moments_with_derivatives(0, v) : std::nullopt;
    ASSERT_EQ(line != "none", want.has_value());
    if (!want) continue;
    double o[6];
    std::istringstream(line) >> o[0] >> o[1] >> o[2] >> o[3] >> o[4] >> o[5];
    EXPECT_NEAR(o[0], want->mean, 1e-12);
    EXPECT_NEAR(o[1], want->variance, 1e-12);
    EXPECT_NEAR(o[2], want->d_mean[0], 1e-12);
    EXPECT_NEAR(o[3], want->d_mean[1], 1e-12);
    EXPECT_NEAR(o[4], want->d_variance[0], 1e-12);
    EXPECT_NEAR(o[5], want->d_variance[1], 1e-12);
  }
  fs::remove_all(folder);
}

TEST(Slice, NamesThatAreNoIdentifiersAreRefused) {
  const PropertySlice slice = make_slice(driven_map(false), 0, 5.0, 12.0);
  EXPECT_THROW((void)slice_header(slice, "3d"), InvalidOption);
  EXPECT_THROW((void)slice_header(slice, "a b"), InvalidOption);
  EXPECT_THROW((void)slice_header(slice, ""), InvalidOption);
  EXPECT_THROW((void)make_slice(driven_map(false), 0, 5.0, 5.0), InvalidOption);
  EXPECT_THROW((void)make_slice(driven_map(true), 0, 5.0, 26.0), InvalidOption);
}

}  // namespace
}  // namespace roadbook
