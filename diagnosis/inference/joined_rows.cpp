#include "diagnosis/inference/joined_rows.hpp"

#include <algorithm>

namespace roadbook {

SharedSides::SharedSides(std::size_t drives, std::size_t accepted)
    : sides_(1 + accepted, SharedSide(drives, -1)) {
  sides_[0] = SharedSide(drives, 0);
}

void SharedSides::set_accepted(std::size_t drive, std::size_t which, std::size_t own) {
  sides_[1 + which][drive] = static_cast<long>(1 + own);
}

std::size_t SharedSides::column(const SharedSide& side) {
  const auto [at, fresh] = known_.try_emplace(side, sides_.size() - 1);
  if (fresh) sides_.push_back(side);
  return at->second;
}

Innovations joined_rows(const std::vector<const Innovations*>& drives,
                        const std::vector<SharedSide>& sides,
                        std::size_t channels) {
  constexpr double kApart = 5.0;  // [s]
  Innovations all;
  all.sides = sides.size();
  std::size_t first_row = 0;
  double end_s = 0.0;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    const Innovations& in = *drives[d];
    double from = in.of.empty() ? 0.0 : in.of.front().t_s;
    for (const Innovation& row : in.of) from = std::min(from, row.t_s);
    const double shift = end_s + kApart - from;
    std::size_t rows = 0;
    for (std::size_t i = 0; i < in.of.size(); ++i) {
      Innovation row = in.of[i];
      rows = std::max(rows, row.row + 1);
      row.row += first_row;
      row.channel += d * channels;
      row.t_s += shift;
      row.drive = d;
      end_s = std::max(end_s, row.t_s);
      all.of.push_back(row);
      for (const SharedSide& side : sides)
        all.values.push_back(side[d] < 0 ? 0.0 : in.row(i)[static_cast<std::size_t>(side[d])]);
    }
    first_row += rows;
  }
  return all;
}

}  // namespace roadbook
