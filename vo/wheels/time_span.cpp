#include "vo/wheels/time_span.hpp"

#include <algorithm>

namespace roadbook {
namespace {

void append(std::vector<TimeSpan>& spans, const TimeSpan& span) {
  constexpr std::int64_t kApartNs = 500'000'000;
  if (!spans.empty() && span.first <= spans.back().second + kApartNs)
    spans.back().second = std::max(spans.back().second, span.second);
  else
    spans.push_back(span);
}

}  // namespace

void add_span(std::vector<TimeSpan>& spans, std::int64_t from_ns, std::int64_t to_ns) {
  constexpr std::int64_t kMarginNs = 150'000'000;
  append(spans, {from_ns - kMarginNs, to_ns + kMarginNs});
}

std::vector<TimeSpan> united(std::vector<TimeSpan> a, const std::vector<TimeSpan>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  std::vector<TimeSpan> result;
  for (const TimeSpan& span : a) append(result, span);
  return result;
}

std::vector<TimeSpan> without(std::vector<TimeSpan> spans, const std::vector<TimeSpan>& known) {
  std::erase_if(spans, [&](const TimeSpan& span) {
    return std::any_of(known.begin(), known.end(), [&](const TimeSpan& k) {
      return span.first < k.second && k.first < span.second;
    });
  });
  return spans;
}

}  // namespace roadbook
