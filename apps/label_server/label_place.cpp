#include "apps/label_server/label_place.hpp"

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "apps/label_server/label_wire.hpp"
#include "base/error.hpp"
#include "mapping/map_layers.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

// Okabe and Ito 2008: told apart by colour-blind people too.
constexpr std::array<const char*, 6> kColours{"#56B4E9", "#E69F00", "#CC79A7",
                                              "#009E73", "#F0E442", "#D55E00"};

GroundImage read_overhead(const MapLayers& layers) {
  if (!layers.has("overhead"))
    throw BadInput({Severity::kError, layers.file().string(), 0, "layer overhead", "none",
                    "an overhead image (roadbook overhead -m MAP makes it)"});
  const RasterInfo info = layers.raster_info("overhead");
  const cv::Mat pixels = layers.read_raster("overhead", {0, 0, info.width, info.height});
  GroundImage image;
  cv::extractChannel(pixels, image.grey, 0);
  if (image.grey.depth() != CV_8U)
    throw BadInput({Severity::kError, layers.file().string(), 0, "layer overhead",
                    "pixels of another type", "8 bit"});
  image.seen = image.grey > 0;
  image.corner = info.corner;
  image.resolution_m = info.resolution_m;
  return image;
}

std::string text_of(const FieldValue& value) {
  const auto* const text = std::get_if<std::string>(&value);
  return text == nullptr ? std::string() : *text;
}

bool is_colour(const std::string& text) {
  return text.size() == 7 && text[0] == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
}

// Columns kind, title, colour, shape.
std::vector<LabelClass> read_classes(const MapLayers& layers) {
  std::vector<LabelClass> classes;
  for (const auto& row : layers.read_table("label_classes").rows) {
    if (row.size() != 4)
      throw BadInput({Severity::kError, layers.file().string(), 0, "table label_classes",
                      std::to_string(row.size()) + " columns", "kind, title, colour, shape"});
    LabelClass c{text_of(row[0]), text_of(row[1]), text_of(row[2]), text_of(row[3]) != "polygon"};
    if (c.kind.empty() || !is_colour(c.colour))
      throw BadInput({Severity::kError, layers.file().string(), 0, "table label_classes",
                      "'" + c.kind + "', '" + c.colour + "'", "a class and a colour like #56B4E9"});
    classes.push_back(c);
  }
  return classes;
}

bool has_table(const MapLayers& layers, const std::string& name) {
  try {
    static_cast<void>(layers.read_table(name));
    return true;
  } catch (const BadInput&) {
    return false;
  }
}

}  // namespace

LabelPlace read_label_place(const std::filesystem::path& map) {
  const MapLayers layers(map);
  LabelPlace place;
  place.name = map.stem().string();
  place.image = read_overhead(layers);
  if (has_table(layers, "label_classes")) place.classes = read_classes(layers);
  if (place.classes.empty())
    place.classes = {{"parking_space", "parking space", kColours[0], true},
                     {"crossing", "crossing", kColours[1], false}};
  if (layers.has("lanes"))
    for (const Feature& lane : layers.read_layer("lanes").features) {
      Json line = Json::array();
      for (const auto& p : lane.points) line.push_back({p.x(), p.y()});
      place.lanes.push_back(line);
    }
  return place;
}

std::vector<LabelClass> with_kinds(std::vector<LabelClass> classes,
                                   const std::vector<std::string>& kinds) {
  for (const std::string& kind : kinds) {
    const bool known = std::any_of(classes.begin(), classes.end(),
                                   [&](const LabelClass& c) { return c.kind == kind; });
    if (known || is_rejected_kind(kind)) continue;
    const char* const colour = kColours[classes.size() % kColours.size()];
    classes.push_back({kind, kind, colour, true});
  }
  return classes;
}

Json poses_json(const Map& map) {
  std::vector<Json> lines(map.sessions.size(), Json::array());
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(k)).translation();
    lines[static_cast<std::size_t>(map.keyframes[k].session)].push_back({p.x(), p.y()});
  }
  return lines;
}

}  // namespace roadbook
