#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace roadbook {

/// A position in path coordinates; e is positive to the left (the paper uses the opposite sign:
/// roadnet/paths/path_sign.hpp).
struct PathPlace {
  double s_m = 0.0;
  double e_m = 0.0;
};

/// Reach of a knot along and across the path: D of the kernel (7), scaled separately.
///
/// It is at least two knot spacings. With less, the gradient of the interpolation oscillates
/// between the knots: at 1.5 spacings the slope of a linear function is 0.47 to 1.60 of the true
/// one, at 2 spacings 0.98 to 1.02.
struct KernelWidth {
  double s_m = 2.0;
  double e_m = 2.0;
};

/// A part of s that is a ring: [begin, begin + length).
struct KnotRing {
  double begin_m = 0.0;
  double length_m = 0.0;
};

/// A regular grid of knots over a path.
struct KnotGridOptions {
  double length_m = 0.0;  ///< of the path
  bool closed = false;
  double e_min_m = -6.0;
  double e_max_m = 6.0;
  double spacing_s_m = 1.0;  ///< made a little smaller so that the knots divide the length evenly
  double spacing_e_m = 1.0;
  KernelWidth width;

  /// Throws InvalidOption, also where the kernel would leave holes between the knots.
  void check() const;
};

/// The knots v_l of a map, with an index that finds those near a position. Its cells are half a
/// kernel width, so that the cost of a query depends on the kernel's support and not on the number
/// of knots L. Immutable.
class Knots {
 public:
  /// `period_m`: length of a closed path, around which s is wrapped. Throws InvalidOption for no
  /// knots, values that are not finite, and a ring shorter than four kernel widths.
  Knots(std::vector<PathPlace> places, const KernelWidth& width, std::optional<double> period_m);
  /// Several paths after each other along s, some of them rings. The gaps between them must be
  /// wider than three kernel widths. Throws InvalidOption, also for rings shorter than four kernel
  /// widths.
  Knots(std::vector<PathPlace> places, const KernelWidth& width, std::vector<KnotRing> rings);

  static Knots grid(const KnotGridOptions& options);

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const std::vector<PathPlace>& places() const { return places_; }
  [[nodiscard]] const KernelWidth& width() const { return width_; }
  [[nodiscard]] const std::optional<double>& period_m() const { return period_m_; }

  /// The ring that contains s (any s if all knots are one ring); null on an open path.
  [[nodiscard]] const KnotRing* ring_at(double s_m) const;

  /// s - s', the shorter way round on a ring.
  [[nodiscard]] double difference_along(double s_m, double other_s_m) const;

  /// Calls visit(knot, x, y, r2) for every knot with r2 = x^2 + y^2 < 1, where (x, y) is v - v_l in
  /// kernel widths. Order depends only on the knots.
  template <typename Visit>
  void for_each_near(const PathPlace& v, const Visit& visit) const {
    if (!(v.e_m > low_e_m_ - width_.e_m && v.e_m < high_e_m_ + width_.e_m)) return;
    if (!(v.s_m - v.s_m == 0.0)) return;  // not finite
    if (const KnotRing* const ring = ring_at(v.s_m)) {
      const double s = wrapped(*ring, v.s_m);
      visit_rows(s, v.e_m, visit);
      if (s < ring->begin_m + width_.s_m) visit_rows(s + ring->length_m, v.e_m, visit);
      if (s > ring->begin_m + ring->length_m - width_.s_m)
        visit_rows(s - ring->length_m, v.e_m, visit);
    } else {
      visit_rows(v.s_m, v.e_m, visit);
    }
  }

 private:
  struct Entry {
    double s_m, e_m;
    std::int32_t knot;
  };
  [[nodiscard]] static double wrapped(const KnotRing& ring, double s_m);
  void check() const;
  void hash();
  [[nodiscard]] std::size_t row_of(double s_m) const;
  [[nodiscard]] std::size_t column_of(double e_m) const;

  template <typename Visit>
  void visit_rows(double s_m, double e_m, const Visit& visit) const {
    if (!(s_m > low_s_m_ - width_.s_m && s_m < high_s_m_ + width_.s_m)) return;
    const std::size_t row_end = row_of(s_m + width_.s_m);
    const std::size_t column_begin = column_of(e_m - width_.e_m);
    const std::size_t column_end = column_of(e_m + width_.e_m);
    const double scale_s = 1.0 / width_.s_m;
    const double scale_e = 1.0 / width_.e_m;
    for (std::size_t row = row_of(s_m - width_.s_m); row <= row_end; ++row) {
      const std::size_t cell = row * columns_;
      const std::size_t end = begin_[cell + column_end + 1];
      for (std::size_t i = begin_[cell + column_begin]; i < end; ++i) {
        const Entry& entry = entries_[i];
        const double x = (s_m - entry.s_m) * scale_s;
        const double y = (e_m - entry.e_m) * scale_e;
        const double r2 = x * x + y * y;
        if (r2 < 1.0) visit(entry.knot, x, y, r2);
      }
    }
  }

  std::vector<PathPlace> places_;
  KernelWidth width_;
  std::optional<double> period_m_;
  std::vector<KnotRing> rings_;  ///< by begin
  double low_s_m_ = 0.0, high_s_m_ = 0.0, low_e_m_ = 0.0, high_e_m_ = 0.0;
  double inverse_cell_s_ = 1.0, inverse_cell_e_ = 1.0;
  std::size_t rows_ = 1, columns_ = 1;
  std::vector<std::uint32_t> begin_;  ///< of each cell in `entries_`, and the end
  std::vector<Entry> entries_;
};

}  // namespace roadbook
