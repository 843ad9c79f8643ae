#include "mapping/pipeline/map_inputs.hpp"

#include <algorithm>

#include "base/digest.hpp"
#include "mapping/pipeline/map_options_text.hpp"
#include "mapping/pipeline/program_digest.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

constexpr const char* kPipelineVersion = "12";   // changes with everything that changes results
constexpr const char* kInputs = "inputs";        // in map_meta
constexpr const char* kExtension = "extension";  // the inputs of the last extension
constexpr const char* kExtensionBuild = "place.extension";  // the key of its checkpoints

std::vector<std::string> digests_of(const std::vector<Drive>& drives) {
  std::vector<std::string> digests;
  for (const Drive& drive : drives) digests.push_back(drive.digest());
  return digests;
}

// A mask is no part of the recording: its change is no other drive, but another map.
void add_masks(const Drive& drive, std::size_t index, Sha256& digest) {
  for (std::size_t camera = 0; camera < drive.rig().cameras.size(); ++camera)
    if (const auto mask = drive.mask_path(camera))
      digest.update("mask " + std::to_string(index) + " " + std::to_string(camera))
          .update_file(*mask);
}

// The map itself does not name the program: two builds of the same version make equal maps.
std::string inputs_key(const std::vector<Drive>& drives, const MapOptions& options) {
  Sha256 digest;
  digest.update(std::string(kPipelineVersion) + " " + options_text(options) + " " +
                std::to_string(options.seed));
  for (const std::string& drive : digests_of(drives)) digest.update(drive);
  for (std::size_t i = 0; i < drives.size(); ++i) add_masks(drives[i], i, digest);
  return digest.hex();
}

// The checkpoints do not depend on the labels whose rows straighten the map, nor on whether parts
// are kept apart; the map does.
std::string map_inputs(const std::vector<Drive>& drives, const MapOptions& options) {
  Sha256 digest;
  digest.update(inputs_key(drives, options) + " " + std::to_string(kMapSchemaVersion) + " " +
                options.rows_digest + (options.gate.apart ? " apart" : "") +
                (options.session_name.empty() ? "" : " as " + options.session_name));
  return digest.hex();
}

// What an extension depends on besides the map.
std::string extension_inputs(const std::vector<Drive>& drives, const MapOptions& options) {
  Sha256 digest;
  digest.update(map_inputs(drives, options) + " adjust " +
                std::to_string(static_cast<int>(options.adjust)));
  return digest.hex();
}

bool meta_has(const std::filesystem::path& file, const std::map<std::string, std::string>& wanted) {
  const auto values = load_meta(file).values;
  return std::all_of(wanted.begin(), wanted.end(), [&](const auto& entry) {
    const auto found = values.find(entry.first);
    return found != values.end() && found->second == entry.second;
  });
}

bool is_same_camera(const MountedCamera& a, const MountedCamera& b) {
  return a.camera.model == b.camera.model && a.camera.parameters == b.camera.parameters &&
         a.camera.width == b.camera.width && a.camera.height == b.camera.height &&
         a.camera.max_angle_rad == b.camera.max_angle_rad && a.time_offset_s == b.time_offset_s &&
         a.exposed_after_s == b.exposed_after_s && a.rolling_shutter_s == b.rolling_shutter_s &&
         a.T_vehicle_camera.matrix() == b.T_vehicle_camera.matrix();
}

}  // namespace

std::string checkpoint_key(const std::vector<Drive>& drives, const MapOptions& options) {
  Sha256 digest;
  digest.update(inputs_key(drives, options) + " " + program_digest());
  return digest.hex();
}

std::map<std::string, std::string> inputs_meta(const std::vector<Drive>& drives,
                                               const MapOptions& options) {
  return {{"options", options_text(options)},
          {"seed", std::to_string(options.seed)},
          {kInputs, map_inputs(drives, options)},
          {kExtension, ""}};
}

std::optional<ExistingMap> existing_map(const std::filesystem::path& file,
                                        const std::vector<Drive>& drives,
                                        const MapOptions& options) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  ExistingMap existing = read_existing_map(file, digests_of(drives));
  if (!existing.goes_on() && !options.replace)
    throw BadInput({Severity::kError, file.string(), 0, "sessions", "a map of " + existing.names(),
                    "a new file, or --replace to build it anew from these drives"});
  return existing;
}

bool is_built_from(const ExistingMap& existing,
                   const std::filesystem::path& file,
                   const std::vector<Drive>& drives,
                   const MapOptions& options) {
  return existing.goes_on() && existing.stay == drives.size() &&
         meta_has(file, inputs_meta(drives, options));
}

std::vector<std::string> tables_to_keep(const ExistingMap& existing,
                                        const std::filesystem::path& file,
                                        const std::vector<Drive>& drives,
                                        const MapOptions& options,
                                        std::vector<Problem>& warnings) {
  auto made_with = inputs_meta(drives, options);
  made_with.erase(kInputs);
  if (existing.goes_on() && drives.size() > existing.stay && !meta_has(file, made_with))
    warnings.push_back(
        {Severity::kWarning, file.string(), 0, "options", "others than the map was made with",
         "the same --model, --equal-rows and --seed; all its drives are mapped with those of now"});
  if (!existing.goes_on() && options.check_what_goes) options.check_what_goes(existing);
  return tables_that_stay(file, existing, options.keep_tables, options.keep_tables_of_drives,
                          warnings);
}

bool has_same_poses(const Map& before, const Map& after) {
  const auto same_session = [](const Session& a, const Session& b) {
    return a.drive_digest == b.drive_digest && a.name == b.name && a.vehicle == b.vehicle &&
           std::equal(a.rig.cameras.begin(), a.rig.cameras.end(), b.rig.cameras.begin(),
                      b.rig.cameras.end(), is_same_camera);
  };
  if (!std::equal(before.sessions.begin(), before.sessions.end(), after.sessions.begin(),
                  after.sessions.end(), same_session) ||
      before.keyframes.size() != after.keyframes.size())
    return false;
  for (std::size_t k = 0; k < after.keyframes.size(); ++k) {
    const auto index = static_cast<int>(k);
    if (before.keyframes[k].session != after.keyframes[k].session ||
        before.keyframes[k].t_ns != after.keyframes[k].t_ns ||
        before.T_map_vehicle(index).matrix() != after.T_map_vehicle(index).matrix())
      return false;
  }
  return true;
}

std::map<std::string, std::string> extension_meta(const std::filesystem::path& file,
                                                  const std::vector<Drive>& drives,
                                                  const MapOptions& options) {
  const MapMeta before = load_meta(file);
  const auto inputs = before.values.find(kInputs);
  Sha256 digest;
  digest.update((inputs == before.values.end() ? std::string() : inputs->second) + " " +
                extension_inputs(drives, options));
  auto meta = inputs_meta(drives, options);
  meta[kInputs] = digest.hex();
  meta[kExtension] = extension_inputs(drives, options);
  meta[kExtensionBuild] = extension_checkpoint_key(before.digest, drives, options);
  return meta;
}

std::map<std::string, std::string> meta_after(const std::filesystem::path& file,
                                              const std::string& change) {
  const MapMeta before = load_meta(file);
  const auto inputs = before.values.find(kInputs);
  Sha256 digest;
  digest.update((inputs == before.values.end() ? std::string() : inputs->second) + " " + change);
  return {{kInputs, digest.hex()}, {kExtension, ""}, {kExtensionBuild, ""}};
}

std::map<std::string, std::string> removal_meta(const std::filesystem::path& file,
                                                const std::string& drive_digest) {
  return meta_after(file, "without " + drive_digest);
}

bool is_extended_by(const std::filesystem::path& file,
                    const std::vector<Drive>& drives,
                    const MapOptions& options) {
  return meta_has(file, {{kExtension, extension_inputs(drives, options)}});
}

bool was_extended(const std::filesystem::path& file) {
  const auto values = load_meta(file).values;
  const auto found = values.find(kExtension);
  return found != values.end() && !found->second.empty();
}

std::string extension_checkpoint_key(const std::string& map_digest,
                                     const std::vector<Drive>& drives,
                                     const MapOptions& options) {
  Sha256 digest;
  digest.update("extension of " + map_digest + " " + extension_inputs(drives, options) + " " +
                program_digest());
  return digest.hex();
}

std::string extension_of_build(const MapMeta& meta) {
  const auto found = meta.values.find(kExtensionBuild);
  return found == meta.values.end() ? std::string() : found->second;
}

}  // namespace roadbook
