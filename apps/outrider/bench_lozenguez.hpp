#pragma once
// What the three benches of Lozenguez et al. 2015 share.

#include <memory>
#include <string>

#include "decision/topological_map.hpp"

namespace outrider::app {

/// The topological map of an embedded world, built from its grid for the world's usual robots; ways longer than
/// `longest_m` [m] (0: none) get waypoints between. The paper's own maps are pictures only.
std::shared_ptr<const decision::TopologicalMap> lozenguez_map(const std::string& world, double longest_m = 0.0);

/// The same map where each path misses its target with probability `deviation`: half of that the robot stays, half it
/// ends elsewhere.
decision::TopologicalMap with_deviation(decision::TopologicalMap map, double deviation);

}  // namespace outrider::app
