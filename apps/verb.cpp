#include "apps/verb.hpp"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "apps/command_line.hpp"
#include "base/files/disk_space.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

constexpr const char* kVersion = ROADBOOK_VERSION;

std::string general_help() {
  std::string text =
      "roadbook turns recorded camera drives into maps that a planner can use.\n\n"
      "usage: roadbook VERB [OPTIONS]\n\n";
  for (const Verb& verb : all_verbs())
    text += "  " + verb.name + std::string(12 - std::min<std::size_t>(verb.name.size(), 11), ' ') +
            verb.summary + "\n";
  return text +
         "\n`roadbook VERB --help` tells the options of a verb. Exit status: 0 done, 1 wrong "
         "usage,\n"
         "2 bad input, 3 disk, permission or lock, 4 result refused, 5 interrupted.\n";
}

InvalidOption unknown_verb(const std::string& word) {
  std::vector<std::string> names;
  for (const Verb& verb : all_verbs()) names.push_back(verb.name);
  std::string want = "a verb of `roadbook --help`";
  if (const auto near = nearest_name(word, names)) want += "; did you mean " + *near + "?";
  return {"verb", "'" + word + "'", want};
}

ExitStatus run_verb(const Verb& verb, const std::vector<std::string>& words) {
  CommonOptions common;
  Options options = options_of(verb, common);
  if (!parse_command_line(verb.name, verb.summary, words, options)) return ExitStatus::kDone;
  if (!common.options_file.empty()) options.read_yaml(common.options_file);
  options.check_required();
  Console console(common.json, common.quiet);
  catch_interrupts();
  return verb.run(console, common);
}

ExitStatus dispatch(const std::vector<std::string>& words) {
  if (words.empty()) throw InvalidOption("verb", "nothing", "a verb of `roadbook --help`");
  if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
    std::cout << general_help();
    return ExitStatus::kDone;
  }
  if (words[0] == "--version") {
    std::cout << "roadbook " << kVersion << '\n';
    return ExitStatus::kDone;
  }
  for (const Verb& verb : all_verbs())
    if (verb.name == words[0])
      return run_verb(verb, std::vector<std::string>(words.begin() + 1, words.end()));
  throw unknown_verb(words[0]);
}

}  // namespace

std::vector<Verb> all_verbs() {
  return {simulate_verb(), check_verb(),    import_verb(),    map_verb(),      calibrate_verb(),
          localise_verb(), compare_verb(),  curate_verb(),    edit_verb(),     overhead_verb(),
          label_verb(),    roads_verb(),    detect_verb(),    friction_verb(), occupancy_verb(),
          layers_verb(),   speeds_verb(),   query_verb(),     diagnose_verb(), export_verb(),
          report_verb(),   evaluate_verb(), completion_verb()};
}

Options options_of(const Verb& verb, CommonOptions& common) {
  Options options;
  verb.declare(options);
  options.add("--json", &common.json, "one JSON object on standard output");
  options.add("--threads", &common.threads, "threads; 0: all cores").range = {0, 1024};
  options.add("--options", &common.options_file, "YAML file with options: `image_scale: 0.5`");
  options.add("--quiet,-q", &common.quiet, "no progress");
  return options;
}

ExitStatus run_roadbook(const std::vector<std::string>& words) {
  try {
    const ExitStatus status = dispatch(words);
    // The error of a full disk or a closed pipe appears only at the flush.
    errno = 0;
    if (!std::cout.flush())
      throw StorageError("error: standard output: got " +
                         write_fault("/dev/stdout", errno == 0 ? EIO : errno));
    return status;
  } catch (const Error& error) {
    print_error(error);
    return error.status();
  } catch (const std::filesystem::filesystem_error& error) {
    print_error(to_line({Severity::kError, error.path1().string(), 0, "",
                         write_fault(error.path1(), error.code().value()),
                         "a file or folder that can be used"}));
    return ExitStatus::kStorage;
  } catch (const std::bad_alloc&) {
    print_error("memory: got none left, want a smaller drive or more memory");
    return ExitStatus::kStorage;
  } catch (const std::exception& error) {
    print_error(std::string("unexpected: ") + error.what());
    return ExitStatus::kRefused;
  }
}

}  // namespace roadbook
