#pragma once

#include <optional>
#include <string>

#include "sim/world.hpp"

namespace outrider::app {

/// The world called `source`: an embedded name, or a map file of any known format. Throws InputError.
sim::World open_world(const std::string& source, std::optional<double> resolution);

}  // namespace outrider::app
