#include "workflows/occupancy/beam_model_file.hpp"

#include <cstdio>

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {

RangeMixture read_beam_model(const std::filesystem::path& file) {
  RangeMixture m = mixture_of({}, 0.02);
  YamlMap yaml = YamlMap::load(file);
  const Range share{0.0, 1.0};
  yaml.read("short", m.share[kShort], share);
  yaml.read("maximum", m.share[kMaximum], share);
  yaml.read("crosstalk", m.share[kCrosstalk], share);
  yaml.read("sigma_m", m.sigma_m, {1e-4, 10.0});
  yaml.read("wide", m.wide, {0.0, 0.5});
  yaml.read("short_rate_per_m", m.short_rate_per_m, {1e-3, 100.0});
  if (m.hit() < 0.0)
    yaml.report("short", "shares with a sum of " + std::to_string(1.0 - m.hit()),
                "a sum of short, maximum and crosstalk up to 1");
  yaml.finish();
  return m;
}

std::string beam_model_text(const RangeMixture& m) {
  char text[400];
  std::snprintf(text, sizeof text,
                "short: %.5f\nmaximum: %.5f\ncrosstalk: %.5f\nsigma_m: %.5f\nwide: %.5f\n"
                "short_rate_per_m: %.4f\n",
                m.share[kShort], m.share[kMaximum], m.share[kCrosstalk], m.sigma_m, m.wide,
                m.short_rate_per_m);
  return text;
}

}  // namespace roadbook
