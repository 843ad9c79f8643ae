#include "apps/label_server/label_fields.hpp"

#include "apps/label_server/request_fields.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

LabelSource source_of(const std::string& name) {
  for (const auto source : {LabelSource::kDrawn, LabelSource::kAccepted, LabelSource::kDetected})
    if (name == to_text(source)) return source;
  refuse_field("source", name, "drawn, accepted or detected");
}

}  // namespace

std::string kind_field(const Json& body) {
  return text_field(body, "kind", 64 + rejected_kind("").size());
}

void read_label_fields(const Json& body, Label* label) {
  label->kind = kind_field(body);
  if (label->kind.empty()) refuse_field("kind", "nothing", "a class");
  label->source = source_of(text_field(body, "source"));
  label->score = body.contains("score") ? number_field(body, "score") : 1.0;
  label->note = body.contains("note") ? text_field(body, "note", 1000) : std::string();
}

}  // namespace roadbook
