#pragma once
// What a Markov decision process is, stated once, and the plain solvers of eq. 1 of Matignon et al. 2012:
//   V*(s) = max_a ( R(s,a) + gamma(s,a) sum_s' T(s,a,s') V*(s') ).
// Solvers are callables; their public fields are their settings. Faster ones for grids are in grid_values.hpp.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace outrider::decision {

using State = std::uint32_t;

/// States are 0 to states() - 1. A state without actions is absorbing: its value is terminal(s). The discount may
/// differ between actions, so that one which takes longer is discounted more (a semi-Markov process).
template <class M>
concept MarkovDecisionProcess = requires(const M& m, State s, int a, void (*visit)(State, double)) {
  { m.states() } -> std::convertible_to<std::size_t>;
  { m.actions(s) } -> std::convertible_to<int>;
  { m.terminal(s) } -> std::convertible_to<double>;
  { m.reward(s, a) } -> std::convertible_to<double>;    ///< R(s,a)
  { m.discount(s, a) } -> std::convertible_to<double>;  ///< gamma, in [0, 1]
  m.outcomes(s, a, visit);                              ///< visit(s', T(s,a,s')); probabilities add up to 1
};

inline constexpr int kNoAction = -1;

struct Solution {
  std::vector<double> values;  ///< V(s)
  std::vector<int> policy;     ///< the best action, the first of equals; kNoAction in absorbing states
  double residual = 0.0;       ///< the largest change in the last sweep
  double bound = 0.0;          ///< |V - V*| is at most this; infinite for an undiscounted process
  int sweeps = 0;
  bool converged = false;
};

/// Q(s,a) under `values`.
template <MarkovDecisionProcess M>
double action_value(const M& model, State s, int a, const std::vector<double>& values) {
  double expected = 0.0;
  model.outcomes(s, a, [&](State next, double p) { expected += p * values[next]; });
  return model.reward(s, a) + model.discount(s, a) * expected;
}

/// max_a Q(s,a) and its action.
template <MarkovDecisionProcess M>
std::pair<double, int> best_action(const M& model, State s, const std::vector<double>& values) {
  std::pair<double, int> best{model.terminal(s), kNoAction};
  for (int a = 0; a < model.actions(s); ++a)
    if (const double q = action_value(model, s, a, values); a == 0 || q > best.first) best = {q, a};
  return best;
}

template <MarkovDecisionProcess M>
double largest_discount(const M& model) {
  double largest = 0.0;
  for (State s = 0; s < model.states(); ++s)
    for (int a = 0; a < model.actions(s); ++a) largest = std::max(largest, static_cast<double>(model.discount(s, a)));
  return largest;
}

/// Value iteration (Bellman 1957). Each sweep backs up every state once: from the values of the sweep before (Jacobi),
/// or from those at hand, in a given order (Gauss-Seidel). Stops when no value changes by more than `tolerance`.
struct ValueIteration {
  double tolerance = 1e-9;
  int most_sweeps = 100000;
  bool in_place = false;            ///< Gauss-Seidel
  std::span<const State> order{};   ///< of a Gauss-Seidel sweep; states that it does not name are not backed up

  /// `start` is V_0; empty: zero.
  template <MarkovDecisionProcess M>
  Solution operator()(const M& model, std::vector<double> start = {}) const {
    const std::size_t n = model.states();
    Solution solution;
    solution.values = std::move(start);
    solution.values.resize(n, 0.0);
    solution.policy.assign(n, kNoAction);
    std::vector<double> before;
    while (!solution.converged && solution.sweeps < most_sweeps) {
      if (!in_place) before = solution.values;
      const std::vector<double>& from = in_place ? solution.values : before;
      solution.residual = 0.0;
      const std::size_t count = in_place && !order.empty() ? order.size() : n;
      for (std::size_t k = 0; k < count; ++k) {
        const State s = in_place && !order.empty() ? order[k] : static_cast<State>(k);
        const auto [value, action] = best_action(model, s, from);
        solution.residual = std::max(solution.residual, std::abs(value - solution.values[s]));
        solution.values[s] = value;
        solution.policy[s] = action;
      }
      ++solution.sweeps;
      solution.converged = solution.residual <= tolerance;
    }
    const double gamma = largest_discount(model);
    solution.bound = solution.residual == 0.0 ? 0.0
                     : gamma < 1.0            ? solution.residual * gamma / (1.0 - gamma)
                                              : std::numeric_limits<double>::infinity();
    return solution;
  }
};

/// A process given by lists: small joint problems, topological maps, tests.
struct GraphMdp {
  struct Outcome {
    State next;
    double probability;
  };
  struct Action {
    double reward = 0.0;
    double discount = 1.0;
    std::vector<Outcome> outcomes;
  };
  std::vector<std::vector<Action>> choices;  ///< by state
  std::vector<double> terminals;             ///< by state; counts where there is no choice

  explicit GraphMdp(std::size_t states) : choices(states), terminals(states, 0.0) {}
  std::size_t states() const { return choices.size(); }
  int actions(State s) const { return static_cast<int>(choices[s].size()); }
  double terminal(State s) const { return terminals[s]; }
  double reward(State s, int a) const { return choices[s][static_cast<std::size_t>(a)].reward; }
  double discount(State s, int a) const { return choices[s][static_cast<std::size_t>(a)].discount; }
  template <class Visit>
  void outcomes(State s, int a, Visit&& visit) const {
    for (const Outcome& o : choices[s][static_cast<std::size_t>(a)].outcomes) visit(o.next, o.probability);
  }
};

static_assert(MarkovDecisionProcess<GraphMdp>);

}  // namespace outrider::decision
