#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

class SqlDatabase;
struct PlainTable;

// A list of events in a map file that only grows. Each event is one small transaction, which is on
// the disk when the call returns. The file is not copied as by MapUpdate.
// Table NAME_events(event, content, chain): events count from 1. `chain` is the digest of the event
// and of the chain before it, so that the last one covers all and a save does not read the others.
class MapEventLog {
 public:
  /// Opens the log of that name, or begins it. Holds the map's lock for as long as it lives. Throws
  /// BadInput (map damaged, chain broken), StorageError (lock, disk), InvalidOption (name).
  MapEventLog(const std::filesystem::path& map, const std::string& name);
  ~MapEventLog();
  MapEventLog(const MapEventLog&) = delete;
  MapEventLog& operator=(const MapEventLog&) = delete;

  /// Contents of all events so far, in order.
  [[nodiscard]] const std::vector<std::string>& events() const;
  /// Stores an event and returns its number. Throws StorageError, which leaves the log unchanged.
  std::int64_t append(const std::string& content) { return append(std::vector{content}); }
  /// Stores events together, all or none, and returns the number of the first. The transaction
  /// waits for the disk once, so many events cost about as much as one. `table`, if given, replaces
  /// a plain table in the same transaction.
  std::int64_t append(const std::vector<std::string>& contents, const PlainTable* table = nullptr);
  /// Replaces a plain table of the map (see MapUpdate::write_table) in place.
  void write_table(const PlainTable& table);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the contents of all events of log `name` of a finished map, in order; empty if the map
/// has no such log. Throws BadInput if the chain is broken.
[[nodiscard]] std::vector<std::string> read_event_log(const std::filesystem::path& map,
                                                      const std::string& name);

/// Copies all logs of map `from`, and the classes of its labels, into file `to`, which is to
/// replace the map. So the work of users survives a build. Throws BadInput for a map that cannot be
/// read.
void carry_event_logs(const std::filesystem::path& from, const std::filesystem::path& to);

/// One problem for each log whose chain is broken.
[[nodiscard]] std::vector<Problem> event_log_problems(const SqlDatabase& database);

}  // namespace roadbook
