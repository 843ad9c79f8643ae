#include "base/yaml.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

std::string lines(const std::vector<Problem>& problems) {
  std::string text;
  for (const auto& problem : problems) text += to_line(problem) + "\n";
  return text;
}

TEST(Yaml, ReadsEveryType) {
  auto yaml = YamlMap::parse(
      "%YAML:1.0\n---\na: 1.5\nb: -3\nc: true\nd: word\ne: [1, 2.5]\nf: {g: 18446744073709551615}\n"
      "h: [{i: 1}, {i: 2}]\nj: [[1, 2], [3]]\n",
      "x.yaml");
  double a = 0;
  int b = 0;
  bool c = false;
  std::string d;
  std::vector<double> e;
  std::uint64_t g = 0;
  std::vector<std::vector<double>> j;
  EXPECT_TRUE(yaml.require("a", a) && yaml.require("b", b, Range{-5, 5}) && yaml.read("c", c));
  EXPECT_TRUE(yaml.read("d", d) && yaml.read_list("e", 2, e) && yaml.map("f")->read("g", g));
  EXPECT_TRUE(yaml.read("j", j));
  int sum = 0;
  for (auto& map : yaml.maps("h")) {
    int i = 0;
    map.require("i", i);
    sum += i;
  }
  EXPECT_EQ(a, 1.5);
  EXPECT_EQ(b, -3);
  EXPECT_TRUE(c);
  EXPECT_EQ(d, "word");
  EXPECT_EQ(e, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(g, 18446744073709551615u);
  EXPECT_EQ(sum, 3);
  EXPECT_EQ(j[1][0], 3.0);
  EXPECT_NO_THROW(yaml.finish());
}

TEST(Yaml, GathersEveryFaultWithItsLine) {
  auto yaml = YamlMap::parse(
      "spacing: .nan\nturn: 1e999\ncount: 2.5\nflag: yes\nname: [1]\nquoted: \"3\"\nturn: 2\n"
      "inner:\n  sigmma: 1\n",
      "o.yaml");
  double number = 7;
  int count = 7;
  bool flag = false;
  std::string name;
  yaml.read("spacing", number);
  yaml.read("turn", number);
  yaml.read("count", count);
  yaml.read("flag", flag);
  yaml.read("name", name);
  yaml.read("quoted", number);
  yaml.require("radius", number);
  yaml.map("inner")->read("sigma", number);
  EXPECT_EQ(number, 7.0);
  EXPECT_EQ(lines(yaml.finish_problems()),
            "error: o.yaml:7: turn: got the key a second time, want each key once\n"
            "error: o.yaml:1: spacing: got .nan, want a finite number\n"
            "error: o.yaml:2: turn: got 1e999, want a finite number\n"
            "error: o.yaml:3: count: got 2.5, want a whole number in [-2.14748e+09, 2.14748e+09]\n"
            "error: o.yaml:4: flag: got yes, want true or false\n"
            "error: o.yaml:5: name: got a list, want a word\n"
            "error: o.yaml:6: quoted: got 3, want a finite number\n"
            "error: o.yaml:1: radius: got nothing, want this key\n"
            "error: o.yaml:9: inner.sigmma: got an unknown key, want a known one (did you mean "
            "sigma?)\n");
  EXPECT_THROW(yaml.finish(), BadInput);
}

TEST(Yaml, RefusesWhatIsNoMapping) {
  EXPECT_THROW((void)YamlMap::parse("- 1\n", "x"), BadInput);
  EXPECT_THROW((void)YamlMap::parse("a: [1,", "x"), BadInput);
  EXPECT_THROW((void)YamlMap::load("/no/such/file.yaml"), BadInput);
  EXPECT_TRUE(YamlMap::parse("", "x").keys().empty());
}

}  // namespace
}  // namespace roadbook
