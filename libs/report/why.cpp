#include "report/why.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/table.hpp"

namespace outrider::report {
namespace {

constexpr std::size_t kMostShown = 8;  // of a robot's own bids, in words

std::string kind(const Json& event) { return event.value("event", std::string()); }

/// Who won `task` in an auction; null when nobody did.
Json winner(const Json& auction, const Json& task) {
  for (const Json& award : auction["awards"])
    if (award["task"] == task) return award["robot"];
  return {};
}

Json bid_json(const Json& auction, const Json& bidder, const Json& bid) {
  const Json task{bid[0], bid[1]};
  return {{"robot", bidder["robot"]},
          {"task", task},
          {"gain_m2", bid[2]},
          {"distance_m", bid[3]},
          {"won_by", winner(auction, task)}};
}

/// Gain per way, so that the bids that nearly won come first.
double appeal(const Json& bid) { return bid["gain_m2"].get<double>() / (1.0 + bid["distance_m"].get<double>()); }

std::string place(const Json& task) {
  return fmt::format("({:.1f}, {:.1f})", task[0].get<double>(), task[1].get<double>());
}

Table bid_table(const std::string& title, const Json& bids, bool own, std::size_t most) {
  Table table{title, {own ? "task at [m]" : "robot", "gain [m²]", "distance [m]", own ? "won by" : "went to"}, {}, ""};
  for (const Json& bid : bids) {
    if (table.rows.size() == most) {
      table.note = fmt::format("and {} more", bids.size() - most);
      break;
    }
    const Json& last = own ? bid["won_by"] : bid["went_to"];
    table.rows.push_back({own ? place(bid["task"]) : bid["robot"].get<std::string>(),
                          fmt::format("{:.1f}", bid["gain_m2"].get<double>()),
                          fmt::format("{:.1f}", bid["distance_m"].get<double>()),
                          last.is_null()     ? "-"
                          : last.is_string() ? last.get<std::string>()
                                             : place(last)});
  }
  return table;
}

}  // namespace

Json why(std::span<const Json> events, const std::string& robot, double t) {
  Json goal, auction;
  for (const Json& e : events) {
    if (e.value("t", 0.0) > t) break;
    const bool own = e.value("robot", std::string()) == robot;
    if (own && kind(e) == "goal") goal = e;
    if (own && kind(e) == "task_end") goal = nullptr;
  }
  Json result{{"robot", robot}, {"t", t}, {"goal", goal}, {"auction", nullptr}};
  if (goal.is_null()) return result;
  for (const Json& e : events) {
    if (e.value("t", 0.0) > t) break;
    if (kind(e) == "auction" && winner(e, goal["task"]) == robot) auction = e;
  }
  if (auction.is_null()) return result;
  Json for_task = Json::array(), own_bids = Json::array();
  for (const Json& bidder : auction["bids"])
    for (const Json& bid : bidder["tasks"]) {
      Json b = bid_json(auction, bidder, bid);
      if (bidder["robot"] == robot) own_bids.push_back(b);
      if (b["task"] != goal["task"]) continue;
      b["went_to"] = nullptr;
      for (const Json& award : auction["awards"])
        if (award["robot"] == bidder["robot"]) b["went_to"] = award["task"];
      for_task.push_back(std::move(b));
    }
  std::stable_sort(own_bids.begin(), own_bids.end(),
                   [](const Json& a, const Json& b) { return appeal(a) > appeal(b); });
  for (const Json& award : auction["awards"])
    if (award["robot"] == robot) result["value"] = award["value"];
  for (const Json& bidder : auction["bids"])
    if (bidder["robot"] == robot) result["explored_rate_m2_s"] = bidder["explored_rate_m2_s"];
  auction.erase("bids");
  result["auction"] = std::move(auction);
  result["for_task"] = std::move(for_task);
  result["own_bids"] = std::move(own_bids);
  return result;
}

std::string why_text(const Json& why) {
  const std::string robot = why["robot"];
  const double t = why["t"];
  const Json& goal = why["goal"];
  if (goal.is_null()) return fmt::format("{} had no task at {:.1f} s.\n", robot, t);
  std::string text =
      fmt::format("{} at {:.1f} s: heading for {} since {:.1f} s, {:.1f} m from where it was then.\n", robot, t,
                  place(goal["task"]), goal["t"].get<double>(), goal["distance_m"].get<double>());
  const Json& auction = why["auction"];
  if (auction.is_null())
    return text +
           fmt::format("No auction was behind it; its own value of the task: {:.3f}.\n", goal["value"].get<double>());
  text += fmt::format(
      "It won this task at {:.1f} s, in round {} of {}, with a bid of {:.3f}; it had explored {:.2f} m²/s so far.\n",
      auction["t"].get<double>(), auction["round"].get<int>(), auction["opener"].get<std::string>(),
      why["value"].get<double>(), why["explored_rate_m2_s"].get<double>());
  if (!auction["unheard"].empty()) text += fmt::format("Not heard in this round: {}.\n", auction["unheard"].dump());
  text += '\n' + table_text(bid_table("Bids for this task", why["for_task"], false, why["for_task"].size()));
  return text + '\n' +
         table_text(bid_table("Its own bids, gain per distance first", why["own_bids"], true, kMostShown));
}

}  // namespace outrider::report
