#include "workflows/labels/label_examples.hpp"

#include "base/error.hpp"
#include "exchange/layers/feature_column.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/labels/label_place.hpp"

namespace roadbook {
namespace {

constexpr const char* kBoxTable = "box_examples";

// Adds the example whose feature is in a row of the table.
void add_row(const TableRow& row, BoxExamples& examples) {
  const auto count = static_cast<Eigen::Index>(examples.labels.size());
  const Eigen::VectorXf feature =
      feature_from_row(row, "feature", count > 0 ? examples.features.cols() : 0);
  examples.features.conservativeResize(count + 1, feature.size());
  examples.features.row(count) = feature;
  examples.labels.push_back(row.get<std::int64_t>("positive") != 0 ? 1 : -1);
  examples.length_m = row.number("length_m", 0.0);
  examples.width_m = row.number("width_m", 0.0);
  if (!(examples.length_m > 0.0)) row.fail("length_m", "no length");
  if (!(examples.width_m > 0.0)) row.fail("width_m", "no width");
}

// Only maps store the examples of a detector.
void check_is_map(const std::filesystem::path& file) {
  try {
    const MapLayers layers(file);
  } catch (const BadInput& fault) {
    const Problem& problem = fault.problems().front();
    throw BadInput(Problem{Severity::kError, file.string(), 0, "--classifier",
                           problem.got + " (" + problem.field + ")", "a map (.gpkg) with labels"});
  }
}

}  // namespace

ExamplesByKind stored_examples(const std::filesystem::path& map) {
  ExamplesByKind examples;
  const MapLayers layers(map);
  if (!layers.has(kBoxTable)) return examples;
  const PlainTable table = layers.read_table(kBoxTable);
  for (const auto& values : table.rows) {
    const TableRow row(map.string(), table.name, table.fields, values,
                       "what `roadbook label --classifier` was given");
    add_row(row, examples[row.get<std::string>("kind")]);
  }
  return examples;
}

PlainTable examples_table(const ExamplesByKind& examples) {
  PlainTable table{kBoxTable,
                   {{"kind", FieldType::kText},
                    {"positive", FieldType::kInteger},
                    {"length_m", FieldType::kReal},
                    {"width_m", FieldType::kReal},
                    {"feature", FieldType::kBytes}},
                   {}};
  for (const auto& [kind, of_kind] : examples)
    for (std::size_t i = 0; i < of_kind.labels.size(); ++i)
      table.rows.push_back({kind, std::int64_t{of_kind.labels[i] > 0 ? 1 : 0}, of_kind.length_m,
                            of_kind.width_m,
                            feature_to_field(of_kind.features.row(static_cast<Eigen::Index>(i)))});
  return table;
}

ExamplesByKind examples_of_map(const std::filesystem::path& map, const BoxLearnerOptions& options) {
  check_is_map(map);
  const LabelPlace place = read_label_place(map);
  const Map poses = load_map(map);
  ExamplesByKind examples = stored_examples(map);
  std::map<std::string, BoxLearner> learners;
  const auto learner_of = [&](const std::string& kind) -> BoxLearner& {
    return learners.try_emplace(kind, place.image, options).first->second;
  };
  const std::vector<Label> labels = read_labels(map);
  if (!labels.empty() && !place.has_picture()) throw BadInput(no_overhead_image(map));
  for (const Label& label : labels)
    if (const auto box = box_in_map(poses, label); box && !is_rejected_kind(label.kind))
      learner_of(label.kind).add_positive(*box);
  for (const Label& label : labels)
    for (auto& [kind, learner] : learners)
      if (label.kind == rejected_kind(kind))
        if (const auto box = box_in_map(poses, label)) learner.add_negative(*box);
  for (auto& [kind, learner] : learners) {
    if (const auto before = examples.find(kind); before != examples.end())
      learner.start_from(before->second);
    if (learner.gather()) examples[kind] = learner.examples();
  }
  if (examples.empty())
    throw BadInput(Problem{Severity::kError, map.string(), 0, "--classifier",
                           "a map without labels", "a map with labelled boxes"});
  return examples;
}

}  // namespace roadbook
