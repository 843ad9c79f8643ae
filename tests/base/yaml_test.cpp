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

// The error of a text, or "" where it is read.
std::string error_of(const std::string& text) {
  try {
    (void)YamlMap::parse(text, "x.yaml");
    return "";
  } catch (const BadInput& bad) {
    return to_line(bad.problems().front());
  }
}

TEST(Yaml, TakesOneDocumentWithItsMarksAndNothingBehindIt) {
  EXPECT_EQ(error_of("a: 1\n"), "");
  EXPECT_EQ(error_of("%YAML 1.2\n# text\n---\na: 1\n...\n# text\n\n"), "");
  EXPECT_EQ(error_of("--- {a: 1}\n"), "");
  EXPECT_EQ(error_of("\xEF\xBB\xBF%YAML:1.0\r\n---\r\na: 1\r\n"), "");
  EXPECT_EQ(error_of("a: ---\nb: \"...\"\nc: 5 %\n"), "");
  EXPECT_EQ(error_of("a: 1\n---\nb: 2\n"),
            "error: x.yaml:2: got a second document ('---'), want one document");
  EXPECT_EQ(error_of("---\na: 1\n---\n"),
            "error: x.yaml:3: got a second document ('---'), want one document");
  EXPECT_EQ(error_of("a: 1\n...\nb: 2\n"),
            "error: x.yaml:3: got text behind the end of the document ('...'), want one document");
  EXPECT_EQ(
      error_of("a: 1\n%b: 2\nc: 3\n"),
      "error: x.yaml:2: got a directive ('%') within the document, want directives before the "
      "document alone");
}

// Found by fuzzing: the parser's own list of documents had no end.
TEST(Yaml, RefusesARestThatTheParserWouldDrop) {
  for (const char* text : {"a: 1\n]\nb: 2\n", "a: 1\n, b\n", ", \"py\": 0\ni: MEI\n", "[1]\n[2]\n",
                           "{a: 1}\n{b: 2}\n", "\"x\" y\n", ", a: 1\n"})
    EXPECT_NE(error_of(text), "") << text;
}

TEST(Yaml, TakesTextInUtf8Alone) {
  EXPECT_EQ(error_of("a: \"B\xC3\xBC\x63her\"\n"), "");
  EXPECT_EQ(error_of("a: 1\nb: \"B\xFC\x63her\"\n"),
            "error: x.yaml:2: got bytes that are no UTF-8, want UTF-8 text");
  EXPECT_EQ(error_of(std::string("\xFF\xFE") + std::string("a\0:\0", 4)),
            "error: x.yaml:1: got UTF-16 or UTF-32 text, want UTF-8 text");
  // The parser takes the character 4 for the end of the file.
  EXPECT_EQ(error_of("a: 1\n\x04\nb: 2\n"),
            "error: x.yaml:2: got the control character 4, want text");
  EXPECT_EQ(error_of(std::string("a: 1\n\0b: 2\n", 12)),
            "error: x.yaml:2: got the control character 0, want text");
}

TEST(Yaml, OpensRegularFilesAlone) {
  const auto error = [](const char* path) {
    try {
      (void)YamlMap::load(path);
    } catch (const BadInput& bad) {
      return to_line(bad.problems().front());
    }
    return std::string();
  };
  EXPECT_EQ(error("/dev/zero"), "error: /dev/zero: got a device, want YAML");
  EXPECT_EQ(error("/"), "error: /: got a folder, want YAML");
  EXPECT_EQ(error("/nowhere/x.yaml"), "error: /nowhere/x.yaml: got no readable file, want YAML");
}

}  // namespace
}  // namespace roadbook
