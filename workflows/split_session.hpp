#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "mapping/sessions/session_map.hpp"

namespace roadbook {

struct SplitRequest {
  std::filesystem::path map;
  std::string part;              ///< NAME, or `NAME@T0,T1` with times in nanoseconds
  std::filesystem::path output;  ///< map file that does not exist yet
  int num_threads = 0;
};

struct SplitResult {
  std::string session;  ///< name
  std::size_t keyframes = 0;
  std::size_t landmarks = 0;
  std::size_t observations = 0;
  std::size_t labels = 0;  ///< copied
  int pieces = 1;
  std::string digest;  ///< of the new map
};

/// Writes a session of a map, or its part between two times, as a separate map
/// (`map_of_session`). The map is only read. Labels on images of the part are copied; other layers
/// and tables are not.
///
/// Throws InvalidOption (no such session, times that cannot be read, an output that exists),
/// Refused (too little for a map), BadInput, StorageError. There is no output then.
SplitResult split_session(const SplitRequest& request);

}  // namespace roadbook
