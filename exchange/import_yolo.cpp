#include <algorithm>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "base/text.hpp"
#include "base/yaml.hpp"
#include "exchange/label_readers.hpp"
#include "semantics/label_classes.hpp"

namespace roadbook {
namespace {

std::vector<std::string> read_names(const std::filesystem::path& file) {
  YamlMap yaml = YamlMap::load(file);
  std::vector<std::string> names;
  if (yaml.is_map("names")) {
    auto by_number = *yaml.map("names");
    for (std::size_t i = 0; by_number.has(std::to_string(i)); ++i) {
      names.emplace_back();
      by_number.require(std::to_string(i), names.back());
    }
  } else {
    yaml.require("names", names);
  }
  for (const std::string& key : yaml.keys())
    if (key != "names") yaml.ignore(key);
  yaml.finish();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto wrong = wrong_name(names[i]))
      throw BadInput({Severity::kError, file.string(), 0, "names[" + std::to_string(i) + "]",
                      *wrong, kNameWanted});
  return names;
}

// The numbers of a row after the class; empty and a problem where it has others.
std::vector<double> shares_of(const std::vector<std::string_view>& words, Problem* problem) {
  std::vector<double> shares;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto value = parse_double(words[i]);
    constexpr double kSlack = 1e-3;
    if (!value || *value < -kSlack || *value > 1.0 + kSlack) {
      problem->field = "column " + std::to_string(i + 1);
      problem->got = std::string(words[i]);
      problem->want = "a share of the image, 0 to 1";
      return {};
    }
    shares.push_back(*value);
  }
  // A middle and sides: a box that stands upright in the image.
  if (shares.size() == 4) {
    const double w = 0.5 * shares[2];
    const double h = 0.5 * shares[3];
    const double x = shares[0];
    const double y = shares[1];
    return {x + w, y + h, x + w, y - h, x - w, y - h, x - w, y + h};
  }
  if (shares.size() >= 6 && shares.size() % 2 == 0) return shares;
  problem->field = "row";
  problem->got = std::to_string(words.size()) + " columns";
  problem->want = "class and x y x y ..., or class x y width height";
  return {};
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  constexpr std::string_view kBlanks = " \t\r";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  std::vector<std::string_view> words;
  for (auto at = line.find_first_not_of(kBlanks); at != std::string_view::npos;
       at = line.find_first_not_of(kBlanks, at)) {
    const auto end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

}  // namespace

PicturePlace yolo_picture_place(const std::filesystem::path& folder, const MapLayers& layers) {
  const PicturePlace own = overhead_place(layers);
  const auto png = folder / "images" / "overhead.png";
  const auto world = folder / "images" / "overhead.pgw";
  if (!std::filesystem::exists(png)) {
    if (std::filesystem::exists(world)) return read_world_file(world, own.width, own.height);
    return own;
  }
  const cv::Mat picture = cv::imread(png.string(), cv::IMREAD_GRAYSCALE);
  if (picture.empty())
    throw BadInput({Severity::kError, png.string(), 0, "image", "no picture", "a PNG"});
  if (std::filesystem::exists(world)) return read_world_file(world, picture.cols, picture.rows);
  require_size(png.string(), own, picture.cols, picture.rows);
  return own;
}

Outlines read_yolo(const std::filesystem::path& folder, const MapLayers& layers) {
  const auto names = read_names(folder / "data.yaml");
  const auto file = folder / "labels" / "overhead.txt";
  std::ifstream in(file);
  if (!in)
    throw BadInput({Severity::kError, file.string(), 0, "", "no such file", "rows of labels"});
  const PicturePlace place = yolo_picture_place(folder, layers);
  Outlines outlines;
  std::vector<Problem> problems;
  std::string line;
  for (std::int64_t number = 1; std::getline(in, line); ++number) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    Problem problem{Severity::kError, file.string(), number, "", "", ""};
    const auto kind = parse_int(words[0]);
    if (!kind || *kind < 0 || *kind >= static_cast<std::int64_t>(names.size())) {
      problem.field = "class";
      problem.got = std::string(words[0]);
      problem.want = "0 to " + std::to_string(names.size() - 1) + ", a row of names in data.yaml";
      problems.push_back(problem);
      continue;
    }
    const auto shares = shares_of(words, &problem);
    if (shares.empty()) {
      problems.push_back(problem);
      continue;
    }
    LabelOutline outline;
    outline.kind = names[static_cast<std::size_t>(*kind)];
    outline.where = "outline";
    outline.line = number;
    for (std::size_t i = 0; i < shares.size(); i += 2)
      outline.corners.push_back(
          place.place_of({shares[i] * place.width, shares[i + 1] * place.height}));
    const auto wrong = outline_problems(file.string(), outline);
    problems.insert(problems.end(), wrong.begin(), wrong.end());
    outlines.push_back(std::move(outline));
  }
  if (!problems.empty()) throw BadInput(problems);
  return outlines;
}

}  // namespace roadbook
