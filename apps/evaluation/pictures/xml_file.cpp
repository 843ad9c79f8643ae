#include "apps/evaluation/pictures/xml_file.hpp"

#include <cmath>
#include <cstdlib>

#include "base/error.hpp"

namespace roadbook {

XmlFile::XmlFile(const std::filesystem::path& file)
    : file_(file), root_(CPLParseXMLFile(file.c_str())) {
  if (!root_)
    throw BadInput(Problem{Severity::kError, file.string(), 0, "", "no XML", "annotations"});
}

std::vector<const CPLXMLNode*> XmlFile::children(const std::string& parent,
                                                 const std::string& name) const {
  return children(CPLGetXMLNode(root_.get(), ("=" + parent).c_str()), "", name);
}

std::vector<const CPLXMLNode*> XmlFile::children(const CPLXMLNode* node,
                                                 const std::string& path,
                                                 const std::string& name) const {
  std::vector<const CPLXMLNode*> found;
  if (node != nullptr && !path.empty())
    node = CPLGetXMLNode(const_cast<CPLXMLNode*>(node), path.c_str());
  if (node == nullptr) return found;
  for (const CPLXMLNode* child = node->psChild; child != nullptr; child = child->psNext)
    if (child->eType == CXT_Element && name == child->pszValue) found.push_back(child);
  return found;
}

double XmlFile::number(const CPLXMLNode* node, const std::string& path) const {
  const char* text = CPLGetXMLValue(const_cast<CPLXMLNode*>(node), path.c_str(), nullptr);
  char* end = nullptr;
  const double value = text != nullptr ? std::strtod(text, &end) : 0.0;
  if (text == nullptr || end == text || !std::isfinite(value))
    throw BadInput(Problem{Severity::kError, file_.string(), 0, path,
                           text != nullptr ? text : "nothing", "a number"});
  return value;
}

}  // namespace roadbook
