#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace roadbook {

struct RemoveRequest {
  std::filesystem::path map;
  std::string session;       ///< name
  bool drop_labels = false;  ///< delete labels that no remaining image can carry
};

struct RemoveResult {
  std::size_t sessions = 0;  ///< of the map now
  std::size_t keyframes = 0;
  std::size_t landmarks = 0;
  std::size_t landmarks_lost = 0;
  std::size_t labels_moved = 0;    ///< to images of other sessions
  std::size_t labels_dropped = 0;  ///< deleted
  std::size_t edits_dropped = 0;   ///< edits by hand that name the session
  int pieces_before = 1;
  int pieces = 1;
  std::vector<std::string> tables_dropped;  ///< that number the sessions
  std::string digest;                       ///< of the map
};

/// Takes a session out of a map (`without_session`). Its labels and those of later sessions, whose
/// numbers change, move to the images of earlier sessions that show them best; their places in the
/// map stay. Layers stay as they are. The labels are moved first: an interruption then leaves a
/// map with the session and with all labels in their places.
///
/// Throws InvalidOption (no such session), Refused (the only session, or labels that no earlier
/// session shows, unless `drop_labels`), BadInput, StorageError. The map then is unchanged.
RemoveResult remove_session(const RemoveRequest& request);

}  // namespace roadbook
