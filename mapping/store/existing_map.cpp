#include "mapping/store/existing_map.hpp"

#include <utility>

#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_open.hpp"

namespace roadbook {

std::string ExistingMap::names(std::size_t first) const {
  std::string names;
  for (std::size_t s = first; s < map.sessions.size(); ++s)
    names += (names.empty() ? "" : ", ") + map.sessions[s].name;
  return names;
}

ExistingMap read_existing_map(const std::filesystem::path& file,
                              const std::vector<std::string>& digests) {
  if (auto problems = event_log_problems(open_verified(file)); !problems.empty())
    throw BadInput(std::move(problems));
  ExistingMap existing{load_map(file)};
  const auto& sessions = existing.map.sessions;
  while (existing.stay < sessions.size() && existing.stay < digests.size() &&
         sessions[existing.stay].drive_digest == digests[existing.stay])
    ++existing.stay;
  return existing;
}

std::vector<std::string> tables_that_stay(const std::filesystem::path& file,
                                          const ExistingMap& existing,
                                          const std::vector<std::string>& always,
                                          const std::vector<std::string>& of_drives,
                                          std::vector<Problem>& warnings) {
  std::vector<std::string> tables = always;
  if (existing.goes_on()) {
    tables.insert(tables.end(), of_drives.begin(), of_drives.end());
    return tables;
  }
  const MapLayers layers(file);
  for (const std::string& table : of_drives)
    if (layers.has(table))
      warnings.push_back({Severity::kWarning, file.string(), 0, table,
                          "what was learnt with " + existing.names(existing.stay),
                          "the same drives in the same order; it is left out"});
  return tables;
}

}  // namespace roadbook
