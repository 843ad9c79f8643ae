#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "base/text_file.hpp"
#include "exchange/import/json_fields.hpp"

namespace roadbook {
namespace {

using FileJson = nlohmann::json;

constexpr std::size_t kDeepest = 64;  // levels: recursion over what was read stays small

// Builds the value while the parser runs, and knows at each moment the path of the value to come.
class JsonBuilder : public nlohmann::json_sax<FileJson> {
 public:
  explicit JsonBuilder(const std::string& bytes) : bytes_(bytes) {}

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(std::int64_t value) override { return put(value); }
  bool number_unsigned(std::uint64_t value) override { return put(value); }
  bool number_float(double value, const std::string&) override { return put(value); }
  bool string(std::string& value) override { return put(std::move(value)); }
  bool binary(FileJson::binary_t&) override { return false; }  // no text has any
  bool start_object(std::size_t) override { return open(FileJson::object()); }
  bool start_array(std::size_t) override { return open(FileJson::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    const bool twice = open_.back()->contains(name);
    keys_.back() = name;
    if (twice) fault_ = {"a key that stands twice in its object", "each key once"};
    return !twice;
  }

  bool parse_error(std::size_t position,
                   const std::string&,
                   const nlohmann::detail::exception& fault) override {
    constexpr int kNumberOverflow = 406;
    line_ = line_of(position);
    if (fault.id == kNumberOverflow)
      fault_ = {"a number that is too large", "numbers up to 1.8e308"};
    else if (std::string_view(fault.what()).find("UTF-8") != std::string_view::npos)
      fault_ = {"bytes that are no UTF-8", "JSON in UTF-8"};
    else
      fault_ = fault_at(position);
    return false;
  }

  FileJson take() { return std::move(root_); }
  [[nodiscard]] Problem problem(const std::string& file) const {
    const std::string path = path_of_next();
    return {Severity::kError, file, line_, path.empty() ? "text" : path, fault_.got, fault_.want};
  }

 private:
  struct Fault {
    std::string got;
    std::string want;
  };

  FileJson* add(FileJson value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    FileJson& parent = *open_.back();
    if (parent.is_object()) return &(parent[keys_.back()] = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }
  bool put(FileJson value) {
    add(std::move(value));
    if (!open_.empty() && open_.back()->is_object()) keys_.back().clear();
    return true;
  }
  bool open(FileJson value) {
    if (open_.size() >= kDeepest) {
      fault_ = {"more than 64 levels", "lists and objects within each other up to 64 deep"};
      return false;
    }
    open_.push_back(add(std::move(value)));
    keys_.emplace_back();
    return true;
  }
  bool close() {
    open_.pop_back();
    keys_.pop_back();
    if (!open_.empty() && open_.back()->is_object()) keys_.back().clear();
    return true;
  }

  [[nodiscard]] std::string path_of_next() const {
    std::string path;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const bool innermost = i + 1 == open_.size();
      if (open_[i]->is_array()) {
        const std::size_t next = open_[i]->size() - (innermost ? 0 : 1);
        path += "[" + std::to_string(next) + "]";
      } else if (!keys_[i].empty()) {
        path += (path.empty() ? "" : ".") + keys_[i];
      }
    }
    return path;
  }

  [[nodiscard]] std::int64_t line_of(std::size_t position) const {
    const auto end =
        bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(position, bytes_.size()));
    return 1 + std::count(bytes_.begin(), end, '\n');
  }

  // The word that holds the last byte read, as far as it goes.
  [[nodiscard]] std::string word_at(std::size_t position) const {
    const auto in_word = [&](std::size_t i) {
      const auto c = static_cast<unsigned char>(bytes_[i]);
      return std::isalnum(c) != 0 || c == '-' || c == '+' || c == '_';
    };
    std::size_t begin = std::min(position, bytes_.size());
    while (begin > 0 && in_word(begin - 1)) --begin;
    std::size_t end = begin;
    while (end < bytes_.size() && in_word(end)) ++end;
    return bytes_.substr(begin, end - begin);
  }

  [[nodiscard]] Fault fault_at(std::size_t position) const {
    constexpr std::string_view kBlanks = " \t\r\n";
    constexpr std::array<std::string_view, 8> kNotFinite{"NaN", "-NaN", "nan",  "Infinity",
                                                         "inf", "Inf",  "-inf", "-Infinity"};
    const std::string word = word_at(position);
    if (std::find(kNotFinite.begin(), kNotFinite.end(), word) != kNotFinite.end())
      return {word, "a number or null (JSON has no " + word + ")"};
    if (word == "None" || word == "True" || word == "False")
      return {word + " as Python writes it", "null, true or false"};
    const std::size_t last = bytes_.find_last_not_of(kBlanks);
    if (last == std::string::npos) return {"nothing", "JSON"};
    if (position > last + 1) return {"the end of the file", "the rest of it (is it cut off?)"};
    const std::size_t at = position > 0 ? position - 1 : 0;
    const std::size_t before =
        at > 0 ? bytes_.find_last_not_of(kBlanks, at - 1) : std::string::npos;
    if ((bytes_[at] == ']' || bytes_[at] == '}') && before != std::string::npos &&
        bytes_[before] == ',')
      return {std::string("a comma before '") + bytes_[at] + "'", "none after the last value"};
    return {"no JSON", "JSON"};
  }

  const std::string& bytes_;
  FileJson root_;
  std::vector<FileJson*> open_;
  std::vector<std::string> keys_;
  std::int64_t line_ = 0;
  Fault fault_{"no JSON", "JSON"};
};

bool is_utf16(std::string_view bytes) {
  if (bytes.size() < 2) return false;
  return bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF") || bytes[0] == '\0' ||
         bytes[1] == '\0';
}

}  // namespace

nlohmann::json read_json_file(const std::filesystem::path& file, const std::string& content) {
  const auto refuse = [&](const char* got, const std::string& want) {
    throw BadInput({Severity::kError, file.string(), 0, "", got, want});
  };
  if (!std::filesystem::exists(file)) refuse("no such file", content);
  const std::string bytes = read_regular_file(file, "a JSON file of " + content);
  if (is_utf16(bytes)) refuse("UTF-16 text", "JSON in UTF-8");
  JsonBuilder builder(bytes);
  if (!nlohmann::json::sax_parse(bytes, &builder)) throw BadInput(builder.problem(file.string()));
  return builder.take();
}

}  // namespace roadbook
