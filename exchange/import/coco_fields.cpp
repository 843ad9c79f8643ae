#include "exchange/import/coco_fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace roadbook {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <class Names>
bool has_name(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), lower_case(name)) != names.end();
}

}  // namespace

std::string_view meaning_of_coco_flag(const std::string& name) {
  constexpr std::array kGroup{"iscrowd",  "is_crowd",  "crowd",       "isgroup",
                              "is_group", "isgroupof", "is_group_of", "group_of"};
  constexpr std::array kIgnored{"ignore", "ignored"};
  constexpr std::array kOutside{"outside"};
  if (has_name(kGroup, name)) return "0: a group is no single thing";
  if (has_name(kIgnored, name)) return "0: it is to be ignored";
  if (has_name(kOutside, name)) return "0: it is not in this image";
  return {};
}

bool may_turn_coco_box(const std::string& name) {
  constexpr std::array kNames{"rotation",     "rotation_deg", "rotation_rad", "bbox_rotation",
                              "rotate",       "rot",          "angle",        "theta",
                              "orientation",  "yaw",          "rbox",         "rbbox",
                              "rotated_bbox", "obb"};
  return has_name(kNames, name);
}

}  // namespace roadbook
