#pragma once

#include "drive/drive.hpp"
#include "drive/writer.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/semantics/two_drives.hpp"

namespace roadbook::test {

inline void write_recording(TwoDrives& drives,
                            int session,
                            const KeyframeImages& images,
                            const std::filesystem::path& folder) {
  const Rig& rig = drives.map.sessions[static_cast<std::size_t>(session)].rig;
  DriveWriter writer(folder, rig, std::nullopt);
  int frame = 0;
  for (std::size_t k = 0; k < drives.map.keyframes.size(); ++k) {
    Keyframe& keyframe = drives.map.keyframes[k];
    if (keyframe.session != session) continue;
    keyframe.drive_frame = frame++;
    for (std::size_t c = 0; c < rig.cameras.size(); ++c)
      writer.write_image(c, keyframe.t_ns, images(static_cast<int>(k), static_cast<int>(c)));
  }
  writer.finish();
}

/// Writes the recordings of both drives, seen from the true poses, to `folder`. The sessions of the
/// map refer to the recordings.
inline void write_recordings(TwoDrives& drives,
                             const std::vector<Eigen::Isometry3d>& T_true,
                             const std::filesystem::path& folder) {
  const KeyframeImages images = drives.images(T_true);
  for (std::size_t s = 0; s < drives.map.sessions.size(); ++s) {
    Session& session = drives.map.sessions[s];
    session.drive_path = session.name;
    write_recording(drives, static_cast<int>(s), images, folder / session.name);
    session.drive_digest = Drive::open(folder / session.name).digest();
  }
}

/// Writes a map file of the first drive with labels, in its state before the second drive.
inline void write_first_drive(const std::filesystem::path& file, const TwoDrives& drives) {
  Map first = drives.map;
  first.sessions.resize(1);
  std::erase_if(first.keyframes, [](const Keyframe& k) { return k.session > 0; });
  first.map_frames.resize(first.keyframes.size());
  MapFileBuilder(file, "first").finish(first, {});
  LabelStore(file).create_all(drives.spaces(), "ann");
}

/// Moves the poses of the second drive ahead of the true poses by `share` of the way.
inline void bend_second_drive(TwoDrives& drives, double share) {
  const auto truth = drives.poses();
  for (std::size_t k = 0; k < truth.size(); ++k)
    if (drives.map.keyframes[k].session == 1)
      drives.map.map_frames[k].T_map_frame.translation().x() +=
          share * (truth[k].translation().x() + 4.0);
}

}  // namespace roadbook::test
