#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

// A part of a property map for a controller [SPM, section 3.5, "externalisation"]: the knots around
// a horizon with their means and variances. It needs neither the map, nor the classes, nor the
// path's geometry, and gives the same numbers as the map.

/// The origin of a slice. A consumer can refuse a slice that is too old or of another map.
struct SliceSource {
  std::string map;           ///< name or digest of the map
  std::int64_t date_ns = 0;  ///< of the newest measurement in it
};

/// One knot of a slice: its mean and variance (not interpolated) and the number of its labels.
struct SliceKnot {
  double s_m = 0.0;
  double e_m = 0.0;
  double mean = 0.0;
  double variance = 0.0;
  double evidence = 0.0;
};

struct PropertySlice {
  static constexpr int kVersion = 1;

  std::string property;
  std::string unit;
  SliceSource source;
  double s_begin_m = 0.0;  ///< the slice equals the map for s in [s_begin, s_end]
  double s_end_m = 0.0;
  KernelWidth width;
  std::optional<double> period_m;  ///< closed path: s is wrapped to [s_begin, s_begin + period)
  std::vector<SliceKnot> knots;  ///< by s, not wrapped: s ascends across the start of a closed path
  std::vector<std::string> classes;
  std::vector<double> shares;  ///< knots x classes: expected class proportions

  /// Share of the knots that have labels.
  [[nodiscard]] double coverage() const;
  /// Digest of everything but the source.
  [[nodiscard]] std::string digest() const;
  /// Throws BadInput: values not finite, variances not positive, order.
  void check(const std::string& file) const;
};

/// Cuts the slice of `map` for s in [s_begin, s_end]. Throws InvalidOption for an empty range, and
/// for one longer than the ring.
[[nodiscard]] PropertySlice make_slice(const PropertyMap& map,
                                       std::size_t property,
                                       double s_begin_m,
                                       double s_end_m,
                                       const SliceSource& source = {});

/// A slice prepared for queries. Immutable; safe to share between threads.
class SliceView {
 public:
  explicit SliceView(const PropertySlice& slice);
  ~SliceView();

  /// Moments at `v`; empty outside [s_begin, s_end] and if no knot is near.
  [[nodiscard]] std::optional<PropertyMoments> moments(const PathPlace& v) const;
  [[nodiscard]] std::optional<PropertyMomentsDerivatives> moments_with_derivatives(
      const PathPlace& v) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// JSON text of a slice; numbers are written so that they read back bit by bit.
[[nodiscard]] std::string slice_json(const PropertySlice& slice);
/// Reads it back. Throws BadInput that names `file`: not JSON, another version, fields missing or
/// of the wrong kind, a digest that does not fit.
[[nodiscard]] PropertySlice parse_slice(const std::string& text, const std::string& file);

/// Returns the text of a header for C99 and C++ that needs only <math.h>. Its function
/// `NAME_evaluate(s, e, out)` sets mean, variance and their derivatives in s and e. Throws
/// InvalidOption for a name that is no identifier.
[[nodiscard]] std::string slice_header(const PropertySlice& slice, const std::string& name);

}  // namespace roadbook
