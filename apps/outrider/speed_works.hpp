#pragma once
// Internal to the bench speed: the pieces of work that are timed, with their floors and references.

#include <functional>
#include <string>
#include <vector>

namespace outrider::app {

/// One piece of work done by one implementation.
struct Work {
  std::string case_name;  ///< the same for all that do the same job
  std::string algorithm;  ///< "outrider", "floor", "plain" or "opencv"
  std::string about;
  /// Builds what the work needs; what it returns does the work once.
  std::function<std::function<void()>()> prepare;
};

/// All works, jobs together. Inputs are made from fixed seeds.
std::vector<Work> speed_works();

/// Keeps a result that nobody reads from being optimised away.
void keep(const void* result);

}  // namespace outrider::app
