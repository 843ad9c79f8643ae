#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "base/error.hpp"
#include "speedmap/property_map/slice.hpp"

namespace roadbook {
namespace {

bool identifier(const std::string& name) {
  const auto letter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  return !name.empty() && letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0;
         });
}

// Shortest text that reads back as the same double, with a point so that C takes it as one.
std::string literal(double x) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  std::string result(text.data(), end);
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

// Text that may stand in a C comment.
std::string comment(std::string text) {
  replace_all(text, "*/", "* /");
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

constexpr const char* kProgram = R"(
#include <math.h>

/* Mean and variance of @PROPERTY@ [@UNIT@] at path coordinates s, e (e positive to the left).
 * out: mean, variance, d mean/ds, d mean/de, d variance/ds, d variance/de.
 * Returns 1; or 0, with out untouched, outside the slice or where no knot is near. */
static inline int @NAME@_evaluate(double s, double e, double out[6]) {
  const double two_pi = 6.283185307179586476925287;
  const double width_s = @WIDTH_S@, width_e = @WIDTH_E@;
  const double s_begin = @S_BEGIN@, s_end = @S_END@, period = @PERIOD@; /* 0: open path */
  double sum = 0.0, sum_s = 0.0, sum_e = 0.0;
  double mean = 0.0, mean_s = 0.0, mean_e = 0.0;
  double second = 0.0, second_s = 0.0, second_e = 0.0, reference;
  int low = 0, high = @COUNT@, i;
  if (period > 0.0) s -= period * floor((s - s_begin) / period);
  if (!(s >= s_begin && s <= s_end)) return 0;
  while (low < high) { /* first knot with its s above s - width_s */
    const int middle = (low + high) / 2;
    if (@NAME@_knots[middle][0] > s - width_s) high = middle; else low = middle + 1;
  }
  reference = low < @COUNT@ ? @NAME@_knots[low][2] : 0.0; /* sums about it cancel less */
  for (i = low; i < @COUNT@ && @NAME@_knots[i][0] < s + width_s; ++i) {
    const double* const k = @NAME@_knots[i];
    const double x = (s - k[0]) / width_s, y = (e - k[1]) / width_e;
    const double r2 = x * x + y * y;
    if (r2 < 1.0) {
      const double r = sqrt(r2), theta = two_pi * (1.0 - r), c = cos(theta), sn = sin(theta);
      const double t2 = theta * theta;
      const double kernel = theta < 0.5
          ? t2 * t2 * theta / (3.0 * two_pi) * (1.0 / 60.0 - t2 * (1.0 / 1260.0 - t2 * (1.0 / 60480.0 - t2 * (1.0 / 4989600.0 - t2 / 622702080.0))))
          : (theta * (2.0 + c) - 3.0 * sn) / (3.0 * two_pi);
      const double slope = theta < 0.5
          ? -t2 * t2 / 3.0 * (1.0 / 12.0 - t2 * (1.0 / 180.0 - t2 * (1.0 / 6720.0 - t2 * (1.0 / 453600.0 - t2 / 47900160.0))))
          : -(2.0 - 2.0 * c - theta * sn) / 3.0;
      const double per_r = r > 1e-9 ? slope / r : -two_pi * two_pi / 3.0;
      const double gs = per_r * x / width_s, ge = per_r * y / width_e;
      const double m = k[2] - reference, q = k[3] + m * m;
      sum += kernel; sum_s += gs; sum_e += ge;
      mean += kernel * m; mean_s += gs * m; mean_e += ge * m;
      second += kernel * q; second_s += gs * q; second_e += ge * q;
    }
  }
  if (!(sum > 0.0)) return 0;
  mean /= sum; second /= sum;
  mean_s = (mean_s - mean * sum_s) / sum; mean_e = (mean_e - mean * sum_e) / sum;
  second_s = (second_s - second * sum_s) / sum; second_e = (second_e - second * sum_e) / sum;
  out[0] = reference + mean;
  out[1] = second - mean * mean;
  out[2] = mean_s;
  out[3] = mean_e;
  out[4] = second_s - 2.0 * mean * mean_s;
  out[5] = second_e - 2.0 * mean * mean_e;
  return 1;
}
)";

}  // namespace

std::string slice_header(const PropertySlice& slice, const std::string& name) {
  if (!identifier(name)) throw InvalidOption("name", "'" + name + "'", "a C identifier");
  slice.check("");
  std::string guard = name;
  std::transform(guard.begin(), guard.end(), guard.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string text = "/* Slice of a property map: " + comment(slice.property) + " [" +
                     comment(slice.unit) + "], s " + literal(slice.s_begin_m) + " to " +
                     literal(slice.s_end_m) + " m.\n * Map: " + comment(slice.source.map) +
                     "; date " + std::to_string(slice.source.date_ns) + " ns; coverage " +
                     literal(slice.coverage()) + "; version " +
                     std::to_string(PropertySlice::kVersion) + ".\n * Digest: " + slice.digest() +
                     " */\n#ifndef " + guard + "_SLICE_H\n#define " + guard + "_SLICE_H\n\n";
  text += "static const double " + name + "_knots[" + std::to_string(slice.knots.size()) +
          "][4] = { /* s, e, mean, variance */\n";
  for (const SliceKnot& knot : slice.knots)
    text += "  {" + literal(knot.s_m) + ", " + literal(knot.e_m) + ", " + literal(knot.mean) +
            ", " + literal(knot.variance) + "},\n";
  text += "};\n";
  std::string program = kProgram;
  replace_all(program, "@COUNT@", std::to_string(slice.knots.size()));
  replace_all(program, "@WIDTH_S@", literal(slice.width.s_m));
  replace_all(program, "@WIDTH_E@", literal(slice.width.e_m));
  replace_all(program, "@S_BEGIN@", literal(slice.s_begin_m));
  replace_all(program, "@S_END@", literal(slice.s_end_m));
  replace_all(program, "@PERIOD@", literal(slice.period_m.value_or(0.0)));
  replace_all(program, "@UNIT@", comment(slice.unit));
  replace_all(program, "@PROPERTY@", comment(slice.property));
  replace_all(program, "@NAME@", name);
  return text + program + "\n#endif\n";
}

}  // namespace roadbook
