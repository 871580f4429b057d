#include "auction/bid_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <variant>

#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::auction {
namespace {

/// A field that takes one of two words; `first` is the default.
struct Choice {
  std::string_view first, second;
  bool (*is_second)(const BidParameters&);
  void (*set)(BidParameters&, bool second);
};

template <auto field, auto first, auto second>
constexpr Choice choice(std::string_view first_word, std::string_view second_word) {
  return {first_word, second_word, [](const BidParameters& k) { return k.*field == second; },
          [](BidParameters& k, bool is_second) { k.*field = is_second ? second : first; }};
}

struct Option {
  std::string_view key;
  std::variant<double BidParameters::*, Choice> field;
  std::string_view about;
};

using P = BidParameters;
const Option kOptions[] = {
    {"rho", &P::rho, "ia, ta with ta=unseen: weight of the distance [m^2/m] (Dai 2014, eq. 3)"},
    {"gamma", &P::gamma, "ia, ea, daa: influence of robots without target (eq. 2)"},
    {"weight", &P::weight, "ia, ea, daa: of U_p2 as a whole [m^2]"},
    {"alpha", &P::alpha, "daa: expected utility per explored rate [s] (eq. 10)"},
    {"gain", choice<&P::gain, Gain::kUnseen, Gain::kFootprint>("unseen", "footprint"),
     "what U_p1 counts: unknown cells in view, or all"},
    {"way", choice<&P::way, Way::kShortest, Way::kStraight>("shortest", "straight"),
     "what D is: safe path or straight line"},
    {"sight", choice<&P::sight, true, false>("yes", "no"), "robots out of sight have no influence (eq. 2)"},
    {"ta", choice<&P::ta, TaUtility::kConstant, TaUtility::kUnseen>("constant", "unseen"),
     "ta: utility of a task; unseen is U_p1, minus rho D"},
    {"turn", choice<&P::turn, Turn::kBestBid, Turn::kRobotOrder>("best-bid", "robot-order"),
     "whose bid is served next"},
    {"rebid", choice<&P::rebid, Rebid::kEverybody, Rebid::kFinisher>("everybody", "finisher"),
     "who bids when the first robot finishes"},
};

const Option& option_called(std::string_view key) {
  std::vector<std::string> keys;
  for (const Option& option : kOptions) {
    if (option.key == key) return option;
    keys.emplace_back(option.key);
  }
  throw InputError(fmt::format("--bids: unknown key '{}'{}", key, suggestion(key, keys)));
}

void set(BidParameters& parameters, std::string_view key, std::string_view value) {
  const Option& option = option_called(key);
  if (const auto* choice = std::get_if<Choice>(&option.field)) {
    if (value != choice->first && value != choice->second)
      throw InputError(fmt::format("--bids {}={}: expected {} or {}", key, value, choice->first, choice->second));
    choice->set(parameters, value == choice->second);
    return;
  }
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !(number >= 0.0 && number <= 1e9))
    throw InputError(fmt::format("--bids {}={}: expected a number from 0 to 1e9", key, value));
  parameters.*std::get<double BidParameters::*>(option.field) = number;
}

std::string value_text(const BidParameters& parameters, const Option& option) {
  if (const auto* choice = std::get_if<Choice>(&option.field))
    return std::string(choice->is_second(parameters) ? choice->second : choice->first);
  return fmt::format("{:g}", parameters.*std::get<double BidParameters::*>(option.field));
}

}  // namespace

const std::vector<BidOptionInfo>& bid_options() {
  static const std::vector<BidOptionInfo> infos = [] {
    std::vector<BidOptionInfo> list;
    for (const Option& option : kOptions) {
      const auto* choice = std::get_if<Choice>(&option.field);
      list.push_back({std::string(option.key),
                      choice ? fmt::format("{}|{}", choice->first, choice->second)
                             : fmt::format("number, {}", value_text({}, option)),
                      std::string(option.about)});
    }
    return list;
  }();
  return infos;
}

void set_bid_options(BidParameters& parameters, std::string_view text) {
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const auto equals = item.find('=');
    if (equals == std::string_view::npos) throw InputError(fmt::format("--bids: '{}': expected KEY=VALUE", item));
    set(parameters, item.substr(0, equals), item.substr(equals + 1));
  }
}

std::string bid_options_text(const BidParameters& parameters) {
  std::string text;
  for (const Option& option : kOptions)
    if (const std::string value = value_text(parameters, option); value != value_text({}, option))
      text += fmt::format("{}{}={}", text.empty() ? "" : ",", option.key, value);
  return text;
}

}  // namespace outrider::auction
