#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/motion/motion_fit.hpp"

namespace roadbook {

// The grammar: every hook times every covariate, as a smooth function of a few terms.

/// A row as a covariate sees it.
struct GrammarMoment {
  MotionState state;
  double t_s = 0.0;
  double left_phase = 0.0;
  double right_phase = 0.0;
};

struct GrammarTerm {
  std::string hook;
  std::string covariate;
};

/// "wheels0.scale", "steering0.angle", "poses.across", ... that the drive has streams for.
[[nodiscard]] std::vector<std::string> grammar_hooks(const Observations& obs);
/// Speeds that scatter by less than this share of their mean tell of nothing that depends on speed.
inline constexpr double kLeastSpeedChange = 0.03;

/// "constant", "speed", "yaw rate", ...; columns of the log (`Observations::columns`) join them.
[[nodiscard]] std::vector<std::string> grammar_covariates(std::string_view hook);
/// Typical size of a term at the hook, in the hook's unit, for a covariate of unit variance.
[[nodiscard]] double grammar_tau(std::string_view hook);
[[nodiscard]] std::string_view grammar_unit(std::string_view hook);
/// The named effect that a constant at the hook is; empty where none is.
[[nodiscard]] std::string_view grammar_constant(std::string_view hook);

/// The grammar's own names of covariates, which no column of a log may have.
[[nodiscard]] bool is_grammar_covariate(std::string_view name);

/// Builds the columns of the grammar's terms at one point; what several terms share is computed
/// once.
class Grammar {
 public:
  Grammar(const Observations& obs, const MotionPoint& smooth_point);

  /// Changes of all rows by the terms of hook x covariate, covariates scaled to unit variance; 0
  /// where the covariate is constant on this drive. The name of an effect is a hook, too: what
  /// moves rows as the effect does.
  [[nodiscard]] Columns columns(const GrammarTerm& term);

  using Terms = std::vector<std::vector<double>>;  ///< each over the rows of a channel
  /// The functions of a covariate that `columns` multiplies with the hook, at a channel's rows.
  const Terms& terms(const std::string& covariate, Channel channel);
  /// The channel's rows as covariates see them.
  const std::vector<GrammarMoment>& moments(Channel channel);

 private:
  const std::vector<double>& gains(const std::string& hook, Channel channel);

  const Observations& obs_;
  const MotionPoint& point_;
  // Of the first channel of a stream: its channels are read at the same moments.
  std::array<std::vector<GrammarMoment>, kChannels> moments_;
  std::map<std::pair<std::string, Channel>, Terms> terms_;
  std::map<std::pair<std::string, Channel>, std::vector<double>> gains_;
};

}  // namespace roadbook
