#include "exchange/import/foreign_classes.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

// Maps a class of a file to the map's name of this class; empty for a rejection.
class ClassNames {
 public:
  ClassNames(const std::vector<LabelClass>& classes, const std::vector<std::string>& kinds) {
    for (const LabelClass& one : with_kinds(classes, kinds)) known_.push_back(one.kind);
  }

  [[nodiscard]] std::optional<std::string> kind_of(const std::string& name) const {
    if (is_known(name)) return name;
    if (is_rejected_kind(name)) {
      if (is_known(searched_kind(name))) return std::nullopt;
      return "is_" + name;
    }
    for (const std::string& kind : known_)
      if (plain(kind) == plain(name)) return kind;
    return name;
  }

 private:
  [[nodiscard]] bool is_known(const std::string& name) const {
    return std::find(known_.begin(), known_.end(), name) != known_.end();
  }
  // Without case, blanks and a plural s.
  static std::string plain(const std::string& name) {
    std::string letters;
    for (const char c : name)
      if (c != ' ' && c != '_' && c != '-')
        letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (letters.size() > 1 && letters.back() == 's') letters.pop_back();
    return letters;
  }
  std::vector<std::string> known_;
};

}  // namespace

void name_foreign_classes(const MapLayers& layers, const std::string& source, LabelFile& file) {
  std::vector<std::string> kinds;
  for (const Label& label : read_labels(layers.file())) kinds.push_back(label.kind);
  const ClassNames names(read_label_classes(layers), kinds);
  std::set<std::string> told;
  std::erase_if(file.outlines, [&](LabelOutline& outline) {
    const auto kind = names.kind_of(outline.kind);
    if (!kind || wrong_name(*kind)) {
      LabelsLeftOut one =
          left_out(source, outline.where, "class '" + outline.kind + "'",
                   kind ? "a shorter name" : "a thing: such a class means a rejection");
      one.reason.line = outline.line;
      file.left_out.push_back(std::move(one));
      return true;
    }
    if (*kind != outline.kind && told.insert(outline.kind).second)
      file.notes.push_back({Severity::kWarning, source, 0, "class", "'" + outline.kind + "'",
                            "'" + *kind + "': it is taken as that"});
    outline.kind = *kind;
    return false;
  });
}

}  // namespace roadbook
