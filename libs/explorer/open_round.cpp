#include "explorer/open_round.hpp"

#include <utility>

namespace outrider::explorer {

RoundOpen OpenRound::call() const {
  RoundOpen open{id, {}, some ? expected : std::vector<RobotId>{}};
  for (const BidSheet& sheet : sheets)
    if (open.heard.size() < RoundOpen::kMostHeard) open.heard.push_back(sheet.robot);
  return open;
}

void OpenRound::collect(const BidSheet& part) {
  if (part.round != id || heard(part.robot)) return;
  auto& have = parts[part.robot];
  const auto known = [&](const BidSheet& other) { return other.part == part.part; };
  if (std::any_of(have.begin(), have.end(), known)) return;
  have.push_back(part);
  if (have.size() < static_cast<std::size_t>(part.parts)) return;
  std::sort(have.begin(), have.end(), [](const BidSheet& a, const BidSheet& b) { return a.part < b.part; });
  BidSheet whole = std::move(have.front());
  for (auto next = have.begin() + 1; next != have.end(); ++next)
    whole.entries.insert(whole.entries.end(), next->entries.begin(), next->entries.end());
  parts.erase(part.robot);
  sheets.push_back(std::move(whole));
}

std::vector<BidSheet> cut(BidSheet sheet) {
  const std::vector<BidEntry> entries = std::exchange(sheet.entries, {});
  sheet.parts = static_cast<int>(std::max<std::size_t>(1, (entries.size() + BidSheet::kMostEntries - 1) / BidSheet::kMostEntries));
  std::vector<BidSheet> parts;
  for (sheet.part = 0; sheet.part < sheet.parts; ++sheet.part) {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(sheet.part) * static_cast<std::ptrdiff_t>(BidSheet::kMostEntries);
    const auto size = std::min<std::ptrdiff_t>(entries.end() - begin, BidSheet::kMostEntries);
    parts.push_back(sheet);
    parts.back().entries.assign(begin, begin + size);
  }
  return parts;
}

std::vector<Awards> cut(const Awards& awards) {
  std::vector<Awards> messages;
  for (std::size_t k = 0; k < awards.bidders.size(); k += Awards::kMostBidders) {
    Awards some{awards.round, awards.epoch, {}, {}};
    for (std::size_t b = k; b < std::min(awards.bidders.size(), k + Awards::kMostBidders); ++b) {
      some.bidders.push_back(awards.bidders[b]);
      for (const Award& award : awards.awards)
        if (award.robot == awards.bidders[b]) some.awards.push_back(award);
    }
    messages.push_back(std::move(some));
  }
  return messages;
}

}  // namespace outrider::explorer
