#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/yaml.hpp"

namespace roadbook {

// The options of a verb. One declaration serves the command line, `--options FILE.yaml`, `--help`
// and the shell completion.
//
// An option named `--image-scale` has the YAML key `image_scale`. The command line overrides the
// file. The same strict functions convert the values of both.

/// The variable that receives a value. A list receives all given values.
using OptionTarget = std::variant<bool*,
                                  int*,
                                  std::uint64_t*,
                                  double*,
                                  std::string*,
                                  std::filesystem::path*,
                                  std::optional<double>*,
                                  std::vector<std::string>*,
                                  std::vector<std::filesystem::path>*>;

struct Option {
  std::string name;        ///< "--map", or "DRIVE" for a positional argument
  std::string short_name;  ///< "-m", or empty
  std::string help;
  OptionTarget target;
  bool required = false;
  Range range;                       ///< of numbers
  std::vector<std::string> choices;  ///< of strings; empty: any
  bool given = false;                ///< on the command line or in the file

  [[nodiscard]] bool positional() const { return name.front() != '-'; }
  [[nodiscard]] bool is_flag() const { return std::holds_alternative<bool*>(target); }
  [[nodiscard]] bool is_list() const;
  [[nodiscard]] bool is_file() const;
  /// Placeholder of the value in the help: "FILE", "NUMBER", ...
  [[nodiscard]] std::string value_name() const;
  /// Returns the key in an options file: `image_scale`.
  [[nodiscard]] std::string key() const;
};

class Options {
 public:
  /// Adds an option. `names`: "--map,-m", "--seed" or "DRIVE". The value of the target is the
  /// default. The reference stays valid until the next `add`.
  Option& add(const std::string& names, OptionTarget target, std::string help);

  [[nodiscard]] std::vector<Option>& all() { return options_; }
  [[nodiscard]] const std::vector<Option>& all() const { return options_; }
  [[nodiscard]] const Option* find(const std::string& name) const;
  [[nodiscard]] bool given(const std::string& name) const;
  /// Returns the long and short names of the options, for messages and completion.
  [[nodiscard]] std::vector<std::string> names() const;

  /// Reads the values of options that were not given so far. Throws BadInput with all errors of the
  /// file.
  void read_yaml(const std::filesystem::path& file);
  /// Throws InvalidOption for a required option that is still missing.
  void check_required() const;

 private:
  std::vector<Option> options_;
};

/// Converts and stores the texts given for `option`. Throws InvalidOption with the name of the
/// option, the given value and the expected value (and the nearest choice).
void set_option(Option& option, const std::vector<std::string>& texts);

}  // namespace roadbook
