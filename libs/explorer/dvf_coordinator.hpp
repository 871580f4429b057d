#pragma once
// Matignon, Jeanpierre and Mouaddib 2012: each robot plans for itself, anew every second.

#include <memory>
#include <string_view>

#include "explorer/coordinator.hpp"

namespace outrider::explorer {

/// `independent` (eq. 1), `dvf` (eq. 3 and 7, Algorithm 1) or `dvf-reactive` (eq. 6).
std::unique_ptr<Coordinator> make_dvf_coordinator(std::string_view name, const CoordinatorSettings& settings);

}  // namespace outrider::explorer
