#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/label_server/people_record.hpp"
#include "base/error.hpp"
#include "mapping/map.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_sightings.hpp"
#include "semantics/overhead/ground_image.hpp"
#include "semantics/people/person_learner.hpp"

namespace roadbook {

/// What a map file holds that the labelling page shows, read before the labels are opened.
struct LabelPlace {
  std::string name;
  GroundImage image;  ///< empty if the map has no overhead image; people can still be labelled
  std::vector<LabelClass> classes;
  /// Table `label_learning`: the picture that an earlier server has learnt on, and what.
  std::string learnt_picture;
  std::string learnt_record;
  /// What was learnt of people before (table `person_examples`), and what rounds in the page left.
  PersonExamples people;
  PeopleRecord people_record;
  std::vector<StoredSighting> sightings;           ///< further anchors of labels
  nlohmann::json lanes = nlohmann::json::array();  ///< lists of [x, y]

  [[nodiscard]] bool has_picture() const { return !image.grey.empty(); }
};

/// What a map without an overhead image lacks, for those that need one.
[[nodiscard]] Problem no_overhead_image(const std::filesystem::path& map);

/// Throws BadInput for a map that is damaged.
[[nodiscard]] LabelPlace read_label_place(const std::filesystem::path& map);

/// Returns the name that identifies a map for a page. Maps of the same drives and poses have the
/// same name. The file name and the layers have no influence. Coordinates from a map with another
/// name are not valid here.
[[nodiscard]] std::string map_version(const Map& map);

/// What all maps share that began with the same drive: labels keep their numbers from one to the
/// next.
[[nodiscard]] std::string place_version(const Map& map);

/// What names a picture: the same pixels, the same name. Empty without one.
[[nodiscard]] std::string picture_version(const GroundImage& image);

/// Where each session's vehicle was, as lists of [x, y, heading, stamp].
[[nodiscard]] nlohmann::json poses_json(const Map& map);

}  // namespace roadbook
