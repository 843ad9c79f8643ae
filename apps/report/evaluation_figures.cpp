#include "apps/report/evaluation_figures.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "apps/report/html.hpp"
#include "base/error.hpp"

namespace roadbook {

std::vector<EvaluationFigure> evaluation_figures(const std::filesystem::path& folder) {
  std::vector<EvaluationFigure> figures;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string extension = entry.path().extension().string();
    if ((extension != ".svg" && extension != ".png") || !entry.is_regular_file(none)) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(in), {}};
    figures.push_back({entry.path().filename().string(),
                       data_uri(extension == ".svg" ? "image/svg+xml" : "image/png", bytes)});
  }
  if (figures.empty())
    throw BadInput(Problem{Severity::kError, folder.string(), 0, "--evaluation", "no figure",
                           "a folder that `roadbook evaluate` wrote"});
  std::sort(figures.begin(), figures.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return figures;
}

}  // namespace roadbook
