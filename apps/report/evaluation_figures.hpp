#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace roadbook {

/// A figure of `roadbook evaluate`.
struct EvaluationFigure {
  std::string name;  ///< name of its file
  std::string data_uri;
};

/// Returns the figures (SVG, PNG) in an output folder of `roadbook evaluate`, by name. Throws
/// BadInput if the folder has no figures.
[[nodiscard]] std::vector<EvaluationFigure> evaluation_figures(const std::filesystem::path& folder);

}  // namespace roadbook
