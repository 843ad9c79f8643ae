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
  std::string title;   ///< shown to users
  std::string colour;  ///< "#rrggbb"
  bool box = true;     ///< drawn as a box by three clicks; false: as a polygon

  bool operator==(const LabelClass&) const = default;
};

/// The classes stored in the map; parking spaces and crossings if the map stores none. Throws
/// BadInput naming the table if a row is invalid.
[[nodiscard]] std::vector<LabelClass> read_label_classes(const MapLayers& layers);

/// The table that `read_label_classes` reads.
[[nodiscard]] PlainTable label_class_table(const std::vector<LabelClass>& classes);

/// JSON list of {kind, title, colour, shape}.
[[nodiscard]] nlohmann::ordered_json classes_to_json(const std::vector<LabelClass>& classes);
/// Inverse of `classes_to_json`. Throws BadInput naming `source`.
[[nodiscard]] std::vector<LabelClass> classes_from_json(const nlohmann::ordered_json& json,
                                                        const std::string& source);

/// Throws InvalidOption for an empty or repeated kind, a kind longer than 64 characters or one that
/// begins with `not_`, a title longer than 64 characters, a colour that is not "#rrggbb", an empty
/// list or more than 64 classes.
void check_label_classes(const std::vector<LabelClass>& classes);

inline constexpr const char* kNameWanted = "1 to 64 printable characters";
/// Checks the name of a class or of a labeller. Returns what is wrong ("''", "70 characters", "a
/// control character"); empty if the name is valid.
[[nodiscard]] std::optional<std::string> wrong_name(const std::string& name);

/// `classes`, plus one class with its own colour for every kind in `kinds` that they lack.
[[nodiscard]] std::vector<LabelClass> with_kinds(std::vector<LabelClass> classes,
                                                 const std::vector<std::string>& kinds);

/// Class not_X: a hypothesis of class X that a labeller rejected. Rejections train the detector;
/// they appear in no layer and no export.
[[nodiscard]] std::string rejected_kind(const std::string& kind);
[[nodiscard]] bool is_rejected_kind(const std::string& kind);
/// The class that the search looked for: X for both X and not_X.
[[nodiscard]] std::string searched_kind(const std::string& kind);

}  // namespace roadbook
