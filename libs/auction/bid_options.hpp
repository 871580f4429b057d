#pragma once
// The parameters and readings of the bid rules by name: what `--bids` and bench tables speak.

#include <string>
#include <string_view>
#include <vector>

#include "auction/bid_rules.hpp"

namespace outrider::auction {

struct BidOptionInfo {
  std::string key;
  std::string values;  ///< "number" or the words, the default first
  std::string about;   ///< with the rules that it concerns
};

/// All keys, in the order of the help text.
const std::vector<BidOptionInfo>& bid_options();

/// Sets parameters from "rho=0.2,gain=footprint". Throws InputError that names the key or value and what was expected.
void set_bid_options(BidParameters& parameters, std::string_view text);

/// The keys whose values differ from the defaults as "key=value,..."; empty when none does.
std::string bid_options_text(const BidParameters& parameters);

}  // namespace outrider::auction
