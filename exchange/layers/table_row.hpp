#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {

/// One row of a layer or table. Reads values by name and checks their types.
class TableRow {
 public:
  /// All must outlive the row. `want`: the expected content of the table, for messages.
  TableRow(std::string file,
           std::string table,
           const std::vector<Field>& fields,
           const std::vector<FieldValue>& values,
           std::string want)
      : file_(std::move(file)),
        table_(std::move(table)),
        fields_(fields),
        values_(values),
        want_(std::move(want)) {}

  /// The value of column `name`. Throws BadInput if it has another type or is missing.
  template <typename T>
  [[nodiscard]] const T& get(const std::string& name) const {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (fields_[i].name == name && std::holds_alternative<T>(values_[i]))
        return std::get<T>(values_[i]);
    fail(name, "no value of its type");
  }
  /// Whether the table has a column of this name.
  [[nodiscard]] bool has(const std::string& name) const {
    for (const Field& field : fields_)
      if (field.name == name) return true;
    return false;
  }
  /// A number, or `otherwise` if it is null.
  [[nodiscard]] double number(const std::string& name, double otherwise) const {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (fields_[i].name == name && std::holds_alternative<double>(values_[i]))
        return std::get<double>(values_[i]);
    return otherwise;
  }
  /// An id of 64 bits without sign, which is stored as text. Throws BadInput.
  [[nodiscard]] std::uint64_t id(const std::string& name) const {
    const auto& text = get<std::string>(name);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) fail(name, text);
    return number;
  }
  [[noreturn]] void fail(const std::string& name, const std::string& got) const {
    throw BadInput(Problem{Severity::kError, file_, 0, table_ + "." + name, got, want_});
  }

 private:
  std::string file_;
  std::string table_;
  const std::vector<Field>& fields_;
  const std::vector<FieldValue>& values_;
  std::string want_;
};

/// A number as a field; null if it is not finite.
[[nodiscard]] inline FieldValue finite_or_null(double value) {
  return value - value == 0.0 ? FieldValue(value) : FieldValue{};
}

}  // namespace roadbook
