#pragma once

#include <filesystem>

#include "context.hpp"

namespace outrider::app {

/// `outrider replay RUN.lcm`: maps and report of a live team from a recording of its traffic. Throws InputError.
void replay_lcm(const std::filesystem::path& log, Context& ctx);

}  // namespace outrider::app
