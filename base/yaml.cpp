#include "base/yaml.hpp"

#include <yaml-cpp/eventhandler.h>

#include <cstdint>
#include <sstream>

#include "base/text.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
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

constexpr std::uint64_t kMaxBytes = 64u << 20;  // far above any calibration or scenario

[[noreturn]] void refuse_text(const std::string& name,
                              std::int64_t line,
                              const std::string& got,
                              const std::string& want) {
  throw BadInput({Severity::kError, name, line, "", got, want});
}

// "---" or "..." alone, or with a blank behind it.
bool is_marker(std::string_view line, std::string_view marker) {
  return line.starts_with(marker) &&
         (line.size() == 3 || line[3] == ' ' || line[3] == '\t' || line[3] == '#');
}

void require_characters(std::string_view line, std::int64_t number, const std::string& name) {
  if (!utf8_characters(line)) refuse_text(name, number, "bytes that are no UTF-8", "UTF-8 text");
  for (const char c : line)
    if ((c >= 0 && c < ' ' && c != '\t') || c == 0x7F)
      refuse_text(name, number, "the control character " + std::to_string(static_cast<int>(c)),
                  "text");
}

// The parser reads one document and drops what follows. So nothing may follow.
class OneDocument {
 public:
  explicit OneDocument(const std::string& name) : name_(name) {}
  void add(std::string_view line, std::int64_t number) {
    require_characters(line, number, name_);
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') return;
    if (ended_)
      refuse_text(name_, number, "text behind the end of the document ('...')", "one document");
    if (is_marker(line, "...")) {
      ended_ = true;
    } else if (is_marker(line, "---")) {
      if (begun_) refuse_text(name_, number, "a second document ('---')", "one document");
      begun_ = true;
    } else if (line.front() != '%') {
      begun_ = true;
    } else if (begun_) {
      refuse_text(name_, number, "a directive ('%') within the document",
                  "directives before the document alone");
    }
  }

 private:
  const std::string& name_;
  bool begun_ = false;
  bool ended_ = false;
};

// Remembers where a document begins.
class DocumentStart : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&,
                const std::string&,
                YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&,
                       const std::string&,
                       YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&,
                  const std::string&,
                  YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  std::int64_t line = 0;
};

// Where the parser ends a document early, at a stray bracket or comma, it takes the rest for
// another one. (YAML::LoadAll would take such a rest for documents without end.)
void require_no_more(const std::string& text, const std::string& name) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  DocumentStart document;
  if (parser.HandleNextDocument(document) && parser.HandleNextDocument(document))
    refuse_text(name, document.line, "text that belongs to no key", "one document");
}

YAML::Node parse_text(const std::string& text, const std::string& name) {
  require_one_yaml_document(text, name);
  try {
    require_no_more(text, name);
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw BadInput(
        {Severity::kError, name, e.mark.line + 1, "", "invalid YAML (" + e.msg + ")", "YAML"});
  }
}

}  // namespace

void require_one_yaml_document(std::string_view text, const std::string& name) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
      text.starts_with(std::string_view("\0\0\xFE\xFF", 4)))
    refuse_text(name, 1, "UTF-16 or UTF-32 text", "UTF-8 text");
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  OneDocument document(name);
  std::int64_t number = 0;
  while (!text.empty()) {
    const auto end = text.find_first_of("\r\n");
    document.add(text.substr(0, end), ++number);
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
  }
}

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
  return parse(read_regular_file(file, "YAML", kMaxBytes), file.string());
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
