#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "explorer/coordinator.hpp"

namespace outrider::explorer {

/// From the sheets of a round to its awards.
using Allocate = std::function<std::vector<Award>(const auction::BidTable&, const auction::Clear&)>;

/// Which tasks a robot bids for.
using BidFor = std::function<TaskGrain(const Situation&)>;

/// The auction cycle of Dai 2014, Fig. 1, as messages. The robot that finishes first opens a round (RoundOpen);
/// everybody who hears it answers with all its bids (BidSheet), busy robots too: unfinished tasks are auctioned again.
/// The opener closes the round when all expected sheets are in, or after 0.5 s, and broadcasts the awards. Of two
/// rounds open at once the one of the lower robot stands. docs/protocol.md has the state chart.
/// With Rebid::kFinisher robots under way are asked, but keep their tasks.
std::unique_ptr<Coordinator> make_auction_coordinator(BidFor bid_for, Allocate allocate,
                                                      auction::Rebid rebid = auction::Rebid::kEverybody);

}  // namespace outrider::explorer
