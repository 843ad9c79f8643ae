#include "base/yaml.hpp"

#include <fstream>

#include "base/text.hpp"
#include "base/yaml_state.hpp"

namespace roadbook {

std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return node.Scalar().size() > 60 ? node.Scalar().substr(0, 57) + "..." : node.Scalar();
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
    default:
      return "nothing";
  }
}

namespace {

constexpr std::uintmax_t kMaxBytes = 64u << 20;  // far above any calibration or scenario

YAML::Node parse_text(const std::string& text, const std::string& name) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw BadInput(
        {Severity::kError, name, e.mark.line + 1, "", "invalid YAML (" + e.msg + ")", "YAML"});
  }
}

}  // namespace

void YamlMap::State::fill(const YAML::Node& node) {
  line = line_of(node);
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      fault("", line_of(entry.first), shown(entry.first) + " as key", "a name");
      continue;
    }
    const std::string& key = entry.first.Scalar();
    if (find(key) != nullptr)
      fault(key, line_of(entry.first), "the key a second time", "each key once");
    else
      entries.emplace_back(key, entry.second);
  }
}

YamlMap YamlMap::load(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) throw BadInput({Severity::kError, file.string(), 0, "", "no readable file", "YAML"});
  if (size > kMaxBytes)
    throw BadInput({Severity::kError, file.string(), 0, "size", std::to_string(size) + " bytes",
                    "at most " + std::to_string(kMaxBytes)});
  std::ifstream in(file, std::ios::binary);
  std::string text(size, '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(size)))
    throw BadInput({Severity::kError, file.string(), 0, "", "no readable file", "YAML"});
  return parse(text, file.string());
}

YamlMap YamlMap::parse(const std::string& text, const std::string& name) {
  std::string body = text;
  // OpenCV writes "%YAML:1.0", which is not the directive it resembles.
  if (body.starts_with("%YAML:")) body[0] = '#';
  const YAML::Node root = parse_text(body, name);
  if (!root.IsMap() && !root.IsNull())
    throw BadInput({Severity::kError, name, line_of(root), "", shown(root), "a mapping"});
  auto document = std::make_shared<Document>();
  document->file = name;
  auto state = std::make_shared<State>();
  state->document = document.get();
  if (root.IsMap()) state->fill(root);
  document->maps.push_back(state);
  // The document lists every state, so the states must not own the document; each handle does.
  return YamlMap(std::shared_ptr<State>(document, state.get()));
}

std::optional<YamlMap> YamlMap::map(std::string_view key) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->IsMap()) {
    state_->fault(key, line_of(*node), shown(*node), "a mapping");
    return std::nullopt;
  }
  auto child = std::make_shared<State>();
  child->document = state_->document;
  child->path = state_->path + std::string(key) + ".";
  child->fill(*node);
  state_->document->maps.push_back(child);
  return YamlMap(std::shared_ptr<State>(state_, child.get()));
}

std::vector<YamlMap> YamlMap::maps(std::string_view key) {
  std::vector<YamlMap> result;
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return result;
  if (!node->IsSequence()) {
    state_->fault(key, line_of(*node), shown(*node), "a list of mappings");
    return result;
  }
  std::size_t index = 0;
  for (const auto& item : *node) {
    const std::string name = std::string(key) + "[" + std::to_string(index++) + "]";
    if (!item.IsMap()) {
      state_->fault(name, line_of(item), shown(item), "a mapping");
      continue;
    }
    auto child = std::make_shared<State>();
    child->document = state_->document;
    child->path = state_->path + name + ".";
    child->fill(item);
    state_->document->maps.push_back(child);
    result.push_back(YamlMap(std::shared_ptr<State>(state_, child.get())));
  }
  return result;
}

void YamlMap::ignore(std::string_view key) { state_->ask(key); }

bool YamlMap::has(std::string_view key) const { return state_->find(key) != nullptr; }

bool YamlMap::is_map(std::string_view key) const {
  const YAML::Node* const node = state_->find(key);
  return node != nullptr && node->IsMap();
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> names;
  for (const auto& [name, node] : state_->entries) names.push_back(name);
  return names;
}

void YamlMap::report(std::string_view key, const std::string& got, const std::string& want) {
  state_->fault(key, line(key), got, want);
}

bool YamlMap::missing(std::string_view key) {
  state_->asked.emplace(key);
  state_->fault(key, state_->line, "nothing", "this key");
  return false;
}

std::int64_t YamlMap::line(std::string_view key) const {
  const YAML::Node* const node = state_->find(key);
  return node == nullptr ? state_->line : line_of(*node);
}

const std::string& YamlMap::file() const { return state_->document->file; }

const std::vector<Problem>& YamlMap::problems() const { return state_->document->problems; }

std::vector<Problem> YamlMap::finish_problems() {
  for (const auto& map : state_->document->maps) {
    const std::vector<std::string> known(map->asked.begin(), map->asked.end());
    for (const auto& [name, node] : map->entries) {
      if (map->asked.contains(name)) continue;
      const auto nearest = nearest_name(name, known);
      map->fault(name, line_of(node), "an unknown key",
                 nearest ? "a known one (did you mean " + *nearest + "?)" : "a known one");
      map->asked.insert(name);  // said once, however often finish is called
    }
  }
  return state_->document->problems;
}

void YamlMap::finish() {
  if (auto found = finish_problems(); !found.empty()) throw BadInput(std::move(found));
}

}  // namespace roadbook
