#include "workflows/settings/config_check.hpp"

#include <algorithm>
#include <utility>

namespace roadbook {

Problem located(Problem fault, const YamlMap& yaml) {
  std::string key = fault.field;
  if (!yaml.has(key)) {
    const auto keys = yaml.keys();
    const auto named = std::find_if(keys.begin(), keys.end(), [&](const std::string& other) {
      return fault.want.find(other) != std::string::npos;
    });
    if (named != keys.end()) key = *named;
  }
  fault.file = yaml.file();
  fault.line = yaml.line(key);
  return fault;
}

}  // namespace roadbook
