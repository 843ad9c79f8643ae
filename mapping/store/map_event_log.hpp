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
  /// Stores an event; its number. StorageError leaves the log as it was.
  std::int64_t append(const std::string& content) { return append(std::vector{content}); }
  /// Stores events together, all or none; the number of the first. What waits for the disk is the
  /// transaction, so that many events cost about what one does. `table`, if any, replaces a plain
  /// table in the same transaction.
  std::int64_t append(const std::vector<std::string>& contents, const PlainTable* table = nullptr);
  /// Replaces a plain table of the map (see MapUpdate::write_table) in place.
  void write_table(const PlainTable& table);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Contents of all events of a finished map's log, in order; none where it has no such log. Throws
/// BadInput where the chain is broken.
[[nodiscard]] std::vector<std::string> read_event_log(const std::filesystem::path& map,
                                                      const std::string& name);

/// Copies all logs of a map, and the classes of its labels, into a file that is to take its place:
/// what people did by hand outlives a build. Throws BadInput for a map that cannot be read.
void carry_event_logs(const std::filesystem::path& from, const std::filesystem::path& to);

/// One problem for each log whose chain is broken.
[[nodiscard]] std::vector<Problem> event_log_problems(const SqlDatabase& database);

}  // namespace roadbook
