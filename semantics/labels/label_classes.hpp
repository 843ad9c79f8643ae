#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"

namespace roadbook {

// Classes of labels: table `label_classes(kind, title, colour, shape)` of a map.

struct LabelClass {
  std::string kind;
  std::string title;   ///< for people
  std::string colour;  ///< "#rrggbb"
  bool box = true;     ///< a box of three clicks, else a polygon

  bool operator==(const LabelClass&) const = default;
};

/// The map's own classes; parking spaces and crossings where it has none. Throws BadInput naming
/// the table for a row that is none.
[[nodiscard]] std::vector<LabelClass> read_label_classes(const MapLayers& layers);

/// The table that `read_label_classes` reads.
[[nodiscard]] PlainTable label_class_table(const std::vector<LabelClass>& classes);

/// A list of {kind, title, colour, shape}.
[[nodiscard]] nlohmann::ordered_json classes_to_json(const std::vector<LabelClass>& classes);
/// Throws BadInput naming `source`.
[[nodiscard]] std::vector<LabelClass> classes_from_json(const nlohmann::ordered_json& json,
                                                        const std::string& source);

/// Throws InvalidOption: a kind that is empty, given twice, longer than 64 bytes or begins with
/// `not_`; a title longer than 64 bytes; a colour other than "#rrggbb"; no class at all, or more
/// than 64.
void check_label_classes(const std::vector<LabelClass>& classes);

inline constexpr const char* kNameWanted = "1 to 64 printable characters";
/// What is wrong with the name of a class, or of who labels: "''", "70 characters", "a control
/// character"; empty where nothing is.
[[nodiscard]] std::optional<std::string> wrong_name(const std::string& name);

/// `classes` and a class with a colour of its own for every other kind in `kinds`.
[[nodiscard]] std::vector<LabelClass> with_kinds(std::vector<LabelClass> classes,
                                                 const std::vector<std::string>& kinds);

/// What is no thing of class X: a hypothesis that a person rejected is a label of class not_X. It
/// is an example for the detector and leaves the map in no other form.
[[nodiscard]] std::string rejected_kind(const std::string& kind);
[[nodiscard]] bool is_rejected_kind(const std::string& kind);
/// The class that a search looked for whose hypothesis this answers: X of X and of not_X.
[[nodiscard]] std::string searched_kind(const std::string& kind);

}  // namespace roadbook
