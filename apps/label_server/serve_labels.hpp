#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/console.hpp"
#include "apps/label_server/http/http_server.hpp"

namespace roadbook {

/// The arguments of `serve_labels`.
struct LabelServerRequest {
  std::filesystem::path map;
  std::vector<std::filesystem::path> drives;  ///< for sessions whose drive has moved
  std::filesystem::path
      classifier;       ///< another map, whose labels the detector uses first; or empty
  std::string who;      ///< user name; empty: name of the system's user
  double idle_s = 0.0;  ///< ends if no page was open for this time; 0: never
  int num_threads = 0;  ///< 0: all cores
};

/// Serves the labelling page of a map until an interrupt or `idle_s`. Returns the number of
/// changes. Throws BadInput, StorageError.
std::size_t serve_labels(const LabelServerRequest& request, HttpServer& server, Console& console);

}  // namespace roadbook
