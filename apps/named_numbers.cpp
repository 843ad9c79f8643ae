#include "apps/named_numbers.hpp"

#include "base/error.hpp"
#include "base/text.hpp"

namespace roadbook {

std::map<std::string, double> named_numbers(const std::string& option,
                                            const std::vector<std::string>& texts,
                                            const std::string& want) {
  std::map<std::string, double> numbers;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const auto number =
        equals == std::string::npos ? std::nullopt : parse_double(text.substr(equals + 1));
    if (!number) throw InvalidOption(option, "'" + text + "'", want);
    numbers[text.substr(0, equals)] = *number;
  }
  return numbers;
}

}  // namespace roadbook
