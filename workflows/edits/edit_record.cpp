#include "workflows/edits/edit_record.hpp"

#include <algorithm>
#include <cstddef>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_bytes.hpp"
#include "workflows/edits/edit_file.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kPartBytes = std::size_t{4} << 20;

std::string next_chain(const std::string& chain, const std::string& text) {
  Sha256 digest;
  digest.update(chain + "\n" + text);
  return digest.hex();
}

[[noreturn]] void refuse_damage(const std::filesystem::path& map, const char* table) {
  throw BadInput(
      {Severity::kError, map.string(), 0, table, "other content", "the edits as they were stored"});
}

}  // namespace

std::vector<MapEdit> stored_edits(const std::filesystem::path& map) {
  const MapLayers layers(map);
  std::vector<MapEdit> edits;
  if (!layers.has(kEditTable)) return edits;
  std::string chain;
  for (const auto& row : layers.read_table(kEditTable).rows) {
    const auto* text = row.size() == 3 ? std::get_if<std::string>(&row[1]) : nullptr;
    const auto* stored = row.size() == 3 ? std::get_if<std::string>(&row[2]) : nullptr;
    if (text == nullptr || stored == nullptr) refuse_damage(map, kEditTable);
    chain = next_chain(chain, *text);
    if (chain != *stored) refuse_damage(map, kEditTable);
    const auto parsed = parse_edits(*text, map.string() + ": " + kEditTable);
    if (parsed.size() != 1) refuse_damage(map, kEditTable);
    edits.push_back(parsed.front());
  }
  return edits;
}

std::optional<Map> stored_map_before_edits(const std::filesystem::path& map) {
  const MapLayers layers(map);
  if (!layers.has(kBeforeTable)) return std::nullopt;
  Bytes whole;
  for (const auto& row : layers.read_table(kBeforeTable).rows) {
    const Bytes* part = row.size() == 2 ? std::get_if<Bytes>(&row[1]) : nullptr;
    if (part == nullptr) refuse_damage(map, kBeforeTable);
    whole.insert(whole.end(), part->begin(), part->end());
  }
  return map_from_bytes(whole, map);
}

void write_edits(MapUpdate& update, const std::vector<MapEdit>& edits, const Map* before) {
  if (edits.empty()) {
    static_cast<void>(update.remove(kEditTable));
    static_cast<void>(update.remove(kBeforeTable));
    return;
  }
  PlainTable table;
  table.name = kEditTable;
  table.fields = {
      {"edit", FieldType::kInteger}, {"text", FieldType::kText}, {"chain", FieldType::kText}};
  std::string chain;
  for (const MapEdit& edit : edits) {
    const std::string text = edit_yaml(edit);
    chain = next_chain(chain, text);
    table.rows.push_back({static_cast<std::int64_t>(table.rows.size()) + 1, text, chain});
  }
  update.write_table(table);
  if (before == nullptr) {
    static_cast<void>(update.remove(kBeforeTable));
    return;
  }
  PlainTable whole;
  whole.name = kBeforeTable;
  whole.fields = {{"part", FieldType::kInteger}, {"bytes", FieldType::kBytes}};
  const Bytes bytes = map_to_bytes(*before);
  for (std::size_t begin = 0; begin < bytes.size(); begin += kPartBytes) {
    const std::size_t end = std::min(bytes.size(), begin + kPartBytes);
    whole.rows.push_back({static_cast<std::int64_t>(whole.rows.size()),
                          Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                                bytes.begin() + static_cast<std::ptrdiff_t>(end))});
  }
  update.write_table(whole);
}

}  // namespace roadbook
