#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/ground_image.hpp"

namespace roadbook {

/// A class of labels: what it is called, how it is drawn.
struct LabelClass {
  std::string kind;
  std::string title;
  std::string colour;  ///< "#rrggbb"
  bool box = true;     ///< a box of three clicks, else a polygon
};

/// What a map file holds that the labelling page shows, read before the labels are opened.
struct LabelPlace {
  std::string name;
  GroundImage image;
  std::vector<LabelClass> classes;  ///< table `label_classes`, or parking spaces and crossings
  nlohmann::json lanes = nlohmann::json::array();  ///< lists of [x, y]
};

/// Throws BadInput for a map that is damaged or has no overhead image.
[[nodiscard]] LabelPlace read_label_place(const std::filesystem::path& map);

/// `classes` and a class with a colour of its own for every other kind in `kinds`.
[[nodiscard]] std::vector<LabelClass> with_kinds(std::vector<LabelClass> classes,
                                                 const std::vector<std::string>& kinds);

/// Driven positions of each session, as lists of [x, y].
[[nodiscard]] nlohmann::json poses_json(const Map& map);

}  // namespace roadbook
