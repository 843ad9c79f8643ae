#pragma once

#include <cpl_minixml.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace roadbook {

/// A small XML file of annotations, which GDAL reads completely.
class XmlFile {
 public:
  /// Throws BadInput.
  explicit XmlFile(const std::filesystem::path& file);

  /// Returns the elements `name` of the top-level element `parent`, in the order of the file.
  [[nodiscard]] std::vector<const CPLXMLNode*> children(const std::string& parent,
                                                        const std::string& name) const;
  /// Returns the elements `name` under `path` (a.b.c) of `node`.
  [[nodiscard]] std::vector<const CPLXMLNode*> children(const CPLXMLNode* node,
                                                        const std::string& path,
                                                        const std::string& name) const;
  /// Returns the number at `path` (a.b.c: elements, the last may be an attribute). Throws BadInput.
  [[nodiscard]] double number(const CPLXMLNode* node, const std::string& path) const;

 private:
  struct Destroy {
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
  };
  std::filesystem::path file_;
  std::unique_ptr<CPLXMLNode, Destroy> root_;
};

}  // namespace roadbook
