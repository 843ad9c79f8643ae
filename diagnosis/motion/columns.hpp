#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// Changes of a drive's rows by one parameter each. Most parameters move one stream only, so a
/// column consists of the channels that it moves.
class Columns {
 public:
  struct Part {
    std::size_t column = 0;
    std::vector<double> values;  ///< over the channel's rows
  };

  [[nodiscard]] std::size_t count() const { return count_; }
  /// Parts of all columns in a channel, in the order of columns.
  [[nodiscard]] const std::vector<Part>& of(Channel channel) const {
    return parts_[index_of(channel)];
  }

  /// One more column that moves nothing yet.
  void add() { ++count_; }
  /// Sets the change of one channel by the last column.
  void set(Channel channel, std::vector<double> values) {
    parts_[index_of(channel)].push_back({count_ - 1, std::move(values)});
  }
  /// All of the others' columns behind these.
  void append(Columns others);

 private:
  std::size_t count_ = 0;
  std::array<std::vector<Part>, kChannels> parts_;
};

}  // namespace roadbook
