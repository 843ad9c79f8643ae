#include "workflows/settings/effect_model.hpp"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {

EffectSizes read_effect_model(const std::filesystem::path& file) {
  EffectSizes sizes;
  YamlMap yaml = YamlMap::load(file);
  if (auto effects = yaml.map("effects"))
    for (const std::string& name : effects->keys()) effects->read(name, sizes[name]);
  yaml.finish();
  try {
    check_effects(sizes);
  } catch (const BadInput& bad) {
    std::vector<Problem> problems = bad.problems();
    for (Problem& problem : problems) problem.file = file.string();
    throw BadInput(std::move(problems));
  }
  return sizes;
}

std::string effect_model_text(const EffectSizes& sizes) {
  if (sizes.empty()) return "effects: {}\n";
  std::string text = "effects:\n";
  for (const auto& [name, size] : sizes)
    text += "  " + name + ": " + nlohmann::json(size).dump() + "\n";
  return text;
}

}  // namespace roadbook
