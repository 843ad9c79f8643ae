#pragma once

#include <vector>

#include "speedmap/property_map/class_refresh.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

// A property map that is updated while driving: the updates of `PropertyMap`, and at intervals a
// batch refresh of the classes from the stored measurements (class_refresh.hpp).

struct RefreshOptions {
  bool enabled = true;
  ClassRefreshOptions classes;
  /// Early classes change fast and are refreshed often.
  double early_until_m = 100.0;
  double early_every_m = 10.0;
  double every_m = 50.0;
  /// A wrong class makes measurements improbable. A refresh is due when the mean log evidence of
  /// the last `drop_values` measurements is this much [nat] below the best such mean since the last
  /// refresh. 0: off.
  double drop_nat = 1.0;
  int drop_values = 40;
  /// Oldest measurements are dropped beyond this many: bounds memory and time of a refresh.
  std::size_t log_size = 20000;

  /// Throws InvalidOption.
  void check() const;
};

class PropertyMapper {
 public:
  /// Throws InvalidOption.
  PropertyMapper(PropertyMap map, RefreshOptions options = {});

  [[nodiscard]] PropertyMap& map() { return map_; }
  [[nodiscard]] const PropertyMap& map() const { return map_; }

  /// As PropertyMap::add_value; also stores the measurement for refreshes.
  PropertyUpdateResult add_value(std::size_t property,
                                 const PathPlace& v,
                                 double y,
                                 double sigma = 0.0);

  /// Call with the total distance driven [m]: refreshes the classes if a refresh is due. Returns
  /// whether it did.
  bool travelled(double distance_m);
  /// Refreshes the classes of every property now, from the class weights that the map has now.
  void refresh();
  [[nodiscard]] int refreshes() const { return refreshes_; }

 private:
  struct Entry {
    PathPlace v;
    double y;
    double sigma;
  };
  struct Log {
    std::vector<Entry> entries;
    double recent = 0.0;  ///< sum of log evidence of the window at work
    int recent_count = 0;
    double best = 0.0;  ///< best mean of a window since the last refresh
    bool has_best = false;
  };
  void watch(Log& log, double log_evidence);
  void refresh(std::size_t property);

  PropertyMap map_;
  RefreshOptions options_;
  std::vector<Log> logs_;
  double next_m_ = 0.0;
  bool due_ = false;
  int refreshes_ = 0;
};

}  // namespace roadbook
