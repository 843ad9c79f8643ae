#include "workflows/edits/edit_file.hpp"

#include <charconv>
#include <optional>
#include <utility>

#include "base/yaml.hpp"

namespace roadbook {
namespace {

constexpr Range kSigmas{1e-4, 100.0};

// SESSION@TIME, time in nanoseconds.
void read_place(YamlMap& yaml, const char* key, EditPlace& place) {
  std::string text;
  if (!yaml.require(key, text)) return;
  const std::size_t split = text.rfind('@');
  const char* begin = split == std::string::npos ? nullptr : text.data() + split + 1;
  const char* end = text.data() + text.size();
  if (begin == nullptr || split == 0 || begin == end ||
      std::from_chars(begin, end, place.t_ns).ptr != end) {
    yaml.report(key, text, "SESSION@TIME, with the time in nanoseconds");
    return;
  }
  place.session = text.substr(0, split);
}

void read_sigma(YamlMap& yaml, MapEdit& edit) {
  if (!yaml.has("sigma")) return;
  std::vector<double> sigma;
  if (!yaml.read_list("sigma", 2, sigma)) return;
  for (const double s : sigma)
    if (!(s >= kSigmas.min && s <= kSigmas.max)) {
      yaml.report("sigma", std::to_string(s), "standard deviations from 0.0001 to 100 [m, rad]");
      return;
    }
  edit.sigma_m = sigma[0];
  edit.sigma_rad = sigma[1];
}

void read_motion(YamlMap& yaml, const char* key, MapEdit& edit) {
  std::vector<double> motion;
  if (!yaml.has(key))
    yaml.report(key, "nothing", "[x, y, heading] in metres and radians");
  else if (yaml.read_list(key, 3, motion))
    edit.motion = {motion[0], motion[1], motion[2]};
}

void read_pixels(YamlMap& yaml, const char* key, std::vector<Eigen::Vector2d>& pixels) {
  std::vector<std::vector<double>> rows;
  if (!yaml.require(key, rows)) return;
  for (const auto& row : rows) {
    if (row.size() != 2) {
      yaml.report(key, std::to_string(row.size()) + " numbers in a pixel", "[u, v]");
      return;
    }
    pixels.emplace_back(row[0], row[1]);
  }
}

void read_same_points(YamlMap& yaml, MapEdit& edit) {
  read_place(yaml, "a", edit.a);
  read_place(yaml, "b", edit.b);
  yaml.require("camera", edit.camera_a);
  edit.camera_b = edit.camera_a;
  yaml.read("camera_b", edit.camera_b);
  read_pixels(yaml, "pixels", edit.pixels_a);
  read_pixels(yaml, "pixels_b", edit.pixels_b);
  read_sigma(yaml, edit);
  if (edit.pixels_a.size() != edit.pixels_b.size())
    yaml.report("pixels_b", std::to_string(edit.pixels_b.size()) + " pixels",
                std::to_string(edit.pixels_a.size()) + ", one for each of `pixels`");
  else if (edit.pixels_a.size() < 2)
    yaml.report("pixels", std::to_string(edit.pixels_a.size()) + " pixels", "two or more");
}

std::optional<MapEdit> read_edit(YamlMap& yaml, const std::string& key) {
  auto of_key = yaml.map(key);
  if (!of_key) return std::nullopt;
  MapEdit edit;
  if (key == "loop") {
    read_place(*of_key, "a", edit.a);
    read_place(*of_key, "b", edit.b);
    read_motion(*of_key, "motion", edit);
    read_sigma(*of_key, edit);
  } else if (key == "same_points") {
    edit.kind = EditKind::kSamePoints;
    read_same_points(*of_key, edit);
  } else if (key == "not_a_loop") {
    edit.kind = EditKind::kNotALoop;
    read_place(*of_key, "a", edit.a);
    read_place(*of_key, "b", edit.b);
  } else {
    edit.kind = EditKind::kAnchor;
    read_place(*of_key, "at", edit.a);
    read_motion(*of_key, "place", edit);
    read_sigma(*of_key, edit);
  }
  return edit;
}

void read_edits(YamlMap yaml, std::vector<MapEdit>& edits) {
  for (const char* key : {"loop", "same_points", "not_a_loop", "anchor"})
    if (yaml.has(key))
      if (auto edit = read_edit(yaml, key)) edits.push_back(std::move(*edit));
}

std::vector<MapEdit> edits_of(YamlMap yaml) {
  std::vector<MapEdit> edits;
  read_edits(yaml, edits);
  if (yaml.has("edits"))
    for (YamlMap& one : yaml.maps("edits")) {
      const std::size_t before = edits.size();
      read_edits(one, edits);
      if (edits.size() != before + 1 && yaml.problems().empty())
        one.report("", std::to_string(edits.size() - before) + " edits in one entry",
                   "one of loop, same_points, not_a_loop and anchor");
    }
  if (edits.empty() && yaml.problems().empty())
    yaml.report("edits", "no edit", "loop, same_points, not_a_loop or anchor");
  yaml.finish();
  return edits;
}

std::string number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string list(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + number(value);
  return text + "]";
}

std::string pixel_list(const std::vector<Eigen::Vector2d>& pixels) {
  std::string text;
  for (const Eigen::Vector2d& p : pixels)
    text += (text.empty() ? "[" : ", ") + list({p.x(), p.y()});
  return text + "]";
}

std::string quoted(const std::string& text) {
  std::string with = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') with += '\\';
    with += c;
  }
  return with + "\"";
}

std::string place(const EditPlace& p) { return quoted(p.session + "@" + std::to_string(p.t_ns)); }

}  // namespace

std::vector<MapEdit> read_edit_file(const std::filesystem::path& file) {
  return edits_of(YamlMap::load(file));
}

std::vector<MapEdit> parse_edits(const std::string& text, const std::string& name) {
  return edits_of(YamlMap::parse(text, name));
}

std::string edit_yaml(const MapEdit& edit) {
  const std::string sigma = ", sigma: " + list({edit.sigma_m, edit.sigma_rad});
  const std::string motion = list({edit.motion.x(), edit.motion.y(), edit.motion.z()});
  const std::string both = "a: " + place(edit.a) + ", b: " + place(edit.b);
  switch (edit.kind) {
    case EditKind::kLoop:
      return "loop: {" + both + ", motion: " + motion + sigma + "}";
    case EditKind::kSamePoints:
      return "same_points: {" + both + ", camera: " + quoted(edit.camera_a) +
             ", camera_b: " + quoted(edit.camera_b) + ", pixels: " + pixel_list(edit.pixels_a) +
             ", pixels_b: " + pixel_list(edit.pixels_b) + sigma + "}";
    case EditKind::kNotALoop:
      return "not_a_loop: {" + both + "}";
    case EditKind::kAnchor:
      return "anchor: {at: " + place(edit.a) + ", place: " + motion + sigma + "}";
  }
  return {};
}

}  // namespace roadbook
