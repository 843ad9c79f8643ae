#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "base/text.hpp"
#include "base/text_file.hpp"
#include "base/yaml.hpp"
#include "exchange/import/label_readers.hpp"
#include "exchange/import/outline_shape.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

// Names by number: 0, 1, ... without a gap. Another key, and a first or missing number, is a fault.
std::vector<std::string> numbered_names(YamlMap& yaml) {
  auto by_number = *yaml.map("names");
  std::map<std::int64_t, std::string> names;
  for (const std::string& key : by_number.keys()) {
    const auto number = parse_int(key);
    if (!number || *number < 0) continue;  // finish names it
    by_number.require(key, names[*number]);
  }
  std::vector<std::string> list;
  for (const auto& [number, name] : names) {
    const auto next = static_cast<std::int64_t>(list.size());
    if (number != next) {
      yaml.report("names",
                  next == 0 ? "a list that begins at " + std::to_string(number)
                            : "no " + std::to_string(next) + " before " + std::to_string(number),
                  "0, 1, ...");
      return {};
    }
    list.push_back(name);
  }
  return list;
}

std::vector<std::string> names_of_data(const std::filesystem::path& file) {
  YamlMap yaml = YamlMap::load(file);
  std::vector<std::string> names;
  if (yaml.is_map("names"))
    names = numbered_names(yaml);
  else
    yaml.require("names", names);
  for (const std::string& key : yaml.keys())
    if (key != "names") yaml.ignore(key);
  yaml.finish();
  return names;
}

// One name a line: how some programs write them in place of data.yaml.
std::vector<std::string> names_of_list(const std::filesystem::path& file) {
  std::istringstream in(read_regular_file(file, "names of classes"));
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) names.emplace_back(trim(line));
  while (!names.empty() && names.back().empty()) names.pop_back();
  return names;
}

std::vector<std::string> read_names(const std::filesystem::path& folder) {
  std::filesystem::path file = folder / "data.yaml";
  const bool listed = !std::filesystem::exists(file);
  if (listed)
    for (const char* name : {"classes.txt", "obj.names", "labels/classes.txt"})
      if (std::filesystem::exists(folder / name) && !std::filesystem::exists(file))
        file = folder / name;
  const bool is_yaml = file.extension() == ".yaml";
  const auto names = is_yaml ? names_of_data(file) : names_of_list(file);
  if (names.empty())
    throw BadInput({Severity::kError, file.string(), 0, "names", "none", "names of the classes"});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto wrong = wrong_name(names[i]))
      throw BadInput({Severity::kError, file.string(), 0, "names[" + std::to_string(i) + "]",
                      *wrong, kNameWanted});
  return names;
}

// The numbers of a row after the class, as corners; empty and a problem where it has others.
std::vector<double> shares_of(const std::vector<std::string_view>& words, Problem* problem) {
  std::vector<double> shares;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto value = parse_double(words[i]);
    constexpr double kSlack = 1e-3;
    if (!value || *value < -kSlack || *value > 1.0 + kSlack) {
      problem->field = "column " + std::to_string(i + 1);
      problem->got = std::string(words[i].substr(0, 60));
      problem->want = "a share of the image, 0 to 1";
      return {};
    }
    shares.push_back(*value);
  }
  if (shares.size() == 4 || (shares.size() >= 6 && shares.size() % 2 == 0)) return shares;
  problem->field = "row";
  problem->got = std::to_string(words.size()) + " columns";
  problem->want = "class and x y x y ..., or class x y width height";
  if (shares.size() >= 5) problem->want += "; no angle, and no confidence at its end";
  return {};
}

// A middle and sides: an upright box in the image.
std::vector<double> corners_of_row(const std::vector<double>& shares) {
  if (shares.size() != 4) return shares;
  const double w = 0.5 * shares[2];
  const double h = 0.5 * shares[3];
  const double x = shares[0];
  const double y = shares[1];
  return {x + w, y + h, x + w, y - h, x - w, y - h, x - w, y + h};
}

// How far rounding may have moved a corner [pixels]: of the shares as they stand, or of whole
// pixels that they were made from.
double step_px(const std::vector<double>& shares,
               const std::vector<Eigen::Vector2d>& pixels,
               const PicturePlace& place) {
  constexpr double kFinestPx = 1e-3;
  const double of_shares = rounding_step(shares) * std::max(place.width, place.height);
  const double slack = std::max(kFinestPx, of_shares);
  const auto is_whole_px = [&](double v) { return std::abs(v - std::round(v)) < slack; };
  const bool whole = slack < 0.1 && std::all_of(pixels.begin(), pixels.end(), [&](const auto& p) {
                       return is_whole_px(p.x()) && is_whole_px(p.y());
                     });
  return whole ? 1.0 : of_shares;
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

// The row of a line; empty and a problem where it is wrong.
std::optional<LabelOutline> outline_of_row(const std::vector<std::string_view>& words,
                                           const std::vector<std::string>& names,
                                           const PicturePlace& place,
                                           Problem* problem) {
  const auto kind = parse_int(words[0]);
  if (!kind || *kind < 0 || *kind >= static_cast<std::int64_t>(names.size())) {
    problem->field = "class";
    problem->got = std::string(words[0].substr(0, 60));
    problem->want = "0 to " + std::to_string(names.size() - 1) + ", a row of names in data.yaml";
    return std::nullopt;
  }
  const auto shares = shares_of(words, problem);
  if (shares.empty()) return std::nullopt;
  const auto corners = corners_of_row(shares);
  std::vector<Eigen::Vector2d> pixels;
  for (std::size_t i = 0; i < corners.size(); i += 2)
    pixels.emplace_back(corners[i] * place.width, corners[i + 1] * place.height);
  LabelOutline outline;
  outline.kind = names[static_cast<std::size_t>(*kind)];
  outline.where = "outline";
  outline.line = problem->line;
  outline.step_m = step_px(shares, pixels, place) * place.resolution_m;
  for (const Eigen::Vector2d& pixel : pixels) outline.corners.push_back(place.place_of(pixel));
  clean_corners(outline);
  return outline;
}

// Rows of other pictures than the overhead image.
std::optional<LabelsLeftOut> rows_of_others(const YoloFiles& files) {
  std::size_t rows = 0;
  for (const auto& file : files.other) {
    std::istringstream in(read_regular_file(file, "rows of labels"));
    for (std::string line; std::getline(in, line);) rows += words_of(line).empty() ? 0 : 1;
  }
  if (rows == 0) return std::nullopt;
  LabelsLeftOut others = left_out(
      files.other.front().string(), "rows",
      std::to_string(rows) + " of " + std::to_string(files.other.size()) + " other pictures",
      "rows of the overhead image");
  others.count = rows;
  return others;
}

}  // namespace

LabelFile read_yolo(const std::filesystem::path& folder, const MapLayers& layers) {
  const auto names = read_names(folder);
  const YoloFiles files = yolo_files(folder);
  const std::string name = files.rows.string();
  if (!std::filesystem::exists(files.rows))
    throw BadInput({Severity::kError, name, 0, "", "no such file", "rows of labels"});
  std::istringstream in(read_regular_file(files.rows, "rows of labels"));
  const PicturePlace place = yolo_picture_place(folder, layers);
  LabelFile result;
  std::vector<Problem> problems;
  std::string line;
  for (std::int64_t number = 1; std::getline(in, line); ++number) {
    if (line.find('\0') != std::string::npos)
      throw BadInput({Severity::kError, name, number, "text", "UTF-16 or binary data", "UTF-8"});
    const auto words = words_of(line);
    if (words.empty()) continue;
    Problem problem{Severity::kError, name, number, "", "", ""};
    auto outline = outline_of_row(words, names, place, &problem);
    if (!outline) {
      problems.push_back(problem);
      continue;
    }
    const auto wrong = outline_problems(name, *outline);
    problems.insert(problems.end(), wrong.begin(), wrong.end());
    result.outlines.push_back(std::move(*outline));
  }
  if (!problems.empty()) throw BadInput(problems);
  if (auto others = rows_of_others(files)) result.left_out.push_back(std::move(*others));
  return result;
}

}  // namespace roadbook
