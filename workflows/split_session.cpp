#include "workflows/split_session.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/pipeline/map_inputs.hpp"
#include "mapping/pipeline/map_paths.hpp"
#include "mapping/sessions/remove_session.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_reading.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/map_copy.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

constexpr const char* kSplitter = "map --split";

struct SessionPart {
  int session = 0;
  TimeSpan span;
};

// A name may contain '@': the whole text counts first.
SessionPart part_named(const Map& map, const std::string& text) {
  const auto is_name = [&](const std::string& name) {
    return std::any_of(map.sessions.begin(), map.sessions.end(),
                       [&](const Session& session) { return session.name == name; });
  };
  const std::size_t cut = text.rfind('@');
  if (cut == std::string::npos || is_name(text)) return {session_named(map, text, "--split"), {}};
  const std::string times = text.substr(cut + 1);
  const std::size_t comma = times.find(',');
  const auto begin = parse_int(times.substr(0, comma));
  const auto end = comma == std::string::npos ? std::optional<std::int64_t>()
                                              : parse_int(times.substr(comma + 1));
  if (!begin || !end || *begin > *end)
    throw InvalidOption("--split", text, "NAME@T0,T1 with times in nanoseconds, T0 first");
  return {session_named(map, text.substr(0, cut), "--split"), {*begin, *end}};
}

// Labels whose image is in the part, as labels of its one session.
std::vector<Label> labels_of_part(const std::vector<Label>& labels, const SessionPart& part) {
  const auto is_in = [&](const LabelAnchor& anchor) {
    return anchor.session == part.session && part.span.contains(anchor.t_ns);
  };
  std::vector<Label> kept;
  for (Label label : labels) {
    if (!is_in(label.anchor)) continue;
    std::erase_if(label.sightings, [&](const LabelSighting& s) { return !is_in(s.anchor); });
    label.anchor.session = 0;
    for (LabelSighting& sighting : label.sightings) sighting.anchor.session = 0;
    if (label.seen) label.seen->sessions = 1;
    kept.push_back(std::move(label));
  }
  return kept;
}

void store_labels(const std::vector<Label>& labels,
                  const std::optional<std::vector<LabelClass>>& classes,
                  const std::filesystem::path& file) {
  if (labels.empty()) return;
  {
    LabelStore store(file);
    if (classes) store.write_table(label_class_table(*classes));
    (void)store.create_all(labels, kSplitter);
  }
  renew_label_layers(file);
}

}  // namespace

SplitResult split_session(const SplitRequest& request) {
  if (std::filesystem::exists(request.output))
    throw InvalidOption("--output", request.output.string() + ", which exists", "a new file");
  const MapReading reading(request.map);
  const Map map = load_map_with_corners(request.map);
  const SessionPart named = part_named(map, request.part);
  MapOptions options;
  options.num_threads = request.num_threads;
  Map part = map_of_session(map, named.session, named.span, options);
  part.sessions.front().drive_path =
      path_from_map(session_folder(request.map, map.sessions[at(named.session)]), request.output);
  std::vector<Label> labels = labels_of_part(read_labels(request.map), named);
  const auto in_images = labels_of_part(read_image_labels(request.map), named);
  labels.insert(labels.end(), in_images.begin(), in_images.end());
  const MapLayers layers(request.map);
  const auto classes = layers.has("label_classes") ? std::optional(read_label_classes(layers))
                                                   : std::optional<std::vector<LabelClass>>();
  auto meta = meta_after(request.map, "split " + request.part);
  reading.require_same_map();

  SplitResult result;
  result.pieces = piece_count(part);
  meta["gauge"] = "first keyframe of each piece";
  if (result.pieces > 1) meta[kPiecesKey] = std::to_string(result.pieces);
  MapCopy copy(request.output, ".split");
  MapFileBuilder(copy.file(), meta["inputs"]).finish(part, meta);
  store_labels(labels, classes, copy.file());
  copy.put_in_place();

  result.session = part.sessions.front().name;
  result.keyframes = part.keyframes.size();
  result.landmarks = part.landmarks.size();
  result.observations = part.observations.size();
  result.labels = labels.size();
  result.digest = load_meta(request.output).digest;
  return result;
}

}  // namespace roadbook
