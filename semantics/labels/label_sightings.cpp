#include "semantics/labels/label_sightings.hpp"

#include "base/error.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

constexpr const char* kSightingsTable = "label_sightings";
constexpr std::size_t kSightingColumns = 9;

StoredSighting sighting_of_row(const std::vector<FieldValue>& row) {
  const auto whole = [&](std::size_t column) { return std::get<std::int64_t>(row.at(column)); };
  const auto real = [&](std::size_t column) { return std::get<double>(row.at(column)); };
  StoredSighting stored{whole(0), whole(1), {}};
  stored.sighting.anchor = {static_cast<int>(whole(2)), whole(3), static_cast<int>(whole(4))};
  stored.sighting.middle_vehicle = {real(5), real(6), real(7)};
  stored.sighting.sigma_m = real(8);
  return stored;
}

// Whether both are the same sighting: the same label version, found at the same place in the same
// image.
bool same_sighting(const StoredSighting& a, const StoredSighting& b) {
  return a.version == b.version && a.sighting.anchor.t_ns == b.sighting.anchor.t_ns &&
         a.sighting.anchor.camera == b.sighting.anchor.camera &&
         a.sighting.middle_vehicle == b.sighting.middle_vehicle;
}

}  // namespace

SightingRecord::SightingRecord(const std::vector<StoredSighting>& stored) {
  for (const StoredSighting& one : stored)
    sightings_[{one.label, one.sighting.anchor.session}] = one;
}

bool SightingRecord::take(const Map& map,
                          const Label& label,
                          int session,
                          const LabelEvidence& evidence) {
  if (evidence.status == EvidenceStatus::kUnseen) return false;
  const std::pair place(label.id, session);
  const auto known = sightings_.find(place);
  if (evidence.status != EvidenceStatus::kFound) return sightings_.erase(place) > 0;
  const StoredSighting found{label.id, label.version, sighting_of(map, label, evidence)};
  if (known != sightings_.end() && same_sighting(known->second, found)) return false;
  sightings_[place] = found;
  return true;
}

std::vector<StoredSighting> SightingRecord::sightings() const {
  std::vector<StoredSighting> all;
  for (const auto& [place, sighting] : sightings_) all.push_back(sighting);
  return all;
}

void look_for_sightings(const Map& map,
                        const std::vector<Label>& labels,
                        const KeyframeImages& images,
                        SightingRecord& record,
                        const Progress& progress) {
  const int sessions = static_cast<int>(map.sessions.size());
  std::size_t done = 0;
  for (const Label& label : labels) {
    report(progress, "labels", done++, labels.size());
    if (!is_on_ground(label) || is_rejected_kind(label.kind)) continue;
    for (int session = 0; session < sessions; ++session)
      if (session != label.anchor.session)
        record.take(map, label, session, look_again(map, label, session, images));
  }
}

PlainTable label_sightings_table(const std::vector<StoredSighting>& sightings) {
  PlainTable table{kSightingsTable,
                   {{"label", FieldType::kInteger},
                    {"version", FieldType::kInteger},
                    {"session", FieldType::kInteger},
                    {"t_ns", FieldType::kInteger},
                    {"camera", FieldType::kInteger},
                    {"x_m", FieldType::kReal},
                    {"y_m", FieldType::kReal},
                    {"z_m", FieldType::kReal},
                    {"sigma_m", FieldType::kReal}},
                   {}};
  for (const StoredSighting& stored : sightings) {
    const LabelAnchor& anchor = stored.sighting.anchor;
    const Eigen::Vector3d& p = stored.sighting.middle_vehicle;
    table.rows.push_back({stored.label, stored.version, std::int64_t{anchor.session}, anchor.t_ns,
                          std::int64_t{anchor.camera}, p.x(), p.y(), p.z(),
                          stored.sighting.sigma_m});
  }
  return table;
}

std::vector<StoredSighting> read_label_sightings(const MapLayers& layers) {
  std::vector<StoredSighting> sightings;
  if (!layers.has(kSightingsTable)) return sightings;
  for (const auto& row : layers.read_table(kSightingsTable).rows) {
    try {
      if (row.size() != kSightingColumns) throw std::bad_variant_access();
      sightings.push_back(sighting_of_row(row));
    } catch (const std::bad_variant_access&) {
      throw BadInput({Severity::kError, layers.file().string(), 0,
                      std::string("table ") + kSightingsTable, "a row with other columns",
                      "label, version, session, t_ns, camera, x_m, y_m, z_m, sigma_m"});
    }
  }
  return sightings;
}

void add_sightings(const std::vector<StoredSighting>& sightings, std::vector<Label>& labels) {
  std::map<std::int64_t, Label*> by_id;
  for (Label& label : labels) by_id[label.id] = &label;
  for (const StoredSighting& stored : sightings) {
    const auto label = by_id.find(stored.label);
    if (label == by_id.end() || label->second->version != stored.version) continue;
    label->second->sightings.push_back(stored.sighting);
  }
}

}  // namespace roadbook
