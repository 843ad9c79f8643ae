#include "semantics/label_drives.hpp"

#include <map>
#include <string>

#include "base/error.hpp"
#include "semantics/label_store.hpp"

namespace roadbook {

void check_labels_stay(const std::filesystem::path& file, const ExistingMap& existing) {
  std::map<int, std::size_t> lost;  // labels by session
  for (const auto& labels : {read_labels(file), read_image_labels(file)})
    for (const Label& label : labels)
      if (label.anchor.session >= static_cast<int>(existing.stay)) ++lost[label.anchor.session];
  if (lost.empty()) return;
  std::string got;
  for (const auto& [session, count] : lost)
    got += (got.empty() ? "" : ", ") + std::to_string(count) + " of drive " +
           existing.map.sessions.at(static_cast<std::size_t>(session)).name;
  throw BadInput({Severity::kError, file.string(), 0, "labels", got,
                  "these drives first, in this order (" + existing.names() +
                      "), or another file for the map; export and import take labels along"});
}

}  // namespace roadbook
