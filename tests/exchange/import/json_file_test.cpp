#include <filesystem>

#include "base/random.hpp"
#include "exchange/import/json_fields.hpp"
#include "tests/exchange/import/foreign_files.hpp"

// Tests the messages about bytes that are not JSON, and arbitrary bytes in label files.

namespace roadbook {
namespace {

std::string fault_of_json(const std::string& text) {
  const test::Folder folder;
  const auto file = folder / "a.json";
  std::ofstream(file, std::ios::binary) << text;
  try {
    (void)read_json_file(file);
  } catch (const BadInput& fault) {
    return fault.what();
  }
  return "taken";
}

TEST(JsonFile, NumbersThatJsonHasNotAreNamedWithTheirPlace) {
  EXPECT_TELLS(fault_of_json("{\"annotations\": [{\"id\": 1,\n \"score\": NaN}]}"),
               "a.json:2: annotations[0].score: got NaN, want a number or null (JSON has no NaN)");
  EXPECT_TELLS(fault_of_json(R"({"a":{"b":[1,2,Infinity]}})"), "a.json:1: a.b[2]: got Infinity");
  EXPECT_TELLS(fault_of_json(R"([[0],-Infinity])"), "a.json:1: [1]: got -Infinity");
  EXPECT_TELLS(fault_of_json(R"({"a":nan})"), "a.json:1: a: got nan");
  EXPECT_TELLS(fault_of_json(R"({"a":1e999})"), "a.json:1: a: got a number that is too large");
  EXPECT_TELLS(fault_of_json(R"({"a":-1e999})"), "a.json:1: a: got a number that is too large");
  EXPECT_TELLS(fault_of_json(R"({"a":None})"), "a: got None as Python writes it");
}

TEST(JsonFile, WhatIsNoJsonIsNamed) {
  EXPECT_TELLS(fault_of_json("{\"a\":[1,\n2,]}"),
               "a.json:2: a[2]: got a comma before ']', want none after the last value");
  EXPECT_TELLS(fault_of_json("{\"a\":1,}"), "got a comma before '}'");
  EXPECT_TELLS(fault_of_json(R"({"a":[1,2)"), "a.json:1: a[2]: got the end of the file");
  EXPECT_TELLS(fault_of_json(""), "a.json:1: text: got nothing, want JSON");
  EXPECT_TELLS(fault_of_json("\n \n"), "text: got nothing, want JSON");
  EXPECT_TELLS(fault_of_json("{'a':1}"), "text: got no JSON");
  EXPECT_TELLS(fault_of_json("{} {}"), "got no JSON");
  EXPECT_TELLS(fault_of_json("{\"a\":\"\xC3\"}"),
               "got bytes that are no UTF-8, want JSON in UTF-8");
  EXPECT_TELLS(fault_of_json(std::string("\xFF\xFE{\0}\0", 6)), "a.json: got UTF-16 text");
  EXPECT_TELLS(fault_of_json(std::string("{\0}\0", 4)), "a.json: got UTF-16 text");
}

TEST(JsonFile, AKeyThatStandsTwiceIsNoChoice) {
  EXPECT_TELLS(fault_of_json(R"({"a":[{"bbox":[1],"bbox":[2]}]})"),
               "a[0].bbox: got a key that stands twice in its object, want each key once");
  EXPECT_EQ(fault_of_json(R"({"a":{"b":1},"c":{"b":1},"b":2})"), "taken");
}

TEST(JsonFile, LevelsHaveAnEnd) {
  const auto nested = [](std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  EXPECT_EQ(fault_of_json(nested(64)), "taken");
  EXPECT_TELLS(fault_of_json(nested(65)), "got more than 64 levels");
  EXPECT_TELLS(fault_of_json(std::string(200'000, '[')), "got more than 64 levels");
}

TEST(JsonFile, AByteOrderMarkIsNone) {
  EXPECT_EQ(fault_of_json("\xEF\xBB\xBF{\"a\":1}"), "taken");
  const test::Folder folder;
  const auto file = folder / "a.json";
  std::ofstream(file) << R"({"a":[1,{"b":null}],"c":-2.5,"d":"x","e":[]})";
  EXPECT_EQ(read_json_file(file),
            nlohmann::json::parse(R"({"a":[1,{"b":null}],"c":-2.5,"d":"x","e":[]})"));
}

class AnyBytes : public test::ForeignFiles {
 protected:
  // Damages a good file: changes, doubles or removes bytes, or inserts words of the format.
  static std::string spoilt(std::string text, std::uint64_t seed) {
    static const std::vector<std::string> words{"1e308", "-1",   "null", "[]",   "{}",     "\"\"",
                                                "NaN",   "1e-9", "true", "[[",   "]]",     ",",
                                                "0.5",   "\n",   "9e99", "\xFF", "\\u0000"};
    Random random(seed, "bytes");
    const int changes = 1 + static_cast<int>(seed % 3);
    for (int i = 0; i < changes && !text.empty(); ++i) {
      const auto at =
          static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(text.size() - 1)));
      const auto length = static_cast<std::size_t>(random.uniform(0.0, 12.0));
      switch (static_cast<int>(random.uniform(0.0, 4.0))) {
        case 0:
          text[at] = static_cast<char>(random.uniform(0.0, 256.0));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, text.substr(at, length));
          break;
        default:
          text.replace(at, length,
                       words[static_cast<std::size_t>(
                           random.uniform(0.0, static_cast<double>(words.size()) - 0.5))]);
      }
    }
    return text;
  }
  // The import must either refuse the file with one line or read all of its content.
  void expect_sense(const std::string& format, const std::filesystem::path& source) const {
    try {
      const LabelFile file = read_label_file(map_, format, source, origin_);
      for (const LabelOutline& outline : file.outlines) {
        EXPECT_GE(outline.corners.size(), 3U);
        for (const Eigen::Vector2d& c : outline.corners) EXPECT_TRUE(c.allFinite());
      }
    } catch (const BadInput& fault) {
      EXPECT_FALSE(fault.problems().empty());
      ++refused_;
    }
  }
  mutable int refused_ = 0;
};

TEST_F(AnyBytes, ACocoFileIsRefusedOrTaken) {
  nlohmann::ordered_json one = {{"bbox", bbox_px(space_)},
                                {"iscrowd", 0},
                                {"score", 0.5},
                                {"attributes", {{"rotation", 30.0}, {"shape", "box"}}}};
  const std::string good =
      coco({one, {{"segmentation", {{100, 100, 160, 100, 160, 200, 100, 200}}}}}).dump();
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    std::ofstream(file_, std::ios::binary) << spoilt(good, seed);
    expect_sense("coco", file_);
  }
  EXPECT_GT(refused_, 100);
  EXPECT_LT(refused_, 400);
}

TEST_F(AnyBytes, AGeoJsonFileIsRefusedOrTaken) {
  const auto c = space_.corners();
  const std::string good =
      collection({feature({{"class", "bay"}, {"space", 1}, {"length_m", 5.0}, {"width_m", 2.5}},
                          "Polygon", Json::array({degrees({c.begin(), c.end()})})),
                  feature({{"layer", "roads"}}, "Point", {8.5, 47.3})})
          .dump();
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    std::ofstream(file_, std::ios::binary) << spoilt(good, seed);
    expect_sense("geojson", file_);
  }
  EXPECT_GT(refused_, 100);
  EXPECT_LT(refused_, 400);
}

TEST_F(AnyBytes, AYoloFolderIsRefusedOrTaken) {
  const std::string names = "path: .\nnames:\n  0: parking_space\n  1: crossing\n";
  const std::string rows = "0 0.22 0.27 0.1 0.2\n1 0.2 0.2 0.3 0.2 0.3 0.3 0.2 0.3\n";
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    expect_sense("yolo", yolo(seed % 4 == 0 ? spoilt(names, seed) : names,
                              seed % 4 == 0 ? rows : spoilt(rows, seed)));
  }
  EXPECT_GT(refused_, 100);
  EXPECT_LT(refused_, 400);
}

}  // namespace
}  // namespace roadbook
