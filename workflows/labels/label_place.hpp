#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_sightings.hpp"
#include "semantics/overhead/ground_image.hpp"
#include "semantics/people/person_learner.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {

/// The parts of a map file that the labelling page shows. They are read before the labels are
/// opened.
struct LabelPlace {
  std::string name;
  GroundImage image;  ///< empty if the map has no overhead image; people can still be labelled
  std::vector<LabelClass> classes;
  /// Table `label_learning`: the picture on which an earlier server has learnt, and its record.
  std::string learnt_picture;
  std::string learnt_record;
  /// Examples of people from earlier sources (table `person_examples`), and the record of the
  /// rounds in the page.
  PersonExamples people;
  PeopleRecord people_record;
  std::vector<StoredSighting> sightings;           ///< further anchors of labels
  nlohmann::json lanes = nlohmann::json::array();  ///< lists of [x, y]

  [[nodiscard]] bool has_picture() const { return !image.grey.empty(); }
};

/// The problem of a map without an overhead image, for functions that need one.
[[nodiscard]] Problem no_overhead_image(const std::filesystem::path& map);

/// Reads the parts. Throws BadInput if the map is damaged.
[[nodiscard]] LabelPlace read_label_place(const std::filesystem::path& map);

/// Returns the name that identifies a map for a page. Maps of the same drives and poses have the
/// same name. The file name and the layers have no influence. Coordinates from a map with another
/// name are not valid here.
[[nodiscard]] std::string map_version(const Map& map);

/// Returns the name that is the same for all maps that begin with the same drive. Label numbers
/// stay the same between such maps.
[[nodiscard]] std::string place_version(const Map& map);

/// Returns the name of a picture. The same pixels give the same name. Empty without a picture.
[[nodiscard]] std::string picture_version(const GroundImage& image);

/// Returns the vehicle poses of each session, as lists of [x, y, heading, stamp].
[[nodiscard]] nlohmann::json poses_json(const Map& map);

}  // namespace roadbook
