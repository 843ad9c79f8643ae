#include "drive/import/import.hpp"

#include <map>

#include "base/text.hpp"
#include "drive/import/import_support.hpp"

namespace roadbook {
namespace {

using Importer = ImportResult (*)(const ImportJob&);

const std::map<std::string, Importer>& importers() {
  static const std::map<std::string, Importer> table = {
      {"comma2k19", &import_comma2k19}, {"euroc", &import_euroc},       {"kaist", &import_kaist},
      {"kitti", &import_kitti},         {"kitti360", &import_kitti360}, {"video", &import_video}};
  return table;
}

}  // namespace

const std::vector<std::string>& import_formats() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& [name, importer] : importers()) list.push_back(name);
    return list;
  }();
  return names;
}

ImportResult import_drive(const std::string& format,
                          const std::filesystem::path& source,
                          const std::filesystem::path& out,
                          const ImportOptions& options,
                          const Progress& progress) {
  const auto found = importers().find(format);
  if (found == importers().end()) {
    std::string known;
    for (const auto& name : import_formats()) known += (known.empty() ? "" : ", ") + name;
    if (const auto near = nearest_name(format, import_formats()))
      known += " (did you mean " + *near + "?)";
    throw BadInput({Severity::kError, "", 0, "format", format, "one of " + known});
  }
  std::error_code error;
  if (!std::filesystem::is_directory(source, error))
    throw BadInput({Severity::kError, source.string(), 0, "", "no such folder", "a recording"});
  return found->second({source, out, options, progress});
}

}  // namespace roadbook
