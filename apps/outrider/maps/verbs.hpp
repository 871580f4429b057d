#pragma once
// The verbs that need the map room. One file a verb.

#include "context.hpp"

namespace outrider::app {

void add_replay(CLI::App& app, Context& ctx);
void add_map(CLI::App& app, Context& ctx);

}  // namespace outrider::app
