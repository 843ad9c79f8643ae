#pragma once

#include <string_view>
#include <vector>

#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// Injection points: quantities of the sensor models to which the grammar adds functions.

/// Where a term of size 1 moves the rows of some channels.
struct GrammarHook {
  std::string_view name;
  std::string_view unit;
  double tau;
  unsigned streams;
  std::vector<Channel> channels;
  /// Change of a row of the channel by a term f = 1; `dt`: time between wheel readings.
  double (*gain)(Channel, const WheelModel&, const MotionState&, double dt);
  std::string_view like = {};  ///< moves the rows as this effect does, where there is no `gain`
};

[[nodiscard]] const std::vector<GrammarHook>& all_grammar_hooks();
/// Null if the name is no injection point.
[[nodiscard]] const GrammarHook* find_grammar_hook(std::string_view name);
/// The name must be that of a hook.
[[nodiscard]] const GrammarHook& grammar_hook(std::string_view name);
/// Channels that a hook may move; of a named effect, which is a hook, too: all.
[[nodiscard]] std::vector<Channel> grammar_channels(std::string_view name);

}  // namespace roadbook
