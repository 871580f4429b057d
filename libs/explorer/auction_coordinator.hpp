#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "explorer/coordinator.hpp"

namespace outrider::explorer {

/// From the sheets of a round to its awards.
using Allocate = std::function<std::vector<Award>(const auction::BidTable&, const auction::Clear&)>;

/// A round asks so many team-mates at most, the nearest to its seller: what a round costs does not grow with the team.
inline constexpr std::size_t kMostAsked = 5;

/// Which tasks a robot bids for.
using BidFor = std::function<TaskGrain(const Situation&)>;

/// How long a task stays with its winner without a sign of life from it [s].
inline constexpr double kLease = 3.0;

/// The auction cycle of Dai 2014, Fig. 1, as messages that may be lost, late, doubled or out of order. The robot that
/// finishes first sells: it opens a round (RoundOpen, repeated until all sheets are in, 1 s at most); everybody who hears
/// it answers with all its bids (BidSheet, in parts), busy robots too: unfinished tasks are auctioned again. The seller
/// then broadcasts the awards and repeats them until all bidders follow them or something newer. Of two rounds open at
/// once that ask the same robot the one of the lower robot stands; of two awards the newer epoch does, whatever the order
/// of arrival. In a team of more than kMostAsked + 1 a round names whom it asks; the others keep what they have.
///
/// A status renews its sender's lease on its goal. The task of a silent robot is not for sale while its lease lasts, and
/// is sold again afterwards. Of two robots with the same frontier that hear each other the one with the older award lets
/// go. Under the ideal radio none of this shows once robots have heard of each other. docs/protocol.md has the whole story.
/// With Rebid::kFinisher robots under way are asked, but keep their tasks.
std::unique_ptr<Coordinator> make_auction_coordinator(BidFor bid_for, Allocate allocate,
                                                      auction::Rebid rebid = auction::Rebid::kEverybody);

}  // namespace outrider::explorer
