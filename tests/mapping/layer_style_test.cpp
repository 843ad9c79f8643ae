#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "base/colour_ramp.hpp"
#include "mapping/layers/layer_style_qml.hpp"

namespace roadbook {
namespace {

// High speeds are calm: from the colour of danger to that of calm in equal steps.
TEST(LayerStyle, SpeedsHaveTheWholeRampOfColours) {
  const std::string style = layer_style("speed_profile").value().renderer;
  const std::string symbols = style.substr(style.find("<symbols>"));
  std::vector<std::string> colours;
  const std::regex fill("<Option name=\"color\"[^>]*value=\"([0-9]+,[0-9]+,[0-9]+),");
  for (auto it = std::sregex_iterator(symbols.begin(), symbols.end(), fill);
       it != std::sregex_iterator(); ++it)
    colours.push_back((*it)[1]);
  ASSERT_GT(colours.size(), 2U);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const auto rgb =
        colour_ramp(1.0 - static_cast<double>(i) / static_cast<double>(colours.size() - 1));
    EXPECT_EQ(colours[i],
              std::to_string(rgb[0]) + "," + std::to_string(rgb[1]) + "," + std::to_string(rgb[2]));
  }
}

}  // namespace
}  // namespace roadbook
