#include "mapping/layers/parse_utc.hpp"

#include <chrono>

namespace roadbook {
namespace {

// Reads fields of fixed width from the front of a text.
class FixedFields {
 public:
  explicit FixedFields(std::string_view text) : rest_(text) {}

  int number(std::size_t digits) {
    int value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
      if (rest_.empty() || rest_.front() < '0' || rest_.front() > '9') return fail();
      value = 10 * value + (rest_.front() - '0');
      rest_.remove_prefix(1);
    }
    return value;
  }
  void expect(char c) {
    if (!take(c)) fail();
  }
  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  // Digits after a decimal point, as nanoseconds; those beyond the ninth are cut.
  std::int64_t nanoseconds() {
    std::int64_t value = 0;
    std::size_t digits = 0;
    for (; !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; rest_.remove_prefix(1))
      if (digits++ < 9) value = 10 * value + (rest_.front() - '0');
    if (digits == 0) fail();
    for (; digits < 9; ++digits) value *= 10;
    return value;
  }
  int fail() {
    good_ = false;
    return 0;
  }
  [[nodiscard]] bool good_to_the_end() const { return good_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool good_ = true;
};

}  // namespace

std::optional<std::int64_t> parse_utc(std::string_view text) {
  FixedFields fields(text);
  const int year = fields.number(4);
  fields.expect('-');
  const int month = fields.number(2);
  fields.expect('-');
  const int day = fields.number(2);
  if (!fields.take('T') && !fields.take('t')) fields.expect(' ');
  const int hour = fields.number(2);
  fields.expect(':');
  const int minute = fields.number(2);
  fields.expect(':');
  const int second = fields.number(2);
  const std::int64_t fraction_ns = fields.take('.') ? fields.nanoseconds() : 0;
  int zone_minutes = 0;
  if (!fields.take('Z') && !fields.take('z')) {
    const int sign = fields.take('-') ? -1 : 1;
    if (sign > 0) fields.expect('+');
    const int zone_hour = fields.number(2);
    fields.expect(':');
    const int zone_minute = fields.number(2);
    if (zone_hour > 23 || zone_minute > 59) fields.fail();
    zone_minutes = sign * (60 * zone_hour + zone_minute);
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!fields.good_to_the_end() || year < 1970 || year > 2261 || !date.ok() || hour > 23 ||
      minute > 59 || second > 59)
    return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t seconds =
      86400 * days + 3600 * hour + 60 * (std::int64_t{minute} - zone_minutes) + second;
  if (seconds < 0) return std::nullopt;
  return seconds * 1'000'000'000 + fraction_ns;
}

}  // namespace roadbook
