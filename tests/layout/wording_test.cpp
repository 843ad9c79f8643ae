#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// Counts phrases that engineers who read English as a second language stumble over, in comments and
// in documents. Comments of Ceres, OpenGV and OpenCV hold 0.1 to 0.5 of these per 1,000 words. The
// rate is a smoke alarm: a text below it can still be hard to read.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

const fs::path kSourceRoot = ROADBOOK_SOURCE_DIR;
constexpr double kMostOverAll = 3.0;  // per 1,000 words
constexpr double kMostInAFolder = 5.0;
constexpr std::size_t kFewestWords = 400;  // a folder with fewer is counted with the others only

const std::vector<std::string> kMarkers = {
    "of which",  "beside",     "besides",      "is told",      "are told",      "tells",
    "told",      "stands",     "stand for",    "hangs on",     "hang on",       "whom",
    "somebody",  "nobody",     "goes on",      "go on",        "so many",       "so much",
    "at hand",   "wants",      "alike",        "is none",      "are none",      "lest",
    "to such",   "thereby",    "wherein",      "whereof",      "of old",        "of today",
    "put right", "takes for",  "taken for",    "takes back",   "taken back",    "looked at",
    "left over", "of its own", "of their own", "for all that", "all of it",     "what they",
    "what it",   "what is",    "what the",     "has none",     "as it is",      "as it stands",
    "come of",   "comes of",   "gone",         "say of",       "says of",       "says so",
    "in vain",   "another's",  "by chance",    "plainly",      "plainest",      "whoever",
    "once more", "anew",       "errs",         "such as are",  "for themselves"};

std::string text_in(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Comments of C++ and TypeScript, without strings.
std::string comments_in(const std::string& code) {
  std::string comments;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] == '"') {
      for (++i; i < code.size() && code[i] != '"' && code[i] != '\n'; ++i)
        if (code[i] == '\\') ++i;
    } else if (code.compare(i, 2, "//") == 0) {
      const std::size_t end = std::min(code.find('\n', i), code.size());
      comments += code.substr(i + 2, end - i - 2) + '\n';
      i = end;
    } else if (code.compare(i, 2, "/*") == 0) {
      const std::size_t end = std::min(code.find("*/", i), code.size());
      comments += code.substr(i + 2, end - i - 2) + '\n';
      i = end + 1;
    }
  }
  return comments;
}

// Lower-case words outside of code: blocks between ``` and names between ` are not read.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  bool in_block = false, in_name = false;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (text.compare(i, 3, "```") == 0) {
      in_block = !in_block;
      i += 2;
      continue;
    }
    const char c = i < text.size() ? text[i] : ' ';
    if (!in_block && c == '`') in_name = !in_name;
    if (c == '\n' && i + 1 < text.size() && text[i + 1] == '\n') in_name = false;
    const bool in_word = std::isalpha(static_cast<unsigned char>(c)) != 0 ||
                         (!word.empty() && (c == '\'' || c == '-'));
    if (in_word && !in_block && !in_name) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  return words;
}

// Markers found, each as often as it occurs; the longest that fits counts.
std::vector<std::string> markers_in(const std::vector<std::string>& words) {
  static const std::set<std::string> known(kMarkers.begin(), kMarkers.end());
  std::vector<std::string> found;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string phrase, longest;
    for (std::size_t k = 0; k < 3 && i + k < words.size(); ++k) {
      phrase += (k > 0 ? " " : "") + words[i + k];
      if (known.contains(phrase)) longest = phrase;
    }
    if (longest.empty()) continue;
    i += static_cast<std::size_t>(std::count(longest.begin(), longest.end(), ' '));
    found.push_back(std::move(longest));
  }
  return found;
}

struct Wording {
  std::size_t words = 0;
  std::map<std::string, std::size_t> markers;

  [[nodiscard]] std::size_t marker_count() const {
    std::size_t count = 0;
    for (const auto& [marker, times] : markers) count += times;
    return count;
  }
  [[nodiscard]] double rate() const {
    return words == 0 ? 0.0
                      : 1000.0 * static_cast<double>(marker_count()) / static_cast<double>(words);
  }
  void add(const std::string& text) {
    const std::vector<std::string> all = words_of(text);
    words += all.size();
    for (const std::string& marker : markers_in(all)) ++markers[marker];
  }
};

// Sources and pages, by folder.
std::map<std::string, Wording> wording_by_folder() {
  static const std::set<std::string> code = {".cpp", ".hpp", ".ts", ".mjs"};
  static const std::set<std::string> left_out = {"build", "out", "node_modules", ".git"};
  std::map<std::string, Wording> folders;
  for (fs::recursive_directory_iterator it(kSourceRoot), end; it != end; ++it) {
    const fs::path file = it->path();
    if (it->is_directory() && left_out.contains(file.filename().string()))
      it.disable_recursion_pending();
    if (!it->is_regular_file()) continue;
    const fs::path name = file.lexically_relative(kSourceRoot);
    if (file.extension() == ".md")
      folders[name.parent_path().string()].add(text_in(file));
    else if (code.contains(file.extension().string()) &&
             file.filename() != "wording_test.cpp")  // it names them all
      folders[name.parent_path().string()].add(comments_in(text_in(file)));
  }
  return folders;
}

TEST(Wording, CountsPhrasesOfComments) {
  EXPECT_EQ(comments_in("int a; // one\nf(\"// no\"); /* two */"), " one\n two \n");
  EXPECT_EQ(words_of("It's `what is` so.\n```\ncode\n```\nEnd"),
            (std::vector<std::string>{"it's", "so", "end"}));
  EXPECT_EQ(markers_in(words_of("What is left, as it stands; nobody.")),
            (std::vector<std::string>{"what is", "as it stands", "nobody"}));
}

TEST(Wording, CommentsAndDocumentsAvoidDialect) {
  Wording all;
  for (const auto& [folder, wording] : wording_by_folder()) {
    all.words += wording.words;
    for (const auto& [marker, times] : wording.markers) all.markers[marker] += times;
    std::string list;
    for (const auto& [marker, times] : wording.markers)
      list += " \"" + marker + "\" " + std::to_string(times);
    if (wording.words >= kFewestWords) {
      EXPECT_LE(wording.rate(), kMostInAFolder) << folder << ":" << list;
    }
  }
  EXPECT_GT(all.words, 50'000u);
  EXPECT_LE(all.rate(), kMostOverAll);
}

}  // namespace
}  // namespace roadbook
