#include "diagnosis/motion/columns.hpp"

namespace roadbook {

void Columns::append(Columns others) {
  for (std::size_t c = 0; c < kChannels; ++c)
    for (Part& part : others.parts_[c])
      parts_[c].push_back({count_ + part.column, std::move(part.values)});
  count_ += others.count_;
}

}  // namespace roadbook
