#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "diagnosis/inference/innovations.hpp"

namespace roadbook {

// The rows of several drives as those of one.

/// Right-hand sides of the drives that belong together, one a drive; -1 if a drive lacks it.
using SharedSide = std::vector<long>;

/// Sides of all drives together: residual, accepted columns, columns of candidates.
class SharedSides {
 public:
  /// `accepted`: of all causes together; each drive's are set with `set_accepted`.
  SharedSides(std::size_t drives, std::size_t accepted);
  /// Size `which` of all is the `own`-th accepted one of a drive.
  void set_accepted(std::size_t drive, std::size_t which, std::size_t own);
  /// Number of a column (counted after the residual); the same for the same sides.
  std::size_t column(const SharedSide& side);
  [[nodiscard]] const std::vector<SharedSide>& all() const { return sides_; }

 private:
  std::vector<SharedSide> sides_;
  std::map<SharedSide, std::size_t> known_;
};

/// Rows one drive behind the other, some seconds apart in time; channel c of drive d becomes d *
/// `channels` + c.
[[nodiscard]] Innovations joined_rows(const std::vector<const Innovations*>& drives,
                                      const std::vector<SharedSide>& sides,
                                      std::size_t channels);

}  // namespace roadbook
